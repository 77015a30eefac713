# SPDX-License-Identifier: BSD-3-Clause
# cmake -DPROJECT= -DBUILD= -DPREFIX= -DCOMPILER= -DGENERATOR= -DFLAGS= -P run_outside.cmake: configures,
# builds and runs the outside project against the installed livens.

# -O1: what is not inlined is what the linker could mix up.
file(REMOVE_RECURSE ${BUILD})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${PROJECT} -B ${BUILD} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=None
                        -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=-O1 ${FLAGS}"
                        -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
# Another livens on this machine must not be the one that was found.
file(STRINGS ${BUILD}/CMakeCache.txt found REGEX "^livens_DIR:")
if(NOT found MATCHES "=${PREFIX}/")
    message(FATAL_ERROR "found another livens: ${found}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${BUILD}/outside COMMAND_ERROR_IS_FATAL ANY)
