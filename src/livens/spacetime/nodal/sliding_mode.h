// SPDX-License-Identifier: BSD-3-Clause
// Motions that slide along a discontinuity of a load.
#pragma once

#include "livens/multibody/state.h"
#include "livens/spacetime/nodal/laws/watched_law.h"

namespace livens::inline spacetime_internal {

/// Whether the motion slides from a state at which the law jumps, behind an element of this length: on either
/// side of the jump the law drives it back (docs/theory.md, "Laws that bend"). `sparse`: see InstantSystem.
bool slides(const ModelTables& tables, bool sparse, const WatchedLaw& law, const State& at, double length);

}   // namespace livens::inline spacetime_internal
