// SPDX-License-Identifier: BSD-3-Clause
// The ends of time as the engine sees them: conditions, closed and consistent.
#pragma once

#include <vector>

#include "livens/multibody/closing.h"
#include "livens/spacetime/problem.h"

namespace livens {

/// States at both ends that fulfil the joints where they are known.
struct Ends {
    Known at_start = Known::state, at_end = Known::nothing;
    State start, end;   ///< V of known positions without momenta, and X of known momenta, are guesses
    std::vector<int> independent;   ///< rows, chosen where X is known
    std::vector<int> redundant;
    std::vector<std::string> notes;

    bool has_state() const { return at_start == Known::state || at_end == Known::state; }
    /// Windows follow each other from the end of time.
    bool is_backwards() const { return at_end == Known::state; }
};

/// Closes the mechanism at the known ends; throws InputError, see close_start().
Ends close_ends(const Model& model, const Conditions& conditions, double start, double end,
                StartPolicy policy);

}   // namespace livens
