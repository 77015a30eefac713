# SPDX-License-Identifier: BSD-3-Clause
# Hostile files. `fuzz_mutations` is deterministic; `fuzz.scenario`, `fuzz.result`, `fuzz.crafted` (headers that lie, with checksums
# that fit), `fuzz.urdf` and `fuzz.round_trip` (reader against writer) are libFuzzer for twenty seconds, `fuzz.mesh_*` for ten each,
# in the preset clang. For longer runs:
#   cmake --preset clang -DLIVENS_SLOW_TESTS=ON && cmake --build --preset clang
#   cd build/clang/tests && ./fuzz_scenario -max_total_time=3600 corpus-scenario ../../../tests/fuzz/corpus
#   LIVENS_MUTATIONS=1000000 ./fuzz_mutations --gtest_filter=Result*
if(NOT LIVENS_BUILD_PROGRAM)
    return()
endif()
livens_test(fuzz_mutations SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/mutations.cpp
            ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/result_mutations.cpp ROOMS ${rooms_spacetime} io SLOW)
if(LIVENS_FUZZ)
    set(seeds_scenario ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus ${PROJECT_SOURCE_DIR}/examples)
    set(seeds_result ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_results)
    set(seeds_crafted ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_crafted)
    set(seeds_urdf ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_urdf)
    set(seeds_round_trip)
    foreach(target scenario result crafted urdf round_trip)
        add_executable(fuzz_${target} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/${target}.cpp)
        target_link_libraries(fuzz_${target} PRIVATE livens_flags livens_io livens_core)
        target_include_directories(fuzz_${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
        target_compile_definitions(fuzz_${target} PRIVATE LIVENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
        target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
        set(found ${CMAKE_CURRENT_BINARY_DIR}/corpus-${target})
        file(MAKE_DIRECTORY ${found})
        add_test(NAME fuzz.${target}
                 COMMAND fuzz_${target} -max_total_time=20 -timeout=20 -rss_limit_mb=4096 -max_len=40000
                         -artifact_prefix=${CMAKE_CURRENT_BINARY_DIR}/ -print_final_stats=1 ${found}
                         ${seeds_${target}})
        set_tests_properties(fuzz.${target} PROPERTIES LABELS fuzz TIMEOUT 600 COST 200)
    endforeach()
    foreach(format stl obj ply msh)
        add_executable(fuzz_mesh_${format} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/mesh.cpp)
        target_compile_definitions(fuzz_mesh_${format} PRIVATE LIVENS_MESH_FORMAT=".${format}")
        target_link_libraries(fuzz_mesh_${format} PRIVATE livens_flags livens_core)
        target_link_options(fuzz_mesh_${format} PRIVATE -fsanitize=fuzzer)
        set(found ${CMAKE_CURRENT_BINARY_DIR}/corpus-mesh-${format})
        file(MAKE_DIRECTORY ${found})
        add_test(NAME fuzz.mesh_${format}
                 COMMAND fuzz_mesh_${format} -max_total_time=10 -timeout=20 -rss_limit_mb=4096 -max_len=50000
                         -artifact_prefix=${CMAKE_CURRENT_BINARY_DIR}/ -print_final_stats=1 ${found}
                         ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus_meshes ${CMAKE_CURRENT_SOURCE_DIR}/unit/geometry/data)
        set_tests_properties(fuzz.mesh_${format} PROPERTIES LABELS fuzz TIMEOUT 600 COST 200)
    endforeach()
endif()
