// SPDX-License-Identifier: BSD-3-Clause
// Elements that are solved together and end where laws bend.  (docs/theory.md, "Laws that bend")
#pragma once

#include <memory>

#include "livens/spacetime/found.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// A motion whose own bends are where its elements end.
struct SettledBends {
    Solution solution;        ///< `bends` of its mesh are ends that bends have made
    bool is_settled = true;   ///< false: they still move, or another try has not found the motion
    double near = 0;          ///< and one of them is here, s
    int n_halved = 0;         ///< how often all elements were halved, since it was not found on longer ones
};

/// From a motion that was found on this mesh by elements of lobatto: these are divided where laws of loads
/// bend or jump on its way, and solved together again, until its bends are where elements end. Where neither
/// the model nor `options` ask for that it is as it was.
SettledBends settle_bends(const std::shared_ptr<const Stated>& stated, const TimeMesh& mesh,
                          const Lobatto& lobatto, const SolveOptions& options, Solution first);

/// Solves stated elements together, which end there as well; where that does not settle, the motion is
/// suspect. `ends`: closed, not those of a march. Methods that cannot end elements there are solved once.
Solution solve_with_bends(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
                          const Method& method, const SolveOptions& options);

}   // namespace livens::inline spacetime_internal
