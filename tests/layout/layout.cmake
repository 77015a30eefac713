# The house's rules, checked as tests: the table of floors, sizes, names, documents. Each checker is also run
# against made-up faults that it must refuse. Debian's interpreter is named by its path: another python3 may
# come first.

set(livens_python /usr/bin/python3)
if(NOT EXISTS ${livens_python})
    find_program(LIVENS_PYTHON python3 REQUIRED)
    set(livens_python ${LIVENS_PYTHON})
endif()
foreach(check floors functions docs)
    set(script ${CMAKE_CURRENT_SOURCE_DIR}/layout/check_floors.py)
    set(arguments ${PROJECT_SOURCE_DIR})
    if(check STREQUAL "functions")
        list(APPEND arguments --functions)
    elseif(check STREQUAL "docs")
        set(script ${CMAKE_CURRENT_SOURCE_DIR}/layout/check_docs.py)
    endif()
    add_test(NAME layout.${check} COMMAND ${livens_python} -B ${script} ${arguments})
    add_test(NAME layout.${check}_refuses_faults
             COMMAND ${livens_python} -B ${script} ${arguments} --controls)
    # 77: a tool is missing, and the check says which.
    set_tests_properties(layout.${check} layout.${check}_refuses_faults
                         PROPERTIES LABELS fast TIMEOUT 60 SKIP_RETURN_CODE 77)
endforeach()
