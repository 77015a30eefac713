// SPDX-License-Identifier: BSD-3-Clause
// A motion that was solved before, as the first guess of another one between both ends of time.
#pragma once

#include <functional>

#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

/// Of a run of bodies with the same names, in any order, which must outlive the guess. Before its start and
/// after its end bodies go on as they move there. Throws InputError: `guess-unused` where the scenario has
/// the state at one end, `guess-bodies` where bodies differ, `guess-time` where the run has no time in common
/// with the scenario.
std::function<State(double t)> guess_of(const Scenario& scenario, const Run& run);

}   // namespace gnu::visibility("default")]]livens
