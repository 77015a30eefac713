# `cmake --install`: the libraries, their headers, the program and the package files for find_package(livens).

include(CMakePackageConfigHelpers)

set(libraries livens_core)
if(LIVENS_UMFPACK)
    list(APPEND libraries livens_umfpack)
endif()
if(LIVENS_BUILD_PROGRAM)
    list(APPEND libraries livens_io livens_netcdf)
    install(TARGETS livens RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS ${libraries} EXPORT livens-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY src/livens DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h"
        PATTERN "detail" EXCLUDE)
install(EXPORT livens-targets NAMESPACE livens:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens)
configure_package_config_file(cmake/livens-config.cmake.in ${PROJECT_BINARY_DIR}/livens-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/livens-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/livens-config.cmake ${PROJECT_BINARY_DIR}/livens-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/livens)
