// SPDX-License-Identifier: BSD-3-Clause
// Points of a motion side by side: what constraints, weights and masses say of all of them at once.
#pragma once

#include "livens/diagnostics/detail/point_tables.h"
#include "livens/dynamics/lanes/aligned_doubles.h"

namespace livens::inline diagnostics_internal {

/// X, V and multipliers of as many points. Lanes that nobody put hold what was there before. Arithmetic is
/// the same in every lane, whatever stands in the others.
class PointLanes {
public:
    explicit PointLanes(const PointTables& tables);

    const PointTables& tables() const { return tables_; }
    void put_positions(int lane, const double* X) { put_bodies(lane, X, X_); }
    void put_velocities(int lane, const double* V) { put_bodies(lane, V, V_); }
    void put_multipliers(int lane, const double* lambda)
    {
        for (int r = 0; r < n_rows(); ++r) multipliers_[r * OfPoints::width + lane] = lambda[r];
    }
    /// |Phi| / scale of a row that is no quadratic form, or |dPhi/dt| / scale.
    void put_violation(int row, int lane, double size) { violations_[row * OfPoints::width + lane] = size; }

    /// All are put: before weights() and joints().
    void find_sizes() { kernels_.sizes(lists_, arrays()); }
    /// Of weights.
    void weights(SupplyOfPoints& supply) { kernels_.weights(lists_, arrays(), supply); }
    /// Their potential energy.
    OfPoints potential();
    OfPoints kinetic_energy();
    /// Moments of momentum about the world's origin, X x V m.
    void moments(OfPoints (&moment)[3]) { kernels_.moments(lists_, arrays(), moment); }
    /// -G^T lambda of all rows that are quadratic forms, and their |Phi| / scale.
    void joints(SupplyOfPoints& supply) { kernels_.joints(lists_, arrays(), supply); }
    /// |Phi| / scale of the same rows, or |dPhi/dt| / scale.
    void find_violations() { kernels_.violations(lists_, arrays()); }
    void find_rates() { kernels_.rates(lists_, arrays()); }
    /// Of all rows, as it was put or found.
    double violation(int row, int lane) const { return violations_[row * OfPoints::width + lane]; }
    /// The largest of them at each point, not a number where one is not.
    OfPoints largest_violation();
    /// Likewise |1/2 (d_a . d_b - delta_ab)| of all bodies.
    OfPoints largest_of_rigidity();

private:
    int n_rows() const { return lists_.n_rows; }
    PointArrays arrays()
    {
        return {X_.data(), V_.data(), multipliers_.data(), violations_.data(), sizes_.data(), forces_.data()};
    }
    void put_bodies(int lane, const double* from, AlignedDoubles& numbers)
    {
        double* to = numbers.data() + lane;
        for (const double* const end = from + lists_.n_numbers; from != end; from += 12)
            for (int i = 0; i < 12; ++i, to += OfPoints::width) *to = from[i];   // unrolled
    }

    const PointTables& tables_;
    const PointLists& lists_;
    const PointKernels& kernels_;
    AlignedDoubles X_, V_, multipliers_, violations_, sizes_, forces_;
};

}   // namespace livens::inline diagnostics_internal
