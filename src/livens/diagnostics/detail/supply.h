// SPDX-License-Identifier: BSD-3-Clause
// What flows into a mechanism through loads and joints.
#pragma once

#include <optional>
#include <vector>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/time/quadrature.h"

namespace livens::inline diagnostics_internal {

/// Rates at an instant, or their integrals.
struct Supply {
    double work = 0;   ///< of loads without potential, and of drives
    Vector3 linear{};
    Vector3 angular{};         ///< about the world's origin
    double gross = 0;          ///< sum of |F|, what rounding in `linear` is relative to
    double gross_moment = 0;   ///< sum of |F| (|x| + length), likewise in `angular` and in energies

    void add_force(const Matrix34& X, const Matrix34& F, double length);
    void add_size(const Matrix34& X, const Matrix34& F, double length);
    void add(double weight, const Supply& other);
};

/// What gravity and loads supply, at the points where the method takes loads.
class LoadSupply {
public:
    LoadSupply(const Model& model, const Motion& motion);

    int n_points() const { return points_.size(); }
    double weight_of(int k) const { return rule_.weights[k]; }
    /// Rates at a point; the points of an element are asked for one after the other.
    Supply at(int element, int k);
    /// What loads make of positions off by their size, and of velocities off by that in h: as rounding is
    /// relative to the size, stiff loads amplify it. At one point of the element.
    Supply stiffness(int element, double h);
    const LoadTurns& turns() const { return turns_; }
    /// Of all instants so far.
    double largest_kinetic() const { return largest_kinetic_; }

private:
    void go_to(int element, int k);
    LoadArguments arguments(int load, Instant at) const;

    const Model& model_;
    const LoadTurns turns_;
    std::vector<Matrix34> weights_of_bodies_;
    Quadrature rule_;
    ElementSampler points_;
    std::vector<Matrix34> X_, V_;
    std::vector<double> angles_;   // where X_ is
    double largest_kinetic_ = 0;
};

/// What joints supply, at the points where the method holds them.
class JointSupply {
public:
    JointSupply(const Model& model, const Motion& motion);

    int n_points() const { return multipliers_ ? points_.size() : 0; }
    double weight_of(int k) const { return rule_.weights[k]; }
    /// -G^T lambda on all bodies: between two bodies it adds up to nothing, so what stays is the world's. Its
    /// power is that of drives, -lambda G X' = lambda dPhi/dt at fixed X.
    Supply at(int element, int k);

private:
    const ModelTables tables_;
    Quadrature rule_;
    ElementSampler points_;
    std::vector<Matrix34> X_;
    std::optional<FieldTable> multipliers_;   // a field of its own degree
    std::vector<double> lambda_;
};

}   // namespace livens::inline diagnostics_internal
