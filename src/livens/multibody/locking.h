// SPDX-License-Identifier: BSD-3-Clause
// Which joints bring a motion to its end in a singular position.  (docs/theory.md, "Singular positions")
#pragma once

#include <vector>

#include "livens/multibody/model.h"

namespace livens {

/// Joints and drives, ascending, that hold together less `now` than `before`: those with a part of a fiftieth
/// and more in the combination of rows that is nearest to nothing, if it is nearer by a hundred times than
/// any was before. Empty: there are none, or too many rows to tell (400), or joints act for a part of the
/// time.
std::vector<int> joints_that_lock(const Model& model, const State& before, const State& now);

}   // namespace livens
