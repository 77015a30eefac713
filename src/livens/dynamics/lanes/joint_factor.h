// SPDX-License-Identifier: BSD-3-Clause
// What constraints hold and leave free at one instant, by elimination along the joints: work and memory grow
// with the bodies, not with their cube. The inertias must be definite.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/lanes/row_pattern.h"

namespace livens::inline dynamics_internal {

/// Room for lanes::Values, aligned for every set of instructions.
class LaneStore {
public:
    /// Width: lanes.
    void resize(const RowPattern& pattern, int width);
    const lanes::Values& values() const { return values_; }
    void swap_places() { std::swap(values_.place, values_.last_place); }

private:
    AlignedDoubles numbers_;
    lanes::Values values_{};
};

/// The factor of lane 0 of W lanes, made at a configuration so near that a pass of a projection with it
/// leaves no more than 1e-8 of what it was to take off.
struct NearFactor {
    const RowPattern* pattern = nullptr;
    const lanes::Values* values = nullptr;
    int width = 0;
};

/// The gradients G by scaled twists (Tables) and a Cholesky factor of G G^T.
class JointFactor {
public:
    /// The smallest pivot at which the squares of what joints hold have digits enough: each pass of a
    /// projection leaves rounding / pivot^2 of what it was to take off.
    static constexpr double well_held = 1e-5;

    /// Whether the tables have what it asks for.
    static bool serves(const ModelTables& tables);

    JointFactor() = default;
    JointFactor(const JointFactor&) = delete;
    JointFactor& operator=(const JointFactor&) = delete;
    JointFactor(JointFactor&&) = default;
    JointFactor& operator=(JointFactor&&) = default;

    void use(std::shared_ptr<const RowPattern> pattern);
    const std::shared_ptr<const RowPattern>& pattern() const { return pattern_; }
    /// Gradients and factor at an instant and X. Returns the smallest pivot, |R_kk| of a QR of the scaled
    /// rows in the order of their elimination; nan if there is none. A `near` factor with the same pattern
    /// does instead of a new one.
    double prepare(const ModelTables& tables, Instant at, const double* X, const NearFactor& near = {});
    /// y <- the part of y that fits G y = rates (null: 0), and mu with y before = y + G^T mu, in the order of
    /// the pattern. Projected twice, where the smallest pivot is below 1e-3 four times: what is left is
    /// small.
    void project(double* y, const double* rates, double* mu) const;
    /// q += factor times the twist rows of G^T mu.
    void add_wrenches(const double* mu, double factor, double* q);
    /// dPhi/dt at the instant where nothing moves, in the order of the pattern: of drives. False: there are
    /// none.
    bool rates(Instant at, double* out) const;
    /// d2 Phi/dt2 where the columns have the rates V and the second derivatives A, 12 numbers a body.
    void curvatures(const ModelTables& tables, Instant at, const double* V, const double* A, double* out);
    /// With one lane: numbers, gradients, violations and factor.
    const lanes::Values& values() const { return store_.values(); }

private:
    std::shared_ptr<const RowPattern> pattern_;
    LaneStore store_;
    std::vector<double> work_;
    int n_passes_ = 2;
};

}   // namespace livens::inline dynamics_internal
