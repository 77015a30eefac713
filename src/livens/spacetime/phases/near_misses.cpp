// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "Events", Errors.
#include "livens/spacetime/phases/near_misses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "livens/spacetime/phases/event_watch.h"
#include "livens/spacetime/phases/events.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinite = std::numeric_limits<double>::infinity();
constexpr double sure = 3;   // times the difference of two motions
constexpr int most_shrinks = 24;

/// Events of a phase along a motion, angles counted on the way.
class Looks {
public:
    Looks(const Model& model, const Motion& motion, std::vector<double>& angles, int element)
        : motion_(motion), angles_(angles), watch_(make(model, motion, angles, element))
    {
        angles_ = watch_.start().angles;
    }

    EventWatch& watch() { return watch_; }

    State at(int element, double s, const Motion& motion) const
    {
        State state = motion.at(motion_.mesh.ends[element] + s * motion_.mesh.length(element));
        state.angles = angles_;
        return state;
    }
    double margin(int event, int element, double s) const
    {
        return watch_.margin(event, at(element, s, motion_));
    }
    /// Where states at both ends of an element say that a margin has a top between them: how high, by its
    /// rates there. Kinks of polynomials between elements may hide it. Minus infinity: they do not.
    double top_by_states(int event, int element, double at_start) const
    {
        const double h = motion_.mesh.length(element), first = rate(event, motion_.at_end(element), h),
                     last = rate(event, motion_.at_end(element + 1, Side::left), h),
                     bend = (last - first) / h;
        return first > 0 && last < 0 ? at_start - first * first / (2 * bend) : -infinite;
    }
    /// Angles as they are at the end of an element.
    void pass(int element, int n_looks)
    {
        for (int k = 1; k <= n_looks; ++k)
            watch_.follow(at(element, k / double(n_looks), motion_).X, angles_);
    }

private:
    static EventWatch make(const Model& model, const Motion& motion, const std::vector<double>& angles,
                           int element)
    {
        const double middle = motion.mesh.ends[element] + 0.5 * motion.mesh.length(element);
        State start = motion.at_end(element);
        start.angles = angles;
        const std::vector<double> ends = model.event_times();
        const auto next = std::ranges::upper_bound(ends, middle);
        return EventWatch(model, acting_at(model, middle), std::vector<bool>(model.events().size(), true),
                          start, next != ends.end() ? *next : motion.end());
    }

    double rate(int event, State state, double h) const
    {
        constexpr double share = 1e-4;
        const double way = share * h;
        state.angles = angles_;
        const double before = watch_.margin(event, state);
        state.t += way;
        for (std::size_t b = 0; b < state.X.size(); ++b) state.X[b] += way * state.V[b];
        return (watch_.margin(event, state) - before) / way;
    }

    const Motion& motion_;
    std::vector<double>& angles_;
    EventWatch watch_;
};

/// The highest place of a function between neighbours that are lower.
double highest(const std::function<double(double)>& f, double low, double high)
{
    constexpr double golden = 0.381966011250105;
    double a = low + golden * (high - low), b = high - golden * (high - low), at_a = f(a), at_b = f(b);
    for (int i = 0; i < most_shrinks; ++i) {
        if (at_a > at_b) {
            high = b, b = a, at_b = at_a;
            a = low + golden * (high - low), at_a = f(a);
        } else {
            low = a, a = b, at_a = at_b;
            b = high - golden * (high - low), at_b = f(b);
        }
    }
    return at_a > at_b ? a : b;
}

bool is_armed(const Model& model, const EventAction& action, double t)
{
    const auto acts = [&] {
        return action.joint >= 0 ? model.joints()[action.joint].acts_at(t)
                                 : model.loads()[action.load].acts_at(t);
    };
    if (action.does == EventAction::Does::begin) return !acts();
    return action.does != EventAction::Does::end || acts();
}

}   // namespace

/// Angles are counted along, so elements are taken in order. A top of the looks counts where it is nearer to
/// zero than the condition moves in the element; between looks it is found by golden section.
double undecided_place(const Model& model, const Motion& motion, const Motion& other)
{
    const std::vector<double> ends = model.event_times();
    const int n_looks = 4 * (motion.X.degree + 1), n_events = static_cast<int>(model.events().size());
    std::vector<double> angles;
    std::unique_ptr<Looks> looks;
    for (int e = 0; e < motion.n_elements(); ++e) {
        const double from = motion.mesh.ends[e];
        if (looks == nullptr || std::ranges::binary_search(ends, from))
            looks = std::make_unique<Looks>(model, motion, angles, e);
        for (int event = 0; event < n_events; ++event) {
            if (!is_armed(model, model.events()[static_cast<std::size_t>(event)].action,
                          from + 0.5 * motion.mesh.length(e)))
                continue;
            const auto f = [&](double s) { return looks->margin(event, e, s); };
            std::vector<double> seen;
            for (int k = 0; k <= n_looks; ++k) seen.push_back(f(k / double(n_looks)));
            const double range = *std::ranges::max_element(seen) - *std::ranges::min_element(seen);
            if (range <= looks->watch().slack(event)) continue;   // bodies move side by side
            const auto apart_at = [&](double s, double here) {
                return std::abs(looks->watch().margin(event, looks->at(e, s, other)) - here);
            };
            bool has_top = *std::ranges::max_element(seen) >= 0;
            for (int k = 1; k < n_looks; ++k) {
                const bool is_top = seen[k] < 0 && seen[k] >= seen[k - 1] && seen[k] >= seen[k + 1];
                has_top = has_top || is_top;
                if (!is_top || !(-seen[k] < range)) continue;
                const double s = highest(f, (k - 1) / double(n_looks), (k + 1) / double(n_looks));
                const double t = from + s * motion.mesh.length(e);
                if (t > other.end()) continue;
                const double lacking = -f(s);
                if (!(lacking > sure * apart_at(s, -lacking))) return t;
            }
            if (has_top || from > other.end()) continue;
            const double lacking = -looks->top_by_states(event, e, seen[0]);
            if (!(lacking > sure * apart_at(0, seen[0]))) return from;
        }
        looks->pass(e, n_looks);
    }
    return nan;
}

}   // namespace livens::inline spacetime_internal
