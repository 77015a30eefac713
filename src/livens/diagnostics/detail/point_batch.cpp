// SPDX-License-Identifier: BSD-3-Clause
// Rows that are no quadratic forms are evaluated here, one point at a time; all others wait for the kernels.
#include "livens/diagnostics/detail/point_batch.h"

#include <algorithm>
#include <cmath>

namespace livens::inline diagnostics_internal {

void PointBatch::put(const MotionPoints& set, int k, const LanePoint& point, const Supply* loads)
{
    const PointRoles& roles = set.roles();
    points_[n_] = point;
    has_loads_ = loads != nullptr;
    if (has_loads_) loads_[n_] = *loads;
    lanes_.put_positions(n_, set.X(k));
    if (roles.loads) lanes_.put_velocities(n_, set.V(k));
    if (roles.joints) lanes_.put_multipliers(n_, set.multipliers(k));
    if (!lanes_.tables().others().empty()) others_[n_] = {};
    for (const int row : lanes_.tables().others()) put_other_row(row, set, k);
    ++n_;
}

/// The row exerts -lambda dPhi/dX, and lambda dPhi/dt is the power of its drives (theory.md, "Drives").
void PointBatch::put_other_row(int r, const MotionPoints& set, int k)
{
    const RowTable& row = model_.rows[r];
    const double* const X = set.X(k);
    if (set.roles().nodes)
        lanes_.put_violation(r, n_, model_.rows.value(r, {points_[n_].t}, X) / row.row->scale);
    const double lambda = set.roles().joints ? set.multipliers(k)[r] : 0;
    if (lambda == 0) return;
    const Instant at = set.instant(k);
    double g[RowTables::gradient_size];
    model_.rows.gradient(r, at, X, g);
    for (int side = 0; side < row.n_sides; ++side) {
        Matrix34 force{}, place;
        for (const int column : row.columns[side])
            for (int i = column; i < column + 3; ++i) force.a[i] = -lambda * g[12 * side + i];
        std::copy_n(X + 12 * row.bodies[side], 12, place.a);
        others_[n_].add_force(place, force, model_.length);
    }
    others_[n_].work += lambda * constraint_rate(*row.row, at, Configurations(X));
}

/// With V dPhi/dt = its part by time + dPhi/dX V over the scale, in 1/s; without V Phi over the scale.
void PointBatch::put_instant(const double* X, const double* V, double t)
{
    points_[n_] = {0, 0, t, 0};
    lanes_.put_positions(n_, X);
    if (V != nullptr) lanes_.put_velocities(n_, V);
    for (const int r : lanes_.tables().others()) {
        const RowTable& row = model_.rows[r];
        double g[RowTables::gradient_size], phi = V == nullptr ? model_.rows.value(r, {t}, X) : 0;
        if (V != nullptr) {
            phi = model_.rows.rate(r, {t}, X);
            model_.rows.gradient(r, {t}, X, g);
            for (int side = 0; side < row.n_sides; ++side)
                for (const int column : row.columns[side])
                    for (int i = column; i < column + 3; ++i)
                        phi += g[12 * side + i] * V[12 * row.bodies[side] + i];
        }
        lanes_.put_violation(r, n_, phi / row.row->scale);
    }
    ++n_;
}

void PointBatch::let_go()
{
    for (int r = 0; r < model_.n_rows(); ++r) {
        const Joint& joint = model_.model->joints()[model_.model->row_joint(r)];
        for (int lane = 0; lane < n_; ++lane)
            if (!joint.holds_at(points_[lane].t))
                lanes_.put_violation(r, lane, 0);
    }
}

}   // namespace livens::inline diagnostics_internal
