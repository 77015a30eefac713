// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component": Momenta, Periodic motions.
#include "livens/spacetime/other_motions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

namespace {

/// What is kept may be the same at a place that is far, along what unfolds a periodic motion.
bool is_closed(const FoundNumbers& numbers)
{
    return std::ranges::all_of(numbers.unfolded, [](double x) { return std::abs(x) <= met_component; });
}

}   // namespace

bool is_at_rest(const Model& model, const Ends& ends, const Motion& motion)
{
    return is_at_rest(model, ends, motion.at_end(0), motion);
}

bool is_at_rest(const Model& model, const Ends& ends, const State& first, const Motion& motion)
{
    constexpr double still = 1e-6;   // lengths
    if (!ends.periodic.is_free) return false;
    for (int e = 0; e < motion.n_elements(); ++e)
        for (const double share : {0.5, 1.0}) {
            const double t = motion.mesh.ends[e] + share * motion.mesh.length(e);
            if (distance_between(first.X, motion.at(t).X, model.length()) > still) return false;
        }
    return true;
}

void report_no_period(const Model& model, const Ends& ends, const FoundNumbers& numbers, const Motion& motion,
                      SolveReport& report)
{
    report_no_period(numbers, is_at_rest(model, ends, motion), report);
}

void report_no_period(const FoundNumbers& numbers, bool is_at_rest, SolveReport& report)
{
    if (!is_closed(numbers)) {
        report.status = SolveStatus::suspect;
        report.message = "the motion ends where what it keeps is as at its start, and is elsewhere, as after "
                         "half a period; try: another guess of the period, or more elements";
    } else if (is_at_rest) {
        report.status = SolveStatus::suspect;
        report.message = "the bodies stay at rest, which is a periodic motion of any period; try: a start "
                         "that is nearer to "
                         "the motion (places and velocities of bodies), or its amplitude among the "
                         "conditions at the start";
    }
}

std::unique_ptr<Window> find_met(const Model& model, const Ends& ends, FoundNumbers& numbers,
                                 std::unique_ptr<Window> window,
                                 const std::function<std::unique_ptr<Window>(SolveReport&)>& next,
                                 SolveReport& report)
{
    constexpr int most = 8;
    const auto has_of = [&](std::size_t end, Known known) {
        return knows_momenta(known) || ends.whole[end] == Known::momenta;
    };
    const bool has_momenta = has_of(0, ends.at_start) || has_of(1, ends.at_end);
    const auto is_met = [&](Window& of) {
        const Motion* motion = of.monitor().so_far();
        return motion == nullptr ||
               (is_closed(numbers) && !(has_momenta && !unmet(model, ends, *motion, {}).empty()) &&
                !is_at_rest(model, ends, *motion));
    };
    if (!report.converged() || !(has_momenta || ends.periodic.is_free) || is_met(*window)) return window;
    const FoundNumbers of_first = numbers;   // each window leaves its own there
    for (int i = 0; i < most; ++i) {
        SolveReport other;
        std::unique_ptr<Window> found = next(other);
        if (!other.converged()) break;
        if (!is_met(*found)) continue;
        report = std::move(other);
        return found;
    }
    numbers = of_first;
    return window;
}

}   // namespace livens::inline spacetime_internal
