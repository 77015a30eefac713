# SPDX-License-Identifier: BSD-3-Clause
# The experiments in their short version, judged as in the full one, and their negative controls. They run the
# program, so there is nothing here for sanitizers that tests/system does not have already.
if(LIVENS_BUILD_PROGRAM AND LIVENS_SLOW_TESTS)
    file(GLOB folders CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/experiments/*/expected.json)
    foreach(path ${folders})
        get_filename_component(folder ${path} DIRECTORY)
        get_filename_component(name ${folder} NAME)
        add_test(NAME experiments.${name} COMMAND ${livens_python} -B ${folder}/run --short
                 --livens $<TARGET_FILE:livens> --output ${PROJECT_BINARY_DIR}/paper_short/${name})
        set_tests_properties(experiments.${name} PROPERTIES LABELS slow TIMEOUT 900 COST 60)
    endforeach()
    add_test(NAME experiments.controls COMMAND ${livens_python} -B
             ${PROJECT_SOURCE_DIR}/experiments/controls/run --livens $<TARGET_FILE:livens>)
    set_tests_properties(experiments.controls PROPERTIES LABELS "slow;controls" TIMEOUT 900 COST 90)
endif()
