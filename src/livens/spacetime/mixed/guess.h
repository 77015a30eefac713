// First guesses of a whole block.
#pragma once

#include <functional>

#include "livens/spacetime/mixed/equations.h"
#include "livens/spacetime/solve.h"

namespace livens::mixed {

/// A motion that is about right, at any instant of the block.
using Guess = std::function<State(double t)>;

/// The motion from a state at `t0` to `t1`, which may lie before `t0`: a march of lobatto(2) over the given
/// element ends, and where that fails straight on from its last good element. `rows` as in Assembly.
Guess guess_from_state(const Model& model, const State& state, const std::vector<double>& ends);

/// Points on straight lines, directors turning steadily, from `first` at `t0` to `last` at `t1`.
Guess guess_between(const State& first, const State& last);

/// Points and directors going on steadily from a state.
Guess guess_steady(const State& state);

/// The places of one state with the velocities and spins of another.
State with_rates(State places, const State& rates);

/// Sets all coefficients of `fields` to the guess: X0, X and P by interpolation, multipliers by the
/// acceleration-level equation at their functions' instants.
void take_guess(const Equations& equations, const Guess& guess, Fields& fields);

}   // namespace livens::mixed
