// SPDX-License-Identifier: BSD-3-Clause
// Smooth curves through points, for slots.
#pragma once

#include <vector>

#include "livens/multibody/joint_coordinates.h"

namespace [[gnu::visibility("default")]] livens {

/// A cubic spline through points, by the lengths of the chords between them: two continuous derivatives,
/// straight on beyond the ends of an open one. A closed one comes back from the last point to the first. Its
/// normals do not turn about the tangent; round a closed curve in space they may come back turned, which
/// turns the rows at the seam and no force.
///
/// Throws InputError (`curve-points`): fewer than 2 points (3 of a closed curve), points that repeat their
/// neighbour, numbers that are not finite; (`curve-straight-back`) where the spline turns back on itself.
Curve spline_curve(const std::vector<Vector3>& points, bool is_closed);

}   // namespace livens
