// SPDX-License-Identifier: BSD-3-Clause
// Which joints bring a motion to its end in a singular position.  (docs/theory.md, "Singular positions")
#pragma once

#include <vector>

#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

/// What holds less together than it did.
struct Lock {
    std::vector<int> joints;   ///< with a part of a fiftieth and more in the combination nearest to nothing
    std::vector<int>
        drives;   ///< without which the others hold, ten times better; those that move, if any do

    bool empty() const { return joints.empty() && drives.empty(); }
};

/// Of a motion from one state to another: the combination of rows that is nearest to nothing is nearer by a
/// hundred times than any was in the first. Empty if none is, if rows are too many to tell (400), or if
/// joints act for a part of the time.
Lock joints_that_lock(const Model& model, const State& before, const State& now);

}   // namespace livens::inline dynamics_internal
