# SPDX-License-Identifier: BSD-3-Clause
# The page of `livens report` in its own tools: rebuilt from its sources, and opened in a browser. Both say SKIPPED where
# Node, the packages of report/ or Chromium are missing; tests/system/report_test.py needs none of them.

if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # nothing of it is compiled
    return()
endif()
find_program(LIVENS_NODE node)
if(LIVENS_NODE)
    set(run_node ${LIVENS_NODE})
else()
    set(run_node ${CMAKE_COMMAND} -E echo "SKIPPED: no node to run")
endif()
add_test(NAME report.page_is_what_its_sources_make COMMAND ${run_node} ${PROJECT_SOURCE_DIR}/report/test/bundle.mjs)
set_tests_properties(report.page_is_what_its_sources_make PROPERTIES LABELS fast TIMEOUT 120)
set(report_tests report.page_is_what_its_sources_make)
if(LIVENS_BUILD_PROGRAM AND LIVENS_SLOW_TESTS)
    add_test(NAME report.in_a_browser COMMAND ${run_node} ${PROJECT_SOURCE_DIR}/report/test/browser.mjs)
    set_tests_properties(report.in_a_browser PROPERTIES LABELS "slow;browser" TIMEOUT 900 COST 100
                         ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>")
    add_test(NAME report.what_the_page_saves COMMAND ${run_node} ${PROJECT_SOURCE_DIR}/report/test/saved.mjs)
    add_test(NAME report.plots COMMAND ${run_node} ${PROJECT_SOURCE_DIR}/report/test/plots.mjs)
    add_test(NAME report.scene COMMAND ${run_node} ${PROJECT_SOURCE_DIR}/report/test/scene.mjs)
    foreach(test what_the_page_saves plots scene)
        set_tests_properties(report.${test} PROPERTIES LABELS "slow;browser" TIMEOUT 600 COST 60
                             ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>")
        list(APPEND report_tests report.${test})
    endforeach()
    list(APPEND report_tests report.in_a_browser)
endif()
set_tests_properties(${report_tests} PROPERTIES SKIP_REGULAR_EXPRESSION "^SKIPPED: ")
