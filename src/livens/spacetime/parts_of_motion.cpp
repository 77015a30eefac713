// SPDX-License-Identifier: BSD-3-Clause
// What is told of a whole motion by ranks that have its parts (theory.md, "The elements of the paper":
// Ranks).
#include "livens/spacetime/parts_of_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "livens/diagnostics/largest.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double far_from_guess = 0.05;   // as a march compares itself with its guess

/// Balances go on from the parts before, and their figures are those of all parts.
/// Work and impulses (7 numbers) are summed over the parts before, drifts made anew against the start of time
/// (8 numbers of the first rank). Figures are the largest of all ranks, but for the references of impulse and
/// moment, which are sums.
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

}   // namespace

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

State state_of_all(const Motion& part, bool at_end, Ranks& ranks)
{
    State state = part.at_end(at_end ? part.n_elements() : 0);
    state.t = at_end ? part.end() : part.start();
    std::vector<double> numbers = numbers_of(state);
    ranks.broadcast(at_end ? ranks.size() - 1 : 0, numbers);
    return state_of(numbers);
}

void compare_parts(const Model& model, const Motion& part, const Guess& guess, Ranks& ranks,
                   SolveReport& report)
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

Motion ends_of_parts(const Motion& part, Ranks& ranks)
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

}   // namespace livens::inline spacetime_internal
