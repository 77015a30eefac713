// SPDX-License-Identifier: BSD-3-Clause
// The state of a scenario at the end of time where its positions are known.
#pragma once

#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

struct KnownState {
    State state;           ///< V = 0 where velocities are guesses
    StartPolicy initial;   ///< how exactly it is meant
};

/// With the joints alone that act at the start of time.
Scenario as_it_starts(Scenario scenario);
/// The same with stops, which hold where bodies lean on them.
Scenario as_it_rests(Scenario scenario);

/// At the start, else at the end; where positions are guesses everywhere, those at the start.
KnownState known_state(const Scenario& scenario);

}   // namespace gnu::visibility("default")]]livens
