# SPDX-License-Identifier: BSD-3-Clause
# Negative controls by mutation: one deliberate fault a program, and the tests that must notice it.
#
# livens_mutant(NAME name             the test is mutant.<name>
#               FILE room/file.cpp    under src/livens, or apps/livens/...; a header needs RECOMPILE as well
#               OLD text NEW text     OLD stands exactly once in FILE, otherwise the build stops
#               TESTS_OF target       a program made by livens_test; its objects are linked again. Or the program, livens
#               MUST_FAIL name...     tests of it as --gtest_filter spells them; each must match a FAILED test. Of the
#                                     program: script.Class.test_method of tests/system
#               [RECOMPILE file...])  sources under src/livens to compile with the fault; default: FILE
#
# A mutant is linked from its own object, the test program's objects and the libraries; the linker takes the
# faulty object and leaves the good one in the archive. Only the faulty source is compiled again.
#
# LIVENS_MUTANTS says which of them are built: all, none, or names. scripts/needs names those that a change concerns.
set(LIVENS_MUTANTS "all" CACHE STRING "Mutants to build: all, none, or a list of names")
set_property(GLOBAL PROPERTY livens_mutants "")

function(livens_mutant)
    # PARSE_ARGV keeps semicolons in the texts.
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME;FILE;OLD;NEW;TESTS_OF" "MUST_FAIL;RECOMPILE")
    foreach(required NAME FILE OLD NEW TESTS_OF MUST_FAIL)
        if(NOT DEFINED arg_${required})
            message(FATAL_ERROR "mutant '${arg_NAME}': ${required} is missing")
        endif()
    endforeach()
    set_property(GLOBAL APPEND PROPERTY livens_mutants ${arg_NAME})
    if(NOT LIVENS_MUTANTS STREQUAL "all" AND NOT arg_NAME IN_LIST LIVENS_MUTANTS)
        return()
    endif()
    set(original ${PROJECT_SOURCE_DIR}/src/livens/${arg_FILE})
    if(arg_FILE MATCHES "^apps/")
        set(original ${PROJECT_SOURCE_DIR}/${arg_FILE})
    endif()
    if(NOT EXISTS ${original} OR NOT TARGET ${arg_TESTS_OF})
        message(FATAL_ERROR "mutant '${arg_NAME}': no ${original} or no test program ${arg_TESTS_OF}")
    endif()
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/mutants/${arg_NAME})
    set(mutated ${folder}/livens/${arg_FILE})
    # Kept as files, written when they change only: a command line would mangle quotes, semicolons and line
    # ends.
    foreach(side OLD NEW)
        string(TOLOWER ${side} text)
        set(text ${folder}/${text}.txt)
        set(known)
        if(EXISTS ${text})
            file(READ ${text} known)
        endif()
        if(NOT EXISTS ${text} OR NOT known STREQUAL "${arg_${side}}")
            file(WRITE ${text} "${arg_${side}}")
        endif()
    endforeach()
    add_custom_command(
        OUTPUT ${mutated}
        COMMAND ${CMAKE_COMMAND} -DNAME=${arg_NAME} -DORIGINAL=${original} -DFOLDER=${folder}
                -DMUTATED=${mutated} -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/mutate.cmake
        DEPENDS ${original} ${folder}/old.txt ${folder}/new.txt
                ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/mutate.cmake
        COMMENT "Mutating ${arg_FILE}: ${arg_NAME}" VERBATIM)

    set(compiled ${original})
    if(arg_RECOMPILE)
        list(TRANSFORM arg_RECOMPILE PREPEND ${PROJECT_SOURCE_DIR}/src/livens/ OUTPUT_VARIABLE compiled)
    elseif(NOT arg_FILE MATCHES "\\.cpp$")
        message(FATAL_ERROR "mutant '${arg_NAME}': say which sources RECOMPILE with the header ${arg_FILE}")
    endif()
    string(REGEX REPLACE "/.*" "" room ${arg_FILE})
    set(target mutant_${arg_NAME})
    # Where sources compile in groups the whole group does: others of it may have the fault inlined, and come with its good
    # object.
    set(sources ${mutated})
    set_source_files_properties(${mutated} PROPERTIES HEADER_FILE_ONLY ON)
    set(seen)
    foreach(source ${compiled})
        if(source IN_LIST seen)
            continue()
        endif()
        file(RELATIVE_PATH of_room ${PROJECT_SOURCE_DIR} ${source})
        string(REGEX REPLACE "^(src/livens/)?([a-z]+)/.*" "\\2" of_room ${of_room})
        livens_group_of(group ${source} ${of_room})
        list(APPEND seen ${group})
        set(text)
        foreach(one ${group})
            if(one STREQUAL original)
                set(one ${mutated})
            endif()
            string(APPEND text "#include \"${one}\"\n")
        endforeach()
        get_filename_component(stem ${source} NAME_WE)
        file(CONFIGURE OUTPUT ${folder}/with_${stem}.cpp CONTENT "${text}" @ONLY)
        set_source_files_properties(${folder}/with_${stem}.cpp PROPERTIES OBJECT_DEPENDS ${mutated})
        list(APPEND sources ${folder}/with_${stem}.cpp)
        get_source_file_property(definitions ${source} DIRECTORY ${PROJECT_SOURCE_DIR} COMPILE_DEFINITIONS)
        if(definitions)
            set_source_files_properties(${folder}/with_${stem}.cpp PROPERTIES COMPILE_DEFINITIONS "${definitions}")
        endif()
    endforeach()
    # A good object of the program must stay away; one of a library is not asked for.
    set(objects $<TARGET_OBJECTS:${arg_TESTS_OF}>)
    if(room STREQUAL "apps")
        get_filename_component(file ${arg_FILE} NAME)
        set(objects "$<FILTER:${objects},EXCLUDE,apps/.*/${file}>")
        if(group_object)
            set(objects "$<FILTER:${objects},EXCLUDE,${group_object}>")
        endif()
    endif()
    add_executable(${target} ${sources} "${objects}")
    if(arg_TESTS_OF STREQUAL "livens")
        set(libraries livens_io CLI11::CLI11 fmt::fmt-header-only)
        set(test -DPYTHON=${livens_python} -DTESTS=${PROJECT_SOURCE_DIR}/tests/system)
        set(script run_program_mutant.cmake)
    else()
        set(libraries GTest::gtest GTest::gtest_main)
        if(room STREQUAL "io" OR arg_TESTS_OF MATCHES "^(reference|unit_io)$")   # which reads scenarios
            list(PREPEND libraries livens_io)
        endif()
        set(test)
        set(script run_mutant.cmake)
    endif()
    # As the room is compiled, but with the faulty folder first, without warnings, as a fault may leave things unused,
    # and in half of the time.
    target_include_directories(${target} BEFORE PRIVATE ${folder})
    if(room STREQUAL "apps")
        target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/apps/livens)
    else()
        target_include_directories(${target} SYSTEM
                                   PRIVATE $<TARGET_PROPERTY:livens_room_${room},INCLUDE_DIRECTORIES>)
        target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:livens_room_${room},COMPILE_DEFINITIONS>)
    endif()
    target_link_libraries(${target} PRIVATE livens_flags ${libraries} livens_core Threads::Threads)
    target_compile_options(${target} PRIVATE -w $<$<CONFIG:Release>:-O1>)
    # A good object may be taken beside it, for a template that only one of both has as a function; what both define
    # is the first one's, which is the faulty one's.
    target_link_options(${target} PRIVATE -Wl,--allow-multiple-definition)
    add_test(NAME mutant.${arg_NAME}
             COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${target}> "-DMUST_FAIL=${arg_MUST_FAIL}" ${test}
                     -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${script})
    set_tests_properties(mutant.${arg_NAME} PROPERTIES LABELS mutant TIMEOUT 300
                         ENVIRONMENT LIVENS_SIMD=sse2)   # the one set of kernels that mutants compile again
endfunction()

if(LIVENS_SLOW_TESTS AND NOT BUILD_SHARED_LIBS)   # which would keep their insides to themselves
    include(${CMAKE_CURRENT_LIST_DIR}/faults.cmake)
    get_property(known GLOBAL PROPERTY livens_mutants)
    set(unknown ${LIVENS_MUTANTS})
    list(REMOVE_ITEM unknown all none ${known})
    if(unknown)
        message(FATAL_ERROR "LIVENS_MUTANTS: no such mutants: ${unknown}")
    endif()
endif()
