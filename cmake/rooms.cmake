# SPDX-License-Identifier: BSD-3-Clause
# A room is a folder of src/livens, compiled once as an object library; libraries and tests are made of rooms.

find_package(Threads REQUIRED)

add_library(livens_flags INTERFACE)
target_include_directories(livens_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(livens_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
                       $<$<NOT:$<BOOL:${LIVENS_UNITY}>>:-Wshadow>   # of names in other sources of a group
                       $<$<BOOL:${LIVENS_WARNINGS_AS_ERRORS}>:-Werror>)
# GCC 12 sees overlapping copies in every sum of std::strings (its bug 105651), from -O2 on.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(livens_flags INTERFACE -Wno-restrict)
endif()
# Problems are stated without the braces of their conditions: solve(model, {model.start()}, ..).
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(livens_flags INTERFACE -Wno-missing-braces)
endif()

# Headers that most sources of TARGET include, compiled once where a build asks for it: half of what sources take to
# compile without optimisation. Not in builds that a compiler's cache serves. All targets that name the same COMMON share
# them; their flags must be the same. MORE headers from LIBRARIES.
function(livens_precompile target common)
    if(NOT LIVENS_PRECOMPILE)
        return()
    endif()
    cmake_parse_arguments(arg "" "" "MORE;LIBRARIES" ${ARGN})
    if(NOT TARGET livens_headers_of_${common})
        set(source ${PROJECT_BINARY_DIR}/headers_of_${common}.cpp)
        file(CONFIGURE OUTPUT ${source} CONTENT "" @ONLY)
        add_library(livens_headers_of_${common} OBJECT ${source})
        get_target_property(options ${target} COMPILE_OPTIONS)
        get_target_property(independent ${target} POSITION_INDEPENDENT_CODE)
        set_target_properties(livens_headers_of_${common} PROPERTIES COMPILE_OPTIONS "${options}"
                              POSITION_INDEPENDENT_CODE ${independent})
        target_link_libraries(livens_headers_of_${common} PRIVATE livens_flags ${arg_LIBRARIES})
        target_precompile_headers(livens_headers_of_${common} PRIVATE <algorithm> <array> <cmath> <functional> <map>
                                  <memory> <optional> <string> <string_view> <vector> ${arg_MORE})
    endif()
    target_precompile_headers(${target} REUSE_FROM livens_headers_of_${common})
endfunction()

# How hard sources are optimised, after the flags of the build: the wheel is small because most of them are not
# unrolled and inlined to the last, and because what nobody calls is left out by the linker.
set(livens_fast $<$<CONFIG:Release>:-O3>)
set(livens_usual $<$<CONFIG:Release>:-O2>)
set(livens_small $<$<CONFIG:Release>:-Os>)
if(NOT MSVC)
    set(livens_sections -ffunction-sections -fdata-sections)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")   # Its own copy for an object is one that the linker cannot leave out.
    set(livens_whole $<$<CONFIG:Release>:-fno-ipa-sra> $<$<CONFIG:Release>:-fno-ipa-cp>)
    list(APPEND livens_usual ${livens_whole})
    list(APPEND livens_small ${livens_whole})
    list(APPEND livens_fast $<$<CONFIG:Release>:-fipa-sra> $<$<CONFIG:Release>:-fipa-cp>)
endif()

# livens_room(NAME [EIGEN] [STACKS] [FAST | SMALL] [LIBRARIES lib...]): FAST is for kernels, SMALL for what reads, writes
# and is asked once. LIBRARIES are linked by whatever the room is linked into. STACKS:
# see livens_harden(). EIGEN: the room that uses Eigen inside its sources, never in a header. Eigen is given another
# namespace there: its inline functions depend on processor flags, and a program that uses Eigen with other flags must
# not share them through the linker. cmake/eigen mends what Eigen does where memory ends.
function(livens_room name)
    cmake_parse_arguments(arg "EIGEN;STACKS;FAST;SMALL" "" "LIBRARIES" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/livens/${name}/*.cpp)
    if(NOT sources)
        add_library(livens_room_${name} INTERFACE)
        return()
    endif()
    add_library(livens_room_${name} OBJECT ${sources})
    set_target_properties(livens_room_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(arg_STACKS)
        set(stacks STACKS)
    endif()
    set(level ${livens_usual})
    if(arg_FAST)
        set(level ${livens_fast})
    elseif(arg_SMALL)
        set(level ${livens_small})
    endif()
    target_compile_options(livens_room_${name} PRIVATE ${level} ${livens_sections})
    if(LIVENS_UNITY AND NOT arg_EIGEN)   # where the same names stand for other things
        set_target_properties(livens_room_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
    livens_harden(livens_room_${name} ${stacks})
    target_link_libraries(livens_room_${name} PRIVATE $<BUILD_INTERFACE:livens_flags> ${arg_LIBRARIES})
    set_target_properties(livens_room_${name} PROPERTIES LIVENS_LIBRARIES "${arg_LIBRARIES}")
    if(arg_EIGEN)
        find_package(Eigen3 3.4 REQUIRED NO_MODULE)
        get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
        target_include_directories(livens_room_${name} SYSTEM PRIVATE ${PROJECT_SOURCE_DIR}/cmake/eigen ${eigen})
        target_compile_definitions(livens_room_${name} PRIVATE Eigen=livens_eigen)
    endif()
endfunction()

# livens_fast_part(ROOM FOLDER): what lies in a folder of a room is for kernels, while the room is not.
function(livens_fast_part room folder)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/livens/${room}/${folder}/*.cpp)
    set_property(SOURCE ${sources} APPEND PROPERTY COMPILE_OPTIONS ${livens_fast})
endfunction()

# livens_link_small(TARGET): without functions that nobody calls. Not by gold, which could make one of those that are the
# same: it takes the wheel's own hypot() for glibc's, see python/src/glibc.cpp.
include(CheckLinkerFlag)
function(livens_link_small target)
    check_linker_flag(CXX "-Wl,--gc-sections" LIVENS_HAS_GC_SECTIONS)
    if(LIVENS_HAS_GC_SECTIONS)
        target_link_options(${target} PRIVATE $<$<CONFIG:Release>:-Wl,--gc-sections>)
    endif()
endfunction()

# livens_library(NAME ROOM...): the installed library livens::NAME.
function(livens_library name)
    set(objects)
    set(libraries)
    foreach(room ${ARGN})
        get_target_property(type livens_room_${room} TYPE)
        if(type STREQUAL "OBJECT_LIBRARY")
            list(APPEND objects $<TARGET_OBJECTS:livens_room_${room}>)
            get_target_property(of_room livens_room_${room} LIVENS_LIBRARIES)
            list(APPEND libraries ${of_room})
        endif()
    endforeach()
    add_library(livens_${name} ${objects})
    add_library(livens::${name} ALIAS livens_${name})
    set_target_properties(livens_${name} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX
                          VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    set_target_properties(livens_${name} PROPERTIES INSTALL_RPATH "$<$<BOOL:${BUILD_SHARED_LIBS}>:$ORIGIN>")
    livens_harden(livens_${name})
    if(BUILD_SHARED_LIBS)   # what templates of other libraries became in here is nobody else's
        target_link_options(livens_${name} PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exported.map -Wl,-z,defs)
        set_property(TARGET livens_${name} PROPERTY LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported.map)
    endif()
    target_compile_features(livens_${name} PUBLIC cxx_std_20)
    target_include_directories(livens_${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(livens_${name} PUBLIC Threads::Threads PRIVATE ${libraries})
endfunction()

# livens_test(NAME SOURCES file... ROOMS room... [LIBRARIES lib...] [SLOW] [STUDY]): a GoogleTest program. With ROOMS
# it links these rooms alone (a room's unit tests build before the rooms above exist). STUDY: what is true of many whole motions,
# which sanitizers need not see. A test whose name begins with LONG_ has the label long instead of fast.
function(livens_test name)
    cmake_parse_arguments(arg "SLOW;STUDY" "" "SOURCES;ROOMS;LIBRARIES" ${ARGN})
    if((arg_SLOW AND NOT LIVENS_SLOW_TESTS) OR (arg_STUDY AND NOT LIVENS_STUDIES))
        return()
    endif()
    add_executable(${name} ${arg_SOURCES})
    foreach(room ${arg_ROOMS})
        get_target_property(type livens_room_${room} TYPE)
        if(type STREQUAL "OBJECT_LIBRARY")
            target_sources(${name} PRIVATE $<TARGET_OBJECTS:livens_room_${room}>)
            get_target_property(libraries livens_room_${room} LIVENS_LIBRARIES)
            target_link_libraries(${name} PRIVATE ${libraries})
        endif()
    endforeach()
    target_link_libraries(${name} PRIVATE livens_flags ${arg_LIBRARIES} GTest::gtest GTest::gtest_main Threads::Threads)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # half of the time to compile; what takes time to run is in the rooms
        target_compile_options(${name} PRIVATE -O0)
    elseif(CMAKE_BUILD_TYPE STREQUAL "Release")   # two thirds of it, likewise
        target_compile_options(${name} PRIVATE -O1)
    endif()
    livens_precompile(${name} tests MORE <gtest/gtest.h> LIBRARIES GTest::gtest)
    # To those alone that ask for it: a compiler's cache serves all others in any folder.
    foreach(source ${arg_SOURCES})
        file(STRINGS ${source} asks REGEX "LIVENS_SOURCE_DIR|shipped\\.h|published\\.h|kit\\.h")
        if(asks)
            set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS LIVENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
        endif()
    endforeach()
    set(label fast)
    if(arg_SLOW)
        set(label slow)
    endif()
    gtest_discover_tests(${name} TEST_FILTER "-*.LONG_*" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS ${label} TIMEOUT 600)
    foreach(source ${arg_SOURCES})
        file(STRINGS ${source} long REGEX "\\(.*LONG_" LIMIT_COUNT 1)
        if(long)   # a label that the name of a test asks for
            gtest_discover_tests(${name} TEST_FILTER "*.LONG_*" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                                 PROPERTIES LABELS long TIMEOUT 600)
            break()
        endif()
    endforeach()
endfunction()

# Every header compiles alone, and twice. Not again those that a source includes first: it proves them alone in every build
# without precompiled headers, and twice, as others include them, too.
function(livens_check_headers)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/livens/*.cpp)
    set(proved)
    foreach(source ${sources})
        file(STRINGS ${source} first REGEX "^[^/]" LIMIT_COUNT 1)   # after comments
        if(first MATCHES "^#include \"(livens/.*)\"")
            list(APPEND proved ${CMAKE_MATCH_1})
        endif()
    endforeach()
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/livens/*.h)
    set(sources)
    foreach(header ${headers})
        if(header IN_LIST proved OR (header MATCHES "livens/io/" AND NOT LIVENS_BUILD_PROGRAM))
            continue()
        endif()
        string(MAKE_C_IDENTIFIER ${header} id)
        set(source ${PROJECT_BINARY_DIR}/headers/${id}.cpp)
        file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\"\n" @ONLY)
        list(APPEND sources ${source})
    endforeach()
    add_library(livens_headers OBJECT ${sources})
    target_link_libraries(livens_headers PRIVATE livens_flags)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # there is nothing to run
        target_compile_options(livens_headers PRIVATE -O0 -fno-sanitize=all)
    endif()
endfunction()
