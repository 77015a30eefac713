# SPDX-License-Identifier: BSD-3-Clause
# What makes a slip in memory end a program instead of opening it. Not under sanitizers, which see more.

include(CheckCXXCompilerFlag)
include(CheckPIESupported)
option(LIVENS_HARDENING "Protect stacks, calls and relocations" ON)
check_pie_supported(LANGUAGES CXX)

# livens_harden(TARGET [STACKS]): STACKS for what reads files and arguments. The engine sees checked numbers only, and
# its small functions would pay for a guard in each.
function(livens_harden target)
    if(NOT LIVENS_HARDENING OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")
        return()
    endif()
    set(flags -fstack-clash-protection -fcf-protection)
    if("STACKS" IN_LIST ARGN)
        list(APPEND flags -fstack-protector-strong)
        # An index beyond a vector ends the program instead of reading on. Of functions that are not inlined the linker
        # may keep the checked ones for the engine too: instructions of solve() grow by less than a thousandth.
        target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
    endif()
    foreach(flag ${flags})
        string(MAKE_C_IDENTIFIER "LIVENS_HAS${flag}" has)
        check_cxx_compiler_flag(${flag} ${has})
        if(${has})
            target_compile_options(${target} PRIVATE ${flag})
        endif()
    endforeach()
    # glibc checks sizes where the compiler knows them, which takes optimisation.
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE>)
    target_compile_definitions(${target} PRIVATE $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:_FORTIFY_SOURCE=3>)
    if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
        target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now,-z,noexecstack)
    endif()
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
