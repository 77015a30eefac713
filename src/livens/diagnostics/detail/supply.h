// SPDX-License-Identifier: BSD-3-Clause
// What flows into a mechanism through loads and joints.
#pragma once

#include <span>
#include <vector>

#include "livens/diagnostics/coordinates.h"

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

/// What loads supply, at the points where the method takes them.
class LoadSupply {
public:
    LoadSupply(const Model& model, const Motion& motion) : model_(model), turns_(model, motion) {}

    bool empty() const { return model_.loads().empty(); }
    const LoadTurns& turns() const { return turns_; }

    /// An element begins: turns are those at its start.
    void begin(int element) { angles_ = turns_.at_end(element); }
    /// What loads make of positions off by their size, and of velocities off by that in h: as rounding is
    /// relative to the size, stiff loads amplify it. At one point of the element.
    Supply stiffness(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V, double h) const;
    /// Rates at a point; the points of an element are asked for one after the other.
    Supply at(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V);

private:
    LoadArguments arguments(int load, Instant at, std::span<const Matrix34> X,
                            std::span<const Matrix34> V) const
    {
        return load_arguments(model_.loads()[load], at, X, V, turns_.turns().of(load, angles_));
    }

    const Model& model_;
    const LoadTurns turns_;
    std::vector<double> angles_;   // at the last point
};

}   // namespace livens::inline diagnostics_internal
