# SPDX-License-Identifier: BSD-3-Clause
# cmake -DBUILD= -DPREFIX= -DCONFIG= -P install_prefix.cmake: installs the finished build into an empty
# PREFIX and looks at what is there: the headers of headers.txt, no other, and all that these include.

cmake_minimum_required(VERSION 3.20)
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} --config "${CONFIG}"
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE installed RELATIVE ${PREFIX}/include ${PREFIX}/include/*)
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/headers.txt wanted)
if(NOT EXISTS ${PREFIX}/include/livens/io)   # built without the program
    list(FILTER wanted EXCLUDE REGEX "^livens/io/")
endif()
set(foreign ${installed})
list(REMOVE_ITEM foreign ${wanted})
set(missing ${wanted})
list(REMOVE_ITEM missing ${installed})
if(foreign OR missing)
    message(FATAL_ERROR "installed, but no public header: ${foreign}; public, but not installed: ${missing}")
endif()
foreach(header ${installed})
    file(STRINGS ${PREFIX}/include/${header} includes REGEX "^#include \"livens/")
    foreach(line ${includes})
        string(REGEX REPLACE ".*\"(.*)\".*" "\\1" name "${line}")
        if(NOT name IN_LIST installed)
            message(FATAL_ERROR "${header} includes ${name}, which is not installed")
        endif()
    endforeach()
endforeach()
