# SPDX-License-Identifier: BSD-3-Clause
# What io and the program are made with; the core needs none of it.

find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_path(LIVENS_TOML_INCLUDE_DIR toml++/toml.h REQUIRED)
add_library(livens_toml INTERFACE)
target_include_directories(livens_toml SYSTEM INTERFACE ${LIVENS_TOML_INCLUDE_DIR})
