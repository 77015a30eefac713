# SPDX-License-Identifier: BSD-3-Clause
# A room is a folder of src/livens, compiled once as an object library; libraries and tests are made of rooms.

find_package(Threads REQUIRED)

set(livens_shadow -Wshadow)
if(LIVENS_UNITY)   # not of names in other sources of a group
    set(livens_shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endif()
add_library(livens_flags INTERFACE)
target_include_directories(livens_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(livens_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
                       ${livens_shadow}
                       $<$<BOOL:${LIVENS_WARNINGS_AS_ERRORS}>:-Werror>)
# GCC 12 sees overlapping copies in every sum of std::strings (its bug 105651), from -O2 on.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(livens_flags INTERFACE -Wno-restrict)
endif()
# What GCC has read it clears away when there is a gigabyte of it, not from 128 megabytes on: 5 to 10 percent of its time.
target_compile_options(livens_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
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
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # half of the time to compile
    set(livens_small -O0)
endif()
if(NOT MSVC)
    set(livens_sections -ffunction-sections -fdata-sections)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")   # Its own copy for an object is one that the linker cannot leave out.
    set(livens_whole $<$<CONFIG:Release>:-fno-ipa-sra> $<$<CONFIG:Release>:-fno-ipa-cp>)
    list(APPEND livens_usual ${livens_whole})
    list(APPEND livens_small ${livens_whole})
    list(APPEND livens_fast $<$<CONFIG:Release>:-fipa-sra> $<$<CONFIG:Release>:-fipa-cp>)
endif()

# Where groups of sources are written: builds that name the same folder compile the same files, which a compiler's cache serves.
set(LIVENS_GROUPS ${PROJECT_BINARY_DIR}/groups CACHE PATH "Folder of the files that include groups of sources")
mark_as_advanced(LIVENS_GROUPS)

# livens_in_groups(TARGET): its sources compile twelve at a time, in a third of the time: most of it is the headers. Those that have
# flags of their own, or LIVENS_ALONE, stay out, without a change to who else is in which group.
function(livens_in_groups target)
    if(NOT LIVENS_UNITY)
        return()
    endif()
    get_target_property(sources ${target} SOURCES)
    set(n 0)
    foreach(source ${sources})
        math(EXPR group "${n} / 12")
        math(EXPR n "${n} + 1")
        set_property(SOURCE ${source} PROPERTY LIVENS_GROUP ${group})
    endforeach()
    cmake_language(EVAL CODE "cmake_language(DEFER CALL livens_write_groups ${target})")   # when flags are known
endfunction()

# livens_read_groups(TARGET): groups <- the numbers of its groups, group_N <- the sources of one.
macro(livens_read_groups target)
    get_target_property(sources_of_groups ${target} SOURCES)
    get_target_property(directory_of_groups ${target} SOURCE_DIR)
    set(groups)
    foreach(one ${sources_of_groups})
        get_source_file_property(group ${one} DIRECTORY ${directory_of_groups} LIVENS_GROUP)
        foreach(property LIVENS_ALONE COMPILE_OPTIONS COMPILE_DEFINITIONS)
            get_source_file_property(value ${one} DIRECTORY ${directory_of_groups} ${property})
            if(value)
                set(group NOTFOUND)
            endif()
        endforeach()
        if(NOT group STREQUAL "NOTFOUND")
            if(NOT group IN_LIST groups)
                list(APPEND groups ${group})
                set(group_${group})
            endif()
            list(APPEND group_${group} ${one})
        endif()
    endforeach()
endmacro()

function(livens_write_groups target)
    livens_read_groups(${target})
    foreach(group ${groups})
        list(TRANSFORM group_${group} REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE text)
        list(JOIN text "" text)
        set(file ${LIVENS_GROUPS}/${target}/${group}.cpp)
        file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
        set_source_files_properties(${group_${group}} PROPERTIES HEADER_FILE_ONLY ON)
        target_sources(${target} PRIVATE ${file})
    endforeach()
endfunction()

# livens_group_of(OUT SOURCE ROOM): one of the sources of a room, or of the program (apps), among those that compile together with
# it; their object is called as OUT_object says, if there are others.
function(livens_group_of out source room)
    set(targets livens_room_${room} livens_room_${room}_fast)
    if(room STREQUAL "apps")
        set(targets livens)
    endif()
    set(${out} ${source} PARENT_SCOPE)
    set(${out}_object "" PARENT_SCOPE)
    foreach(target ${targets})
        if(NOT TARGET ${target})
            continue()
        endif()
        livens_read_groups(${target})
        foreach(group ${groups})
            if(source IN_LIST group_${group})
                set(${out} ${group_${group}} PARENT_SCOPE)
                set(${out}_object "groups/${target}/${group}[.]cpp" PARENT_SCOPE)
            endif()
        endforeach()
    endforeach()
endfunction()

# livens_room(NAME [EIGEN] [STACKS] [FAST | SMALL] [FAST_FOLDERS folder...] [LIBRARIES lib...]): FAST, or a FAST_FOLDER, is for
# kernels, SMALL for what reads, writes and is asked once. LIBRARIES are linked by whatever the room is linked into. STACKS:
# see livens_harden(). EIGEN: the room that uses Eigen inside, in no header that others see. Eigen is given another
# namespace there: its inline functions depend on processor flags, and a program that uses Eigen with other flags must
# not share them through the linker. cmake/eigen mends what Eigen does where memory ends.
function(livens_room name)
    cmake_parse_arguments(arg "EIGEN;STACKS;FAST;SMALL" "" "LIBRARIES;FAST_FOLDERS" ${ARGN})
    set(folder ${PROJECT_SOURCE_DIR}/src/livens/${name})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    if(NOT sources)
        add_library(livens_room_${name} INTERFACE)
        return()
    endif()
    set(level ${livens_usual})
    if(arg_FAST)
        set(level ${livens_fast})
    elseif(arg_SMALL)
        set(level ${livens_small})
    endif()
    set(parts livens_room_${name})
    if(arg_FAST_FOLDERS)
        set(fast)
        foreach(part ${arg_FAST_FOLDERS})   # no regular expression: a path may have any letters
            file(GLOB_RECURSE of_part CONFIGURE_DEPENDS ${folder}/${part}/*.cpp)
            list(APPEND fast ${of_part})
        endforeach()
        list(REMOVE_ITEM sources ${fast})
        list(APPEND parts livens_room_${name}_fast)
        add_library(livens_room_${name}_fast OBJECT ${fast})
        target_compile_options(livens_room_${name}_fast PRIVATE ${livens_fast})
    endif()
    add_library(livens_room_${name} OBJECT ${sources})
    target_compile_options(livens_room_${name} PRIVATE ${level})
    if(arg_STACKS)
        set(stacks STACKS)
    endif()
    set(objects)
    foreach(part ${parts})
        list(APPEND objects $<TARGET_OBJECTS:${part}>)
        set_target_properties(${part} PROPERTIES POSITION_INDEPENDENT_CODE ON)
        target_compile_options(${part} PRIVATE ${livens_sections})
        livens_in_groups(${part})
        livens_harden(${part} ${stacks})
        target_link_libraries(${part} PRIVATE $<BUILD_INTERFACE:livens_flags> ${arg_LIBRARIES})
    endforeach()
    set_target_properties(livens_room_${name} PROPERTIES LIVENS_LIBRARIES "${arg_LIBRARIES}" LIVENS_OBJECTS "${objects}")
    if(arg_EIGEN)
        find_package(Eigen3 3.4 REQUIRED NO_MODULE)
        get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
        target_include_directories(livens_room_${name} SYSTEM PRIVATE ${PROJECT_SOURCE_DIR}/cmake/eigen ${eigen})
        # nothing of the LGPL, be it in some version of Eigen
        target_compile_definitions(livens_room_${name} PRIVATE Eigen=livens_eigen EIGEN_MPL2_ONLY)
        foreach(source ${sources})   # a group of their own: what several of them ask of Eigen is made once
            file(STRINGS ${source} uses REGEX "#include (<Eigen/|.*/eigen_views)" LIMIT_COUNT 1)
            if(uses AND LIVENS_UNITY)
                set_property(SOURCE ${source} PROPERTY LIVENS_GROUP eigen)
            endif()
        endforeach()
    endif()
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
            get_target_property(of_room livens_room_${room} LIVENS_OBJECTS)
            list(APPEND objects ${of_room})
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

# livens_add_shards(NAME LABEL SOURCE..): the tests of a program, but for long ones, as one test of ctest for three sources:
# every n-th one each, so that none is missed whatever sources come to hold. What fails is in its output by name, for
# --gtest_filter.
function(livens_add_shards name label)
    list(LENGTH ARGN n_sources)
    math(EXPR n "(${n_sources} + 2) / 3")
    math(EXPR last "${n} - 1")
    foreach(i RANGE ${last})
        math(EXPR number "${i} + 1")
        add_test(NAME ${name}.${number}_of_${n} COMMAND ${name} --gtest_filter=-*.LONG_* --gtest_brief=1)
        set_tests_properties(${name}.${number}_of_${n} PROPERTIES LABELS ${label} TIMEOUT 900
                             ENVIRONMENT "GTEST_TOTAL_SHARDS=${n};GTEST_SHARD_INDEX=${i}")
    endforeach()
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
    livens_in_groups(${name})
    foreach(room ${arg_ROOMS})
        get_target_property(type livens_room_${room} TYPE)
        if(type STREQUAL "OBJECT_LIBRARY")
            get_target_property(objects livens_room_${room} LIVENS_OBJECTS)
            target_sources(${name} PRIVATE ${objects})
            get_target_property(libraries livens_room_${room} LIVENS_LIBRARIES)
            target_link_libraries(${name} PRIVATE ${libraries})
        endif()
    endforeach()
    target_link_libraries(${name} PRIVATE livens_flags ${arg_LIBRARIES} GTest::gtest GTest::gtest_main Threads::Threads)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # half of the time to compile; what takes time to run is in the rooms
        target_compile_options(${name} PRIVATE -O0)
    elseif(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT name MATCHES "^(unit|fuzz)_" OR name STREQUAL "unit_geometry")
        target_compile_options(${name} PRIVATE -O1)   # two thirds of it: these compute references of their own
    elseif(CMAKE_BUILD_TYPE STREQUAL "Release")   # half of it
        target_compile_options(${name} PRIVATE -O0)
    endif()
    livens_precompile(${name} tests MORE <gtest/gtest.h> LIBRARIES GTest::gtest)
    # To those alone that ask for it: a compiler's cache serves all others in any folder.
    foreach(source ${arg_SOURCES})
        file(STRINGS ${source} asks REGEX "LIVENS_SOURCE_DIR|shipped\\.h|published\\.h|kit\\.h")
        if(asks AND LIVENS_UNITY)
            target_compile_definitions(${name} PRIVATE LIVENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
            break()
        elseif(asks)
            set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS LIVENS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
        endif()
    endforeach()
    set(label fast)
    if(arg_SLOW)
        set(label slow)
    endif()
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address")   # whose start takes as long as most tests do: dozens a process
        livens_add_shards(${name} ${label} ${arg_SOURCES})
        return()
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
# without precompiled headers, and twice, as others include them, too. LIVENS_CHECK_HEADERS may name those that are to.
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
        if((LIVENS_CHECK_HEADERS MATCHES "/" AND NOT header IN_LIST LIVENS_CHECK_HEADERS)
           OR header IN_LIST proved OR (header MATCHES "livens/io/" AND NOT LIVENS_BUILD_PROGRAM)
           OR header MATCHES "/eigen_views")   # of sources that have Eigen's path
            continue()
        endif()
        string(MAKE_C_IDENTIFIER ${header} id)
        set(source ${PROJECT_BINARY_DIR}/headers/${id}.cpp)
        file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\"\n" @ONLY)
        list(APPEND sources ${source})
    endforeach()
    if(NOT sources)
        return()
    endif()
    add_library(livens_headers OBJECT ${sources})
    target_link_libraries(livens_headers PRIVATE livens_flags)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")   # there is nothing to run
        target_compile_options(livens_headers PRIVATE -O0 -fno-sanitize=all)
    endif()
endfunction()
