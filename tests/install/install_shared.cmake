# SPDX-License-Identifier: BSD-3-Clause
# cmake -DSOURCE= -DBUILD= -DPREFIX= -DCOMPILER= -DGENERATOR= -DWARNINGS_AS_ERRORS= -DGROUPS= -P install_shared.cmake: builds shared libraries and the
# program from scratch, installs them into an empty PREFIX and lets the program solve an example there.

file(REMOVE_RECURSE ${PREFIX} ${BUILD}/solved.nc)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
                        -DCMAKE_CXX_COMPILER=${COMPILER} -DBUILD_SHARED_LIBS=ON -DLIVENS_BUILD_TESTS=OFF
                        -DLIVENS_WARNINGS_AS_ERRORS=${WARNINGS_AS_ERRORS} -DLIVENS_GROUPS=${GROUPS}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD} --parallel 2 OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
# Away from the build, as if it had been copied to another machine.
file(RENAME ${BUILD} ${BUILD}-away)
execute_process(COMMAND ${PREFIX}/bin/livens solve ${SOURCE}/examples/free_box.toml -o ${PREFIX}/solved.nc -q
                RESULT_VARIABLE result)
file(RENAME ${BUILD}-away ${BUILD})
if(NOT result EQUAL 0)
    message(FATAL_ERROR "the installed program ended with ${result}")
endif()
