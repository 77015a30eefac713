// SPDX-License-Identifier: BSD-3-Clause
// Where events have nearly come.
#pragma once

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline spacetime_internal {

/// The first place where an event has been missed, or so nearly that nobody knows: another motion, which
/// differs from it by what is not known of both, differs there in the condition by more than a third of what
/// was lacking. `model`: as the first motion has decided. nan: nowhere.
double undecided_place(const Model& model, const Motion& motion, const Motion& other);

}   // namespace livens::inline spacetime_internal
