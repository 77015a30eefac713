// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "Events": Where.
#include "livens/spacetime/phases/event_end.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/spacetime/phases/events.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr int most_turns = 60;
/// Of an element: how near to the event it is to end, beside rounding of the time; and the shortest, where it
/// begins beyond it.
constexpr double near_event = 1e-13, of_clock = 4e-16, at_start = 1e-9;
/// Of an element: how far an event may lie ahead that it is said to have passed.
constexpr double ahead = 0.1;

/// The last element once more, with another end. False: it is not found, and all is as it was.
bool solve_last(const WatchedPhase& phase, double end, Solution& solved)
{
    const int last_element = solved.motion.n_elements() - 1;
    Problem problem = phase.problem;
    problem.fired = nullptr;
    problem.conditions.start = solved.motion.at_end(last_element);
    SolveOptions options = phase.options;
    options.initial = StartPolicy::project;
    options.end_at_bends = false;
    const TimeMesh mesh{{solved.motion.mesh.ends[last_element], end}};
    Solution last = phase.solve(phase.watch.model(), problem, mesh, solved.method, options);
    if (!last.report.converged() || last.motion.n_elements() == 0) return false;
    drop_last(solved.motion);
    if (solved.motion.n_elements() == 0)
        solved.motion = std::move(last.motion);
    else
        join(solved.motion, std::move(last.motion), false);
    solved.motion.mesh.bends.push_back(solved.motion.end());
    return true;
}

}   // namespace

/// Newton's steps by the margin of the state at the end and its rate behind it, each with the last element
/// solved anew up to there; a step that leaves the bracket is a bisection. What has fired may lie a little
/// ahead, as the polynomial has it before the state does.
bool end_at_event(const WatchedPhase& phase, std::vector<int>& fired, Solution& solved)
{
    Motion& motion = solved.motion;
    const double start = motion.mesh.ends[motion.n_elements() - 1], end = motion.end();
    const bool was_beyond = phase.watch.was_beyond(motion, fired),
               has_jumped = phase.watch.have_jumped(motion, fired);
    double low = start, high = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_turns && !has_jumped; ++i) {
        const double now = motion.end();
        const EventWatch::Border border = phase.watch.border_of(motion, fired);
        (border.margin > 0 ? high : low) = now;
        const double away = border.margin > 0 || std::isinf(high) ? low : high;   // it moves off
        double zero = border.rate > 0 ? now - border.margin / border.rate : away;
        if (was_beyond && border.rate > 0 && zero <= start) {   // its slack was used up there
            if (motion.n_elements() > 1) {
                drop_last(motion);
                return end_at_event(phase, fired, solved);
            }
            solve_last(phase, start + at_start * (end - start), solved);
            break;
        }
        if (std::abs(zero - now) <= std::max(near_event * (end - start), of_clock * std::abs(now))) break;
        if (std::isinf(high)) {   // it lies ahead, and not far
            if (!(zero > now && zero < end + ahead * (end - start))) return false;
        } else if (!(zero > low && zero < high)) {
            zero = 0.5 * (low + high);
        }
        if (!(zero > start) || !solve_last(phase, zero, solved)) break;
    }
    fired = phase.watch.holding(motion, fired);
    return true;
}

}   // namespace livens::inline spacetime_internal
