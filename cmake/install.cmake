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
if(LIVENS_PETSC)
    list(APPEND libraries livens_petsc)
endif()
if(LIVENS_BUILD_PROGRAM)
    list(APPEND libraries livens_io livens_zlib livens_tinyxml2)
    add_dependencies(livens ${libraries})   # a build of the program alone can be installed
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
# What users include, and no insides.
file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/headers.txt livens_headers)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/headers.txt)
foreach(header ${livens_headers})
    get_filename_component(folder ${header} DIRECTORY)
    if(LIVENS_BUILD_PROGRAM OR NOT header MATCHES "^livens/io/")
        install(FILES src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} ${dev})
    endif()
endforeach()
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
