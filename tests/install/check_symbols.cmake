# SPDX-License-Identifier: BSD-3-Clause
# cmake -DNM= -DPREFIX= -P check_symbols.cmake: no symbol of the installed core is in the namespace Eigen, and
# some are in livens (so that a listing that could not be read does not pass).

file(GLOB_RECURSE library ${PREFIX}/*livens_core.*)
execute_process(COMMAND ${NM} ${library} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "N6livens")
    message(FATAL_ERROR "no symbols of livens in '${library}'")
endif()
if(symbols MATCHES "[^\n]*[^0-9]5Eigen[^\n]*")
    message(FATAL_ERROR "the library shares Eigen's symbols with its users: ${CMAKE_MATCH_0}")
endif()
