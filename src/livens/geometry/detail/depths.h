// SPDX-License-Identifier: BSD-3-Clause
// How often the pieces of a surface wind round a point.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "livens/geometry/detail/facets.h"
#include "livens/geometry/detail/triangle_grid.h"

namespace livens::inline geometry_internal {

/// Closed pieces along straight lines: what a line in the direction of the first axis crosses behind a point,
/// counted by the side from which it comes. Where that is not clear (the line passes an edge, the point lies
/// next to a face, a piece is open), the solid angles of the faces tell.
class Depths {
public:
    /// Triangles must be of the facets; all must stay.
    Depths(const Facets& facets, const Triangles& triangles, const Pieces& pieces);

    /// In how many pieces but `own` the point lies, those that are inside out counted down, or,
    /// `as_if_outwards`, as the others. What was asked for before is_beyond() is of no use.
    int of(const Vector3& point, std::int32_t own, bool as_if_outwards);
    /// Whether pieces lie about each other so often that it would take too long to count.
    bool is_beyond() const;

private:
    struct Wound {
        int behind = 0;   ///< a face from inside counts 1, one from outside -1
        int in_all = 0;   ///< on both sides of the point: 0 of what is closed
        bool is_clear = true, is_met = false;
    };
    struct Around {
        Vector3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        std::vector<std::int32_t> faces;

        void widen(const Vector3& p);
        bool holds(const Vector3& p) const;
    };

    void cross(const Vector3& point, std::size_t triangle, Wound& wound) const;
    double seen(const Vector3& point, std::int32_t piece);

    const Facets& facets_;
    const Triangles& triangles_;
    const Pieces& pieces_;
    std::vector<Around> around_;      ///< of each piece
    std::vector<Wound> wounds_;       ///< of each piece
    std::vector<std::int32_t> met_;   ///< pieces, at the current point
    TriangleGrid grid_;
    std::int64_t n_looks_ = 0;
};

/// The solid angle of a face seen from a point over 4 pi, positive from inside [van Oosterom and Strackee
/// 1983].
double share_of_view(const Facets& facets, std::int32_t face, const Vector3& point);

}   // namespace livens::inline geometry_internal
