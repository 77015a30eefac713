// SPDX-License-Identifier: BSD-3-Clause
// The march kernel on registers of 8 doubles; compiled for AVX512 alone, see CMakeLists.txt (docs/theory.md,
// "Without a tangent", Registers).
#ifdef LIVENS_X86_SETS
#define LIVENS_REGISTER 8
#define LIVENS_UNROLLED 0   // nobody is given it unasked: not worth the code
#include "livens/spacetime/elements/lane_kernel.h"

namespace livens::lanes {

const Functions* avx512(int n) { return functions_for(n); }

}   // namespace livens::lanes
#else
#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::lanes {

const Functions* avx512(int) { return nullptr; }

}   // namespace livens::lanes
#endif
