# SPDX-License-Identifier: BSD-3-Clause
# CPack runs it on what it has installed and is about to pack: what Debian wants of every package's documents, and manual
# pages and lists of changes compressed, with no date in them; pkg-config's files among those of the architecture.

if(NOT CPACK_GENERATOR STREQUAL "DEB")
    return()
endif()
find_program(gzip gzip REQUIRED)
file(GLOB roots ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(root ${roots})
    get_filename_component(component ${root} NAME)
    set(name ${CPACK_DEBIAN_PROGRAM_PACKAGE_NAME})
    if(component STREQUAL "dev")
        set(name ${CPACK_DEBIAN_DEV_PACKAGE_NAME})
    endif()
    set(documents ${root}/usr/share/doc/${name})
    file(COPY ${CPACK_LIVENS_SOURCE_DIR}/packaging/debian/copyright DESTINATION ${documents})
    file(REMOVE ${documents}/LICENSE ${documents}/NOTICES)   # all of both stands in copyright
    configure_file(${CPACK_LIVENS_SOURCE_DIR}/packaging/debian/changelog ${documents}/changelog @ONLY)
    file(GLOB compressed ${documents}/changelog ${root}/usr/share/man/man1/*.1)
    execute_process(COMMAND ${gzip} -9 -n ${compressed} COMMAND_ERROR_IS_FATAL ANY)
    # Where pkg-config looks when it is asked for this architecture among others: one folder deeper.
    file(GLOB pkgconfig ${root}/usr/lib/pkgconfig/*.pc)
    if(pkgconfig AND CPACK_LIVENS_ARCHITECTURE)
        foreach(file ${pkgconfig})
            file(READ ${file} text)
            string(REPLACE "prefix=\${pcfiledir}/" "prefix=\${pcfiledir}/../" text "${text}")
            file(WRITE ${file} "${text}")
        endforeach()
        file(MAKE_DIRECTORY ${root}/usr/lib/${CPACK_LIVENS_ARCHITECTURE})
        file(RENAME ${root}/usr/lib/pkgconfig ${root}/usr/lib/${CPACK_LIVENS_ARCHITECTURE}/pkgconfig)
    endif()
    if(EXISTS ${root}/usr/share/zsh/site-functions)   # where Debian has those of packages
        file(RENAME ${root}/usr/share/zsh/site-functions ${root}/usr/share/zsh/vendor-completions)
    endif()
endforeach()
