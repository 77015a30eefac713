# SPDX-License-Identifier: BSD-3-Clause
# PETSc with MUMPS and MPI, for one motion by several processes (scripts/setup petsc; docs/howto/cluster.md).
# Sets livens_petsc to what the room that uses it links. Nothing else of the build knows of MPI.

set(livens_petsc)
if(LIVENS_PETSC)
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(LIVENS_PETSC_FOUND REQUIRED IMPORTED_TARGET PETSc)
    pkg_check_modules(LIVENS_MPI_FOUND REQUIRED IMPORTED_TARGET mpi-c)
    add_library(livens_petsc INTERFACE)
    # Linked only: no header mentions it.
    target_link_libraries(livens_petsc INTERFACE $<BUILD_INTERFACE:PkgConfig::LIVENS_PETSC_FOUND>
                          $<BUILD_INTERFACE:PkgConfig::LIVENS_MPI_FOUND> $<INSTALL_INTERFACE:petsc_real> $<INSTALL_INTERFACE:mpi>)
    target_include_directories(livens_petsc SYSTEM INTERFACE
                               $<BUILD_INTERFACE:${LIVENS_PETSC_FOUND_INCLUDE_DIRS}>
                               $<BUILD_INTERFACE:${LIVENS_MPI_FOUND_INCLUDE_DIRS}>)
    target_compile_definitions(livens_petsc INTERFACE $<BUILD_INTERFACE:LIVENS_HAS_PETSC>)
    set(livens_petsc livens_petsc)
endif()
