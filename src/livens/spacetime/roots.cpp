// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Several motions": guesses that turn more often, or the other way, and what is found from them.
#include "livens/spacetime/roots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "livens/base/text.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"
#include "livens/multibody/state_quantities.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/guess_of_components.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens::inline spacetime_internal {

namespace {

/// That a guess has more than what is stated, either way; under weight some more than it shall have.
constexpr double turns_more[] = {1, 1.5, 2, 3};
constexpr int tries_a_root = 12;      // guesses at most
constexpr double one_motion = 1e-6;   // of lengths and directors: two solutions are one motion
constexpr int n_compared = 64;        // instants

/// Rates of joints that turn; where there are none those of bodies.
std::vector<StateQuantity> turning_rates(const Model& model)
{
    std::vector<StateQuantity> all;
    for (const Joint& joint : model.joints())
        for (const NamedCoordinate& q : joint.coordinates)
            if (q.coordinate.counts_turns()) all.push_back({joint.name + "." + q.name + "_rate", "", q, 1});
    if (!all.empty()) return all;
    for (const Body& body : model.bodies()) {
        if (!body.is_matter()) continue;
        for (const char* of : {".velocity", ".angular_velocity"}) {
            if (body.is_point && of[1] == 'a') continue;
            const std::vector<StateQuantity> three = state_quantities(model, body.name + of);
            all.insert(all.end(), three.begin(), three.end());
        }
    }
    return all;
}

/// States at the start whose rates are others than those that are stated.
std::vector<State> other_starts(const ModelTables& tables, const Ends& ends)
{
    std::vector<State> all;
    const State& start = ends.start;
    const double duration = ends.end.t - start.t;
    const bool is_moving = std::ranges::any_of(start.V, [](const Matrix34& V) { return norm(V) > 0; });
    for (const double factor : {-1.0, 2.0, 0.5}) {
        if (!is_moving) break;
        all.push_back(start);
        for (Matrix34& V : all.back().V) V = factor * V;
    }
    std::vector<Matrix34> stated;
    for (const Body& body : tables.model->bodies()) stated.push_back(body.X);
    const double round = 2 * std::numbers::pi / duration;
    for (const double turns : turns_more)
        for (const StateQuantity& rate : turning_rates(*tables.model))
            for (const int sign : {1, -1}) {
                const double unit = rate.is_angle() ? 1 : tables.length;
                const double now = value_of(rate, stated, start.X, start.V);
                Ends turned = ends;
                turned.components = {{rate, now + sign * turns * round * unit, Condition::At::start}};
                all.push_back(settled(tables, turned, Condition::At::start, start));
            }
    return all;
}

bool is_same(const Model& model, const Motion& one, const Motion& other, double errors)
{
    double off = 0;
    for (int i = 0; i <= n_compared; ++i) {
        const double t = one.start() + (one.end() - one.start()) * i / n_compared;
        off = std::max(off, distance_between(one.at(t).X, other.at(t).X, model.length()));
    }
    return off <= std::max(one_motion, 10 * errors);
}

double error_of(const Solution& solution)
{
    return solution.estimate.empty() || !std::isfinite(solution.estimate.largest) ? 0
                                                                                  : solution.estimate.largest;
}

/// "pivot.angle turns by -1.25 rounds"
std::string turns_of(const Model& model, const Motion& motion)
{
    std::vector<Matrix34> stated;
    for (const Body& body : model.bodies()) stated.push_back(body.X);
    std::string text;
    constexpr int a_degree = 4;
    for (const StateQuantity& rate : turning_rates(model)) {
        if (!rate.coordinate.coordinate.counts_turns() || rate.derivative != 1) continue;
        const JointCoordinate& q = rate.coordinate.coordinate;
        const double first = coordinate_change(q, stated, motion.at_end(0).X);
        double now = first;
        const int n = a_degree * motion.X.degree;
        for (int e = 0; e < motion.n_elements(); ++e)
            for (int i = 1; i <= n; ++i)
                now = turned_to(
                    coordinate_change(q, stated,
                                      motion.at(motion.mesh.ends[e] + motion.mesh.length(e) * i / n).X),
                    now);
        const std::string name = rate.name.substr(0, rate.name.size() - std::string("_rate").size());
        text += (text.empty() ? "" : ", ") + name + " turns by " +
                to_text((now - first) / (2 * std::numbers::pi), 4) + " rounds";
    }
    return text;
}

bool is_motion(const Solution& solution)
{
    return solution.report.reached_end() && solution.motion.n_elements() > 0;
}

class Several {
public:
    Several(const Model& model, int wanted) : model_(model), wanted_(wanted) {}

    bool is_done() const { return static_cast<int>(found_.size()) >= wanted_; }
    void take(Solution solution)
    {
        if (!is_motion(solution)) return;
        for (const Solution& one : found_)
            if (is_same(model_, one.motion, solution.motion, error_of(one) + error_of(solution))) return;
        found_.push_back(std::move(solution));
    }

    /// The first in order, with the others.
    Solution result(const Solution& failed)
    {
        if (found_.empty()) return failed;
        std::ranges::stable_sort(found_, {},
                                 [&](const Solution& one) { return effort_of(model_, one.motion); });
        Solution best = std::move(found_.front());
        found_.erase(found_.begin());
        best.roots = std::move(found_);
        for (int i = 0; i <= static_cast<int>(best.roots.size()); ++i) {
            const Solution& one = i == 0 ? best : best.roots[static_cast<std::size_t>(i) - 1];
            const std::string turns = turns_of(model_, one.motion);
            notes_.push_back("motion " + std::to_string(i + 1) + " of " +
                             std::to_string(best.roots.size() + 1) + " that were found: effort " +
                             to_text(effort_of(model_, one.motion), 6) +
                             " J s (kinetic energy over all of time)" + (turns.empty() ? "" : ", " + turns));
        }
        if (static_cast<int>(best.roots.size()) + 1 < wanted_)
            notes_.push_back("no more were found of " + std::to_string(wanted_) +
                             " that were asked for; that there are no others is not known");
        best.report.notes.insert(best.report.notes.end(), notes_.begin(), notes_.end());
        return best;
    }

private:
    const Model& model_;
    int wanted_;
    std::vector<Solution> found_;
    std::vector<std::string> notes_;
};

}   // namespace

/// Each start has one march, which is bent to the other end and solved by plain iteration: no other guess is
/// tried and nothing is led, so that a start costs little where it leads nowhere.
Solution with_roots(const Model& model, const Problem& problem, const Time& time, const Method& method,
                    const SolveOptions& options, Solution first)
{
    if (first.report.status == SolveStatus::cancelled) return first;
    const Ends ends = close_ends(model, problem, start_of(time), end_of(time), options.initial);
    const ModelTables tables(model, ends.independent);
    const int n = std::max(first.motion.n_elements(), 1);
    const TimeMesh mesh = first.motion.n_elements() > 0 ? first.motion.mesh
                                                        : make_time_mesh(start_of(time), end_of(time), 4 * n);
    const Ends guessed = ends.has_components() ? ends_for_guesses(model, ends, mesh.ends) : ends;
    SolveOptions alone = options;
    alone.roots = 1;
    Several search(model, options.roots);
    search.take(first);
    int tries = 0;
    for (const State& start : other_starts(tables, guessed)) {
        if (search.is_done() || ++tries > tries_a_root * options.roots) break;
        Ends other = guessed;
        other.start = start;
        Problem one = problem;
        one.is_only_guess = true;
        one.guess = guesses_from_ends(model, other, {mesh.ends}, 0).front().motion;
        Solution found = solve_unjudged(model, one, time, method, alone);
        if (found.report.status == SolveStatus::cancelled) break;
        search.take(std::move(found));
    }
    return search.result(first);
}

}   // namespace livens::inline spacetime_internal

namespace livens {

double effort_of(const Model& model, const Motion& motion)
{
    const ActionSeries of = action(model, motion);
    double sum = 0;
    for (std::size_t e = 0; e < of.lagrangian.size(); ++e)
        sum += 0.5 * (of.lagrangian[e] + of.hamiltonian[e]);
    return sum;
}

}   // namespace livens
