// SPDX-License-Identifier: BSD-3-Clause
// Phases between conditions: what they are alike in, and motions to begin with. theory.md, "Phases between
// conditions".
#pragma once

#include <string>
#include <vector>

#include "livens/spacetime/march/numbered.h"
#include "livens/spacetime/march/window.h"
#include "livens/spacetime/nodal/phase_plan.h"

namespace livens::inline spacetime_internal {

/// A march of lobatto through all phases from a state, brought onto the joints; empty: it does not arrive.
Guess march_over_phases(const Model& model, const State& start, const TimeMesh& mesh, int degree);

/// The phases of a problem with the numbers as they are guessed, and one guess after the other.
class PlannedPhases {
public:
    /// References must outlive it.
    PlannedPhases(const Problem& problem, const NumberedProblem& numbered, int degree);

    /// Empty, and why() says it: no march arrives from which phases could begin.
    const PhasePlan& plan() const { return plan_; }
    const std::string& why() const { return why_; }
    /// Empty: no more of them.
    Guess guess();
    /// How the last one was found, if that is worth to be told.
    const std::string& told() const { return told_; }

private:
    Guess next_march();
    const std::vector<Matrix34>& steady_rates();
    void make_plan(const Guess& motion);

    const Problem& problem_;
    const NumberedProblem& numbered_;
    int degree_;
    int n_marches_ = 0;
    std::vector<Matrix34> rates_;   // of bodies at rest, once they are asked for
    Guess first_;                   // of which the plan was made
    PhasePlan plan_;
    std::string why_, told_;
};

}   // namespace livens::inline spacetime_internal
