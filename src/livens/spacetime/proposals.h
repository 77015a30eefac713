// SPDX-License-Identifier: BSD-3-Clause
// Guesses that windows start from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/numbered.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/method.h"
#include "livens/spacetime/planned_phases.h"

namespace livens::inline spacetime_internal {

/// Where windows start from, one attempt after the other. From a state: a march of lobatto over the
/// elements, or more and more pieces of them. Single elements of lobatto and radau have their own guess;
/// where that leads nowhere they are too long, and are divided.
class Proposals {
public:
    /// References must outlive it; `phases`: null if there are none.
    Proposals(const Problem& problem, const NumberedProblem& numbered, const Method& method,
              const Window& window, PlannedPhases* phases);

    WindowOptions::Proposal operator()(int first, int last, int attempt);
    /// How the last guess was found, if it was led.
    const std::string& told() const { return phases_ != nullptr ? phases_->told() : told_; }

private:
    Guess between_ends();
    int degree() const;
    GuessMesh guess_mesh() const { return {numbered_.mesh().ends, degree()}; }
    const Ends& guessed_ends();

    const Model& model_;
    const Problem& problem_;
    const NumberedProblem& numbered_;
    const Ends& ends_;
    const Method& method_;
    const Window& window_;
    PlannedPhases* phases_;                               // or null
    std::optional<Ends> guessed_;                         // of conditions by component
    std::vector<GuessFromEnds> plain_;                    // of the turns that were needed so far
    std::optional<std::vector<GuessFromEnds>> nearest_;   // made where plain ones fail
    int turn_ = 0, n_plain_ = 0;                          // turns and guesses so far
    int lead_ = 0, n_curves_ = 0;                         // marches that were led, and curves
    std::string told_;
};

}   // namespace livens::inline spacetime_internal
