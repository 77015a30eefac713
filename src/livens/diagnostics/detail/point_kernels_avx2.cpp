// SPDX-License-Identifier: BSD-3-Clause
// Points side by side on registers of four doubles; compiled for AVX2 alone, see CMakeLists.txt.
#ifdef LIVENS_X86_SETS
#define LIVENS_REGISTER 4
#include "livens/diagnostics/detail/point_kernels_code.h"

namespace livens::inline diagnostics_internal {

const PointKernels* avx2_point_kernels() { return &functions; }

}   // namespace livens::inline diagnostics_internal
#else
#include "livens/diagnostics/detail/point_kernels.h"

namespace livens::inline diagnostics_internal {

const PointKernels* avx2_point_kernels() { return nullptr; }

}   // namespace livens::inline diagnostics_internal
#endif
