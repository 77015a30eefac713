// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/solve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/dynamics/start/singular.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/accuracy.h"
#include "livens/spacetime/accuracy/turning_springs.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/nodal/window.h"
#include "livens/spacetime/phases.h"
#include "livens/stepping/stepping.h"

namespace livens {

namespace {

/// Beyond, conditions at both ends do not determine the motion: the matrix of a window of N nodes has a
/// condition number of N^2 or so, and 1e16 where the conditions leave a motion free.
constexpr double undetermined = 1e11;

std::unique_ptr<Window> make_window(const Tables& tables, const TimeMesh& mesh, const Ends& ends,
                                    const Method& method, bool look_at_laws, const Motion* near)
{
    if (const auto* mixed = std::get_if<Mixed>(&method))
        return std::make_unique<MixedWindow>(tables, mesh, ends, *mixed);
    auto window = std::make_unique<LobattoWindow>(tables, mesh, ends, rule_of(method));
    if (near != nullptr) window->follow(*near);
    if (!look_at_laws) window->ignore_laws();
    return window;
}

/// Instants in the direction of solution: the ends of elements first..last - 1, each divided into `pieces`.
std::vector<double> instants(const TimeMesh& mesh, const Ends& ends, int first, int last, int pieces)
{
    std::vector<double> times;
    for (int e = first; e < last; ++e)
        for (int i = 0; i < pieces; ++i) times.push_back(mesh.ends[e] + mesh.length(e) * i / pieces);
    times.push_back(mesh.ends[last]);
    if (ends.is_backwards()) std::reverse(times.begin(), times.end());
    return times;
}

/// Where windows start from, one attempt after the other. From a state: a march of lobatto over the
/// elements, or more and more pieces of them. Single elements of lobatto and radau have their own guess;
/// where that leads nowhere they are too long, and are divided.
class Proposals {
public:
    Proposals(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
              const Method& method, const Window& window)
        : model_(model), problem_(problem), mesh_(mesh), ends_(ends), method_(method), window_(window)
    {}

    WindowOptions::Proposal operator()(int first, int last, int attempt) const
    {
        if (!ends_.has_state()) {
            if (attempt == 0 && problem_.guess) return {problem_.guess, false};
            if (attempt > (problem_.guess ? 1 : 0)) return {};
            return {guess_from_ends(model_, ends_, instants(mesh_, ends_, first, last, 1)), false};
        }
        State state;
        window_.near_state(state);
        const auto* mixed = std::get_if<Mixed>(&method_);
        if (mixed != nullptr && (attempt > 0 || mixed->first_guess == Mixed::FirstGuess::steady))
            return {attempt > 0 ? Guess{} : guess_steady(state), false};
        if (attempt > 2 || (mixed == nullptr && last - first == 1)) return {};
        try {
            const std::vector<double> times = instants(mesh_, ends_, first, last, 1 << (2 * attempt));
            return {guess_from_state(model_, state, times, mixed ? mixed->witness().degree : 2).motion, true};
        } catch (const InputError&) {
            return {guess_steady(state),
                    false};   // what was handed on is too far from a rigid state to march on
        }
    }

private:
    const Model& model_;
    const Problem& problem_;
    const TimeMesh& mesh_;
    const Ends& ends_;
    const Method& method_;
    const Window& window_;
};

/// What an iteration leaves has to be far below the errors that two motions are compared for.
double compared_tolerance(const SolveOptions& options)
{
    const bool is_compared = options.growth || options.estimate != SolveOptions::Estimate::none;
    return is_compared ? std::min(options.tolerance, 1e-10) : options.tolerance;
}

WindowOptions window_options(const Model& model, const Ends& ends, const Method& method,
                             const SolveOptions& options)
{
    WindowOptions w;
    w.by_newton = options.by_newton;
    w.direction = ends.is_backwards() ? -1 : 1;
    w.tolerance = is_nodal(method) ? compared_tolerance(options) : options.tolerance;
    w.max_iterations = options.max_iterations;
    w.progress = options.progress;
    w.length_of_model = model.length();
    w.locking = [&model](const State& first, const State& last) { return of_locking(model, first, last); };
    if (const auto* mixed = std::get_if<Mixed>(&method)) {
        w.length = mixed->window;
        w.shortest = shortest_block(*mixed);
        w.may_split = false;   // shorter blocks are other equations
        w.advice = "shorter elements, or fewer of them at once";
    } else {
        if (const auto* lobatto = std::get_if<Lobatto>(&method)) {
            w.length = lobatto->window;
            if (ends.has_state() && EnergyWatch::serves(model))
                w.watch = [watch = EnergyWatch(model, lobatto->degree)](const Motion& so_far,
                                                                        double until) mutable {
                    return watch.look(so_far, until);
                };
        }
        w.may_divide = options.divide && ends.has_state();
        w.ends_at_bends = options.end_at_bends && model.has_pieces();
        if (w.may_divide) w.trust = {acceptable_velocity_jump, true, true};
    }
    if (!ends.has_state()) {
        w.length = 0;
        w.may_split = false;
        w.advice =
            "a shorter time, more elements, ends that are nearer, or a better guess (rates stated beside the "
            "known positions)";
    }
    return w;
}

/// The caller's word while condition numbers are computed, after the last window. Nothing that ends them may
/// cost the motion.
class ConditionNumbersOfLast {
public:
    ConditionNumbersOfLast(const SolveOptions& options, const TimeMesh& mesh, double t)
        : progress_(options.progress), state_{mesh.n_elements(), mesh.n_elements(), t, 0, 0}
    {}

    /// work(goes_on) leaves what it finds in the report.
    template <class Work>
    void measure(SolveReport& report, const Work& work)
    {
        const std::function<bool()> goes_on = [this] {
            is_stopped_ = is_stopped_ || (progress_ && !progress_(state_));
            return !is_stopped_;
        };
        const Patience patience(goes_on);
        try {
            work(goes_on);
        } catch (const Stopped&) {
            is_stopped_ = true;
        } catch (const std::bad_alloc&) {
            has_no_memory_ = true;
            report.notes.push_back("memory ended before condition numbers were computed");
        }
    }
    bool is_stopped() const { return is_stopped_; }
    bool has_no_memory() const { return has_no_memory_; }

private:
    const ProgressCallback& progress_;
    Progress state_;
    bool is_stopped_ = false, has_no_memory_ = false;
};

/// Conditions at both ends may leave a motion free, at conjugate and focal times: then the solution is one of
/// many, and its digits are made of rounding.
void refuse_undetermined(Window& window, ConditionNumbersOfLast& last, SolveReport& report)
{
    SolveReport measured;
    last.measure(report, [&](const auto& goes_on) { window.measure_condition(measured, goes_on); });
    if (last.is_stopped()) return;
    if (last.has_no_memory()) {
        report.status = SolveStatus::suspect;
        report.message =
            "memory ended before it was found whether the conditions at the two ends determine the motion";
        return;
    }
    const bool is_singular = !measured.notes.empty() || !(measured.condition_1 < undetermined);
    if (!is_singular) return;
    report.status = SolveStatus::singular;
    report.message =
        "the conditions at the two ends of time do not determine the motion (condition number " +
        (measured.notes.empty() ? to_text(measured.condition_1, 6) : std::string("infinite")) +
        "): a neighbouring motion fulfils them as well, as at conjugate and focal times; try: another "
        "duration, or the state at one end";
}

Solution solve_by_windows(const Model& model, const Problem& problem, const TimeMesh& given,
                          const Method& method, const SolveOptions& options)
{
    TimeMesh mesh = given;
    const std::vector<double> breaks = model.load_breaks();
    mesh.required.insert(mesh.required.end(), breaks.begin(), breaks.end());
    std::ranges::sort(mesh.required);
    const bool is_mixed = std::holds_alternative<Mixed>(method);
    const Ends ends = close_ends(model, problem, mesh.start(), mesh.end(), options.initial);
    const Tables tables(model, ends.independent, is_mixed, problem.prepared->pattern(model));
    const std::unique_ptr<Window> window =
        make_window(tables, mesh, ends, method, options.look_at_laws, problem.near);
    Solution solution;
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    WindowOptions w = window_options(model, ends, method, options);
    w.propose = Proposals(model, problem, mesh, ends, method, *window);
    solve_windows(*window, mesh, w, report);
    ConditionNumbersOfLast last(options, mesh, w.direction > 0 ? mesh.end() : mesh.start());
    if (!ends.has_state() && !is_mixed && report.status != SolveStatus::cancelled)
        refuse_undetermined(*window, last, report);
    // Else the last window is all there is, or nothing: single elements of a march form no matrix.
    const bool is_whole = !std::holds_alternative<Lobatto>(method) || !ends.has_state() ||
                          (mesh.n_elements() > 1 && (w.length == 0 || w.length >= mesh.n_elements()));
    if (options.condition && report.converged() && is_whole)
        last.measure(report, [&](const auto& goes_on) { window->measure_condition(report, goes_on); });
    solution.unseen = window->take_unseen();
    solution.motion = window->take_motion();
    if (options.condition && report.converged() && !is_whole)
        last.measure(report, [&](const auto& goes_on) {
            // the march's equations as one window of all elements, at the solution
            LobattoWindow whole(tables, mesh, ends, rule_of(method));
            const Motion& motion = solution.motion;
            if (whole.open(0, mesh.n_elements(), report) &&
                whole.start_from([&](double t) { return motion.at(t); }) && whole.equations().residual())
                whole.measure_condition(report, goes_on);
        });
    if (last.is_stopped()) {
        report.status = SolveStatus::cancelled;
        report.failed_at = solution.motion.end();
        report.message = "stopped as asked while condition numbers were computed; the motion is complete";
    }
    return solution;
}

Solution solve_by_steps(const Model& model, const Problem& problem, const TimeMesh& mesh,
                        const Method& method, const SolveOptions& options)
{
    const ClosedStart start = problem.prepared->close(model, problem.conditions.start, options.initial);
    refuse_singular_start(model, start);
    const auto rule =
        std::holds_alternative<Midpoint>(method) ? SteppingRule::midpoint : SteppingRule::endpoint;
    SteppingResult result = march_stepping(model, start, mesh, rule,
                                           {options.tolerance, options.max_iterations, options.progress});
    return {std::move(result.motion), method, std::move(result.report)};
}

/// Loads that break inside elements hold every order down: to 1 where they jump, to 2 where they bend.
void lower_orders(const Model& model, Motion& motion)
{
    const std::vector<double> breaks = missed(motion.mesh, model.load_breaks());
    if (breaks.empty()) return;
    const Tables tables(model, {});
    for (const double t : breaks) {
        const State state = motion.at(t);
        std::vector<double> X, V, jump(12 * state.X.size(), 0.0);
        for (const Matrix34& x : state.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
        for (const Matrix34& v : state.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
        tables.add_loads({t, Side::right}, X.data(), V.data(), 1, jump.data(), state.angles);
        tables.add_loads({t, Side::left}, X.data(), V.data(), -1, jump.data(), state.angles);
        const int order = std::ranges::any_of(jump, [](double f) { return f != 0; }) ? 1 : 2;
        for (int* stated : {&motion.order_at_ends, &motion.dense_order_X, &motion.dense_order_V})
            *stated = std::min(*stated, order);
    }
}

Solution solve_phase(const Model& model, const Problem& problem, const Time& time, const Method& method,
                     const SolveOptions& options)
{
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr) return solve_to_accuracy(model, problem, std::get<Span>(time), method, options);
    return is_elements(method) ? solve_by_windows(model, problem, *mesh, method, options)
                               : solve_by_steps(model, problem, *mesh, method, options);
}

Solution solve_all_time(const Model& model, const Problem& problem, const Time& time, const Method& method,
                        const SolveOptions& options)
{
    return model.has_events() ? solve_by_phases(model, problem, time, method, options, solve_phase)
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
                     " cannot be told, the motion is whole up to " + to_text(end, 6) +
                     " s; the rounding of numbers grows to " + to_text(found, 3) + ", most in " +
                     in_words(solution.rounding.empty() ? solution.growing : solution.rounding_in, model) +
                     "; try: an earlier end of time, or a larger error in accuracy";
}

}   // namespace

Solution solve(const Model& model, const Problem& stated, const Time& time, const Method& method,
               const SolveOptions& given)
{
    check_method(model, stated, time, method, given);
    const Problem problem = with_prepared(stated);
    SolveOptions options = given;
    Progress last;
    std::function<bool()> goes_on;
    if (given.progress) {
        options.progress = [&](const Progress& progress) {
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
    lower_orders(model, solution.motion);
    if (!options.judge) return solution;
    estimate(model, problem, method, options, solution);
    refuse_rounding(model, solution);
    judge(model, problem, options, solution, goes_on);
    return solution;
}

ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& given, double t,
                           const SolveOptions& options)
{
    Method method = given;   // the motion knows what was taken of what was left open
    if (is_nodal(given) && motion.X.points == Points::radau)
        method = Radau{motion.X.degree};
    else if (is_nodal(given))
        method = Lobatto{motion.X.degree};
    if (!(t >= motion.start() && t <= motion.end()))
        throw InputError({"time-out-of-range", "at", "the instant lies outside the motion", to_text(t),
                          to_text(motion.start()) + " to " + to_text(motion.end()), "", ""});
    const int element = motion.mesh.element_at(t);
    for (int end = element; end <= element + 1; ++end)
        if (motion.mesh.ends[end] == t) return {motion.at_end(end), sample_joints(model, motion, t), {}};
    if (std::holds_alternative<Mixed>(method))
        throw InputError(
            {"sample-exact-method", "at", "the elements of the family mixed cannot be solved one by one", "",
             "", "each depends on all others of its block",
             "sample the polynomials, whose order is stated, or make the instant an output time"});
    SolveOptions quiet = options;
    quiet.progress = {};
    quiet.condition = false;   // one shortened element is not what was asked about
    quiet.initial =
        StartPolicy::project;   // an end state holds its constraints to rounding; polish, never refuse
    Problem problem = with_prepared({{motion.at_end(element)}});
    problem.conditions.start.angles = LoadTurns(model, motion).at_end(element);   // files do not hold them
    const TimeMesh one{{motion.mesh.ends[element], t}};
    quiet.judge = false;
    quiet.meeting = std::numeric_limits<double>::infinity();
    Solution s = solve_all_time(model, problem, one, method, quiet);
    const double there = s.motion.end();   // t, if it converged
    return {sample_state(s.motion, there), sample_joints(model, s.motion, there), std::move(s.report)};
}

}   // namespace livens
