// SPDX-License-Identifier: BSD-3-Clause
#include "simd.h"

#include <cstdlib>
#include <optional>

#include "exit_code.h"
#include "failure.h"
#include "livens/solvers/instructions.h"

namespace livens::program {

void pin_instructions(const std::string& asked)
{
    const char* variable = std::getenv("LIVENS_SIMD");
    const std::string word = !asked.empty() || variable == nullptr ? asked : variable;
    if (word.empty()) return;
    const std::string place = asked.empty() ? "LIVENS_SIMD" : "--simd";
    const std::optional<Instructions> set = instructions_named(word);
    if (!set)
        throw failure(exit_usage,
                      place + ": '" + word + "' is no set of instructions; sse2, avx2 and avx512 are");
    if (!use_instructions(*set))
        throw failure(exit_usage,
                      place + ": this processor, or this livens, has no " + word + "; sse2 is everywhere");
}

}   // namespace livens::program
