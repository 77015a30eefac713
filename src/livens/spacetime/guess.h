// SPDX-License-Identifier: BSD-3-Clause
// Motions that are about right, for Newton's iteration to start from.
#pragma once

#include <span>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline spacetime_internal {

/// From a state along the given instants, which rise or fall from its own: a march of lobatto(degree) over
/// them, dividing elements as solve() does, and where that fails straight on from its last good element.
struct MarchGuess {
    Guess motion;
    double reached = 0;      ///< s; the last instant if all went well
    bool is_closed = true;   ///< else no march begins near the state, and the motion is a steady one
};
MarchGuess guess_from_state(const Model& model, const State& state, std::span<const double> times,
                            int degree = 2);

/// Points and directors going on steadily from a state.
Guess guess_steady(const State& state);

/// Points on straight lines and directors turning steadily from the places of one state to those of another.
Guess guess_between(const State& first, const State& last);

/// For conditions at both ends: from what is known, with what is stated beside it as a guess. Where a state
/// at one end is complete that way, a march from it, bent steadily onto what is known at the other end.
Guess guess_from_ends(const Model& model, const Ends& ends, std::span<const double> times);

}   // namespace livens::inline spacetime_internal
