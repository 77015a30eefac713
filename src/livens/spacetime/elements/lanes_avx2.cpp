// SPDX-License-Identifier: BSD-3-Clause
// The march kernel on registers of 4 doubles; compiled for AVX2 alone, see CMakeLists.txt (docs/theory.md,
// "Without a tangent", Registers).
#ifdef LIVENS_X86_SETS
#define LIVENS_REGISTER 4
#include "livens/spacetime/elements/lane_kernel.h"

namespace livens::lanes {

const Functions* avx2(int n) { return functions_for(n); }

}   // namespace livens::lanes
#else
#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::lanes {

const Functions* avx2(int) { return nullptr; }

}   // namespace livens::lanes
#endif
