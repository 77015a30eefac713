// SPDX-License-Identifier: BSD-3-Clause
// Sets of instructions that kernels are compiled for. Equal sets give equal bits.
#pragma once

#include <optional>
#include <string_view>

namespace [[gnu::visibility("default")]] livens {

/// In the order of their width: two doubles in a register, which every processor has, four with products and
/// sums in one, eight.
enum class Instructions { sse2, avx2, avx512 };

std::string_view to_string(Instructions set);
/// By its word; empty if there is none of that name.
std::optional<Instructions> instructions_named(std::string_view word);
/// Whether this processor has them and the library was built with them.
bool has(Instructions set);

/// What kernels are made for from now on: at first what the environment variable LIVENS_SIMD names, if that
/// is there, else AVX2 where the processor has it, else SSE2.
Instructions instructions();
/// False: they are not there, and nothing changes.
bool use_instructions(Instructions set);

}   // namespace gnu::visibility("default")]]livens
