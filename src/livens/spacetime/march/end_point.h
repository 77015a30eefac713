// SPDX-License-Identifier: BSD-3-Clause
// A state at one instant by its places and momenta, and what quantities do along its free motions.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/state.h"
#include "livens/multibody/state_quantities.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::inline spacetime_internal {

/// X and momenta of all bodies at an end of time. Momenta are those of NodalRows: six numbers a body (three a
/// point mass) in world axes, linear momentum and moment about the reference point. What joints and drives do
/// not let them be is taken off, and velocities follow.
class EndPoint {
public:
    explicit EndPoint(const ModelTables& tables);

    /// False: something is not finite, or free motions carry no inertia. `X_low`: null for zeros.
    bool place(double t, const double* X, const double* X_low, const std::vector<double>& momenta);
    /// The same from a state that need not keep to the joints; its places are brought onto them.
    bool place(const State& state);
    /// Velocities as they are told where elements do not keep to the joints: values are of these.
    void tell(std::vector<Matrix34> velocities) { V_ = std::move(velocities); }
    /// X of `from` moved along a scaled twist and brought onto the joints, with other momenta.
    bool place_moved(const EndPoint& from, const double* scaled_twist, const std::vector<double>& momenta);

    double t() const { return state_.t; }
    const std::vector<double>& momenta() const { return momenta_; }
    const ConstraintBasis& basis() const { return state_.held.basis; }
    const double* maps() const { return state_.maps.data(); }
    double value(const StateQuantity& quantity) const;
    /// Whether it has a value here, see livens::is_known().
    bool is_known(const StateQuantity& quantity) const;
    State state() const;
    /// X'' of the bodies under their loads.
    std::vector<Matrix34> accelerations() const;

    /// Momenta that scaled free motion j of a basis at these maps has as a velocity.
    void momenta_along(const ConstraintBasis& basis, const double* maps, int j, double* momenta) const;
    /// Size of free motion j, in lengths and radians.
    double size_along(const ConstraintBasis& basis, const double* maps, int j) const;
    /// Of the velocities that momenta are here, in lengths and radians per second.
    double size_of_momenta(std::vector<double> momenta) const;
    /// d(quantities) by the scaled free motions of a basis here, then by momenta along them: 2 f columns.
    /// Four-point central differences; momenta are held in world axes while the bodies move.
    /// `rate`: per s, of motions that matter.
    DenseMatrix derivatives(std::span<const StateQuantity> quantities, const ConstraintBasis& basis,
                            double rate) const;

private:
    bool finish(const std::vector<double>& momenta);
    void free_motion(const ConstraintBasis& basis, int j, double* scaled_twist) const;
    double size_of(const double* maps, const double* scaled_twist) const;

    const ModelTables& tables_;
    mutable InstantSystem instant_;
    mutable InstantState state_;   // accelerations are found in it
    std::vector<double> momenta_;
    std::vector<Matrix34> stated_, X_, V_;
};

}   // namespace livens::inline spacetime_internal
