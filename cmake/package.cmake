# SPDX-License-Identifier: BSD-3-Clause
# CPack: Debian packages `livens` (the program) and `liblivens-dev`, and one archive of both. scripts/packages makes and
# tries them.

set(CPACK_GENERATOR TGZ DEB)
set(CPACK_PACKAGE_NAME livens)
set(CPACK_PACKAGE_VENDOR "The livens authors")
# Debian wants an address; there is none yet, and a name under .invalid (RFC 2606) can be nobody else's. The one place for it.
set(CPACK_PACKAGE_CONTACT "The livens authors <maintainers@livens.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "multibody dynamics that says how exact it is")
set(CPACK_PACKAGE_FILE_NAME livens-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_documents.cmake)
set(CPACK_LIVENS_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_LIVENS_ARCHITECTURE "${CMAKE_LIBRARY_ARCHITECTURE}")   # x86_64-linux-gnu

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME livens)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Without the first line, which is the summary.
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "livens computes the motion of rigid bodies that are tied together by joints:
pendulums, tops, linkages, mechanisms with closed loops. A mechanism is a TOML
file; the program solves it to the accuracy that is asked for, says how far
the answer is off, writes it as NetCDF, and shows it as a page for browsers.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME liblivens-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "g++ (>= 4:12), zlib1g-dev, libtinyxml2-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "livens, cmake, pkgconf")
set(CPACK_DEBIAN_DEV_DESCRIPTION "livens computes the motion of rigid bodies that are tied together by joints,
with finite elements in time and an estimate of the error. Here are its
static libraries, C++20 headers, and what CMake and pkg-config look for.")
include(CPack)
