// SPDX-License-Identifier: BSD-3-Clause
// Bits are the same whichever is taken, so no word of the user decides (docs/results.md, "What decides the
// bits").
#include "livens/diagnostics/detail/point_kernels.h"

namespace livens::inline diagnostics_internal {

namespace {

bool has_avx2()
{
#ifdef LIVENS_X86_SETS
    return __builtin_cpu_supports("avx2");
#else
    return false;
#endif
}

}   // namespace

const PointKernels& point_kernels()
{
    static const PointKernels& best = has_avx2() ? *avx2_point_kernels() : portable_point_kernels();
    return best;
}

}   // namespace livens::inline diagnostics_internal
