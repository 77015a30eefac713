// SPDX-License-Identifier: BSD-3-Clause
// A motion as accurate as is asked for.  (docs/theory.md, "To an accuracy")
#pragma once

#include "livens/spacetime/solve.h"

namespace livens {

/// Marches with elements as long as their local errors allow, with a second solution beside, and again with
/// shorter ones until the global estimate is within the accuracy: six times at most. What comes back is not
/// judged. The method is nodal, the state given at the start; degree
/// 0 is chosen.
Solution solve_to_accuracy(const Model& model, const Problem& problem, const Span& span,
                           const Method& method, const SolveOptions& options);

}   // namespace livens
