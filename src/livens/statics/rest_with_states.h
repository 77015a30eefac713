// SPDX-License-Identifier: BSD-3-Clause
// Rest of mechanisms with controllers: bodies and states are found together (docs/theory.md, "States").
#pragma once

#include "livens/statics/equilibrium.h"
#include "livens/statics/equilibrium_search.h"

namespace livens::inline statics_internal {

/// From `here`, where it ends; `iterations` count on.
SearchOutcome rest_with_states(Search& search, const EquilibriumOptions& options, RestPoint& here,
                               int& iterations);

}   // namespace livens::inline statics_internal
