// SPDX-License-Identifier: BSD-3-Clause
// Accelerations along a motion, of bodies and their points.
#pragma once

#include <memory>
#include <vector>

#include "livens/diagnostics/coordinates.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

/// X'' = [a, alpha x d_i + w x (w x d_i)] of all bodies, m/s^2 | 1/s^2, from the equations of motion at the
/// instant and not by differences: what loads and joints do to the bodies in that state, so that the second
/// derivative of every joint's rows is zero.  (docs/theory.md, "Accelerations")
///
/// At element ends these are what the motion holds there, of the method's full order. In between the
/// equations are solved in the state that is given, put onto the joints: of the motion's dense orders in one
/// of sample_state(), of the full order in one of sample_exactly(), and exact where drives leave nothing
/// free. Where the joints lose rank all bodies' are nan.
class Accelerations {
public:
    Accelerations(const Model& model, const Motion& motion);

    /// In a state at an instant of the motion. Where a load jumps, `side` tells before from after.
    AcceleratedState at(const State& state, Side side = Side::right) const;
    /// The nearest state that joints and drives allow, positions and rates: between element ends; where it
    /// cannot be had, and at ends, the state itself.
    State on_joints(const State& state) const;
    /// Of all rows of the model, zero of those that are not needed or do not act: what belongs to at(state),
    /// between element ends. Empty where the joints lose rank.
    std::vector<double> multipliers_at(const State& state) const;

private:
    struct Phase;

    bool is_at_end(const State& state) const;
    Phase& phase_at(double t) const;

    const Model& model_;
    const Motion& motion_;
    LoadTurns turns_;
    std::vector<double> events_;
    std::shared_ptr<std::vector<std::shared_ptr<Phase>>> phases_;   // between events, once they are asked for
};

/// (w' of D' = w x D) from X and X'': the part of w x (w x d_i) drops out.
Vector3 angular_acceleration(const Matrix34& X, const Matrix34& A);

}   // namespace gnu::visibility("default")]]livens
