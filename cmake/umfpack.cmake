# SPDX-License-Identifier: BSD-3-Clause
# UMFPACK, the paper's sparse solver. It has no CMake package; its METIS comes with it, through CHOLMOD.
# Sets livens_umfpack to what the room that uses it adds to its arguments.

set(livens_umfpack)
if(LIVENS_UMFPACK)
    find_path(LIVENS_UMFPACK_INCLUDE_DIR suitesparse/umfpack.h REQUIRED)
    find_library(LIVENS_UMFPACK_LIBRARY umfpack REQUIRED)
    add_library(livens_umfpack INTERFACE)
    # Linked only: no public header mentions it. Installed by its name, so that the package can be moved.
    target_link_libraries(livens_umfpack INTERFACE $<BUILD_INTERFACE:${LIVENS_UMFPACK_LIBRARY}>
                          $<INSTALL_INTERFACE:umfpack>)
    target_include_directories(livens_umfpack SYSTEM INTERFACE $<BUILD_INTERFACE:${LIVENS_UMFPACK_INCLUDE_DIR}>)
    target_compile_definitions(livens_umfpack INTERFACE $<BUILD_INTERFACE:LIVENS_HAS_UMFPACK>)
    set(livens_umfpack livens_umfpack)
endif()
