// SPDX-License-Identifier: BSD-3-Clause
// The paper's elements, all of time at once, divided among processes: a march that goes from rank to rank
// makes the guess, the driver of windows solves in all ranks at once, and figures are joined (theory.md, "The
// elements of the paper": Ranks).
#include "livens/spacetime/on_ranks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/ensemble.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/rank_block.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/proposals.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens {

namespace {

constexpr double far_from_guess = 0.05;   // as a march compares itself with its guess

[[noreturn]] void refuse(const char* code, const char* path, const std::string& what,
                         const std::string& given, const std::string& help)
{
    throw InputError({code, path, what, given, "", "docs/howto/cluster.md", help});
}

std::vector<double> numbers_of(const State& state)
{
    std::vector<double> numbers{state.t};
    for (const auto* all : {&state.X, &state.V})
        for (const Matrix34& one : *all) numbers.insert(numbers.end(), one.a, one.a + 12);
    return numbers;
}

State state_of(const std::vector<double>& numbers)
{
    State state;
    state.t = numbers[0];
    const std::size_t n = (numbers.size() - 1) / 24;
    for (std::size_t b = 0; b < 2 * n; ++b) {
        Matrix34 one{};
        std::copy_n(numbers.data() + 1 + 12 * b, 12, one.a);
        (b < n ? state.X : state.V).push_back(one);
    }
    return state;
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

/// How far the motion is from the march that it was guessed by.
void compare(const Model& model, const Motion& part, const Guess& guess, Ranks& ranks, SolveReport& report)
{
    double distance = 0, first = std::numeric_limits<double>::infinity(), at = first;
    for (int end = 0; guess && end <= part.n_elements(); ++end) {
        const double t = part.mesh.ends[end];
        const double here = distance_between(part.at_end(end).X, guess(t).X, model.length());
        if (here > far_from_guess) first = std::min(first, t);
        if (here > distance) at = t;
        raise_to(distance, here);
    }
    report.guess_distance = ranks.largest(distance);
    const bool is_doubtful = report.guess_distance > far_from_guess;
    const double earliest = is_doubtful ? first : report.guess_distance == distance ? at : first;
    const double found = -ranks.largest(-earliest);
    report.guess_distance_time = std::isfinite(found) ? found : 0;
}

/// The two ends of time as a motion, of which conditions are asked.
Motion ends_of(const Motion& part, Ranks& ranks)
{
    Motion both;
    both.n_bodies = part.n_bodies;
    both.n_rows = part.n_rows;
    both.X = {12 * part.n_bodies, 1, true, {}, {}};
    for (const bool at_end : {false, true}) {
        const int end = at_end ? part.n_elements() : 0;
        const auto n = static_cast<std::size_t>(part.n_bodies);
        std::vector<double> numbers = numbers_of(part.at_end(end));
        for (std::size_t b = 0; b < n; ++b) {
            const Matrix34& P = part.momenta[static_cast<std::size_t>(end) * n + b];
            numbers.insert(numbers.end(), P.a, P.a + 12);
        }
        numbers[0] = part.mesh.ends[end];
        ranks.broadcast(at_end ? ranks.size() - 1 : 0, numbers);
        both.mesh.ends.push_back(numbers[0]);
        both.X.values.insert(both.X.values.end(), numbers.begin() + 1,
                             numbers.begin() + 1 + static_cast<std::ptrdiff_t>(12 * n));
        for (std::size_t b = n; b < 3 * n; ++b) {
            Matrix34 one{};
            std::copy_n(numbers.data() + 1 + 12 * b, 12, one.a);
            (b < 2 * n ? both.velocities : both.momenta).push_back(one);
        }
    }
    return both;
}

/// Balances go on from the parts before, and their figures are those of all parts.
void join_balances(Balance& part, BalanceFigures& figures, Ranks& ranks)
{
    const std::size_t last = part.t.size() - 1;
    std::array<double, 8> at_start{part.potential[0], part.energy[0]};
    std::array<double, 7> supplied{part.work[last]};
    for (int i = 0; i < 3; ++i) {
        at_start[2 + i] = part.linear_momentum[0][i];
        at_start[5 + i] = part.angular_momentum[0][i];
        supplied[1 + i] = part.linear_impulse[last][i];
        supplied[4 + i] = part.angular_impulse[last][i];
    }
    ranks.broadcast(0, at_start);
    const std::vector<double> before = ranks.sum_before(supplied);
    BalanceFigures& f = figures;
    std::array<double, 2> sums{f.reference_impulse, f.reference_moment};
    f.largest_change = f.largest_impulse = f.largest_energy_drift = f.largest_linear_momentum_drift =
        f.largest_angular_momentum_drift = 0;
    for (std::size_t e = 0; e <= last; ++e) {
        part.work[e] += before[0];
        Vector3 linear = part.linear_momentum[e], angular = part.angular_momentum[e];
        for (int i = 0; i < 3; ++i) {
            part.linear_impulse[e][i] += before[1 + i];
            part.angular_impulse[e][i] += before[4 + i];
            linear[i] -= at_start[2 + i] + part.linear_impulse[e][i];
            angular[i] -= at_start[5 + i] + part.angular_impulse[e][i];
        }
        part.energy_drift[e] = std::abs(part.energy[e] - at_start[1] - part.work[e]);
        part.linear_momentum_drift[e] = norm(linear);
        part.angular_momentum_drift[e] = norm(angular);
        raise_to(f.largest_change, std::abs(part.potential[e] - at_start[0]));
        raise_to(f.largest_impulse, norm(part.linear_impulse[e]));
        raise_to(f.largest_energy_drift, part.energy_drift[e]);
        raise_to(f.largest_linear_momentum_drift, part.linear_momentum_drift[e]);
        raise_to(f.largest_angular_momentum_drift, part.angular_momentum_drift[e]);
    }
    std::array<double*, 9> all{&f.largest_kinetic,
                               &f.largest_momentum,
                               &f.largest_moment,
                               &f.reference_energy,
                               &f.largest_change,
                               &f.largest_impulse,
                               &f.largest_energy_drift,
                               &f.largest_linear_momentum_drift,
                               &f.largest_angular_momentum_drift};
    std::array<double, 9> values{};
    for (std::size_t i = 0; i < all.size(); ++i) values[i] = *all[i];
    ranks.largest(values);
    ranks.sum(sums);
    for (std::size_t i = 0; i < all.size(); ++i) *all[i] = values[i];
    f.reference_impulse = sums[0];
    f.reference_moment = sums[1];
    double left = part.energy[last] - part.work[last];
    ranks.broadcast(ranks.size() - 1, {&left, 1});
    f.energy_loss = at_start[1] - left;
}

/// Measured by every rank of its part, and joined. Zigzags are those of parts by themselves.
void judge_parts(const Model& model, const Motion& part, const SolveReport& report, Ranks& ranks, Verdict& v)
{
    v = measure_part(model, part);
    auto series = std::make_shared<MotionSeries>(*v.series);
    join_balances(series->balance, v.balance, ranks);
    v.series = series;
    const double zigzag = std::max(v.zigzag_positions, v.zigzag_momenta);
    std::array<double*, 5> all{&v.max_constraint_violation, &v.max_velocity_violation, &v.max_weak_violation,
                               &v.zigzag_positions, &v.zigzag_momenta};
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < all.size(); ++i) values[i] = *all[i];
    ranks.largest(values);
    for (std::size_t i = 0; i < all.size(); ++i) *all[i] = values[i];
    const bool is_worst = zigzag == std::max(v.zigzag_positions, v.zigzag_momenta);
    v.zigzag_time = ranks.largest(is_worst ? v.zigzag_time : -std::numeric_limits<double>::max());
    v.energy_drift = v.balance.relative_energy_drift();
    v.linear_momentum_drift = v.balance.relative_linear_momentum_drift();
    v.angular_momentum_drift = v.balance.relative_angular_momentum_drift();
    weigh_weak(v, report);
}

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

void take_work(const MixedWindow& window, const TimeMesh& mesh, const Traffic& before, Ranks& ranks,
               Solution& solution, RankWork& work)
{
    const mixed::RankBlock* block = window.of_rank();
    if (block == nullptr) return;
    const auto rank = static_cast<std::size_t>(ranks.rank());
    const Model& model = *block->equations().space().coordinates.tables.model;
    const std::vector<int> parts = parts_of_ranks(model, mesh, ranks.size());
    work = {parts[rank],
            parts[rank + 1],
            block->equations().n_formed(),
            block->factors().n_left(),
            block->n_chain(),
            block->factors().flops(),
            {ranks.traffic().messages - before.messages, ranks.traffic().bytes - before.bytes}};
    std::array<double, 2> sums{static_cast<double>(block->n_own()),
                               static_cast<double>(block->factors().entries())};
    ranks.sum(sums);
    solution.report.unknowns = static_cast<int>(sums[0]);
    solution.report.factor_entries = static_cast<long long>(sums[1]);
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
    if (problem.conditions.has_components() || !problem.unknowns.is_empty() || options.roots > 1)
        refuse("ranks-conditions", "start",
               "conditions by component, periodic motions and unknown numbers are not divided among ranks",
               "", "a state at one end, or positions or momenta at both; or " + all);
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
    const auto& elements = std::get<Mixed>(method);
    const Ends ends = close_ends(model, problem, mesh.start(), mesh.end(), options.initial);
    const Traffic before = ranks.traffic();
    Solution solution;
    solution.method = method;
    SolveReport& report = solution.report;
    report.notes = ends.notes;
    const ModelTables tables(model, ends.independent, true, problem.prepared->pattern(model));
    MixedWindow window(tables, mesh, ends, elements, &ranks);
    WindowOptions w = options_on_ranks(model, ends, options, ranks);
    RelayedMarch relayed(model, mesh, ends, elements, ranks);
    const NumberedProblem numbered(model, ends, mesh, problem.unknowns);
    Proposals between(problem, numbered, method, window, nullptr);
    if (ends.has_state())
        w.propose = std::ref(relayed);
    else
        w.propose = std::ref(between);
    solve_windows(window, mesh, w, report);
    take_work(window, mesh, before, ranks, solution, work);
    if (!report.converged()) return solution;
    solution.motion = window.take_motion();
    lower_orders(model, mesh, solution.motion);
    compare(model, solution.motion, relayed.guess(), ranks, report);
    report.notes.push_back("solved by " + std::to_string(ranks.size()) +
                           " processes; no second solution tells its error");
    judge_parts(model, solution.motion, report, ranks, solution.verdict);
    if (!ends.has_state()) {
        const std::vector<std::string> off = unmet(model, ends, ends_of(solution.motion, ranks), {});
        solution.verdict.reasons.insert(solution.verdict.reasons.begin(), off.begin(), off.end());
        report.notes.push_back("whether the conditions at both ends determine the motion was not asked");
    }
    if (solution.verdict.reasons.empty()) return solution;
    report.status = SolveStatus::suspect;
    report.message = solution.verdict.reasons.front();
    return solution;
}

}   // namespace livens
