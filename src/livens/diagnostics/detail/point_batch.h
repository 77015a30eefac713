// SPDX-License-Identifier: BSD-3-Clause
// Points of a set, gathered until as many stand side by side as are looked at together.
#pragma once

#include <span>
#include <vector>

#include "livens/diagnostics/detail/motion_points.h"
#include "livens/diagnostics/detail/point_lanes.h"
#include "livens/diagnostics/detail/supply.h"

namespace livens::inline diagnostics_internal {

/// A point in a lane.
struct LanePoint {
    int element = 0;
    int node = -1;   ///< in the order of X's coefficients
    double t = 0;
    double weight = 0;
};

class PointBatch {
public:
    PointBatch(const ModelTables& model, const PointTables& tables) : model_(model), lanes_(tables) {}

    bool is_full() const { return n_ == OfPoints::width; }
    std::span<const LanePoint> points() const { return {points_, static_cast<std::size_t>(n_)}; }
    PointLanes& lanes() { return lanes_; }
    void clear() { n_ = 0; }

    /// Point k of the set, which is in an element. `loads`: what they supply there, or null.
    void put(const MotionPoints& set, int k, const LanePoint& point, const Supply* loads);
    /// What was asked of a point alone: of loads, and of rows that are no quadratic forms. Null: nothing.
    const Supply* loads(int lane) const { return has_loads_ ? &loads_[lane] : nullptr; }
    const Supply* others(int lane) const
    {
        return lanes_.tables().others().empty() ? nullptr : &others_[lane];
    }
    /// X and V at an instant, for violations of rates; without V, of positions at node 0.
    void put_instant(const double* X, const double* V, double t);
    /// Rows of joints that do not act there are not violated.
    void let_go();

private:
    void put_other_row(int row, const MotionPoints& set, int k);

    const ModelTables& model_;
    PointLanes lanes_;
    LanePoint points_[OfPoints::width];
    Supply loads_[OfPoints::width], others_[OfPoints::width];
    bool has_loads_ = false;
    int n_ = 0;
};

}   // namespace livens::inline diagnostics_internal
