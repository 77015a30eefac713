// SPDX-License-Identifier: BSD-3-Clause
// The march kernel on registers of two doubles, which every processor has.
#define LIVENS_REGISTER 2
#include "livens/spacetime/lobatto/lane_kernel.h"

namespace livens::lanes {

const Functions* sse2(int n) { return functions_for(n); }

}   // namespace livens::lanes
