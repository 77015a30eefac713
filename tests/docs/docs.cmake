# SPDX-License-Identifier: BSD-3-Clause
# README.md and the pages for people: their code blocks run, and print what they show. Blocks of Python, and the site
# itself, are tried by scripts/docs.

# Not under sanitizers: what is tried here is documents, and blocks of C++ are compiled as a reader would.
if(LIVENS_BUILD_PROGRAM AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    set(blocks ${livens_python} -B ${CMAKE_CURRENT_LIST_DIR}/blocks.py ${PROJECT_SOURCE_DIR})
    add_test(NAME docs.blocks COMMAND ${blocks})
    add_test(NAME docs.blocks_refuses_faults COMMAND ${blocks} --controls)
    set_tests_properties(docs.blocks docs.blocks_refuses_faults PROPERTIES LABELS fast TIMEOUT 900 COST 100
                         ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>")

    set(pages ${livens_python} -B ${PROJECT_SOURCE_DIR}/scripts/type_pages)
    add_test(NAME docs.type_pages_are_current COMMAND ${pages} --check)
    add_test(NAME docs.type_pages_refuse_faults COMMAND ${pages} --controls)
    add_test(NAME docs.sketches_are_current COMMAND ${livens_python} -B ${PROJECT_SOURCE_DIR}/scripts/draw_loads --check)
    set_tests_properties(docs.type_pages_are_current docs.type_pages_refuse_faults docs.sketches_are_current PROPERTIES LABELS fast TIMEOUT 300
                         ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>")

    set(figures ${livens_python} -B ${CMAKE_CURRENT_LIST_DIR}/figures.py ${PROJECT_SOURCE_DIR} $<TARGET_FILE:livens>)
    if(TARGET reference)
        list(APPEND figures $<TARGET_FILE:reference>)
    endif()
    add_test(NAME docs.figures_are_what_is_measured COMMAND ${figures})
    add_test(NAME docs.figures_refuses_stale_ones COMMAND ${figures} --controls)
    set_tests_properties(docs.figures_are_what_is_measured docs.figures_refuses_stale_ones PROPERTIES LABELS fast TIMEOUT 900 COST 50)
    foreach(test blocks_refuses_faults type_pages_refuse_faults figures_refuses_stale_ones)
        set_tests_properties(docs.${test} PROPERTIES LABELS "fast;controls")   # see scripts/needs
    endforeach()
endif()
add_test(NAME docs.changelog_is_current COMMAND ${livens_python} -B ${PROJECT_SOURCE_DIR}/scripts/changelog --check)
set_tests_properties(docs.changelog_is_current PROPERTIES LABELS fast TIMEOUT 60)
