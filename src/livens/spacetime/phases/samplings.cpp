// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "States".
#include "livens/spacetime/phases/samplings.h"

#include <cmath>

#include "livens/multibody/unwrapped_angles.h"

namespace livens::inline spacetime_internal {

void change_states(const Model& model, const StateChange& change, State& state)
{
    const UnwrappedAngles turns(model);
    livens::change_states(model.loads()[static_cast<std::size_t>(change.load)], change,
                          {state.t, Side::right}, state.X, turns.of(change.load, state.angles), state.V);
}

bool ask_controllers(const Model& model, double gap, State& state)
{
    bool is_any = false;
    for (const Sampling& sampling : model.samplings()) {
        const double k = std::round((state.t - sampling.first) / sampling.every),
                     instant = sampling.first + k * sampling.every;
        if (k < 0 || std::abs(instant - state.t) > gap || instant > sampling.last + gap) continue;
        change_states(model, sampling.change, state);
        is_any = true;
    }
    return is_any;
}

}   // namespace livens::inline spacetime_internal
