# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install`: the libraries, their headers, the program and the package files for find_package(livens).

include(CMakePackageConfigHelpers)

# Components, which packages are made of: `program`, and `dev` with all that it takes to build with the library.
set(dev COMPONENT dev)
set(program COMPONENT program)

set(libraries livens_core)
if(LIVENS_UMFPACK)
    list(APPEND libraries livens_umfpack)
endif()
if(LIVENS_BUILD_PROGRAM)
    list(APPEND libraries livens_io livens_zlib)
    install(TARGETS livens RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} ${program})
    # Where the shells and man look without being told.
    install(FILES ${livens_pages}/livens.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 ${program})
    install(FILES ${livens_pages}/livens DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
            ${program})
    install(FILES ${livens_pages}/_livens DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions ${program})
    install(FILES ${livens_pages}/livens.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
            ${program})
endif()
install(FILES LICENSE NOTICES DESTINATION ${CMAKE_INSTALL_DOCDIR} ${program})
install(TARGETS ${libraries} EXPORT livens-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${dev}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${dev})
# What users include, and no insides: tests/install/headers.txt lists it.
install(DIRECTORY src/livens DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${dev} FILES_MATCHING PATTERN "*.h"
        PATTERN "detail" EXCLUDE PATTERN "results" EXCLUDE PATTERN "scenario" EXCLUDE
        PATTERN "exports" EXCLUDE PATTERN "report" EXCLUDE
        PATTERN "lobatto" EXCLUDE PATTERN "mixed" EXCLUDE PATTERN "stepping" EXCLUDE
        PATTERN "dense.h" EXCLUDE PATTERN "elementary.h" EXCLUDE PATTERN "projection.h" EXCLUDE PATTERN "time_space.h" EXCLUDE
        PATTERN "constraint_basis.h" EXCLUDE PATTERN "instant.h" EXCLUDE PATTERN "rank.h" EXCLUDE
        PATTERN "rows.h" EXCLUDE PATTERN "tables.h" EXCLUDE PATTERN "twist.h" EXCLUDE PATTERN "blocks.h" EXCLUDE
        PATTERN "linear_solver.h" EXCLUDE PATTERN "newton.h" EXCLUDE PATTERN "patience.h" EXCLUDE PATTERN "ends.h" EXCLUDE PATTERN "guess.h"
        EXCLUDE PATTERN "window.h" EXCLUDE PATTERN "windows.h" EXCLUDE PATTERN "accuracy.h" EXCLUDE
        PATTERN "pace.h" EXCLUDE PATTERN "phases.h" EXCLUDE PATTERN "second.h" EXCLUDE PATTERN "largest.h" EXCLUDE
        PATTERN "acceptance_bounds.h" EXCLUDE PATTERN "surface.h" EXCLUDE
        PATTERN "aligned_doubles.h" EXCLUDE PATTERN "forest.h" EXCLUDE PATTERN "locking.h" EXCLUDE PATTERN "orientation.h" EXCLUDE PATTERN "joint_factor.h" EXCLUDE PATTERN "row_pattern.h" EXCLUDE PATTERN "sparse_rows.h" EXCLUDE
        PATTERN "small_motions.h" EXCLUDE PATTERN "statics.h" EXCLUDE PATTERN "turning_vibrations.h" EXCLUDE
        PATTERN "lanes.h" EXCLUDE PATTERN "lane_*.h" EXCLUDE)
install(EXPORT livens-targets NAMESPACE livens:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens ${dev})
configure_package_config_file(cmake/livens-config.cmake.in ${PROJECT_BINARY_DIR}/livens-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/livens-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/livens-config.cmake ${PROJECT_BINARY_DIR}/livens-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens ${dev})

# For those who build by other means: pkg-config --cflags --libs livens (or livens-io, which reads and writes files).
file(RELATIVE_PATH livens_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)   # found wherever the whole was moved to
string(REGEX REPLACE "/$" "" livens_pc_prefix ${livens_pc_prefix})
foreach(library livens livens-io)
    if(library STREQUAL "livens" OR LIVENS_BUILD_PROGRAM)
        configure_file(cmake/${library}.pc.in ${PROJECT_BINARY_DIR}/${library}.pc @ONLY)
        install(FILES ${PROJECT_BINARY_DIR}/${library}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${dev})
    endif()
endforeach()
include(cmake/package.cmake)
