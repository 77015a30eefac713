// SPDX-License-Identifier: BSD-3-Clause
// An unknown number that no condition depends on.
#pragma once

#include <optional>

#include "livens/base/error.h"
#include "livens/spacetime/march/numbered.h"

namespace livens::inline spacetime_internal {

/// Asked where a problem was not solved: an unknown number that changes nothing of what the conditions state,
/// on marches that begin anywhere. Nothing: each changes something, or marches cannot tell.
std::optional<Complaint> why_unseen(const NumberedProblem& problem);

}   // namespace livens::inline spacetime_internal
