// SPDX-License-Identifier: BSD-3-Clause
// Vibrations whose forms are carried round by the motion.
#pragma once

#include <vector>

#include "livens/statics/frequencies.h"

namespace livens::inline statics_internal {

/// A vibration by springs, and how fast its form leaves itself towards softer ones; where it turns into forms
/// that are as stiff, as of a body held alike on all sides, it stays.
struct TurningVibration {
    Frequency spring;
    double turn = 0;   ///< rad/s
};

/// Of what loads make of the free motions at `state`, those with a rate of `slowest` and more. They turn as
/// the velocities have it that are left without them: what vibrates as fast stretches springs, which changes
/// the stiffness across them and turns nothing. None of models of more than 600 freedoms, as work grows with
/// their cube, and where the state is not fit.
std::vector<TurningVibration> turning_vibrations(const Model& model, const State& state, double slowest);

}   // namespace livens::inline statics_internal
