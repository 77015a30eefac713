// SPDX-License-Identifier: BSD-3-Clause
// Densities that scenarios state as expressions in x, y and z.
#pragma once

#include <string>

#include "livens/geometry/primitive_solid.h"

namespace livens::inline io_internal {

/// In kg/m^3 at the place in m; of the mesh's numbers one is so many m. Throws what Expression does, and
/// `density-field`.
Moments weighted_by_field(const Mesh& mesh, double unit, const std::string& text);
/// Likewise, about the solid's own origin.
Moments weighted_by_field(const PrimitiveSolid& solid, const std::string& text);

}   // namespace livens::inline io_internal
