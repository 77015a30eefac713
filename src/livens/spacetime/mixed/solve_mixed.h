// The elements of the paper, block after block.
#pragma once

#include "livens/spacetime/solve.h"

namespace livens {

/// Throws InputError for a method that makes no solvable system on this mesh: degree, gauss_points, block,
/// knots, weights, pairings (`mixed-pairing`), conditions at the ends.
void check_mixed(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Mixed& method);

/// Solves with (P23). Blocks follow each other in time from the end where the state is given; the motion
/// holds those that were solved.
Solution solve_mixed(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Mixed& method,
                     const SolveOptions& options);

}   // namespace livens
