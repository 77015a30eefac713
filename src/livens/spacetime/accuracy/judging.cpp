// SPDX-License-Identifier: BSD-3-Clause
// What solve() does last: the verdict, and what beside it only the engine knows.
#include <algorithm>
#include <functional>
#include <new>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "livens/base/text.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/accuracy/load_limits.h"
#include "livens/spacetime/accuracy/turning_springs.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/solve.h"
#include "livens/spacetime/solve_mesh.h"
#include "livens/statics/frequencies.h"

namespace livens {

namespace {

/// Conditions that the motion found for them does not meet.
std::vector<std::string> missed_conditions(const Model& model, const Problem& problem,
                                           const SolveOptions& options, const Solution& solution)
{
    if (!solution.report.converged() || solution.motion.n_elements() == 0) return {};
    const double start = solution.motion.start(), end = solution.motion.end();
    const auto closed = [&](const Model& acting) {
        return close_ends(acting, problem, start, end, options.initial);
    };
    const bool is_march = model.has_events() && problem.conditions.has_state();
    const Ends ends = is_march ? closed(acting_at(model, start).model) : closed(model);
    return unmet(model, ends, solution.motion, solution.estimate);
}

/// A motion that ends as it began goes on as it did, unless what drives it has another period.
/// It may be off by what a velocity that is rounded at its start moves at its end: `arrival` is in s.
std::string another_period(const Model& model, const Problem& problem, const SolveOptions& options,
                           const Solution& solution)
{
    constexpr double same = 1e-6, rounding = 1e-12;
    const Motion& motion = solution.motion;
    const bool is_whole = solution.report.converged() && motion.n_elements() > 0;
    if (!problem.conditions.is_periodic || problem.conditions.turn || !is_whole) return "";
    if (!solution.numbers.unfolded.empty()) return "";   // nothing drives it
    const double period = motion.end() - motion.start();
    Problem next{{motion.at_end(motion.n_elements())}};
    TimeMesh mesh = motion.mesh;
    mesh.required = mesh.bends = {};
    for (double& t : mesh.ends) t += period;
    SolveOptions again = options;
    again.condition = again.judge = false;
    again.roots = 1;
    again.initial = StartPolicy::project;
    // Elements of the paper by their own kind: they are off by more than what is compared here.
    Method method = Lobatto{motion.X.degree};
    if (const auto* mixed = std::get_if<Mixed>(&solution.method)) {
        method = *mixed;
        std::get<Mixed>(method).knots.clear();
    }
    const Solution second = solve_unjudged(model, next, mesh, method, again);
    double off = 0, at = period;
    for (int e = 0; second.report.converged() && e <= motion.n_elements(); ++e) {
        const double t = motion.mesh.ends[e];
        const double here =
            distance_between(motion.at_end(e).X, second.motion.at(t + period).X, model.length());
        if (!(here > off)) continue;
        off = here;
        at = t;
    }
    const double allowed = std::max(same, rounding * solution.report.arrival / period);
    if (second.report.converged() && off <= allowed) return "";
    return of_another_period(period, off, at + period);
}

/// Energy that nobody supplied has a reason that no other check knows. Where an accuracy was asked for and is
/// told to be met the vibrations are below it.
void blame_turning_springs(const Model& model, Solution& solution)
{
    const auto* lobatto = std::get_if<Lobatto>(&solution.method);
    const bool is_midpoint = std::holds_alternative<Midpoint>(solution.method);
    const int degree = lobatto != nullptr ? lobatto->degree : static_cast<int>(is_midpoint);
    SolveReport& report = solution.report;
    Verdict& verdict = solution.verdict;
    const bool is_failed = report.status == SolveStatus::not_converged;
    if (degree == 0 || !EnergyWatch::serves(model) || !(is_failed || report.converged()) ||
        !(verdict.energy_drift > doubtful_energy))
        return;
    const std::string why = of_turning_springs(model, solution.motion, degree);
    if (is_failed && !why.empty())
        report.message = why;
    else if (!why.empty() && (report.accuracy == 0 || !verdict.reasons.empty()))
        verdict.reasons.insert(verdict.reasons.begin(), why);
    else if (!verdict.reasons.empty())
        if (std::string perhaps = of_unsteady_springs(model, solution.motion, degree); !perhaps.empty())
            verdict.reasons.push_back(std::move(perhaps));
}

/// An accuracy that lobatto did not reach may be what radau is for.
void advise_radau(const Model& model, Solution& solution)
{
    const SolveReport& report = solution.report;
    const bool is_said = report.message.find("radau") != std::string::npos;
    if (report.status != SolveStatus::inaccurate || is_said ||
        !std::holds_alternative<Lobatto>(solution.method) || !EnergyWatch::serves(model))
        return;
    const State start = solution.motion.at_end(0);
    const Frequency vibration = highest_frequencies(model, start).fastest_vibration();
    if (vibration.rate * time_of_motion(model, start) > fast_vibration)
        solution.report.message += ", or the family radau, since " + vibration.where(model) +
                                   " vibrates at " + to_text(vibration.rate, 3) + " rad/s";
}

/// What bodies turn by that a load can no longer follow, and conditions that are not met, beside the verdict.
void judge_beside(const Model& model, const Problem& problem, const SolveOptions& options, Solution& solution)
{
    for (const std::string& reason : missed_conditions(model, problem, options, solution))
        solution.verdict.reasons.push_back(reason);
    if (std::string why = another_period(model, problem, options, solution); !why.empty())
        solution.verdict.reasons.push_back(std::move(why));
    constexpr double degree = std::numbers::pi / 180;
    const bool is_solved = solution.report.converged();
    std::string limit = turned_too_far(model, solution.motion, 175 * degree);
    if (limit.empty() && !is_solved)   // which may break off before it
        limit = turned_too_far(model, solution.motion, 165 * degree);
    if (!limit.empty() && is_solved)   // first, as the others may follow from it
        solution.verdict.reasons.insert(solution.verdict.reasons.begin(), limit);
    if (!limit.empty() && !is_solved) solution.report.message += "; " + limit;
    if (std::string angle = angle_without_value(model, solution.motion); !angle.empty() && is_solved)
        solution.verdict.reasons.push_back(std::move(angle));
    blame_turning_springs(model, solution);
    advise_radau(model, solution);
}

}   // namespace

void judge(const Model& model, const Problem& problem, const SolveOptions& options, Solution& solution,
           const std::function<bool()>& goes_on)
{
    // Most motions are judged by then; of the others the writing alone takes as long as anybody waits.
    constexpr std::size_t large = 2'000'000;                                  // numbers
    const double grace = solution.motion.X.values.size() > large ? 0 : 0.5;   // s of CPU time
    SolveReport& report = solution.report;
    const auto give_up = [&](SolveStatus status, const std::string& why) {
        solution.verdict = {};
        const std::string what = why + " before the motion was checked";
        report.notes.push_back(what);
        if (!report.converged()) return;   // the status says why it is short
        report.status = status;
        report.message = what;
    };
    try {
        const Patience patience(goes_on, grace);
        solution.verdict = judge(model, solution.motion, report, solution.estimate, solution.growth,
                                 solution.growing, solution.rounding, solution.rounding_in,
                                 solution.measured.get());
        judge_beside(model, problem, options, solution);
    } catch (const Stopped&) {
        return give_up(SolveStatus::cancelled, "stopped as asked");
    } catch (const std::bad_alloc&) {
        return give_up(SolveStatus::suspect, "memory ended");
    }
    if (solution.verdict.reasons.empty()) return;
    report.status = SolveStatus::suspect;
    report.message = solution.verdict.reasons.front();
}

}   // namespace livens
