// SPDX-License-Identifier: BSD-3-Clause
// The phases of a motion, one after the other.
#pragma once

#include "livens/spacetime/phases/phases.h"

namespace livens::inline spacetime_internal {

/// What is asked over events. What it refers to has to stay.
struct PhasedProblem {
    const Model& model;
    const Problem& problem;
    const Time& time;
    const SolveOptions& options;
    const SolvePhase& solve_phase;
};

/// All phases, as far as they go: up to what is known beforehand, or what the motion decides. `accuracy`: of
/// each phase, if the time has one; `meeting`: see SolveOptions.
Solution solve_chain(const PhasedProblem& given, const Method& method, double accuracy, double meeting);

}   // namespace livens::inline spacetime_internal
