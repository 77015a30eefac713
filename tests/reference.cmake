# SPDX-License-Identifier: BSD-3-Clause
# Examples as shipped against numbers from elsewhere: io reads the examples, a JSON library the numbers.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/reference/*.cpp)
if(LIVENS_BUILD_PROGRAM AND sources)
    find_package(nlohmann_json 3 REQUIRED)
    livens_test(reference STUDY SOURCES ${sources} LIBRARIES livens_io livens_core nlohmann_json::nlohmann_json)
    file(GLOB slow CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/reference/slow/*.cpp)
    livens_test(published SLOW SOURCES ${slow} LIBRARIES livens_io livens_core nlohmann_json::nlohmann_json)
endif()
