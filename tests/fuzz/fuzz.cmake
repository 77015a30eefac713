# SPDX-License-Identifier: BSD-3-Clause
# Hostile files. `fuzz_mutations` is deterministic; `fuzz.scenario` is libFuzzer for a minute, in a build of its
# own (LIVENS_FUZZ) by Clang, skipped where there is none with libFuzzer. For longer runs:
#   cmake -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=clang++ -DLIVENS_FUZZ=ON -DLIVENS_BUILD_TESTS=ON
#   cmake --build build/fuzz --target fuzz_scenario
#   build/fuzz/tests/fuzz_scenario -max_total_time=3600 build/fuzz/corpus tests/fuzz/corpus examples
if(NOT LIVENS_BUILD_PROGRAM)
    return()
endif()
livens_test(fuzz_mutations SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/mutations.cpp LIBRARIES livens_io livens_core SLOW)
if(LIVENS_FUZZ)
    add_executable(fuzz_scenario ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/scenario.cpp)
    target_link_libraries(fuzz_scenario PRIVATE livens_flags livens_io livens_core)
    target_include_directories(fuzz_scenario PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_options(fuzz_scenario PRIVATE -fsanitize=fuzzer)
elseif(LIVENS_SLOW_TESTS)
    add_test(NAME fuzz.scenario COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run scenario ${PROJECT_SOURCE_DIR}
                                        ${PROJECT_BINARY_DIR}/fuzz 60)
    set_tests_properties(fuzz.scenario PROPERTIES LABELS slow TIMEOUT 3600 SKIP_RETURN_CODE 77)
endif()
