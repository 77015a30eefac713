// SPDX-License-Identifier: BSD-3-Clause
// Which set of vector instructions the kernels use: theory.md, "Without a tangent", Registers. It decides
// last bits, so it is chosen once for the program, or named by LIVENS_SIMD.
#include "livens/solvers/instructions.h"

#include <array>
#include <atomic>
#include <cstdlib>

namespace livens {

namespace {

constexpr std::array<std::string_view, 3> words{"sse2", "avx2", "avx512"};

Instructions first_choice()
{
    const char* word = std::getenv("LIVENS_SIMD");
    const auto named = word != nullptr ? instructions_named(word) : std::nullopt;
    if (named && has(*named)) return *named;
    // Not AVX-512, also where it is there: what it gains where eight nodes fill a register it loses where
    // they do not (docs/performance.md), and so the same bits come from almost every processor of today.
    return has(Instructions::avx2) ? Instructions::avx2 : Instructions::sse2;
}

std::atomic<Instructions>& choice()
{
    static std::atomic<Instructions> chosen = first_choice();
    return chosen;
}

}   // namespace

std::string_view to_string(Instructions set) { return words[static_cast<std::size_t>(set)]; }

std::optional<Instructions> instructions_named(std::string_view word)
{
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i] == word) return static_cast<Instructions>(i);
    return {};
}

bool has([[maybe_unused]] Instructions set)
{
#ifdef LIVENS_X86_SETS
    // AVX2 alone does not promise fused multiplication; the kernels use both.
    if (set == Instructions::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (set == Instructions::avx512) return __builtin_cpu_supports("avx512f") && has(Instructions::avx2);
#endif
    return set == Instructions::sse2;
}

Instructions instructions() { return choice(); }

bool use_instructions(Instructions set)
{
    if (!has(set)) return false;
    choice() = set;
    return true;
}

}   // namespace livens
