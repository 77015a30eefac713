# SPDX-License-Identifier: BSD-3-Clause
# Tests that run the program as a user does: one ctest a class of these scripts. Standard library only; what needs
# netCDF4, xarray, ncdump or the right to mount is skipped where it is missing.
include(CheckFunctionExists)

if(LIVENS_BUILD_PROGRAM)
    check_function_exists(__libc_memalign LIVENS_HAS_GLIBC)
    if(LIVENS_HAS_GLIBC)   # to be loaded before the program's libraries: allocations that fail
        add_library(failing_allocations MODULE ${CMAKE_CURRENT_SOURCE_DIR}/system/failing_allocations.cpp)
        target_link_libraries(failing_allocations PRIVATE livens_flags)
        set_target_properties(failing_allocations PROPERTIES PREFIX "")
    endif()
    foreach(file program_test terminal_test rest_test locking_test mass_test skew_test export_test report_test watch_test stop_test memory_test strangers_test import_test picture_test hard_ends)
        set(script ${CMAKE_CURRENT_SOURCE_DIR}/system/${file}.py)
        file(STRINGS ${script} classes REGEX "^class [A-Za-z]+\\((ProgramTest|HardTest)\\)")
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
        list(FILTER classes EXCLUDE REGEX "class HardTest")
        set(label fast)
        if(file MATCHES "^(hard_ends|picture_test)$")   # hard_ends.py --long is for people
            set(label slow)
        endif()
        if(label STREQUAL "slow" AND NOT LIVENS_SLOW_TESTS)
            continue()
        endif()
        foreach(line ${classes})
            string(REGEX REPLACE "^class ([A-Za-z]+).*" "\\1" name "${line}")
            set(labels ${label} program)
            if(NOT name MATCHES "^(CraftedResults|Files|Formats|Gltf|HardEnds|HostileImport|Import|Npz|NothingIsLost|WrongInput)$")
                list(APPEND labels motions)   # whole motions and what is printed: not under sanitizers in scripts/test
            endif()
            if(name STREQUAL "Pictures")
                list(APPEND labels browser)   # see scripts/needs
            endif()
            add_test(NAME system.${name} COMMAND ${livens_python} -B ${script} ${name})
            set_tests_properties(
                system.${name}
                PROPERTIES LABELS "${labels}" TIMEOUT 600 COST 100   # first, since they are the longest
                ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>;LIVENS_SOURCE_DIR=${PROJECT_SOURCE_DIR}")
        endforeach()
    endforeach()
    set(livens_has_petsc 0)
    if(LIVENS_PETSC)
        set(livens_has_petsc 1)
    endif()
    add_test(NAME distributed COMMAND ${livens_python} -B ${CMAKE_CURRENT_SOURCE_DIR}/system/distributed_test.py)
    set_tests_properties(distributed PROPERTIES LABELS "fast;motions" TIMEOUT 1200 SKIP_REGULAR_EXPRESSION "SKIPPED: distributed"
        ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>;LIVENS_HAS_PETSC=${livens_has_petsc}")
endif()
