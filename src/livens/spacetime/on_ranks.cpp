// SPDX-License-Identifier: BSD-3-Clause
// Elements of all of time at once, divided among processes: a march that goes from rank to rank
// makes the guess, the driver of windows solves in all ranks at once, and figures are joined (theory.md, "The
// elements of the paper": Ranks).
#include "livens/spacetime/on_ranks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/accuracy/turning_springs.h"
#include "livens/spacetime/ensemble.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/nodal/ranks_window.h"
#include "livens/spacetime/other_motions.h"
#include "livens/spacetime/parts_of_motion.h"
#include "livens/spacetime/proposals.h"
#include "livens/spacetime/solve_mesh.h"
#include "livens/spacetime/unseen_number.h"

namespace livens {

namespace {

/// A march that begins where the one of the rank before has ended. Attempts have elements a quarter as long
/// as those before.
class RelayedMarch {
public:
    RelayedMarch(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends, const Method& method,
                 Ranks& ranks)
        : tables_(tables), mesh_(mesh), ends_(ends), method_(method), ranks_(ranks)
    {}

    WindowOptions::Proposal operator()(int, int, int attempt)
    {
        const State& known = ends_.is_backwards() ? ends_.end : ends_.start;
        const auto* mixed = std::get_if<Mixed>(&method_);
        const bool is_steady = mixed != nullptr && mixed->first_guess == Mixed::FirstGuess::steady;
        if (attempt > (is_steady ? 0 : 2)) return {};
        if (is_steady) return {guess_steady(known), false};
        const std::vector<double> times = instants(1 << (2 * attempt));
        State first = received(known);
        std::vector<double> angles = tables_.loads.turns.begin(first);
        guess_ =
            guess_from_state(*tables_.model, first, times, mixed != nullptr ? mixed->witness().degree : 2)
                .motion;
        State reached;
        for (const double t : times) {
            reached = guess_(t);
            tables_.loads.turns.follow(reached.X, angles);
        }
        reached.t = times.back();
        reached.angles = std::move(angles);
        hand_on(reached);
        return {guess_, false};
    }
    const Guess& guess() const { return guess_; }

private:
    /// In the direction of the march: element ends of the rank, each element divided into `pieces`.
    std::vector<double> instants(int pieces) const
    {
        const std::vector<int> parts = parts_of_ranks(*tables_.model, mesh_, ranks_.size(), method_);
        const auto rank = static_cast<std::size_t>(ranks_.rank());
        std::vector<double> times;
        for (int e = parts[rank]; e < parts[rank + 1]; ++e)
            for (int i = 0; i < pieces; ++i) times.push_back(mesh_.ends[e] + mesh_.length(e) * i / pieces);
        times.push_back(mesh_.ends[parts[rank + 1]]);
        if (ends_.is_backwards()) std::ranges::reverse(times);
        return times;
    }
    int next() const { return ranks_.rank() + (ends_.is_backwards() ? -1 : 1); }
    State received(const State& known)
    {
        const int before = 2 * ranks_.rank() - next();
        if (before < 0 || before >= ranks_.size()) return known;
        std::vector<double> numbers = numbers_of(known), angles = tables_.loads.turns.begin();
        ranks_.receive(before, numbers);
        if (!angles.empty()) ranks_.receive(before, angles);
        State state = state_of(numbers);
        state.angles = std::move(angles);
        return state;
    }
    void hand_on(const State& reached)
    {
        if (next() < 0 || next() >= ranks_.size()) return;
        ranks_.send(next(), numbers_of(reached));
        if (!reached.angles.empty()) ranks_.send(next(), reached.angles);
    }

    const ModelTables& tables_;
    const TimeMesh& mesh_;
    const Ends& ends_;
    const Method& method_;
    Ranks& ranks_;
    Guess guess_;
};

/// Loads that break inside of elements, which nobody looks at closer here.
void lower_orders(const Model& model, const TimeMesh& mesh, Motion& part)
{
    if (missed(mesh, model.load_breaks()).empty()) return;
    for (int* stated : {&part.order_at_ends, &part.dense_order_X, &part.dense_order_V})
        *stated = std::min(*stated, 1);
}

WindowOptions options_on_ranks(const Model& model, const Ends& ends, const Method& method,
                               const SolveOptions& options, Ranks& ranks)
{
    WindowOptions w = window_options(model, options);
    if (std::holds_alternative<Lobatto>(method)) {
        // As alone: motions are compared with others, and a march looks at its elements.
        w.solve.tolerance = std::min(options.tolerance, 1e-10);
        if (options.divide && ends.has_state()) w.criteria = {acceptable_velocity_jump, true, true};
    }
    w.direction = ends.is_backwards() ? -1 : 1;
    w.length = 0;
    w.may_split = w.ends_at_bends = false;
    w.has_state = ends.has_state();
    w.advice = "shorter elements, or a shorter time";
    // Asked of all ranks in the same place: what one of them is told ends all.
    w.solve.progress = [&ranks, given = options.progress](const Progress& progress) {
        return ranks.all(!given || given(progress));
    };
    return w;
}

UnknownsWindow::Maker maker_on_ranks(const Method& method, Ranks& ranks)
{
    if (const auto* mixed = std::get_if<Mixed>(&method)) return mixed_windows(*mixed, &ranks);
    return windows_of_ranks(std::get<Lobatto>(method), ranks);
}

/// The window of this rank: with numbers that are to be found, or without.
class OwnWindow {
public:
    OwnWindow(const NumberedProblem& numbered, const ModelTables& tables, const Method& method, Ranks& ranks,
              FoundNumbers& found)
    {
        const auto* mixed = std::get_if<Mixed>(&method);
        if (numbered.size() > 0)
            numbered_.emplace(numbered, numbered.guesses(), maker_on_ranks(method, ranks), found);
        else if (mixed != nullptr)
            plain_ = std::make_unique<MixedWindow>(tables, numbered.mesh(), numbered.ends(), *mixed, &ranks);
        else
            plain_ = std::make_unique<RanksWindow>(tables, numbered.mesh(), numbered.ends(),
                                                   std::get<Lobatto>(method), ranks);
    }
    Window& window() { return numbered_ ? static_cast<Window&>(*numbered_) : *plain_; }
    const PartOfRanks& part() const
    {
        return dynamic_cast<const PartOfRanks&>(numbered_ ? numbered_->now() : *plain_);
    }
    /// As they are with what was found.
    Ends ends(const Ends& stated) const { return numbered_ ? numbered_->instance().ends : stated; }
    TimeMesh mesh(const TimeMesh& stated) const { return numbered_ ? numbered_->instance().mesh : stated; }

private:
    std::optional<UnknownsWindow> numbered_;
    std::unique_ptr<BorderedWindow> plain_;
};

void take_work(const FiguresOfPart& of, const Traffic& before, Ranks& ranks, SolveReport& report,
               RankWork& work)
{
    work = {
        of.first,      of.last,
        of.n_formed,   of.n_left,
        of.n_in_chain, of.n_chain,
        of.flops,      {ranks.traffic().messages - before.messages, ranks.traffic().bytes - before.bytes}};
    std::array<double, 2> sums{static_cast<double>(of.n_unknowns), static_cast<double>(of.factor_entries)};
    ranks.sum(sums);
    report.unknowns = static_cast<int>(sums[0]);
    report.factor_entries = static_cast<long long>(sums[1]);
}

/// As a march looks at itself: why springs that turn let vibrations grow in this motion; empty: they do not.
std::string unsteady(const Model& model, const Motion& part, const Method& method, Ranks& ranks)
{
    const auto* lobatto = std::get_if<Lobatto>(&method);
    if (lobatto == nullptr || !EnergyWatch::serves(model)) return "";
    return said_by_first(EnergyWatch(model, lobatto->degree).look(part, part.end()), ranks);
}

/// Conditions that the motion does not meet. Angles that count turns are known to all ranks.
std::vector<std::string> unmet_by_parts(const Model& model, Ends ends, const std::vector<double>& values,
                                        const Motion& both)
{
    std::vector<std::string> off;
    if (ends.has_components()) {
        off = unmet_values(model, ends, values, both.end() - both.start());
        ends.components.clear();
        ends.at_start = ends.whole[0];
        ends.at_end = ends.whole[1];
    }
    const std::vector<std::string> whole = unmet(model, ends, both, {});
    off.insert(off.end(), whole.begin(), whole.end());
    return off;
}

/// The motion, whose verdict has only what it misses of its conditions; `mesh` becomes that of all of it.
Solution solve_parts(const Model& model, const Problem& problem, TimeMesh& mesh, const Method& method,
                     const SolveOptions& options, Ranks& ranks, RankWork& work)
{
    const Ends ends = close_ends(model, problem, mesh.start(), mesh.end(), options.initial);
    const Traffic before = ranks.traffic();
    Solution solution;
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    const bool is_mixed = std::holds_alternative<Mixed>(method);
    const ModelTables tables(model, ends.independent, is_mixed, problem.prepared->pattern(model));
    const NumberedProblem numbered(model, ends, mesh, problem.unknowns);
    OwnWindow own(numbered, tables, method, ranks, solution.numbers);
    WindowOptions w = options_on_ranks(model, ends, method, options, ranks);
    RelayedMarch relayed(tables, mesh, ends, method, ranks);
    Proposals between(problem, numbered, method, own.window(), nullptr);
    if (ends.has_state())
        w.propose = std::ref(relayed);
    else
        w.propose = std::ref(between);
    solve_windows(own.window(), mesh, w, report);
    if (!report.converged()) {
        if (report.status != SolveStatus::cancelled) solution.cannot_begin = why_unseen(numbered);
        return solution;
    }
    mesh = own.mesh(mesh);
    take_work(own.part().figures(), before, ranks, report, work);
    work.mesh = mesh;
    solution.motion = own.window().take_motion();
    Motion& motion = solution.motion;
    const Model& found = found_model(model, solution);
    lower_orders(found, motion.mesh, motion);
    compare_parts(found, motion, relayed.guess(), ranks, report);
    if (ends.has_state()) {
        if (std::string why = unsteady(found, motion, method, ranks); !why.empty())
            solution.verdict.reasons.push_back(std::move(why));
        return solution;
    }
    solution.verdict.reasons = unmet_by_parts(found, own.ends(ends), own.part().values_of_conditions(),
                                              ends_of_parts(motion, ranks));
    const State first = state_of_all(motion, false, ranks);
    report_no_period(solution.numbers, ranks.all(is_at_rest(found, ends, first, motion)), report);
    return solution;
}

/// See judge(): a motion that ends as it began is solved for one more period.
std::string another_period(const Model& model, const Solution& solution, TimeMesh mesh,
                           const SolveOptions& options, Ranks& ranks)
{
    constexpr double same = 1e-6;
    const Motion& motion = solution.motion;
    const State end = state_of_all(motion, true, ranks);
    const double period = mesh.end() - mesh.start();
    mesh.required = mesh.bends = {};
    for (double& t : mesh.ends) t += period;
    SolveOptions again = options;
    again.initial = StartPolicy::project;
    RankWork work;
    const Solution second =
        solve_parts(model, with_prepared({{end}}), mesh, solution.method, again, ranks, work);
    double off = 0, at = end.t;
    for (int e = 0; second.report.converged() && e <= motion.n_elements(); ++e) {
        const double here = distance_between(motion.at_end(e).X, second.motion.at_end(e).X, model.length());
        if (here > off) off = here, at = motion.mesh.ends[e] + period;
    }
    const double most = ranks.largest(off);
    at = -ranks.largest(off == most ? -at : -std::numeric_limits<double>::max());
    return second.report.converged() && most <= same ? "" : of_another_period(period, most, at);
}

}   // namespace

Solution solve_on_ranks(const Model& model, const Problem& stated, const Time& time, const Method& method,
                        const SolveOptions& options, Ranks& ranks, RankWork& work)
{
    check_ranks(model, stated, time, method, options, ranks.size());
    const Crew crew(threads_for(options.threads));
    const Problem problem = with_prepared(stated);
    TimeMesh mesh = std::get<TimeMesh>(time);
    Solution solution = solve_parts(model, problem, mesh, method, options, ranks, work);
    SolveReport& report = solution.report;
    if (solution.motion.mesh.ends.empty()) return solution;
    const Model& found = found_model(model, solution);
    report.notes.push_back("solved by " + std::to_string(ranks.size()) +
                           " processes; no second solution tells its error");
    if (!problem.conditions.has_state())
        report.notes.push_back("whether the conditions at both ends determine the motion was not asked");
    std::vector<std::string> off = std::move(solution.verdict.reasons);
    judge_parts(found, solution.motion, report, ranks, solution.verdict);
    const Conditions& given = problem.conditions;
    if (report.converged() && given.is_periodic && !given.turn && solution.numbers.unfolded.empty())
        if (std::string why = another_period(found, solution, mesh, options, ranks); !why.empty())
            off.push_back(std::move(why));
    std::vector<std::string>& reasons = solution.verdict.reasons;
    reasons.insert(reasons.begin(), off.begin(), off.end());
    if (reasons.empty() || !report.converged()) return solution;
    report.status = SolveStatus::suspect;
    report.message = reasons.front();
    return solution;
}

}   // namespace livens
