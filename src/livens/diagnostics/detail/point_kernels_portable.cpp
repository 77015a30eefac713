// SPDX-License-Identifier: BSD-3-Clause
// Points side by side on registers of two doubles, which every processor has.
#define LIVENS_REGISTER 2
#include "livens/diagnostics/detail/point_kernels_code.h"

namespace livens::inline diagnostics_internal {

const PointKernels& portable_point_kernels() { return functions; }

}   // namespace livens::inline diagnostics_internal
