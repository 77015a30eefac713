// SPDX-License-Identifier: BSD-3-Clause
// Loads along a coordinate of a joint.
#pragma once

#include <functional>
#include <string>

#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"

namespace livens {

/// A generalised force Q, N or N m, and its slopes.
struct LawValue {
    double force = 0;
    double by_value = 0;
    double by_rate = 0;
};

/// What the law is asked with: the coordinate as its joint counts it, without whole turns.
struct LawArguments {
    Instant at;
    double value = 0, rate = 0;
};

/// F_b = Q dq/dX_b on the bodies of the joint: by virtual work Q dq. The angle is counted from where it
/// stands in X, from -pi to pi. Flags, breaks and energies are left to the caller.
class CoordinateLoad {
public:
    CoordinateLoad(const Joint& joint, const NamedCoordinate& coordinate, const Configurations& X);

    std::array<int, 2> bodies() const { return bodies_; }
    /// The coordinate in the bodies of the model, an angle from where it is in X.
    const JointCoordinate& coordinate() const { return coordinate_; }
    /// Where forces are not in the first column alone.
    std::array<bool, 2> needs_directors() const { return needs_directors_; }
    /// q and its rate; the bodies are those of the load.
    LawArguments look(const LoadArguments& arguments) const;

    void forces(const LoadArguments& arguments, double Q, LoadForces& F) const;
    void tangent(const LoadArguments& arguments, const LawValue& Q, LoadTangent& tangent) const;

private:
    JointCoordinate coordinate_;
    std::array<int, 2> bodies_{world, world};
    std::array<bool, 2> needs_directors_{};
    ConstraintRow row_;   ///< of q, with the places of the bodies for bodies
    double at_start_ = 0;
    std::size_t n_ = 1;   ///< of bodies
};

}   // namespace livens
