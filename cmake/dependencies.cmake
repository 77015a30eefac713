# SPDX-License-Identifier: BSD-3-Clause
# What io and the program are made with; the core needs none of it.

find_package(fmt REQUIRED)
if(LIVENS_BUILD_PROGRAM)
    find_package(CLI11 REQUIRED)
endif()
find_path(LIVENS_TOML_INCLUDE_DIR toml++/toml.h REQUIRED)
add_library(livens_toml INTERFACE)
target_include_directories(livens_toml SYSTEM INTERFACE ${LIVENS_TOML_INCLUDE_DIR})

# Compresses the numbers of a report. Linked only, as UMFPACK is: no public header mentions it.
find_package(ZLIB REQUIRED)
add_library(livens_zlib INTERFACE)
target_link_libraries(livens_zlib INTERFACE $<BUILD_INTERFACE:ZLIB::ZLIB> $<INSTALL_INTERFACE:z>)

# Reads XML for `livens import`. Linked only, likewise.
find_path(LIVENS_TINYXML2_INCLUDE_DIR tinyxml2.h REQUIRED)
find_library(LIVENS_TINYXML2_LIBRARY tinyxml2 REQUIRED)
add_library(livens_tinyxml2 INTERFACE)
target_include_directories(livens_tinyxml2 SYSTEM INTERFACE $<BUILD_INTERFACE:${LIVENS_TINYXML2_INCLUDE_DIR}>)
target_link_libraries(livens_tinyxml2 INTERFACE $<BUILD_INTERFACE:${LIVENS_TINYXML2_LIBRARY}> $<INSTALL_INTERFACE:tinyxml2>)
