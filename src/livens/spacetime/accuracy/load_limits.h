// SPDX-License-Identifier: BSD-3-Clause
// Where loads end that do not hold for every motion.
#pragma once

#include <string>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline spacetime_internal {

/// The first load by a rotation vector (a bushing) that turns further than `most` (rad) or through half a
/// turn, where the vector changes its sign and the load jumps: which, when and why. Empty: none does.
std::string turned_too_far(const Model& model, const Motion& motion, double most);

}   // namespace livens::inline spacetime_internal
