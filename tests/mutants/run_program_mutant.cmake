# SPDX-License-Identifier: BSD-3-Clause
# cmake -DPROGRAM= -DPYTHON= -DTESTS= -DMUST_FAIL="script.Class.test_method;..." -P run_program_mutant.cmake: succeeds only
# if each of these tests runs to its end and an assertion of it fails.

foreach(name ${MUST_FAIL})
    string(REGEX MATCH "^([a-z_]+)\\.(.+)$" parts ${name})
    execute_process(COMMAND ${CMAKE_COMMAND} -E env LIVENS_PROGRAM=${PROGRAM} LIVENS_SOURCE_DIR=${TESTS}/../..
                            ${PYTHON} -B ${TESTS}/${CMAKE_MATCH_1}.py ${CMAKE_MATCH_2}
                    OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE result)
    if(NOT result EQUAL 1 OR NOT errors MATCHES "FAILED \\(failures=")
        message(FATAL_ERROR "The fault went unnoticed: ${name} ended with ${result}.\n${output}\n${errors}")
    endif()
endforeach()
message(STATUS "noticed by ${MUST_FAIL}")
