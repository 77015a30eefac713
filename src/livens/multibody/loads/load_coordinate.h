// SPDX-License-Identifier: BSD-3-Clause
// Coordinates as loads look at them, and loads along them.
#pragma once

#include <array>
#include <vector>

#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens::inline multibody_internal {

/// A generalised force Q, N or N m, and its slopes.
struct LawValue {
    double force = 0;
    double by_value = 0;
    double by_rate = 0;
};

/// A coordinate and its rate.
struct CoordinateState {
    double value = 0, rate = 0;
};

/// A coordinate of the bodies of a load, and F_b = Q dq/dX_b on those, by virtual work Q dq. An angle is
/// counted from where it stands in X at the start.
class LoadCoordinate {
public:
    /// Of bodies of the model; `at_stated` is what the coordinate is at the start.
    LoadCoordinate(const JointCoordinate& coordinate, double at_stated, const Configurations& X);

    /// Of the model: one, or two; the first is never the world.
    std::array<int, 2> bodies() const { return bodies_; }
    /// As the model has it, an angle from where it is in X.
    const JointCoordinate& coordinate() const { return coordinate_; }
    /// Whose orientation it needs.
    PerBody<char> needs_directors() const { return needs_directors_; }
    /// What it is at the start: the middle of the angles that it knows.
    double at_start() const { return at_start_; }

    /// Its bodies as places in a load's list, which has them all; an angle whose turns count joins the load's
    /// list of these. Required before what follows.
    void place(Load& load, bool counts_turns = true);
    CoordinateState look(const LoadArguments& arguments) const;

    /// by_X and by_V of a size += by_value dq/dX and by_rate dq/dX: dq'/dX is left out.
    void add_products(const LoadArguments& arguments, double by_value, double by_rate,
                      ProductSlopes& slopes) const;
    void add_forces(const LoadArguments& arguments, double Q, LoadForces& F) const;
    /// Of Q(q, q').
    void add_tangent(const LoadArguments& arguments, const LawValue& Q, LoadTangent& tangent) const;
    /// by_X += by_value dq/dX + by_rate dq'/dX and by_V += by_rate dq'/dX', for all bodies of the load.
    void add_slopes(const LoadArguments& arguments, double by_value, double by_rate, PerBody<Matrix34>& by_X,
                    PerBody<Matrix34>& by_V) const;

    // The same on a tape; F += Q dq/dX.
    TapeNumber value(LoadTape& tape) const;
    TapeNumber rate(LoadTape& tape) const;
    void pull(LoadTape& tape, TapeNumber Q) const;

private:
    /// The function of the forms, its gradient and the rate by it, on a tape.
    struct OnTape;

    JointCoordinate coordinate_, placed_;   ///< of the model, and with places for bodies
    std::array<int, 2> bodies_{world, world};
    PerBody<char> needs_directors_{};
    ConstraintRow row_;   ///< of q, with places for bodies
    double at_start_ = 0, offset_ = 0;
    std::array<int, 2> places_{};
    int angle_ = -1;      ///< its place among those of the load
    std::size_t n_ = 1;   ///< of bodies
};

}   // namespace livens::inline multibody_internal
