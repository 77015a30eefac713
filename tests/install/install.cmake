# SPDX-License-Identifier: BSD-3-Clause
# An outside project finds the installed livens, solves the free box and compares a number: with the
# compiler's default flags and with processor flags that the library was not built with, which a program that
# uses Eigen itself may have.

include(CheckCXXSourceRuns)

set(livens_install_prefix ${CMAKE_CURRENT_BINARY_DIR}/install/prefix)
add_test(NAME install.prefix
         COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DPREFIX=${livens_install_prefix}
                 -DCONFIG=$<CONFIG> -P ${CMAKE_CURRENT_LIST_DIR}/install_prefix.cmake)
set_tests_properties(install.prefix PROPERTIES FIXTURES_SETUP livens_installed LABELS slow TIMEOUT 120)

# The library's own Eigen has another namespace; were it not so, the flags below could change the library's
# results.
add_test(NAME install.shares_no_eigen_symbols
         COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DPREFIX=${livens_install_prefix}
                 -P ${CMAKE_CURRENT_LIST_DIR}/check_symbols.cmake)
set_tests_properties(install.shares_no_eigen_symbols PROPERTIES
                     FIXTURES_REQUIRED livens_installed LABELS slow TIMEOUT 60)

function(livens_install_test name flags prefix installed labels)
    add_test(NAME install.free_box_${name}
             COMMAND ${CMAKE_COMMAND} -DPROJECT=${CMAKE_CURRENT_FUNCTION_LIST_DIR}/outside
                     -DBUILD=${CMAKE_CURRENT_BINARY_DIR}/install/${name} -DPREFIX=${prefix}
                     -DCOMPILER=${CMAKE_CXX_COMPILER} -DGENERATOR=${CMAKE_GENERATOR}
                     "-DFLAGS=${CMAKE_CXX_FLAGS} ${flags}"
                     -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/run_outside.cmake)
    set_tests_properties(install.free_box_${name} PROPERTIES
                         FIXTURES_REQUIRED ${installed} LABELS "${labels}" TIMEOUT 300)
endfunction()

# A flag is tried only where the machine can run its code.
function(livens_install_test_if_supported name flags feature)
    set(source "int main() { return __builtin_cpu_supports(\"${feature}\") ? 0 : 1; }")
    check_cxx_source_runs("${source}" LIVENS_HAS_${feature})
    if(LIVENS_HAS_${feature})
        livens_install_test(${name} "${flags}" ${livens_install_prefix} livens_installed "slow;installs")
    endif()
endfunction()

if(LIVENS_SLOW_TESTS)
    livens_install_test(default "" ${livens_install_prefix} livens_installed slow)
    livens_install_test(native "-march=native" ${livens_install_prefix} livens_installed "slow;installs")
    livens_install_test_if_supported(mavx "-mavx" avx)
    livens_install_test_if_supported(x86_64_v3 "-march=x86-64-v3" avx2)
endif()

set(check_binaries ${livens_python} -B ${CMAKE_CURRENT_LIST_DIR}/check_binaries.py)
if(LIVENS_BUILD_PROGRAM AND LIVENS_HARDENING AND CMAKE_BUILD_TYPE MATCHES "^Rel" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    add_test(NAME install.program_is_hardened
             COMMAND ${check_binaries} hardened $<TARGET_FILE:livens> ${CMAKE_CXX_COMPILER})
    set_tests_properties(install.program_is_hardened PROPERTIES LABELS fast TIMEOUT 60 SKIP_RETURN_CODE 77)
endif()

# Shared libraries, from a build of their own; by the flags of this one, so that a compiler's cache has the objects.
if(LIVENS_SLOW_TESTS AND LIVENS_BUILD_PROGRAM)
    set(shared ${CMAKE_CURRENT_BINARY_DIR}/install/shared_libraries)   # not the folder of a test below
    add_test(NAME install.shared_libraries
             COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DBUILD=${shared}/build -DPREFIX=${shared}/prefix
                     -DCOMPILER=${CMAKE_CXX_COMPILER} -DGENERATOR=${CMAKE_GENERATOR}
                     -DWARNINGS_AS_ERRORS=${LIVENS_WARNINGS_AS_ERRORS} -DGROUPS=${LIVENS_GROUPS}
                     -P ${CMAKE_CURRENT_LIST_DIR}/install_shared.cmake)
    set_tests_properties(install.shared_libraries PROPERTIES
                         FIXTURES_SETUP livens_installed_shared LABELS "slow;shared" TIMEOUT 3600)
    add_test(NAME install.shared_libraries_export_what_is_declared
             COMMAND ${check_binaries} exported ${shared}/prefix)
    set_tests_properties(install.shared_libraries_export_what_is_declared PROPERTIES
                         FIXTURES_REQUIRED livens_installed_shared LABELS "slow;shared" TIMEOUT 60 SKIP_RETURN_CODE 77)
    livens_install_test(shared "" ${shared}/prefix livens_installed_shared "slow;shared")
endif()
