// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of bodies as triangles, for pictures, and with fewer of them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "livens/base/linear.h"

namespace livens::inline io_internal {

/// Triangles that bound a body, in its own coordinates; seen from outside their corners go round to the left.
struct Surface {
    std::vector<Vector3> points;    ///< m
    std::vector<Vector3> normals;   ///< one a point, of length 1, outwards; none where they do not matter
    std::vector<std::array<int, 3>> triangles;
    std::size_t n_left_out = 0;   ///< triangles that thinning took away
    double moved = 0;   ///< m: no corner is drawn farther from where it is; what is smaller may be gone
};

/// Corners in the cells of a grid become one, and triangles that are left without area go: as many as there
/// may be. Normals are kept apart where they face different ways, so that edges stay sharp.
Surface thinned(Surface surface, std::size_t most_triangles);

/// What the surfaces of a page may each have, so that all of them are a few MB.
std::size_t triangles_of_each(std::span<const Surface> surfaces);

}   // namespace livens::inline io_internal
