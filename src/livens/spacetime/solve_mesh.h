// SPDX-License-Identifier: BSD-3-Clause
// Motions that nobody has judged yet.
#pragma once

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// What every march takes from the caller's options and the model.
WindowOptions window_options(const Model& model, const SolveOptions& options);

/// On a mesh that is given, of a model without events. `ends`: closed; the problem keeps what is found.
Solution solve_mesh(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
                    const Method& method, const SolveOptions& options);

/// The motion as solve() has it before it asks for the error and judges, of input that is known to be right:
/// where its start does not close, Solution::cannot_begin says so.
Solution solve_unjudged(const Model& model, const Problem& problem, const Time& time, const Method& method,
                        const SolveOptions& options);

}   // namespace livens::inline spacetime_internal
