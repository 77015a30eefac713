// SPDX-License-Identifier: BSD-3-Clause
// Joints that begin with an impact: what it makes of velocities, and which stops stay closed behind it.
#pragma once

#include <string>
#include <vector>

#include "livens/spacetime/phases/decisions.h"

namespace livens::inline spacetime_internal {

/// What one of the joints that begin has done.
struct Contact {
    int joint = 0;
    double impulse = 0, approach = 0;   ///< SolvedEvent::impulse, speed; none: it was not met
    bool is_hit = false;
    bool closes = false;   ///< it holds from now on
    double rests_at = 0;   ///< s, of what closes: when bounces that were left out would be over
};

struct ContactOutcome {
    std::vector<Matrix34> V;   ///< of all bodies behind it
    bool jumps = false;        ///< other than before
    std::vector<Contact> begun;
    std::vector<int> opens;   ///< stops that the impact has left behind
    std::string refused;      ///< why there is none, for people
};

/// How far a state is beyond the stop that an event closes, by the scale of its row.
struct StopDepth {
    int event = 0;
    double depth = 0;
};
std::vector<StopDepth> depths_of_stops(const Model& model, const State& start);
/// Throws InputError `stop-violated` where a state is beyond a stop.
void check_stops(const Model& model, const State& start);

/// Of the scale of a stop's row: bodies that are so near are at it.
inline constexpr double touching_stop = 1e-12;
/// Where these events meet stops, those that close others at which bodies are without a force, as balls of a
/// row before another one hits it: the impact goes on through them.
std::vector<int> stops_beside(const Model& model, const Decisions& decisions, const std::vector<int>& events,
                              const State& reached);

/// Of a stop that is met: how fast its row changes with its coordinate, of which speeds are told. That of a
/// distance is half its square.
double slope_of_row(const Event& event, const State& state);

/// What the slack of a stop (EventWatch) becomes behind an impact, where it was met (0), or only touched with
/// so much of it: bodies that move side by side are beyond it by rounding, which adds up. Neighbours of a
/// motion are beyond it from the start.
double slack_behind(const Model& model, const Event& event, const State& reached, double touched_with);

/// Joints of a model with ImpactLaw that begin at a state, where what else begins or ends there has been
/// decided. Hops lower than `lowest_hop` times the row's scale are left out: the stop closes.
/// (docs/theory.md, "Impacts")
ContactOutcome meet_joints(const Model& model, const Decisions& decisions, const State& reached,
                           const std::vector<int>& begins, double lowest_hop);

}   // namespace livens::inline spacetime_internal
