// SPDX-License-Identifier: BSD-3-Clause
// Elements that are found while marching.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/spacetime/march/march.h"

namespace livens {

namespace {

/// The velocity jump of an element without a solution.
constexpr double unseen = std::numeric_limits<double>::infinity();

}   // namespace

void March::run_at_pace(Pace& pace)
{
    while (time_ < pace.end()) {
        if (!pace.ascends()) return stop_vanishing();
        const double start = time_, end = bends_.end(start, pace.next_end(start)), length = end - start;
        const double most = pace.largest_jump(start, end);
        mesh_.ends.push_back(end);
        const int e = mesh_.n_elements() - 1;
        if (!window_.open(e, e + 1, report_)) return void(set_failed(e, e + 1));
        const NewtonReport outcome = attempt(e, e + 1);
        Closed closed{0, outcome.status != SolveStatus::converged, unseen};
        if (!closed.is_refused && options_.ends_at_bends && bends_.moves(window_, start, end)) {
            mesh_.ends.pop_back();
            continue;
        }
        const bool end_may_move = !pace.is_stop(end) || pace.may_leave(end);
        if (!closed.is_refused)
            closed = close({most, true, true}, end_may_move, true);
        else if (window_.monitor().rank_loss() == RankLoss::at_end)
            closed.loss = loss_of_failed(end, end_may_move);
        if (closed.loss != RankLoss::none) {
            count_shift(end);
            if (closed.loss == RankLoss::at_end) pace.leave(end);
            pace.shorten((1 - shift) * length);
            mesh_.ends.pop_back();
            continue;
        }
        if (closed.n_elements > 0) {
            pace.accepted(length, closed.velocity_jump, outcome.iterations);
            if (options_.ends_at_bends && bends_.accepted(start, end)) count_bend(end);
            if (!take(e, e + 1, closed, outcome) || (options_.goes_on && !options_.goes_on())) return;
            if (options_.ends_at_bends && bends_.is_stuck() && !window_.monitor().jumping_load().empty())
                return stop_at_jump(window_.monitor().jumping_load());
            continue;
        }
        ++report_.refused;
        blame(closed);
        const bool can_help = closed.is_refused && may_shorten(outcome) && !is_contradictory(closed);
        if (!can_help || !pace.refused(length, closed.velocity_jump, most))
            return give_up(e, closed, outcome);
        mesh_.ends.pop_back();
    }
}

void March::blame(const Closed& closed)
{
    troubles_.load = closed.load;
    if (!closed.load.empty()) report_.steep_load = closed.load;
}

void March::give_up(int element, const Closed& closed, const NewtonReport& outcome)
{
    if (!closed.is_refused) return void(set_failed(element, element + 1));   // the report says why
    if (!closed.contradiction.empty()) return void(set_contradiction(element, element + 1, closed));
    if (outcome.status != SolveStatus::converged && !(is_near_singular_end() && may_shorten(outcome)))
        return void(explain(element, element + 1, outcome));
    stop_vanishing();
}

bool March::is_near_singular_end() const
{
    return std::abs(time_ - singular_end_) < 1e-3 * (options_.pace->end() - mesh_.start());
}

void March::stop_vanishing()
{
    report_.status = SolveStatus::not_converged;
    report_.failed_at = time_;
    report_.message = is_near_singular_end() ? of_singular_end(singular_end_) : locking_in_words();
    if (report_.message.empty()) report_.message = of_vanishing(time_, troubles_.load);
}

void March::stop_at_jump(const std::string& load)
{
    report_.status = SolveStatus::not_converged;
    report_.failed_at = time_;
    report_.message = of_sticking(load, time_);
}

int March::n_elements() const
{
    if (options_.pace == nullptr) return mesh_.n_elements();
    const double share = (time_ - mesh_.start()) / (options_.pace->end() - mesh_.start());
    return share > 0 ? static_cast<int>(std::lround(std::min(done_ / share, 1e9))) : 0;
}

}   // namespace livens
