// SPDX-License-Identifier: BSD-3-Clause
// Surfaces with fewer triangles, for pictures.
#pragma once

#include <cstddef>
#include <span>

#include "livens/io/exports/formats.h"

namespace livens {

struct Thinned {
    Surface surface;
    std::size_t n_before = 0;   ///< triangles; 0: nothing was taken away
    double moved = 0;   ///< m: no corner is drawn farther from where it is; what is smaller may be gone
};

/// Corners in the cells of a grid become one, and triangles that are left without area go: as many as there
/// may be. Normals are kept apart where they face different ways, so that edges stay sharp.
Thinned thinned(Surface surface, std::size_t most_triangles);

/// What the surfaces of a page may each have, so that all of them are a few MB.
std::size_t triangles_of_each(std::span<const Surface> surfaces);

}   // namespace livens
