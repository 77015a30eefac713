// SPDX-License-Identifier: BSD-3-Clause
// Loads whose laws read reactions of joints (docs/theory.md, "Laws of reactions").
#pragma once

#include <vector>

#include "livens/multibody/loads/reaction_law.h"
#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// ReactionLaw::make. Where joints that are read share what they bear, forces are not numbers.
std::vector<Load> loads_by_reactions(const Model& rest, const std::vector<ReactionLaw>& laws);

/// Throws InputError `event-reaction` for a law of the model that reads reactions that are not unique where
/// it begins, at time t.
void check_reaction_laws(const Model& model, double t);

}   // namespace gnu::visibility("default")]]livens
