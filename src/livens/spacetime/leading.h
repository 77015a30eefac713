// SPDX-License-Identifier: BSD-3-Clause
// Ends that are led from where a motion arrives to where it shall.
#pragma once

#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// How a motion was led.
struct Leading {
    Guess motion{};              ///< that meets both ends; empty: it was not found
    double share = 0;            ///< of the way that was gone
    int steps = 0;               ///< solutions, with those that failed
    bool has_followed = false;   ///< the curve, past where the way turned back
    int turns = 0;               ///< of it
};

/// A motion of lobatto(degree) that meets what is known at both ends, from one that meets what is known at
/// one: the other end goes from what that motion has there to what is stated, in steps that grow while they
/// succeed and are halved where they fail, each begun with what two motions before foretell. `from_start`:
/// the end of time is led, else its start. `may_turn`: where it comes no farther the curve of motions is
/// followed.
Leading lead(const NumberedProblem& problem, int degree, const Guess& begin, bool from_start, bool may_turn);

/// "found by an end that was led, in 3 steps, from where a march from the start with the stated rates
/// arrives".
std::string in_words(const Leading& led, const GuessFromEnds& march);

}   // namespace livens::inline spacetime_internal
