// SPDX-License-Identifier: BSD-3-Clause
// Which triangles a line along the first axis may cross.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "livens/geometry/detail/facets.h"

namespace livens::inline geometry_internal {

/// Cells of the plane across the first axis, and the triangles that lie over them.
class TriangleGrid {
public:
    TriangleGrid(const std::vector<Vector3>& points, const Triangles& triangles);

    /// Those over the cell of a point; all others are passed by.
    std::span<const std::int32_t> over(const Vector3& point) const;

private:
    int cell(int side, double x) const;

    int n_ = 1;   ///< cells along each side
    double low_[2]{}, scale_[2]{};
    std::vector<std::int32_t> begins_, triangles_;
};

}   // namespace livens::inline geometry_internal
