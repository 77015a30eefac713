// SPDX-License-Identifier: BSD-3-Clause
// Models with inertias along coordinates are solved with their points (WithRotors); what is told has none.
#pragma once

#include <memory>

#include "livens/multibody/rotors.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// Conditions of a state at the start, closed by nobody yet; what was prepared of the model is of no use.
Problem with_rotors(const WithRotors& rotors, const Problem& problem);

/// Motion, errors and names of the bodies of the model alone; `whole` goes along.
Solution without_rotors(const WithRotors& rotors, const std::shared_ptr<Solution>& whole);

/// Throws InputError `rotor-method` for what cannot take them: other families and conditions.
void refuse_rotors(const Model& model, const Conditions& conditions, const Method& method);

}   // namespace livens::inline spacetime_internal
