// SPDX-License-Identifier: BSD-3-Clause
// The triangles round each point of a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "livens/base/linear.h"

namespace livens::inline geometry_internal {

struct Rings {
    /// Round each point that triangles use lies one ring of them, all turned the same way. Then the surface
    /// is closed, its edges have two faces which turn them opposite ways, and nothing touches at a point.
    bool are_closed = false;
    /// Of each point bits of directions, seen along which its triangles are known to lie beside each other
    /// like the slices of a cake: all turn the same way and go round once. Then those that share the point
    /// have nothing else in common. Bits 0 to 2 are the axes, 3 to 5 their opposites, 6 is another direction,
    /// asked for only where there is none of these.
    std::vector<std::uint8_t> directions;
};

/// `corners`: three points of each triangle.
Rings rings_of(const std::vector<Vector3>& points, std::span<const std::int32_t> corners);

}   // namespace livens::inline geometry_internal
