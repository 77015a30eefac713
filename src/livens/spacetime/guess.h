// SPDX-License-Identifier: BSD-3-Clause
// Motions that are about right, for Newton's iteration to start from.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline spacetime_internal {

/// From a state along the given instants, which rise or fall from its own: a march of lobatto(degree) over
/// them, dividing elements whose velocity jump is above `velocity_jump`, and where that fails straight on
/// from its last good element.
struct MarchGuess {
    Guess motion;
    double reached = 0;      ///< s; the last instant if all went well
    bool is_closed = true;   ///< else no march begins near the state, and the motion is a steady one
};
MarchGuess guess_from_state(const Model& model, const State& state, std::span<const double> times,
                            int degree = 2, double velocity_jump = acceptable_velocity_jump);
/// The same over a fine mesh, of whose elements several are one of the march; those that are too long are
/// divided.
MarchGuess guess_over_many(const Model& model, const State& state, std::span<const double> times, int degree);
/// So many instants that it serves.
inline constexpr std::size_t many_instants = 200;

/// Points and directors going on steadily from a state.
Guess guess_steady(const State& state);

/// Points on straight lines and directors turning steadily from the places of one state to those of another.
Guess guess_between(const State& first, const State& last);

/// Element ends and the degree of marches that conditions at both ends are looked for from: where small
/// changes grow, one of a low degree arrives elsewhere.
struct GuessMesh {
    std::span<const double> times;
    int degree = 2;
};

/// For conditions at both ends; made from one of them on.
struct GuessFromEnds {
    Guess motion;
    bool from_start = true;
    std::string rates{};   ///< in words, of marches to lead from; or how many times the stated ones
    int next = 0;          ///< attempt after that
};
/// From what is known, with what is stated beside it as a guess: a march from each end where that is enough,
/// bent steadily onto positions that are known at the other end; momenta are met as a march has them. Between
/// places without rates, steady motions. `turn` 0 and 1: of the ends, that which moves first; those of an end
/// that miss least before others. Empty behind the last turn.
std::vector<GuessFromEnds> guesses_from_ends(const Model& model, const Ends& ends, const GuessMesh& mesh,
                                             int turn);

/// Marches that conditions at the other end may be led from: with the rates that are stated, with those of
/// steady motions between the ends, and with others. Null behind the last one.
GuessFromEnds march_to_lead(const Model& model, const Ends& ends, const GuessMesh& mesh, int attempt);

/// Marches with many sizes of the stated rates, of which those that arrive nearest to what is known at the
/// other end are bent to it, nearest first. Where none are stated: of those of the other end, or of steady
/// motions.
std::vector<GuessFromEnds> nearest_marches(const Model& model, const Ends& ends, const GuessMesh& mesh);

}   // namespace livens::inline spacetime_internal
