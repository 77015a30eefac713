// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/march/ends.h"

#include <utility>

#include "livens/dynamics/start/singular.h"

namespace livens {

namespace {

/// One end: rates that are guesses need not fit the joints, places that are guesses are brought onto them.
void close_end(const Model& model, State& state, Known known, StartPolicy policy, Prepared* prepared,
               Ends& ends)
{
    if (known == Known::nothing) return;
    const std::vector<Matrix34> guessed = state.V;
    if (known == Known::positions) state.V.assign(guessed.size(), Matrix34{});
    // positions alone need not move as drives do
    const bool is_still = known == Known::positions && model.has_drives();
    ClosedStart closed = is_still              ? close_start(frozen(model, {state.t}), state, policy)
                         : prepared != nullptr ? prepared->close(model, state, policy)
                                               : close_start(model, state, policy);
    if (known == Known::state) refuse_singular_start(model, closed);
    state = std::move(closed.start);
    if (known == Known::positions) state.V = guessed;
    ends.independent = std::move(closed.independent);
    ends.redundant = std::move(closed.redundant);
    ends.notes.insert(ends.notes.end(), closed.notes.begin(), closed.notes.end());
}

}   // namespace

Problem with_prepared(Problem problem)
{
    if (problem.prepared == nullptr) problem.prepared = std::make_shared<Prepared>();
    return problem;
}

Ends close_ends(const Model& model, const Problem& problem, double start, double end, StartPolicy policy)
{
    const Conditions& conditions = problem.conditions;
    Prepared* const prepared = problem.prepared.get();
    Ends ends;
    ends.at_start = conditions.at_start;
    ends.at_end = conditions.at_end;
    ends.start = conditions.start;
    ends.end = conditions.end;
    ends.start.t = start;
    ends.end.t = end;
    close_end(model, ends.end, ends.at_end, policy, prepared, ends);
    close_end(model, ends.start, ends.at_start, policy, prepared, ends);
    return ends;
}

}   // namespace livens
