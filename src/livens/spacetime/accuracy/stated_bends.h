// SPDX-License-Identifier: BSD-3-Clause
// Stated elements between both ends of time, which end also where laws bend.
#pragma once

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// Solves the elements together, and again with those divided in which laws of loads bend or jump on the way
/// of the motion, until its bends are where elements end. `ends`: closed, not those of a march. Methods that
/// cannot end elements there are solved once. (docs/theory.md, "Laws that bend")
Solution solve_with_bends(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
                          const Method& method, const SolveOptions& options);

}   // namespace livens::inline spacetime_internal
