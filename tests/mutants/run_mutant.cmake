# SPDX-License-Identifier: BSD-3-Clause
# cmake -DPROGRAM= -DMUST_FAIL="filter;..." -P run_mutant.cmake: succeeds only if the program ran to its end
# (no crash) and every filter matches a test that failed.

list(JOIN MUST_FAIL ":" filter)
execute_process(COMMAND ${PROGRAM} --gtest_filter=${filter} --gtest_color=no --gtest_print_time=0
                OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE result)
if(NOT output MATCHES "\\[==========\\] ([0-9]+) tests? from [^\n]* ran\\.")
    message(FATAL_ERROR "The program ended early (${result}): a crash does not count as noticed.\n"
                        "${output}\n${errors}")
endif()
set(n_ran ${CMAKE_MATCH_1})
foreach(name ${MUST_FAIL})
    string(REGEX REPLACE "([][+.^$()|\\])" "\\\\\\1" pattern "${name}")
    string(REPLACE "*" "[^ ,\n]*" pattern "${pattern}")
    string(REPLACE "?" "[^ ,\n]" pattern "${pattern}")
    if(NOT output MATCHES "\\[  FAILED  \\] ${pattern}[ ,\n]")
        message(FATAL_ERROR "The fault went unnoticed: no test '${name}' failed (${n_ran} ran).\n${output}")
    endif()
endforeach()
if(NOT result EQUAL 1)
    message(FATAL_ERROR "The program ended with ${result} instead of 1.\n${output}\n${errors}")
endif()
message(STATUS "noticed by ${MUST_FAIL}")
