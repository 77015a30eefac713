// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/solve.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/lobatto/window.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/windows.h"
#include "livens/stepping/stepping.h"

namespace livens {

namespace {

/// Beyond, conditions at both ends do not determine the motion: the matrix of a window of N nodes has a
/// condition number of N^2 or so, and 1e16 where the conditions leave a motion free.
constexpr double undetermined = 1e11;

std::unique_ptr<Window> make_window(const Tables& tables, const TimeMesh& mesh, const Ends& ends,
                                    const Method& method)
{
    if (const auto* mixed = std::get_if<Mixed>(&method))
        return std::make_unique<MixedWindow>(tables, mesh, ends, *mixed);
    return std::make_unique<LobattoWindow>(tables, mesh, ends, std::get<Lobatto>(method));
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

/// Where windows start from, one attempt after the other. From a state: a march of lobatto(2) over the
/// elements, or more and more pieces of them. Single elements of lobatto have their own guess; where that
/// leads nowhere they are too long, and are divided.
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
            return {guess_from_state(model_, state, times).motion, true};
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

WindowOptions window_options(const Model& model, const Ends& ends, const Method& method,
                             const SolveOptions& options)
{
    WindowOptions w;
    w.direction = ends.is_backwards() ? -1 : 1;
    w.tolerance = options.tolerance;
    w.max_iterations = options.max_iterations;
    w.progress = options.progress;
    w.length_of_model = model.length();
    if (const auto* mixed = std::get_if<Mixed>(&method)) {
        w.length = mixed->window;
        w.shortest = shortest_block(*mixed);
        w.may_split = false;   // shorter blocks are other equations
        w.advice = "shorter elements, or fewer of them at once";
    } else {
        w.length = std::get<Lobatto>(method).window;
        w.may_divide = options.divide && ends.has_state();
        if (w.may_divide) w.trust = {acceptable_velocity_jump, true};
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

/// The caller's word while condition numbers are computed, after the last window.
class Patience {
public:
    Patience(const SolveOptions& options, const TimeMesh& mesh, double t)
        : progress_(options.progress), state_{mesh.n_elements(), mesh.n_elements(), t, 0, 0}
    {}
    std::function<bool()> goes_on()
    {
        return [this] {
            is_exhausted_ = is_exhausted_ || (progress_ && !progress_(state_));
            return !is_exhausted_;
        };
    }
    bool is_exhausted() const { return is_exhausted_; }

private:
    const ProgressCallback& progress_;
    Progress state_;
    bool is_exhausted_ = false;
};

/// Conditions at both ends may leave a motion free, at conjugate and focal times: then the solution is one of
/// many, and its digits are made of rounding.
void refuse_undetermined(Window& window, Patience& patience, SolveReport& report)
{
    SolveReport measured;
    window.measure_condition(measured, patience.goes_on());
    if (patience.is_exhausted()) return;
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
    const bool is_mixed = std::holds_alternative<Mixed>(method);
    const Ends ends = close_ends(model, problem.conditions, mesh.start(), mesh.end(), options.initial);
    const Tables tables(model, ends.independent, is_mixed);
    const std::unique_ptr<Window> window = make_window(tables, mesh, ends, method);
    Solution solution;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    WindowOptions w = window_options(model, ends, method, options);
    w.propose = Proposals(model, problem, mesh, ends, method, *window);
    solve_windows(*window, mesh, w, report);
    Patience patience(options, mesh, w.direction > 0 ? mesh.end() : mesh.start());
    if (!ends.has_state() && !is_mixed && report.status != SolveStatus::cancelled)
        refuse_undetermined(*window, patience, report);
    const bool is_whole = is_mixed || w.length == 0 || w.length >= mesh.n_elements();
    if (options.condition && report.converged() && is_whole)
        window->measure_condition(report, patience.goes_on());
    solution.motion = window->take_motion();
    if (options.condition && report.converged() && !is_whole) {
        // the march's equations as one window of all elements, at the solution
        LobattoWindow whole(tables, mesh, ends, std::get<Lobatto>(method));
        const Motion& motion = solution.motion;
        if (whole.open(0, mesh.n_elements(), report) &&
            whole.start_from([&](double t) { return motion.at(t); }) && whole.equations().residual())
            whole.measure_condition(report, patience.goes_on());
    }
    if (patience.is_exhausted()) {
        report.status = SolveStatus::cancelled;
        report.failed_at = solution.motion.end();
        report.message = "stopped as asked while condition numbers were computed; the motion is complete";
    }
    return solution;
}

Solution solve_by_steps(const Model& model, const Problem& problem, const TimeMesh& mesh,
                        const Method& method, const SolveOptions& options)
{
    const ClosedStart start = close_start(model, problem.conditions.start, options.initial);
    const auto rule =
        std::holds_alternative<Midpoint>(method) ? SteppingRule::midpoint : SteppingRule::endpoint;
    SteppingResult result = march_stepping(model, start, mesh, rule,
                                           {options.tolerance, options.max_iterations, options.progress});
    return {std::move(result.motion), std::move(result.report)};
}

bool is_elements(const Method& method)
{
    return std::holds_alternative<Lobatto>(method) || std::holds_alternative<Mixed>(method);
}

void check_state(const Model& model, const State& state, const char* path)
{
    if (state.X.size() == model.bodies().size() && state.V.size() == model.bodies().size()) return;
    throw InputError({"start-size", path, std::string("the ") + path + " needs X and V of every body",
                      std::to_string(state.X.size()), std::to_string(model.n_bodies()), "", ""});
}

/// Momenta at both ends do not say where free bodies are: bodies that neither joints nor loads tie to the
/// world, directly or through others, can be displaced together.
void refuse_free_bodies(const Model& model)
{
    std::vector<int> group(model.bodies().size());
    for (int b = 0; b < model.n_bodies(); ++b) group[b] = b;
    std::vector<bool> is_held(group.size(), false);
    const auto tie = [&](int i, int j) {
        if (i == world) std::swap(i, j);
        if (i == world) return;
        if (j == world) {
            is_held[group[i]] = true;
            return;
        }
        const int from = group[j], to = group[i];
        if (from == to) return;
        is_held[to] = is_held[to] || is_held[from];
        for (int& g : group)
            if (g == from) g = to;
    };
    for (int r = 0; r < model.n_rows(); ++r) {
        tie(model.row(r).body_i, model.row(r).body_j);
        for (const PairForm& q : model.row(r).coordinates) tie(q.body_i, q.body_j);
    }
    for (const Load& load : model.loads())
        if (load.depends_on_X && load.potential) tie(load.bodies[0], load.bodies[1]);
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!is_held[group[b]])
            throw InputError({"boundary-conditions", "end.given",
                              "momenta at both ends do not tell where body '" + model.body_name(b) + "' is",
                              "", "positions at one end at least",
                              "it could be displaced in any direction without any change of its momenta",
                              "give positions at the start or at the end"});
}

/// The other families take quadratic forms alone.
void refuse_special_rows(const Model& model, const Method& method)
{
    if (std::holds_alternative<Lobatto>(method)) return;
    const std::string name = std::holds_alternative<Mixed>(method) ? "mixed" : name_of(method);
    if (model.has_drives())
        throw InputError({"drives-method", "method.name", "the method " + name + " cannot follow drives",
                          name, "lobatto", "", "use lobatto for joints that depend on time"});
    for (int r = 0; r < model.n_rows(); ++r)
        if (model.row(r).function)
            throw InputError({"joint-method", "method.name",
                              "the method " + name + " cannot hold " + model.row_name(r), name, "lobatto",
                              "its rows must be quadratic forms of the bodies' positions and directors",
                              "use lobatto for screws, gears and slots"});
}

void check_conditions(const Model& model, const Conditions& given, const Method& method)
{
    const auto is_at = [&](const State& state, Known known, const char* path) {
        if (known != Known::nothing) check_state(model, state, path);
    };
    is_at(given.start, given.at_start, "start");
    is_at(given.end, given.at_end, "end");
    const int positions = (knows_positions(given.at_start) ? 1 : 0) + (knows_positions(given.at_end) ? 1 : 0);
    const int momenta = (knows_momenta(given.at_start) ? 1 : 0) + (knows_momenta(given.at_end) ? 1 : 0);
    if (positions + momenta != 2)
        throw InputError({"boundary-conditions", "end.given",
                          "the conditions at the ends of time do not determine a motion", "",
                          "two of: positions and momenta at the start, positions and momenta at the end", "",
                          "give the state at one end, or one half of it at each"});
    if (given.at_start == Known::state) return;
    if (!is_elements(method))
        throw InputError({"boundary-method", "start.given",
                          "the method " + name_of(method) + " needs the whole state at the start", "",
                          "the state at the start", "",
                          "use lobatto or mixed for conditions at the end of time"});
    if (positions > 0) return;
    if (std::holds_alternative<Mixed>(method))
        throw InputError({"boundary-conditions", "end.given", "the elements mixed need positions at one end",
                          "", "positions at one end at least", "", "use lobatto for momenta at both ends"});
    refuse_free_bodies(model);
}

}   // namespace

std::string name_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method))
        return "lobatto(" + std::to_string(lobatto->degree) + ")";
    if (std::holds_alternative<Midpoint>(method)) return "midpoint";
    if (std::holds_alternative<Endpoint>(method)) return "endpoint";
    const Mixed& mixed = std::get<Mixed>(method);
    const char* const bases[] = {"lagrange", "bspline", "nurbs"};
    return std::string("mixed(") + bases[static_cast<int>(mixed.basis)] + ", " +
           std::to_string(mixed.degree) + ", " +
           (mixed.start == Mixed::Start::natural ? "natural" : "strong") + ", " +
           (mixed.multipliers == Mixed::Multipliers::equal ? "equal" : "lower") + ")";
}

void check_method(const Model& model, const Problem& problem, const TimeMesh& mesh, const Method& method,
                  const SolveOptions& options)
{
    if (model.n_bodies() == 0)
        throw InputError({"no-bodies", "body", "a model needs at least one body", "", "", "", "add a body"});
    refuse_special_rows(model, method);
    check_conditions(model, problem.conditions, method);
    if (mesh.n_elements() < 1)
        throw InputError(
            {"no-elements", "time.elements", "at least one time element is needed", "", ">= 1", "", ""});
    if (!(options.tolerance > 0) || !(options.tolerance < 1))
        throw InputError({"tolerance-out-of-range", "method.tolerance",
                          "the tolerance must lie between 0 and 1", to_text(options.tolerance),
                          "0 < tolerance < 1", "", ""});
    if (options.max_iterations < 1)
        throw InputError({"max-iterations-out-of-range", "method.max_iterations",
                          "at least one iteration is needed", std::to_string(options.max_iterations), ">= 1",
                          "", ""});
    if (const auto* mixed = std::get_if<Mixed>(&method)) check_mixed(model, problem.conditions, mesh, *mixed);
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) {
        lobatto_rule(lobatto->degree);   // throws
        if (lobatto->window < 0)
            throw InputError({"window-out-of-range", "method.window", "a window has at least one element",
                              std::to_string(lobatto->window), "1 to all", "", ""});
    }
}

Solution solve(const Model& model, const Problem& problem, const TimeMesh& mesh, const Method& method,
               const SolveOptions& options)
{
    check_method(model, problem, mesh, method, options);
    Solution solution = is_elements(method) ? solve_by_windows(model, problem, mesh, method, options)
                                            : solve_by_steps(model, problem, mesh, method, options);
    if (!options.judge) return solution;
    estimate(model, problem, method, options, solution);
    judge(model, solution);
    return solution;
}

void judge(const Model& model, Solution& solution)
{
    solution.verdict = judge(model, solution.motion, solution.report, solution.estimate);
    if (solution.verdict.reasons.empty()) return;
    solution.report.status = SolveStatus::suspect;
    solution.report.message = solution.verdict.reasons.front();
}

ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options)
{
    if (!(t >= motion.start() && t <= motion.end()))
        throw InputError({"time-out-of-range", "at", "the instant lies outside the motion", to_text(t),
                          to_text(motion.start()) + " to " + to_text(motion.end()), "", ""});
    const int element = motion.mesh.element_at(t);
    for (int end = element; end <= element + 1; ++end)
        if (motion.mesh.ends[end] == t) return {motion.at_end(end), {}};
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
    const Problem problem{{motion.at_end(element)}};
    const TimeMesh one{{motion.mesh.ends[element], t}};
    Solution s = is_elements(method) ? solve_by_windows(model, problem, one, method, quiet)
                                     : solve_by_steps(model, problem, one, method, quiet);
    return {s.motion.at_end(s.motion.mesh.n_elements()), std::move(s.report)};
}

}   // namespace livens
