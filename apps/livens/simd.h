// SPDX-License-Identifier: BSD-3-Clause
// Which set of instructions kernels use, as asked for.
#pragma once

#include <string>

namespace livens::program {

/// Equal instructions give equal bytes on any machine. `asked`: on the command line; empty: what the
/// environment variable LIVENS_SIMD says, or AVX2 where the processor has it. A word that is none, or a set
/// that is not to be had, is a usage error.
void pin_instructions(const std::string& asked);

}   // namespace livens::program
