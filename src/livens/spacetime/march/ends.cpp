// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/march/ends.h"

#include <utility>

#include "livens/dynamics/start/prepared.h"
#include "livens/dynamics/start/singular.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/phases/events.h"

namespace livens::inline spacetime_internal {

namespace {

/// One end: rates that are guesses need not fit the joints, places that are guesses are brought onto them.
std::optional<Complaint> close_end(const Model& model, State& state, Known known, StartPolicy policy,
                                   Prepared* prepared, Ends& ends)
{
    if (known == Known::nothing) return {};
    const std::vector<Matrix34> guessed = state.V;
    if (known == Known::positions) state.V.assign(guessed.size(), Matrix34{});
    // positions alone need not move as drives do
    const bool is_still = known == Known::positions && model.has_drives();
    TriedStart tried = is_still              ? try_consistent_start(frozen(model, {state.t}), state, policy)
                       : prepared != nullptr ? prepared->try_close(model, state, policy)
                                             : try_consistent_start(model, state, policy);
    if (!tried.closed) return std::move(tried.why);
    ConsistentStart& closed = *tried.closed;
    if (known == Known::state) {
        std::optional<Complaint> why =
            prepared != nullptr ? prepared->why_singular(model, closed) : why_singular(model, closed);
        if (why) return why;
    }
    state = std::move(closed.start);
    if (known == Known::positions) state.V = guessed;
    ends.independent = std::move(closed.independent);
    ends.redundant = std::move(closed.redundant);
    ends.notes.insert(ends.notes.end(), closed.notes.begin(), closed.notes.end());
    return {};
}

/// Guesses at both ends, of which that at the start says which rows are independent; a guess at the end that
/// no place near closes, or that nobody gave, is the one at the start.
std::optional<Complaint> close_guesses(const Model& whole, const Problem& problem, Ends& ends,
                                       StartPolicy policy)
{
    const Model model = acting_at_end(whole, ends.start.t, ends.end.t, false),
                last = acting_at_end(whole, ends.start.t, ends.end.t, true);
    std::optional<Complaint> given = close_end(last, ends.end, ends.at_end, policy, nullptr, ends);
    if (!given) given = close_end(model, ends.start, ends.at_start, policy, nullptr, ends);
    if (given) return given;
    if (is_over_phases(whole, problem) && ends.at_start == Known::state) ends.start_is = Ends::Start::known;
    TriedStart start = try_consistent_start(model, ends.start, StartPolicy::project);
    if (!start.closed) return std::move(start.why);
    ends.start = std::move(start.closed->start);
    ends.independent = std::move(start.closed->independent);
    ends.redundant = std::move(start.closed->redundant);
    const double t = ends.end.t;
    ends.is_end_guessed = !ends.end.X.empty();
    if (!ends.is_end_guessed) ends.end = ends.start;
    ends.end.t = t;
    TriedStart end = try_consistent_start(last, ends.end, StartPolicy::project);
    if (!end.closed && whole.has_events()) {
        ends.end.X = ends.start.X;
        end = try_consistent_start(last, ends.end, StartPolicy::project);
        if (!end.closed) return std::move(end.why);
    }
    if (end.closed) ends.end = std::move(end.closed->start);
    ends.independent_at_end = whole.has_events() ? end.closed->independent : ends.independent;
    const ModelTables tables(model, ends.independent), tables_at_end(last, ends.independent_at_end);
    make_given(tables, tables_at_end, ends);
    if (problem.conditions.is_periodic) {
        ends.start = settled(tables, ends, Condition::At::start, ends.start);
        if (std::optional<Complaint> why = make_periodic(tables, problem.conditions, ends)) return why;
    }
    if (std::optional<Complaint> why = why_undetermined(tables, tables_at_end, ends, problem.unknowns))
        return why;
    ends.start = settled(tables, ends, Condition::At::start, ends.start);
    if (ends.is_end_guessed) ends.end = settled(tables_at_end, ends, Condition::At::end, ends.end);
    return {};
}

}   // namespace

bool is_over_phases(const Model& model, const Problem& problem)
{
    const Conditions& given = problem.conditions;
    const bool is_from_state =
        given.at_start == Known::state && !given.components.empty() && !problem.unknowns.is_empty();
    return is_from_state || (model.has_events() && !given.has_state());
}

/// Asked in the middle of the first or the last phase, away from instants at which joints begin or end.
Model acting_at_end(const Model& model, double start, double end, bool last)
{
    if (!model.has_events()) return model;
    std::vector<double> instants{start};
    for (const double t : events_inside(model, start, end)) instants.push_back(t);
    instants.push_back(end);
    const std::size_t i = last ? instants.size() - 1 : 1;
    return acting_at(model, 0.5 * (instants[i - 1] + instants[i])).model;
}

Problem with_prepared(Problem problem)
{
    if (problem.prepared == nullptr) problem.prepared = std::make_shared<Prepared>();
    return problem;
}

/// The start is closed last: each known end says which rows are independent, and where both are known those
/// of the start serve.
TriedEnds try_close_ends(const Model& model, const Problem& problem, double start, double end,
                         StartPolicy policy)
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
    ends.components = conditions.components;
    ends.n_numbers = static_cast<int>(problem.unknowns.numbers.size());
    if (conditions.has_components() || is_over_phases(model, problem)) {
        if (std::optional<Complaint> why = close_guesses(model, problem, ends, policy))
            return {{}, std::move(*why)};
        return {std::move(ends), {}};
    }
    std::optional<Complaint> why = close_end(model, ends.end, ends.at_end, policy, prepared, ends);
    if (!why) why = close_end(model, ends.start, ends.at_start, policy, prepared, ends);
    if (why) return {{}, std::move(*why)};
    return {std::move(ends), {}};
}

Ends close_ends(const Model& model, const Problem& problem, double start, double end, StartPolicy policy)
{
    TriedEnds tried = try_close_ends(model, problem, start, end, policy);
    if (!tried.ends) throw InputError(std::move(tried.why));
    return std::move(*tried.ends);
}

}   // namespace livens::inline spacetime_internal
