// SPDX-License-Identifier: BSD-3-Clause
// The paper's elements, all of time at once, divided among processes: a march that goes from rank to rank
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
#include "livens/spacetime/ensemble.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/rank_block.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/other_motions.h"
#include "livens/spacetime/parts_of_motion.h"
#include "livens/spacetime/proposals.h"
#include "livens/spacetime/solve_mesh.h"
#include "livens/spacetime/unseen_number.h"

namespace livens {

namespace {

[[noreturn]] void refuse(const char* code, const char* path, const std::string& what,
                         const std::string& given, const std::string& help)
{
    throw InputError({code, path, what, given, "", "docs/howto/cluster.md", help});
}

/// A march that begins where the one of the rank before has ended. Attempts have elements a quarter as long
/// as those before.
class RelayedMarch {
public:
    RelayedMarch(const Model& model, const TimeMesh& mesh, const Ends& ends, const Mixed& method,
                 Ranks& ranks)
        : model_(model), mesh_(mesh), ends_(ends), method_(method), ranks_(ranks)
    {}

    WindowOptions::Proposal operator()(int, int, int attempt)
    {
        const State& known = ends_.is_backwards() ? ends_.end : ends_.start;
        const bool is_steady = method_.first_guess == Mixed::FirstGuess::steady;
        if (attempt > (is_steady ? 0 : 2)) return {};
        if (is_steady) return {guess_steady(known), false};
        const std::vector<int> parts = parts_of_ranks(model_, mesh_, ranks_.size());
        const auto rank = static_cast<std::size_t>(ranks_.rank());
        std::vector<double> times;
        const int pieces = 1 << (2 * attempt);
        for (int e = parts[rank]; e < parts[rank + 1]; ++e)
            for (int i = 0; i < pieces; ++i) times.push_back(mesh_.ends[e] + mesh_.length(e) * i / pieces);
        times.push_back(mesh_.ends[parts[rank + 1]]);
        if (ends_.is_backwards()) std::ranges::reverse(times);
        std::vector<double> numbers = numbers_of(known);
        const int before = ranks_.rank() - (ends_.is_backwards() ? -1 : 1),
                  behind = ranks_.rank() + (ends_.is_backwards() ? -1 : 1);
        if (before >= 0 && before < ranks_.size()) ranks_.receive(before, numbers);
        guess_ = guess_from_state(model_, state_of(numbers), times, method_.witness().degree).motion;
        State reached = guess_(times.back());
        reached.t = times.back();
        if (behind >= 0 && behind < ranks_.size()) ranks_.send(behind, numbers_of(reached));
        return {guess_, false};
    }
    const Guess& guess() const { return guess_; }

private:
    const Model& model_;
    const TimeMesh& mesh_;
    const Ends& ends_;
    const Mixed& method_;
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

WindowOptions options_on_ranks(const Model& model, const Ends& ends, const SolveOptions& options,
                               Ranks& ranks)
{
    WindowOptions w = window_options(model, options);
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

/// The window of this rank: with numbers that are to be found, or without.
class OwnWindow {
public:
    OwnWindow(const NumberedProblem& numbered, const ModelTables& tables, const Mixed& method, Ranks& ranks,
              FoundNumbers& found)
    {
        if (numbered.size() > 0)
            numbered_.emplace(numbered, numbered.guesses(), mixed_windows(method, &ranks), found);
        else
            plain_.emplace(tables, numbered.mesh(), numbered.ends(), method, &ranks);
    }
    Window& window() { return numbered_ ? static_cast<Window&>(*numbered_) : *plain_; }
    const MixedWindow& at_hand() const
    {
        return numbered_ ? static_cast<const MixedWindow&>(numbered_->now()) : *plain_;
    }
    /// As they are with what was found.
    Ends ends(const Ends& stated) const { return numbered_ ? numbered_->instance().ends : stated; }
    TimeMesh mesh(const TimeMesh& stated) const { return numbered_ ? numbered_->instance().mesh : stated; }

private:
    std::optional<UnknownsWindow> numbered_;
    std::optional<MixedWindow> plain_;
};

void take_work(const MixedWindow& window, const Traffic& before, Ranks& ranks, SolveReport& report,
               RankWork& work)
{
    const mixed::RankBlock* block = window.of_rank();
    if (block == nullptr) return;
    work = {window.elements().first,
            window.elements().second,
            block->equations().n_formed(),
            block->factors().n_left(),
            block->factors().n_in_chain(),
            block->factors().n_chain(),
            block->factors().flops(),
            {ranks.traffic().messages - before.messages, ranks.traffic().bytes - before.bytes}};
    std::array<double, 2> sums{static_cast<double>(block->n_own()),
                               static_cast<double>(block->factors().entries())};
    ranks.sum(sums);
    report.unknowns = static_cast<int>(sums[0]);
    report.factor_entries = static_cast<long long>(sums[1]);
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
    const auto& elements = std::get<Mixed>(method);
    const Ends ends = close_ends(model, problem, mesh.start(), mesh.end(), options.initial);
    const Traffic before = ranks.traffic();
    Solution solution;
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    const ModelTables tables(model, ends.independent, true, problem.prepared->pattern(model));
    const NumberedProblem numbered(model, ends, mesh, problem.unknowns);
    OwnWindow own(numbered, tables, elements, ranks, solution.numbers);
    WindowOptions w = options_on_ranks(model, ends, options, ranks);
    RelayedMarch relayed(model, mesh, ends, elements, ranks);
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
    take_work(own.at_hand(), before, ranks, report, work);
    work.mesh = mesh;
    solution.motion = own.window().take_motion();
    Motion& motion = solution.motion;
    const Model& found = found_model(model, solution);
    lower_orders(found, motion.mesh, motion);
    compare_parts(found, motion, relayed.guess(), ranks, report);
    if (ends.has_state()) return solution;
    solution.verdict.reasons = unmet_by_parts(found, own.ends(ends), own.at_hand().values_of_conditions(),
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

void check_ranks(const Model& model, const Problem& problem, const Time& time, const Method& method,
                 const SolveOptions& options, int n_ranks)
{
    check_method(model, problem, time, method, options);
    const auto* elements = std::get_if<Mixed>(&method);
    const auto* mesh = std::get_if<TimeMesh>(&time);
    const std::string all = "solve it without '--distributed'";
    if (elements == nullptr || mesh == nullptr)
        refuse("ranks-method", "method.family",
               "only the elements of the family mixed are divided among ranks", name_of(method),
               "the family mixed with a number of elements, or " + all);
    if (elements->window != 0 && elements->window < mesh->n_elements())
        refuse("ranks-method", "method.window", "blocks that follow each other are not divided among ranks",
               std::to_string(elements->window), "all elements at once, or " + all);
    if (elements->basis != Mixed::Basis::lagrange)
        refuse("ranks-method", "method.basis", "functions of several elements are not divided among ranks",
               std::string(mixed::basis_of(*elements).word), "Lagrange's basis, or " + all);
    if (elements->linear_solver != SparseBackend::eigen || options.condition)
        refuse("ranks-method", options.condition ? "method.condition" : "method.linear_solver",
               "ranks have no matrix of the whole", "", "leave it out, or " + all);
    if (options.roots > 1)
        refuse("ranks-conditions", "method.roots", "several motions are not looked for by ranks",
               std::to_string(options.roots), "leave roots out, or " + all);
    if (model.has_events() || model.has_rotors())
        refuse("ranks-conditions", "event",
               "events and inertias along coordinates are not divided among ranks", "", all);
    const std::vector<int> parts = parts_of_ranks(model, *mesh, n_ranks);
    for (std::size_t i = 1; i < parts.size(); ++i)
        if (parts[i] <= parts[i - 1])
            refuse("ranks-elements", "time.elements", "every rank needs an element of its own",
                   std::to_string(mesh->n_elements()) + " elements for " + std::to_string(n_ranks) + " ranks",
                   "start fewer ranks");
}

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
