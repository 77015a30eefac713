// SPDX-License-Identifier: BSD-3-Clause
// Instruction sets for which kernels are compiled. The same set gives the same bits.
#pragma once

#include <optional>
#include <string_view>

namespace [[gnu::visibility("default")]] livens {

/// In order of vector width: two doubles (available on every processor), four with fused multiply-add,
/// eight.
enum class Instructions { sse2, avx2, avx512 };

std::string_view to_string(Instructions set);
/// The set with this name; empty if there is none.
std::optional<Instructions> instructions_named(std::string_view word);
/// Whether the processor supports the set and the library was built with it.
bool has(Instructions set);

/// The set in use: initially the one named by the environment variable LIVENS_SIMD, if available, else AVX2
/// if the processor has it, else SSE2.
Instructions instructions();
/// Selects a set. Returns false, without effect, if it is not available.
bool use_instructions(Instructions set);

}   // namespace livens
