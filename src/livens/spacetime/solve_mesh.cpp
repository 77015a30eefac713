// SPDX-License-Identifier: BSD-3-Clause
// Motions over a stated mesh: one driver of windows for all families of elements, or the steps of a classical
// rule. Window, guesses and what is watched on the way are put together here (theory.md, "Windows").
#include "livens/spacetime/solve_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/turning_springs.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/nodal/phases_window.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/spacetime/other_motions.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/proposals.h"
#include "livens/spacetime/unseen_number.h"
#include "livens/stepping/stepping.h"

namespace livens::inline spacetime_internal {

namespace {

/// Beyond, conditions at both ends do not determine the motion: the share of it that rounding may move. Where
/// they leave a motion free it is about 1.
constexpr double undetermined = 1e-4;
std::unique_ptr<Window> make_window(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends,
                                    const Method& method, bool look_at_laws, const Motion* near)
{
    if (const auto* mixed = std::get_if<Mixed>(&method))
        return std::make_unique<MixedWindow>(tables, mesh, ends, *mixed);
    auto window = std::make_unique<NodalWindow>(tables, mesh, ends, rule_of(method));
    if (near != nullptr) window->follow(*near);
    if (!look_at_laws) window->ignore_laws();
    return window;
}

/// What an iteration leaves has to be far below the errors that two motions are compared for.
double compared_tolerance(const SolveOptions& options)
{
    const bool is_compared = options.growth || options.estimate != SolveOptions::Estimate::none;
    return is_compared ? std::min(options.tolerance, 1e-10) : options.tolerance;
}

WindowOptions options_of_mesh(const Model& model, const Ends& ends, const Method& method,
                              const SolveOptions& options)
{
    WindowOptions w = window_options(model, options);
    w.direction = ends.is_backwards() ? -1 : 1;
    if (is_nodal(method)) w.solve.tolerance = compared_tolerance(options);
    if (const auto* mixed = std::get_if<Mixed>(&method)) {
        w.length = mixed->window;
        w.shortest = shortest_block(*mixed);
        w.may_split = false;   // shorter blocks are other equations
        w.advice = "shorter elements, or fewer of them at once";
        w.ends_at_bends = false;
    } else {
        if (const auto* lobatto = std::get_if<Lobatto>(&method)) {
            w.length = lobatto->window;
            // Stiff springs that turn make vibrations grow: theory.md, "Springs that turn".
            if (ends.has_state() && EnergyWatch::serves(model))
                w.watch = [watch = EnergyWatch(model, lobatto->degree)](const Motion& so_far,
                                                                        double until) mutable {
                    return watch.look(so_far, until);
                };
        }
        w.may_divide = options.divide && ends.has_state();
        if (w.may_divide) w.criteria = {acceptable_velocity_jump, true, true};
    }
    w.has_state = ends.has_state();
    if (!w.has_state) {
        w.length = 0;
        w.may_split = false;
        w.keeps_iterate = is_nodal(method);
        w.advice = "a shorter time, more elements, ends that are nearer, or a better guess (rates given "
                   "beside the known positions)";
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
/// many, and its digits are made of rounding. How far rounding may move it.
Uncertainty refuse_undetermined(Window& window, ConditionNumbersOfLast& last, SolveReport& report)
{
    Uncertainty found;
    last.measure(report, [&](const auto&) { found = window.monitor().uncertainty(); });
    if (last.is_stopped()) return {};
    if (last.has_no_memory()) {
        report.status = SolveStatus::suspect;
        report.message =
            "memory ended before it was found whether the conditions at the two ends determine the motion";
        return {};
    }
    // Inequality: what rounding may move <= 1e-4 of the motion, else the conditions do not determine it
    // (theory.md, "Windows").
    if (found.size <= undetermined) return found;
    report.status = SolveStatus::singular;
    report.message = "the conditions at the two ends of time do not determine the motion: rounding alone may "
                     "move it by " +
                     to_text(found.size, 3) + " of itself, most of all " + found.name +
                     "; a neighbouring motion satisfies them as well, as at conjugate and focal times; try: "
                     "another duration, or the state at one end";
    return found;
}

/// What rounding may move, if all of it went the worst way.
void take_rounding(const NumberedProblem& numbered, const Uncertainty& found, Solution& solution)
{
    solution.report.moved_by_rounding = found.moved;
    if (found.numbers.empty()) return;
    for (int i = 0; i < numbered.n_stated(); ++i)
        solution.numbers.rounding.push_back(found.numbers[i] * numbered.scale(i));
}

/// Of the elements of the paper by nodal ones about their motion: it is the conditions that are asked, and a
/// finer element tells a conjugate time from one nearby.
void refuse_undetermined(const NumberedProblem& numbered, const Method& method, ConditionNumbersOfLast& last,
                         Solution& solution)
{
    const Motion& motion = solution.motion;
    SolveReport& report = solution.report;
    const ElementRule& rule = lobatto_rule(std::clamp(2 * std::get<Mixed>(method).degree, 4, 8));
    if (numbered.size() > 0) {
        FoundNumbers found = solution.numbers;
        std::vector<double> values = found.values;
        values.insert(values.end(), found.unfolded.begin(), found.unfolded.end());
        UnknownsWindow nodal(numbered, values, nodal_windows(rule, true), found);
        const auto guess = [&](double t) { return motion.at(carried_to(numbered.mesh(), t, motion.mesh)); };
        SolveReport ignored;
        if (!nodal.open(0, motion.n_elements(), ignored) || !nodal.start_from(guess)) return;
        if (!nodal.equations().residual()) return;
        nodal.close({}, ignored);
        return take_rounding(numbered, refuse_undetermined(nodal, last, report), solution);
    }
    const Ends& ends = numbered.ends();
    const ModelTables tables(numbered.model(), ends.independent);
    NodalWindow nodal(tables, motion.mesh, ends, rule);
    const bool is_formed = nodal.open(0, motion.n_elements(), report) &&
                           nodal.start_from([&](double t) { return motion.at(t); }) &&
                           nodal.equations().residual() && nodal.equations().factorise();
    if (is_formed) report.moved_by_rounding = refuse_undetermined(nodal, last, report).moved;
}

/// The equations of a march as those of one window, at its motion: of all elements, or of radau the last one.
void measure_at_solution(const ModelTables& tables, const Motion& motion, const Ends& ends,
                         const ElementRule& rule, SolveReport& report, const std::function<bool()>& goes_on)
{
    TimeMesh mesh = motion.mesh;
    Ends from = ends;
    if (rule.points == Points::radau) {
        const int n = mesh.n_elements(), e = ends.is_backwards() ? 0 : n - 1;
        (ends.is_backwards() ? from.end : from.start) = motion.at_end(ends.is_backwards() ? 1 : n - 1);
        mesh.ends = {mesh.ends[e], mesh.ends[e + 1]};
    }
    NodalWindow whole(tables, mesh, from, rule);
    if (whole.open(0, mesh.n_elements(), report) &&
        whole.start_from([&](double t) { return motion.at(t); }) && whole.equations().residual())
        whole.equations().measure_condition(report, goes_on);
}

/// What is left once the motion is solved: it is taken, with condition numbers if they are asked for.
void finish(const ModelTables& tables, Window& window, const Ends& ends, const Method& method,
            bool with_condition, ConditionNumbersOfLast& last, Solution& solution)
{
    SolveReport& report = solution.report;
    // A march forms no matrix of single elements, and where it divided some, not of all.
    const bool is_whole = std::holds_alternative<Mixed>(method) || !ends.has_state();
    if (with_condition && report.converged() && is_whole)
        last.measure(report,
                     [&](const auto& goes_on) { window.equations().measure_condition(report, goes_on); });
    solution.unseen = window.monitor().take_unseen();
    solution.motion = window.take_motion();
    if (with_condition && report.converged() && !is_whole)
        last.measure(report, [&](const auto& goes_on) {
            measure_at_solution(tables, solution.motion, ends, rule_of(method), report, goes_on);
        });
    if (!last.is_stopped()) return;
    report.status = SolveStatus::cancelled;
    report.failed_at = solution.motion.end();
    report.message = "stopped as asked while condition numbers were computed; the motion is complete";
}

/// The window of a problem with unknown numbers, as they are tried.
UnknownsWindow::Maker maker_of(const Method& method, bool look_at_laws, const PhasePlan* plan)
{
    if (const auto* mixed = std::get_if<Mixed>(&method)) return mixed_windows(*mixed);
    const ElementRule& rule = rule_of(method);
    if (plan == nullptr) return nodal_windows(rule, look_at_laws);
    return [=](const NumberedProblem::Instance& of) {
        return std::make_shared<PhasesWindow>(of.rebuilt.model, of.mesh, of.ends, *plan, rule, look_at_laws);
    };
}

/// What joints did on the way, or why one that begins would be an impact.
void look_at_events(const Model& model, const SolveOptions& options, Solution& solution)
{
    const Motion& motion = solution.motion;
    if (!model.has_events() || std::isinf(options.meeting)) return;
    const std::vector<double> instants = phase_ends(model, motion.mesh);
    for (std::size_t k = 1; k + 1 < instants.size(); ++k)
        if (!is_met(model, motion, element_end_at(motion.mesh, instants[k]), motion.end() - motion.start(),
                    options.meeting, solution.report))
            return;
    tell_releases(model, motion, instants, solution.report);
}

/// The mesh with jumps of loads among the ends that stay where they are, whatever is divided or shifted.
TimeMesh with_breaks(const Model& model, const TimeMesh& given)
{
    TimeMesh mesh = given;
    const std::vector<double> breaks = model.load_breaks();
    mesh.required.insert(mesh.required.end(), breaks.begin(), breaks.end());
    std::ranges::sort(mesh.required);
    return mesh;
}

/// Null, and the report says why: no motion gets through all phases.
const PhasePlan* plan_of(const PlannedPhases& phases, double start, SolveReport& report)
{
    if (!phases.plan().phases.empty()) return &phases.plan();
    report.status = SolveStatus::not_converged;
    report.failed_at = start;
    report.message = phases.why();
    return nullptr;
}

Solution solve_by_windows(const Model& model, const Problem& problem, const TimeMesh& given, const Ends& ends,
                          const Method& method, const SolveOptions& options)
{
    TimeMesh mesh = with_breaks(model, given);
    const bool is_mixed = std::holds_alternative<Mixed>(method);
    const NumberedProblem numbered(model, ends, mesh, problem.unknowns);
    Solution solution;
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    std::optional<PlannedPhases> phases;
    std::optional<Model> at_start;   // with the joints that act there
    if (is_over_phases(model, problem)) phases.emplace(problem, numbered, rule_of(method).degree);
    const PhasePlan* const plan = phases ? plan_of(*phases, mesh.start(), report) : nullptr;
    if (!report.converged()) return solution;
    const Model& first =
        phases ? at_start.emplace(acting_at_end(model, mesh.start(), mesh.end(), false)) : model;
    const ModelTables tables(first, ends.independent, is_mixed, problem.prepared->pattern(first));
    const auto make = [&]() -> std::unique_ptr<Window> {
        const bool looks = options.look_at_laws;
        if (numbered.size() > 0)
            return std::make_unique<UnknownsWindow>(numbered, numbered.guesses(),
                                                    maker_of(method, looks, plan), solution.numbers);
        if (plan != nullptr)
            return std::make_unique<PhasesWindow>(std::make_shared<const Model>(model), mesh, ends, *plan,
                                                  rule_of(method), looks);
        return make_window(tables, mesh, ends, method, looks, problem.near);
    };
    std::unique_ptr<Window> window = make();
    WindowOptions w = options_of_mesh(first, ends, method, options);
    Proposals proposals(problem, numbered, method, *window, phases ? &*phases : nullptr);
    w.propose = std::ref(proposals);
    w.fired = problem.fired;
    solve_windows(*window, mesh, w, report);
    const auto next = [&](SolveReport& other) {
        other.notes = ends.notes;
        std::unique_ptr<Window> one = make();
        solve_windows(*one, mesh, w, other);
        return one;
    };
    if (!ends.has_state()) {
        window = find_met(model, ends, solution.numbers, std::move(window), next, report);
        if (report.converged() && !proposals.told().empty()) report.notes.push_back(proposals.told());
    }
    ConditionNumbersOfLast last(options, mesh, w.direction > 0 ? mesh.end() : mesh.start());
    const bool is_asked = !ends.has_state() && problem.is_determination_asked;
    if (is_asked && !is_mixed && report.converged())
        take_rounding(numbered, refuse_undetermined(*window, last, report), solution);
    if (!report.converged() && report.status != SolveStatus::cancelled)
        solution.cannot_begin = why_unseen(numbered);
    finish(tables, *window, ends, method, options.condition, last, solution);
    if (is_asked && is_mixed && report.converged()) refuse_undetermined(numbered, method, last, solution);
    if (report.converged()) report_no_period(model, ends, solution.numbers, solution.motion, report);
    if (phases && !report.converged() && report.status != SolveStatus::cancelled)
        if (const std::string beginning = begin_in_words(model, mesh.start(), mesh.end()); !beginning.empty())
            report.message += "; " + beginning + ", where bodies must be, and move, as it holds them";
    if (phases && report.converged())
        look_at_events(numbered.size() > 0 ? *solution.numbers.rebuilt.model : model, options, solution);
    return solution;
}

Solution solve_by_steps(const Model& model, const Problem& problem, const TimeMesh& mesh,
                        const Method& method, const SolveOptions& options)
{
    const ConsistentStart start = problem.prepared->close(model, problem.conditions.start, options.initial);
    const auto rule =
        std::holds_alternative<Midpoint>(method) ? SteppingRule::midpoint : SteppingRule::endpoint;
    SteppingResult result = march_stepping(model, start, mesh, rule,
                                           {options.tolerance, options.max_iterations, options.progress});
    return {{}, {}, std::move(result.motion), method, std::move(result.report)};
}

}   // namespace

WindowOptions window_options(const Model& model, const SolveOptions& options)
{
    WindowOptions w;
    w.solve = options;
    w.length_of_model = model.length();
    w.ends_at_bends = options.end_at_bends && model.has_pieces();
    w.locking = [&model](const State& first, const State& last) { return of_locking(model, first, last); };
    return w;
}

Solution solve_mesh(const Model& model, const Problem& problem, const TimeMesh& mesh, const Ends& ends,
                    const Method& method, const SolveOptions& options)
{
    return is_elements(method) ? solve_by_windows(model, problem, mesh, ends, method, options)
                               : solve_by_steps(model, problem, mesh, method, options);
}

}   // namespace livens::inline spacetime_internal
