// SPDX-License-Identifier: BSD-3-Clause
// Momenta of all bodies that are known at an end, beside conditions by component at the other one.
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/problem.h"

namespace livens::inline spacetime_internal {

/// Of six momenta a body, in world axes and about its reference point, those along the motions that joints
/// leave free where the bodies are stated: as many conditions. The motions stay what they are wherever the
/// end is; each momentum is told as the speed that such a motion alone would have of it, m/s.
/// `stated`: closed. Empty: free motions carry no inertia there.
std::vector<Condition> given_momenta(const ModelTables& tables, const State& stated, Condition::At at);

}   // namespace livens::inline spacetime_internal
