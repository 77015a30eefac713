# cmake -DBUILD= -DPREFIX= -DCONFIG= -P install_prefix.cmake: installs the finished build into an empty
# PREFIX.

file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} --config "${CONFIG}"
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE foreign RELATIVE ${PREFIX} ${PREFIX}/include/*)
list(FILTER foreign EXCLUDE REGEX "^include/livens/[a-z_/]+\\.h$")
if(foreign)
    message(FATAL_ERROR "installed, but no public header: ${foreign}")
endif()
