// SPDX-License-Identifier: BSD-3-Clause
// The entry: checks, consistent starts, the march or the search for elements, the estimate and the verdict,
// in this order (docs/architecture.md, "The rooms"). What each of them does stands in a file of its own.
#include "livens/spacetime/solve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/dynamics/start/singular.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/accuracy/settled_bends.h"
#include "livens/spacetime/ensemble.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/phases/phases.h"
#include "livens/spacetime/roots.h"
#include "livens/spacetime/rotating.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens {

namespace {

/// Loads that break inside elements hold every order down: to 1 where they jump, to 2 where they bend.
void lower_orders(const Model& model, Motion& motion)
{
    const std::vector<double> breaks = missed(motion.mesh, model.load_breaks());
    if (breaks.empty()) return;
    const ModelTables tables(model, {});
    for (const double t : breaks) {
        const State state = motion.at(t);
        std::vector<double> X, V, jump(12 * state.X.size(), 0.0);
        for (const Matrix34& x : state.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
        for (const Matrix34& v : state.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
        // Loads right of the instant less those left of it, in the same state: what differs is the jump.
        tables.loads.add({t, Side::right}, X.data(), V.data(), 1, jump.data(), state.angles);
        tables.loads.add({t, Side::left}, X.data(), V.data(), -1, jump.data(), state.angles);
        // A force that jumps makes the velocity bend, order 1; one that only bends is seen one order later.
        const int order = std::ranges::any_of(jump, [](double f) { return f != 0; }) ? 1 : 2;
        for (int* stated : {&motion.order_at_ends, &motion.dense_order_X, &motion.dense_order_V})
            *stated = std::min(*stated, order);
    }
}

Solution solve_phase(const Model& model, const Problem& problem, const Time& time, const Method& method,
                     const SolveOptions& options)
{
    TriedEnds tried = try_close_ends(model, problem, start_of(time), end_of(time), options.initial);
    if (!tried.ends) {
        Solution none;
        none.method = method;
        none.report.status = SolveStatus::singular;
        none.report.failed_at = start_of(time);
        none.report.message = tried.why.message;
        none.cannot_begin = std::move(tried.why);
        return none;
    }
    const auto* mesh = std::get_if<TimeMesh>(&time);
    // Elements that are not stated are found for the accuracy: theory.md, "To an accuracy".
    if (mesh == nullptr) {
        const bool is_march = problem.conditions.has_state();
        return is_march
                   ? solve_to_accuracy(model, problem, *tried.ends, std::get<Span>(time), method, options)
                   : solve_between_ends(model, problem, *tried.ends, std::get<Span>(time), method, options);
    }
    return problem.conditions.has_state()
               ? solve_mesh(model, problem, *mesh, *tried.ends, method, options)
               : solve_with_bends(model, problem, *mesh, *tried.ends, method, options);
}

Solution solve_all_time(const Model& model, const Problem& problem, const Time& time, const Method& method,
                        const SolveOptions& options)
{
    return model.has_events() && problem.conditions.has_state()
               ? solve_by_phases(model, problem, time, method, options, solve_phase)
               : solve_phase(model, problem, time, method, options);
}

/// Over events growth is known when all else is.
void refuse_rounding(const Model& model, Solution& solution)
{
    SolveReport& report = solution.report;
    const double found = solution.estimate.empty() ? 0 : solution.estimate.largest;
    if (!report.converged() || !(report.accuracy > 0) || found <= report.accuracy) return;
    const double end = solution.motion.end();
    report.status = SolveStatus::inaccurate;
    report.failed_at = solution.estimate.time;
    report.message = "the accuracy " + to_text(report.accuracy, 6) +
                     " is not known, the motion is complete up to " + to_text(end, 6) +
                     " s; rounding errors grow to " + to_text(found, 3) + ", most in " +
                     in_words(solution.rounding.empty() ? solution.growing : solution.rounding_in, model) +
                     "; try: an earlier end of time, or a larger error in accuracy";
}

}   // namespace

Solution spacetime_internal::solve_unjudged(const Model& model, const Problem& stated, const Time& time,
                                            const Method& method, const SolveOptions& given)
{
    const Problem problem = with_prepared(stated);
    SolveOptions options = given;
    Progress last;
    std::function<bool()> goes_on;
    if (given.progress) {
        options.progress = [&](const Progress& progress) {
            // Work without a progress of its own asks with the last one whether to go on.
            last = progress;
            return given.progress(progress);
        };
        goes_on = [&] { return given.progress(last); };
    }
    const Patience patience(goes_on);
    Solution solution;
    try {
        solution = solve_all_time(model, problem, time, method, options);
    } catch (const Stopped&) {
        solution = {};
        solution.method = method;
        solution.report.status = SolveStatus::cancelled;
        solution.report.message = "stopped as asked before the first element was solved";
        return solution;
    }
    if (!solution.motion.mesh.ends.empty()) lower_orders(found_model(model, solution), solution.motion);
    return solution;
}

namespace {

/// Threads share the nodes of a guess; what the caller's own looks at is not known.
std::function<State(double)> one_at_a_time(std::function<State(double)> guess)
{
    return [guess = std::move(guess), turn = std::make_shared<std::mutex>()](double t) {
        const std::lock_guard lock(*turn);
        return guess(t);
    };
}

}   // namespace

Solution solve(const Model& model, const Problem& stated, const Time& time, const Method& method,
               const SolveOptions& options)
{
    // A method that cannot take the conditions or the drives is refused before any work.
    check_method(model, stated, time, method, options);
    const Crew crew(threads_for(options.threads));
    Problem problem = with_prepared(stated);
    if (problem.guess && Crew::size() > 1) problem.guess = one_at_a_time(std::move(problem.guess));
    Solution solution;
    if (model.has_rotors()) {
        const WithRotors rotors(model);
        solution =
            without_rotors(rotors, std::make_shared<Solution>(solve_unjudged(
                                       rotors.model(), with_rotors(rotors, problem), time, method, options)));
    } else {
        solution = solve_unjudged(model, problem, time, method, options);
    }
    // A start that does not close is an error of the input; inside of searches it is a result among others.
    if (solution.cannot_begin) throw InputError(std::move(*solution.cannot_begin));
    if (options.roots > 1 && !problem.conditions.has_state())
        solution = with_roots(model, problem, time, method, options, std::move(solution));
    const bool is_iterate = solution.report.n_elements == 0 && solution.motion.n_elements() > 0;
    if (is_iterate && !solution.report.converged())
        solution.report.message +=
            "; the last iterate is kept, which does not meet the equations but may serve as a guess";
    if (!options.judge || solution.motion.mesh.ends.empty()) return solution;
    // The estimate comes first: whether rounding spoils the accuracy, and what is suspect, follow from it.
    const Model& found = found_model(model, solution);
    const Problem judged = with_found(problem, solution.numbers);
    estimate(found, judged, method, options, solution);
    refuse_rounding(found, solution);
    std::function<bool()> goes_on;
    const int n = solution.motion.n_elements();
    if (options.progress)
        goes_on = [&] {
            return options.progress({n, n, solution.motion.end(), 0, solution.report.residual_norm});
        };
    judge(found, judged, options, solution, goes_on);
    for (Solution& root : solution.roots) {
        estimate(found_model(model, root), with_found(problem, root.numbers), method, options, root);
        judge(found_model(model, root), with_found(problem, root.numbers), options, root, goes_on);
    }
    return solution;
}

ExactSampler::ExactSampler(const Model& model, const Motion& motion, const Method& method,
                           const SolveOptions& options)
    : model_(model), motion_(motion), method_(method), options_(options), turns_(model, motion),
      joints_(model, motion), prepared_(std::make_shared<Prepared>()),
      rotors_(model.has_rotors() ? std::make_shared<const WithRotors>(model) : nullptr)
{
    // The motion knows what was taken of what was left open.
    if (is_nodal(method) && motion.X.points == Points::radau)
        method_ = Radau{motion.X.degree};
    else if (is_nodal(method))
        method_ = Lobatto{motion.X.degree};
    options_.progress = {};
    options_.condition = false;   // one shortened element is not what was asked about
    options_.initial =
        StartPolicy::project;   // an end state holds its constraints to rounding; polish, never refuse
    options_.judge = false;
    options_.meeting = std::numeric_limits<double>::infinity();
    // The element was accepted whole: its laws bend at its ends alone. Where one begins within rounding of a
    // bend, looks would find that at every division anew.
    options_.divide = options_.end_at_bends = options_.look_at_laws = false;
}

ExactSample ExactSampler::at(double t) const
{
    if (!(t >= motion_.start() && t <= motion_.end()))
        throw InputError({"time-out-of-range", "at", "the instant lies outside the motion", to_text(t),
                          to_text(motion_.start()) + " to " + to_text(motion_.end()), "", ""});
    const int element = motion_.mesh.element_at(t);
    for (int end = element; end <= element + 1; ++end)
        if (motion_.mesh.ends[end] == t) {
            State state = motion_.at_end(end);
            std::vector<JointSample> joints = joints_.at(state);
            return {std::move(state), std::move(joints), {}};
        }
    if (std::holds_alternative<Mixed>(method_))
        throw InputError(
            {"sample-exact-method", "at", "the elements of the family mixed cannot be solved one by one", "",
             "", "each depends on all others of its block",
             "sample the polynomials, whose order is given, or make the instant an output time"});
    Problem problem = with_prepared({{motion_.at_end(element)}, {}, nullptr, prepared_});
    problem.conditions.start.angles = turns_.at_end(element);   // files do not hold them
    // One shortened element from the state before it: its end has the order 2p that the polynomial lacks.
    const TimeMesh one{{motion_.mesh.ends[element], t}};
    if (rotors_ != nullptr) problem.conditions.start = rotors_->with(problem.conditions.start);
    const Model& whole = rotors_ != nullptr ? rotors_->model() : model_;
    Solution s = solve_all_time(whole, problem, one, method_, options_);
    if (rotors_ != nullptr) rotors_->take_off(s.motion);
    if (s.cannot_begin) throw InputError(std::move(*s.cannot_begin));
    const double there = s.motion.end();   // t, if it converged
    return {sample_state(s.motion, there), sample_joints(model_, s.motion, there), std::move(s.report)};
}

ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options)
{
    return ExactSampler(model, motion, method, options).at(t);
}

}   // namespace livens
