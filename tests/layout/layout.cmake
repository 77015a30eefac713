# SPDX-License-Identifier: BSD-3-Clause
# The house's rules, checked as tests: the table of floors, sizes, names, documents. Each checker is also run
# against made-up faults that it must refuse.

if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # no program is run here
    return()
endif()
foreach(check floors functions classes names docs words faults)
    set(script ${CMAKE_CURRENT_SOURCE_DIR}/layout/check_floors.py)
    set(arguments ${PROJECT_SOURCE_DIR})
    if(check MATCHES "functions|classes")
        list(APPEND arguments --${check})
    elseif(check MATCHES "names|docs|words|faults")
        set(script ${CMAKE_CURRENT_SOURCE_DIR}/layout/check_${check}.py)
    endif()
    add_test(NAME layout.${check} COMMAND ${livens_python} -B ${script} ${arguments})
    add_test(NAME layout.${check}_refuses_faults
             COMMAND ${livens_python} -B ${script} ${arguments} --controls)
    # 77: a tool is missing, and the check says which.
    set_tests_properties(layout.${check} layout.${check}_refuses_faults
                         PROPERTIES LABELS fast TIMEOUT 60 SKIP_RETURN_CODE 77)
    set_tests_properties(layout.${check}_refuses_faults PROPERTIES LABELS "fast;controls")   # see scripts/needs
endforeach()
add_test(NAME layout.needs_of_a_change COMMAND ${livens_python} -B ${CMAKE_CURRENT_SOURCE_DIR}/layout/needs_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(layout.needs_of_a_change PROPERTIES LABELS "fast;controls" TIMEOUT 120 COST 50 SKIP_RETURN_CODE 77)
