// SPDX-License-Identifier: BSD-3-Clause
// How far conditions are from changing in states, by what rates, and what a jump makes of that:
// docs/theory.md, "Events", Jumps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/diagnostics/rounding.h"
#include "livens/spacetime/phases/event_watch.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of an element: between which rates are differences; and of these what rounding may be.
constexpr double rate_ways[] = {1e-4, 1e-2}, rounded = 1e-13;
/// Of what a jump changes, and of spacings: what lies on the border behind it is not beyond.
constexpr double on_border = 1e-10, many_digits = 64;

}   // namespace

EventWatch::Border EventWatch::border_of(const Motion& motion, std::span<const int> events) const
{
    const auto first = [&](const State& state) {
        double largest = -std::numeric_limits<double>::infinity();
        for (const int e : events) largest = std::max(largest, margin(e, state));
        return largest;
    };
    const int n = motion.n_elements();
    const State end = motion.at_end(n);
    const double here = first(end);
    double change = 0, way = 0;
    for (const double share : rate_ways) {   // the nearer one, unless it is but rounding
        const State later = beside(motion, n, share, false);
        way = later.t - end.t;
        change = first(later) - here;
        if (std::abs(change) > rounded) break;
    }
    return {here, change / way};
}

bool EventWatch::have_jumped(const Motion& motion, std::span<const int> events) const
{
    const State end = motion.at_end(motion.n_elements());
    const auto has_one = [&](Side side) {
        return std::ranges::any_of(events, [&](int e) { return margin(e, end, side) > 0; });
    };
    return !has_one(Side::left) && has_one(Side::right);
}

bool EventWatch::was_beyond(const Motion& motion, std::span<const int> events) const
{
    const State before = motion.at_end(motion.n_elements() - 1);
    return std::ranges::any_of(events, [&](int e) { return slack(e) > 0 && margin(e, before) > 0; });
}

/// What a spacing of the numbers of a state makes of a margin.
double EventWatch::rounding_in(const State& state, int event) const
{
    const double length = whole_.length();
    return std::numeric_limits<double>::epsilon() *
           changes_by_rounding({margin(event, state)}, [&](const auto& shift) {
               State there = state;
               for (std::size_t b = 0; b < there.X.size(); ++b)
                   for (int i = 0; i < 3; ++i)
                       for (int k = 0; k < 4; ++k) {
                           const double place = norm(state.X[b].column(0));
                           there.X[b](i, k) += shift(k == 0 ? std::max(length, place) : 1);
                           there.V[b](i, k) += shift(norm(state.V[b].column(k)));
                       }
               return std::vector{margin(event, there)};
           })[0];
}

/// By the rate of the condition rounding is a time. Of n elements sqrt(n) times as much.
double EventWatch::rounding_at_end(const Motion& motion, int event) const
{
    // Elements are iterated, and their ends looked for, to so much of their motion.
    constexpr double found_to = 1e-13;
    constexpr double digits = std::numeric_limits<double>::epsilon();
    const int n = motion.n_elements();
    const State end = motion.at_end(n);
    const double rate = border_of(motion, std::span(&event, 1)).rate,
                 of_state = rate > 0 ? rounding_in(end, event) / rate : 0;
    return std::sqrt(static_cast<double>(n)) * (digits * std::abs(end.t) + of_state) +
           found_to * std::max(motion.mesh.length(n - 1), n > 1 ? motion.mesh.length(n - 2) : 0);
}

std::vector<double> EventWatch::margins(const State& state) const
{
    std::vector<double> all(armed_.size(), std::numeric_limits<double>::infinity());
    for (std::size_t e = 0; e < all.size(); ++e) {
        const int joint = whole_.events()[e].action.joint;
        const bool is_stop =
            joint >= 0 && whole_.joints()[joint].impact && whole_.joints()[joint].impact->open_side != 0;
        if (armed_[e] && !is_stop) all[e] = margin(static_cast<int>(e), state);
    }
    return all;
}

/// Both sides have the same number where nothing has jumped, but for rounding where reactions are solved for.
std::vector<int> EventWatch::come_by_jump(const std::vector<double>& before) const
{
    std::vector<int> found;
    const std::vector<double> now = margins(start_);
    for (std::size_t e = 0; e < now.size() && !before.empty(); ++e) {
        const double least = on_border * std::abs(now[e] - before[e]);
        if (!(before[e] <= least && now[e] > least)) continue;   // also no number
        if (now[e] > many_digits * rounding_in(start_, static_cast<int>(e)))
            found.push_back(static_cast<int>(e));
    }
    return found;
}

void EventWatch::keep(const std::vector<int>& events, const std::vector<double>& before)
{
    for (const int e : events) {
        const double change = margin(e, start_) - before[static_cast<std::size_t>(e)];
        if (change >= 0 || -change <= many_digits * rounding_in(start_, e)) held_.at_start.push_back(e);
    }
}

}   // namespace livens::inline spacetime_internal
