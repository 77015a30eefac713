# What io and the program are made with; the core needs none of it.

find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(NETCDF REQUIRED IMPORTED_TARGET netcdf)
add_library(livens_netcdf INTERFACE)
target_link_libraries(livens_netcdf INTERFACE $<BUILD_INTERFACE:PkgConfig::NETCDF> $<INSTALL_INTERFACE:netcdf>)
find_path(LIVENS_TOML_INCLUDE_DIR toml++/toml.h REQUIRED)
add_library(livens_toml INTERFACE)
target_include_directories(livens_toml SYSTEM INTERFACE ${LIVENS_TOML_INCLUDE_DIR})
