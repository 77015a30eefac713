// SPDX-License-Identifier: BSD-3-Clause
// The march kernel on registers of two doubles, which every processor has, and on one alone (docs/theory.md,
// "Without a tangent", Registers).
#define LIVENS_REGISTER 2
#define LIVENS_UNROLLED 0   // processors without more are old: not worth the code
#include "livens/spacetime/elements/lane_kernel.h"

namespace livens::lanes {

const Functions* sse2(int n) { return n == 1 ? &functions_of<1> : functions_for(n); }

}   // namespace livens::lanes
