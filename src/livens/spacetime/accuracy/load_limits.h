// SPDX-License-Identifier: BSD-3-Clause
// Where loads and angles end that do not hold for every motion.
#pragma once

#include <string>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline spacetime_internal {

/// The first load by a rotation vector (a bushing) that turns further than `most` (rad) or through half a
/// turn, where the vector changes its sign and the load jumps: which, when and why. Empty: none does.
std::string turned_too_far(const Model& model, const Motion& motion, double most);

/// The first angle of a ball joint, or of a sensor on it, that the motion leads to where it is not unique:
/// which, when and why. Empty: there is none.
std::string angle_without_value(const Model& model, const Motion& motion);

}   // namespace livens::inline spacetime_internal
