// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component as the makers of guesses know conditions.
#pragma once

#include <span>

#include "livens/spacetime/march/ends.h"

namespace livens::inline spacetime_internal {

/// Ends where positions are known if as many places are stated as joints leave motions free. Where nobody
/// guessed the state at the end, it is what a march from the start arrives at, brought to what is stated.
Ends ends_for_guesses(const Model& model, const Ends& ends, std::span<const double> times);

}   // namespace livens::inline spacetime_internal
