// SPDX-License-Identifier: BSD-3-Clause
// Controllers that are asked at instants, and states that events set.
#pragma once

#include "livens/multibody/model.h"

namespace livens::inline spacetime_internal {

/// What states of the model become at the time of a state.
void change_states(const Model& model, const StateChange& change, State& state);

/// All that are asked within `gap` of the time of a state, in their order. False: there are none.
bool ask_controllers(const Model& model, double gap, State& state);

}   // namespace livens::inline spacetime_internal
