# SPDX-License-Identifier: BSD-3-Clause
# Robots of the package index: slow, and only where `scripts/setup models` has been.
if(LIVENS_BUILD_PROGRAM AND LIVENS_SLOW_TESTS)
    set(models_python ${PROJECT_SOURCE_DIR}/build/models-venv/bin/python)
    foreach(test all_urdfs against_pinocchio reads_mjcf hostile_mjcf all_mjcf against_mujoco states)
        if(EXISTS ${models_python})
            add_test(NAME models.${test} COMMAND ${models_python} -B ${CMAKE_CURRENT_SOURCE_DIR}/models/${test}.py)
        else()
            add_test(NAME models.${test} COMMAND ${CMAKE_COMMAND} -E echo
                     "SKIPPED: robots of the package index; scripts/setup models installs them")
        endif()
        set_tests_properties(models.${test} PROPERTIES LABELS models TIMEOUT 900 COST 100
                             SKIP_REGULAR_EXPRESSION "^SKIPPED: " ENVIRONMENT "LIVENS_PROGRAM=$<TARGET_FILE:livens>")
    endforeach()
endif()
