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
#include "livens/spacetime/guess.h"
#include "livens/spacetime/guess_of_components.h"
#include "livens/spacetime/leading.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/spacetime/other_motions.h"
#include "livens/spacetime/unseen_number.h"
#include "livens/stepping/stepping.h"

namespace livens::inline spacetime_internal {

namespace {

/// Beyond, conditions at both ends do not determine the motion: the share of it that rounding may move. Where
/// they leave a motion free it is about 1.
constexpr double undetermined = 1e-4;
/// Past folds: each may cost some hundred factorisations.
constexpr int most_curves = 3;

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
    Proposals(const Problem& problem, const NumberedProblem& numbered, const Method& method,
              const Window& window)
        : model_(numbered.model()), problem_(problem), numbered_(numbered), mesh_(numbered.mesh()),
          ends_(numbered.ends()), method_(method), window_(window)
    {}

    WindowOptions::Proposal operator()(int first, int last, int attempt)
    {
        if (!ends_.has_state()) return {between_ends(), false};
        const State state = window_.at(ends_.is_backwards() ? last : first);
        const auto* mixed = std::get_if<Mixed>(&method_);
        if (mixed != nullptr && (attempt > 0 || mixed->first_guess == Mixed::FirstGuess::steady))
            return {attempt > 0 ? Guess{} : guess_steady(state), false};
        if (attempt > 2 || (mixed == nullptr && last - first == 1)) return {};
        // Each attempt marches with elements a quarter as long as the one before.
        const std::vector<double> times = instants(mesh_, ends_, first, last, 1 << (2 * attempt));
        MarchGuess march = guess_from_state(model_, state, times, mixed ? mixed->witness().degree : 2);
        return {std::move(march.motion), march.is_closed};
    }

    /// How the last guess was found, if it was led.
    const std::string& told() const { return told_; }

private:
    /// Plain guesses first, then ends that are led: theory.md, "Finding the motion". What was proposed before
    /// is not proposed again.
    Guess between_ends()
    {
        const int attempt = n_plain_++;
        if (attempt == 0 && problem_.guess) return problem_.guess;
        if (problem_.is_only_guess) return {};
        if (plain_.empty()) {
            plain_ = guesses_from_ends(model_, guessed_ends(), guess_mesh());
            if (problem_.guess) plain_.insert(plain_.begin(), GuessFromEnds{});   // tried before
        }
        const int n_plain = static_cast<int>(plain_.size());
        if (attempt < n_plain) return plain_[attempt].motion;
        if (!nearest_) nearest_ = nearest_marches(model_, guessed_ends(), guess_mesh());
        if (attempt < n_plain + static_cast<int>(nearest_->size())) {
            told_ = "found from the stated or steady rates times " + (*nearest_)[attempt - n_plain].rates +
                    ", with which a march arrives nearest";
            return (*nearest_)[attempt - n_plain].motion;
        }
        while (true) {
            const GuessFromEnds march = march_to_lead(model_, guessed_ends(), guess_mesh(), lead_);
            if (!march.motion) break;
            lead_ = march.next;
            const Leading led =
                lead(numbered_, degree(), march.motion, march.from_start, n_curves_ < most_curves);
            n_curves_ += led.has_followed ? 1 : 0;
            if (!led.motion) continue;
            told_ = in_words(led, march);
            return led.motion;
        }
        return {};
    }

    int degree() const
    {
        const auto* mixed = std::get_if<Mixed>(&method_);
        return mixed != nullptr ? mixed->witness().degree : rule_of(method_).degree;
    }
    GuessMesh guess_mesh() const { return {mesh_.ends, degree()}; }

    const Ends& guessed_ends()
    {
        if (!ends_.has_components()) return ends_;
        if (!guessed_) guessed_ = ends_for_guesses(model_, ends_, mesh_.ends);
        return *guessed_;
    }

    const Model& model_;
    const Problem& problem_;
    const NumberedProblem& numbered_;
    const TimeMesh& mesh_;
    const Ends& ends_;
    const Method& method_;
    const Window& window_;
    std::optional<Ends> guessed_;   // of conditions by component
    std::vector<GuessFromEnds> plain_;
    std::optional<std::vector<GuessFromEnds>> nearest_;   // made where plain ones fail
    int n_plain_ = 0, lead_ = 0, n_curves_ = 0;   // guesses, marches that were led, and curves, so far
    std::string told_;
};

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
/// many, and its digits are made of rounding. How far rounding may move it, in lengths and rad.
double refuse_undetermined(Window& window, ConditionNumbersOfLast& last, SolveReport& report)
{
    Uncertainty found;
    last.measure(report, [&](const auto&) { found = window.uncertainty(); });
    if (last.is_stopped()) return 0;
    if (last.has_no_memory()) {
        report.status = SolveStatus::suspect;
        report.message =
            "memory ended before it was found whether the conditions at the two ends determine the motion";
        return 0;
    }
    // Inequality: what rounding may move <= 1e-4 of the motion, else the conditions do not determine it
    // (theory.md, "Windows").
    if (found.size <= undetermined) return found.moved;
    report.status = SolveStatus::singular;
    report.message = "the conditions at the two ends of time do not determine the motion: rounding alone may "
                     "move it by " +
                     to_text(found.size, 3) + " of itself, most of all " + found.name +
                     "; a neighbouring motion satisfies them as well, as at conjugate and focal times; try: "
                     "another duration, or the state at one end";
    return found.moved;
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

Solution solve_by_windows(const Model& model, const Problem& problem, const TimeMesh& given, const Ends& ends,
                          const Method& method, const SolveOptions& options)
{
    TimeMesh mesh = given;
    const std::vector<double> breaks = model.load_breaks();
    mesh.required.insert(mesh.required.end(), breaks.begin(), breaks.end());
    // Ends at jumps of loads stay where they are, whatever is divided or shifted.
    std::ranges::sort(mesh.required);
    const bool is_mixed = std::holds_alternative<Mixed>(method);
    const ModelTables tables(model, ends.independent, is_mixed, problem.prepared->pattern(model));
    const NumberedProblem numbered(model, ends, mesh, problem.unknowns);
    Solution solution;
    const auto make = [&]() -> std::unique_ptr<Window> {
        if (numbered.size() > 0)
            return std::make_unique<UnknownsWindow>(numbered, numbered.guesses(), rule_of(method),
                                                    options.look_at_laws, solution.numbers);
        return make_window(tables, mesh, ends, method, options.look_at_laws, problem.near);
    };
    std::unique_ptr<Window> window = make();
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    WindowOptions w = options_of_mesh(model, ends, method, options);
    Proposals proposals(problem, numbered, method, *window);
    w.propose = std::ref(proposals);
    solve_windows(*window, mesh, w, report);
    if (!ends.has_state()) {
        window = find_met(
            model, ends, std::move(window),
            [&](SolveReport& other) {
                other.notes = ends.notes;
                std::unique_ptr<Window> one = make();
                solve_windows(*one, mesh, w, other);
                return one;
            },
            report);
        if (report.converged() && !proposals.told().empty()) report.notes.push_back(proposals.told());
    }
    ConditionNumbersOfLast last(options, mesh, w.direction > 0 ? mesh.end() : mesh.start());
    if (!ends.has_state() && !is_mixed && problem.is_determination_asked && report.converged())
        solution.report.moved_by_rounding = refuse_undetermined(*window, last, report);
    if (!report.converged() && report.status != SolveStatus::cancelled)
        solution.cannot_begin = why_unseen(numbered);
    finish(tables, *window, ends, method, options.condition, last, solution);
    if (report.converged() && is_at_rest(model, ends, solution.motion)) {
        report.status = SolveStatus::suspect;
        report.message =
            "the bodies stay at rest, which is a periodic motion of any period; try: a start that "
            "is nearer to the motion (places and velocities of bodies), or its amplitude among the "
            "conditions at the start";
    }
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
    return {std::move(result.motion), method, std::move(result.report)};
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
