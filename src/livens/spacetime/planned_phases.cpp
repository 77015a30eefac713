// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Phases between conditions": Guesses.
#include "livens/spacetime/planned_phases.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the rates that are stated at a start that is not known, or of steady ones.
constexpr std::array<double, 7> shares{1, 0.5, 1.5, 0, 2, 0.75, -1};

bool has_no_rates(const State& state)
{
    return std::ranges::all_of(
        state.V, [](const Matrix34& V) { return std::ranges::all_of(V.a, [](double v) { return v == 0; }); });
}

}   // namespace

/// Joints that begin take off whatever is in their way, however large: a guess need not meet them.
Guess march_over_phases(const Model& model, const State& start, const TimeMesh& mesh, int degree)
{
    SolveOptions options;
    options.judge = options.growth = options.look_at_laws = options.end_at_bends = false;
    options.estimate = SolveOptions::Estimate::none;
    options.initial = StartPolicy::project;
    options.meeting = std::numeric_limits<double>::infinity();
    Solution march = solve_unjudged(model, {{start}}, mesh, Lobatto{degree}, options);
    if (march.motion.n_elements() == 0 || march.motion.end() != mesh.end()) return {};
    const auto motion = std::make_shared<const Motion>(std::move(march.motion));
    return [motion](double t) { return motion->at(t); };
}

PlannedPhases::PlannedPhases(const Problem& problem, const NumberedProblem& numbered, int degree)
    : problem_(problem), numbered_(numbered), degree_(degree)
{
    first_ = problem.guess;
    while (!first_ && n_marches_ < static_cast<int>(shares.size())) first_ = next_march();
    if (first_)
        make_plan(first_);
    else
        why_ = "no motion from the start, as it is given or guessed, gets through all phases";
}

Guess PlannedPhases::guess()
{
    if (first_) return std::exchange(first_, {});
    if (problem_.is_only_guess) return {};
    while (n_marches_ < static_cast<int>(shares.size()))
        if (Guess march = next_march()) return march;
    return {};
}

/// From a start that is known there is one march; else rates may be others.
Guess PlannedPhases::next_march()
{
    const Ends& ends = numbered_.ends();
    const int i =
        std::exchange(n_marches_, ends.is_start_known() ? static_cast<int>(shares.size()) : n_marches_ + 1);
    State start = ends.start;
    if (!ends.is_start_known() && has_no_rates(start)) start.V = steady_rates();
    for (Matrix34& V : start.V) V = shares[i] * V;
    if (i > 0) told_ = "found from the stated or steady rates times " + to_text(shares[i], 3);
    return march_over_phases(numbered_.model(), start, numbered_.mesh(), degree_);
}

/// Of a motion straight to the end: as it is guessed, or to where what falls from rest meets the conditions.
const std::vector<Matrix34>& PlannedPhases::steady_rates()
{
    if (!rates_.empty()) return rates_;
    const Ends& ends = numbered_.ends();
    State end = ends.end;
    if (!ends.is_end_guessed) {
        const Guess fall = march_over_phases(numbered_.model(), ends.start, numbered_.mesh(), degree_);
        const Model model = acting_at_end(numbered_.model(), ends.start.t, ends.end.t, true);
        const ModelTables tables(model, ends.independent_at_end);
        end = settled(tables, ends, Condition::At::end, fall ? fall(ends.end.t) : ends.start);
        end.t = ends.end.t;
    }
    rates_ = guess_between(ends.start, end)(ends.start.t).V;
    return rates_;
}

/// The first phase begins as stated, others where the motion is by then, closed by the joints that act.
void PlannedPhases::make_plan(const Guess& motion)
{
    const Model& model = numbered_.model();
    const TimeMesh& mesh = numbered_.mesh();
    const std::vector<double> instants = phase_ends(model, mesh);
    for (std::size_t k = 0; k + 1 < instants.size(); ++k) {
        const auto end = [&](double t) {
            return static_cast<int>(std::ranges::lower_bound(mesh.ends, t) - mesh.ends.begin());
        };
        const ActingModel acting = acting_at(model, 0.5 * (instants[k] + instants[k + 1]));
        State start = k == 0 ? numbered_.ends().start : motion(instants[k]);
        start.t = instants[k];
        TriedStart tried = try_consistent_start(acting.model, start, StartPolicy::project);
        if (!tried.closed) {
            why_ = "behind the event at " + to_text(instants[k], 6) +
                   " s the motion cannot begin: " + tried.why.message;
            plan_ = {};
            return;
        }
        std::vector<double> angles = std::move(start.angles);
        start = std::move(tried.closed->start);
        start.angles = std::move(angles);
        plan_.phases.push_back({end(instants[k]), end(instants[k + 1]), acting.joints,
                                std::move(tried.closed->independent), std::move(start)});
    }
}

}   // namespace livens::inline spacetime_internal
