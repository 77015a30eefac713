// SPDX-License-Identifier: BSD-3-Clause
// Where a phase ends that an event has ended.  (docs/theory.md, "Events")
#pragma once

#include <vector>

#include "livens/spacetime/phases/event_watch.h"
#include "livens/spacetime/phases/phases.h"

namespace livens::inline spacetime_internal {

/// A phase with what solves it once more.
struct WatchedPhase {
    const EventWatch& watch;
    const Problem& problem;
    const SolveOptions& options;
    const SolvePhase& solve;
};

/// The last element of a phase is solved anew until the state at its end is where the first of some events
/// is: the slope of its polynomial, by which velocities were seen on the way, is of a lower order. `fired`:
/// those that are true there. False: there is none.
bool end_at_event(const WatchedPhase& phase, std::vector<int>& fired, Solution& solved);

}   // namespace livens::inline spacetime_internal
