// SPDX-License-Identifier: BSD-3-Clause
// Joints that act for a part of the time: one phase of the motion after the other.
//
// In every phase the joints that act are a model of their own, so that nothing else knows of events. Letting
// go leaves velocities as they are; a joint that begins must find its bodies as it will hold them.
#pragma once

#include <functional>

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// Solves a model without events in a part of the time.
using SolvePhase =
    std::function<Solution(const Model&, const Problem&, const Time&, const Method&, const SolveOptions&)>;

/// Throws InputError: `joint-time-method` for methods and conditions that know no events, `joint-time-mesh`
/// for an event inside an element.
void check_events(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options);

/// The motion through all events of a model, with a note for each. Where a joint begins, bodies that are off
/// by more than SolveOptions::meeting end the motion. An accuracy is that of the whole: phases are solved to
/// a part of it, and once more to a smaller one until a second solution of the whole is within.
Solution solve_by_phases(const Model& model, const Problem& problem, const Time& time, const Method& method,
                         const SolveOptions& options, const SolvePhase& solve_phase);

}   // namespace livens::inline spacetime_internal
