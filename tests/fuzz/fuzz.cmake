# SPDX-License-Identifier: BSD-3-Clause
# Hostile files. `fuzz_mutations` is deterministic; `fuzz.scenario` and `fuzz.result` are libFuzzer for a minute each, in
# a build of their own (LIVENS_FUZZ) by Clang, skipped where there is none with libFuzzer. For longer runs:
#   cmake -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=clang++ -DLIVENS_FUZZ=ON -DLIVENS_BUILD_TESTS=ON
#   cmake --build build/fuzz --target fuzz_scenario fuzz_result fuzz_mutations
#   build/fuzz/tests/fuzz_scenario -max_total_time=3600 build/fuzz/corpus tests/fuzz/corpus examples
#   LIVENS_MUTATIONS=1000000 build/fuzz/tests/fuzz_mutations --gtest_filter=Result*
if(NOT LIVENS_BUILD_PROGRAM)
    return()
endif()
livens_test(fuzz_mutations SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/mutations.cpp
            ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/result_mutations.cpp ROOMS ${rooms_spacetime} io SLOW)
if(LIVENS_FUZZ)
    foreach(target scenario result)
        add_executable(fuzz_${target} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/${target}.cpp)
        target_link_libraries(fuzz_${target} PRIVATE livens_flags livens_io livens_core)
        target_include_directories(fuzz_${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
        target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
    endforeach()
elseif(LIVENS_SLOW_TESTS)
    set(seeds_scenario ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus ${PROJECT_SOURCE_DIR}/examples)
    set(seeds_result ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_results)
    foreach(target scenario result)
        add_test(NAME fuzz.${target} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run ${target} ${PROJECT_SOURCE_DIR}
                                             ${PROJECT_BINARY_DIR}/fuzz 60 ${seeds_${target}})
        # They share a build.
        set_tests_properties(fuzz.${target} PROPERTIES LABELS slow TIMEOUT 3600 SKIP_RETURN_CODE 77
                             RESOURCE_LOCK livens_fuzz)
    endforeach()
endif()
