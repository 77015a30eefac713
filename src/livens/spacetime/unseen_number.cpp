// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Unknown numbers".
#include "livens/spacetime/unseen_number.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/planned_phases.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double change = 1e-2;      // of a number or its scale
constexpr double no_change = 1e-9;   // of what a condition is compared with

/// The guess at the start, with rates that nobody chose: at rest a damper would show nothing. The joints have
/// them already: what a projection changes depends on masses.
State moving(const NumberedProblem& problem)
{
    State state = problem.ends().start;
    const double speed = problem.model().length() / (problem.mesh().end() - problem.mesh().start());
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        const double share = 0.3 + 0.1 * static_cast<double>(b % 5);
        const Vector3 v{share * speed, -0.7 * share * speed, 0.4 * share * speed};
        if (problem.model().bodies()[b].is_point) {
            state.V[b].set_column(0, state.V[b].column(0) + v);
            continue;
        }
        const Vector3 w = (1 / problem.model().length()) * Vector3{v[1], v[2], v[0]};
        state.V[b] += rate(state.X[b], v, w);
    }
    const TriedStart tried = try_consistent_start(problem.model(), state, StartPolicy::project);
    return tried.closed ? tried.closed->start : state;
}

/// Empty: none begins there.
Guess march_through(const Model& model, const State& begin, const TimeMesh& mesh)
{
    if (model.has_events()) return march_over_phases(model, begin, mesh, 2);
    const MarchGuess march = guess_from_state(model, begin, mesh.ends);
    return march.is_closed ? march.motion : Guess{};
}

/// By how much each condition is missed by a march from a state, of the model that these values make, in the
/// scales of the conditions; empty: there is no such march, or no such model.
std::vector<double> missed_with(const NumberedProblem& problem, const std::vector<double>& values,
                                const State& start)
{
    const NumberedProblem::Tried tried = problem.try_at(values);
    if (!tried.made) return {};
    const NumberedProblem::Instance& made = *tried.made;
    const Model& model = *made.rebuilt.model;
    State begin = made.ends.is_start_known() ? made.ends.start : start;
    begin.t = made.mesh.start();
    const Guess march = march_through(model, begin, made.mesh);
    if (!march) return {};
    std::vector<double> missed = values_in(model, made.ends, march, made.mesh.ends);
    const double duration = made.mesh.end() - made.mesh.start();
    for (std::size_t i = 0; i < missed.size(); ++i) {
        const Condition& one = made.ends.components[i];
        missed[i] = (missed[i] - one.value) / scale_of(one, model.length(), duration);
    }
    return missed;
}

}   // namespace

/// What cannot be tried (no model, no march) is not refused: it may show.
std::optional<Complaint> why_unseen(const NumberedProblem& problem)
{
    if (problem.size() == 0) return {};
    const std::vector<double> guesses = problem.guesses();
    const State start = moving(problem);
    const std::vector<double> before = missed_with(problem, guesses, start);
    for (int i = 0; i < problem.size() && !before.empty(); ++i) {
        const UnknownNumber& number = problem[i];
        std::vector<double> values = guesses;
        const double step = change * std::max(problem.scale(i), std::abs(guesses[i]));
        values[i] = std::min(guesses[i] + step, number.high);
        if (values[i] - guesses[i] < 0.5 * step) values[i] = std::max(guesses[i] - step, number.low);
        const std::vector<double> now = missed_with(problem, values, start);
        double largest = now.empty() ? 1 : 0;
        for (std::size_t k = 0; k < now.size(); ++k)
            largest = std::max(largest, std::abs(now[k] - before[k]));
        if (!(largest <= no_change)) continue;
        return Complaint{"unknown-unseen",
                         "unknown[" + number.name + "]",
                         "the conditions do not depend on the unknown '" + number.name + "'",
                         "",
                         "",
                         "whatever it is, the motion meets them as well or as badly",
                         "give it as a number, or state what it changes"};
    }
    return {};
}

}   // namespace livens::inline spacetime_internal
