// SPDX-License-Identifier: BSD-3-Clause
// Figures of a motion of which every rank has a part.
#pragma once

#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/ranks.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline spacetime_internal {

/// t, X and V as a message, and back.
std::vector<double> numbers_of(const State& state);
State state_of(const std::vector<double>& numbers);

/// How far the motion is from the march that it was guessed by.
void compare_parts(const Model& model, const Motion& part, const Guess& guess, Ranks& ranks,
                   SolveReport& report);
/// The two ends of time as a motion, of which conditions are asked.
Motion ends_of_parts(const Motion& part, Ranks& ranks);
/// Measured by every rank of its part, and joined; balances go on from the parts before. Zigzags are those of
/// parts by themselves.
void judge_parts(const Model& model, const Motion& part, const SolveReport& report, Ranks& ranks, Verdict& v);
/// The state at the end of time, or at its start, on all ranks.
State state_of_all(const Motion& part, bool at_end, Ranks& ranks);

}   // namespace livens::inline spacetime_internal
