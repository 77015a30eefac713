// SPDX-License-Identifier: BSD-3-Clause
// Several motions for the same conditions at both ends of time.
#pragma once

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// Looks for as many motions as the options want, from guesses with other rates and turns than those that led
/// to `first`, which may have failed. The one of least effort is what comes back, the others are in its
/// roots, and notes tell the effort and the turns of each. There may be more.
Solution with_roots(const Model& model, const Problem& problem, const Time& time, const Method& method,
                    const SolveOptions& options, Solution first);

}   // namespace livens::inline spacetime_internal
