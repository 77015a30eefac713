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
