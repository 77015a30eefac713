# SPDX-License-Identifier: BSD-3-Clause
# Files in and out: the io room stands on the whole core.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/unit/io/*.cpp)
if(LIVENS_BUILD_PROGRAM AND sources)
    livens_test(unit_io SOURCES ${sources} ROOMS ${rooms_spacetime} io)
endif()
