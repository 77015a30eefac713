// SPDX-License-Identifier: BSD-3-Clause
// Events of the second solution, at instants of its own: docs/theory.md, "Events", Errors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/spacetime/accuracy/reference_solution.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/phases/near_misses.h"

namespace livens {

namespace {

/// Of the error of an instant that of the next one has at least: both solutions may agree by chance.
constexpr double kept_error = 0.2;

/// Whether an element end that is neither the first nor the last is where a law bends.
bool has_bend(const Motion& motion, const TimeMesh& mesh, double end)
{
    return end > mesh.start() && end < mesh.end() && std::ranges::binary_search(motion.mesh.bends, end);
}

}   // namespace

/// Where an event ends the motion, its own may come later.
TimeMesh ReferenceSolution::mesh_between(int first, int last) const
{
    TimeMesh mesh{{first_.mesh.ends.begin() + first, first_.mesh.ends.begin() + last + 1}};
    const bool is_open = ends_by_event(last);
    const double end = mesh.end();
    if (is_open) mesh.ends.push_back(end + 0.5 * first_.mesh.length(last - 1));
    for (const double t : mesh.ends)   // it bends at instants of its own, near those of the first
        (has_bend(first_, mesh, t) ? mesh.bends : mesh.required).push_back(t);
    for (const double t : missed(mesh, model_.load_breaks()))   // what one solution missed, two would
        mesh.ends.insert(std::ranges::upper_bound(mesh.ends, t), t);
    return mesh;
}

bool ReferenceSolution::ends_by_event(int end) const
{
    return end == first_.n_elements() && !events_.empty() && events_.back().t == first_.end() &&
           model_.events()[static_cast<std::size_t>(events_.back().event)].action.does ==
               EventAction::Does::end_motion;
}

/// Each solution has its own instants. At an event its state is compared where the first one has it: it moves
/// there as fast as it does, which leaves out what is of second order in the difference.
void ReferenceSolution::compare_events(Solution& second, double start, double end)
{
    const double gap = nearest_ends * (end - start);
    std::vector<SolvedEvent*> of_first;
    for (SolvedEvent& one : events_)
        if (one.t > start && one.t <= end) of_first.push_back(&one);
    std::vector<SolvedEvent>& own = second.events;
    std::erase_if(own,
                  [&](const SolvedEvent& one) { return one.t <= start; });   // the first has them there, too
    for (std::size_t k = 0; k < std::max(own.size(), of_first.size()); ++k) {
        if (k < own.size() && k < of_first.size() && own[k].event == of_first[k]->event) continue;
        const bool is_last = k + 1 >= std::max(own.size(), of_first.size());
        const double t = k < of_first.size() ? of_first[k]->t : own[k].t;
        if (is_last && std::abs(t - end) <= gap) break;   // it may come just behind the end
        differs_from_ = k < own.size() ? std::min(t, own[k].t) : t;
        return;
    }
    Motion& motion = second.motion;
    if (!model_.events().empty()) differs_from_ = undecided_place(model_, first_, motion);
    if (!std::isnan(differs_from_)) return;
    for (std::size_t k = 0; k < std::min(own.size(), of_first.size()); ++k) {
        const double there = of_first[k]->t, later = there - own[k].t;
        const double before = k > 0 ? of_first[k - 1]->error : 0;
        of_first[k]->error = std::max(std::abs(later) + of_first[k]->rounding, kept_error * before);
        const int i = element_end_at(motion.mesh, own[k].t), n = motion.n_elements();
        const bool fits =
            i > 0 && there > motion.mesh.ends[i - 1] && (i == n || there < motion.mesh.ends[i + 1]);
        if (!fits || later == 0) continue;
        motion.mesh.ends[i] = there;
        const State on_this_side = motion.at_end(i, later > 0 ? Side::right : Side::left);
        const std::span<double> X =
            i < n ? motion.X.coefficient(i, 0) : motion.X.coefficient(n - 1, motion.X.degree);
        for (std::size_t b = 0; b < static_cast<std::size_t>(motion.n_bodies); ++b)
            for (std::size_t c = 0; c < 12; ++c) X[12 * b + c] += later * on_this_side.V[b].a[c];
    }
}

void spacetime_internal::add_rests(const Model& model, const std::vector<SolvedEvent>& events,
                                   const Motion& motion, double lowest_hop, ErrorEstimate& found)
{
    const auto n = static_cast<std::size_t>(found.n_bodies);
    double left_out = 0;
    std::size_t end = 0;
    for (std::size_t k = 0; k <= events.size() && !found.empty(); ++k) {
        const double until = k < events.size() ? events[k].t : std::numeric_limits<double>::infinity();
        for (; end < motion.mesh.ends.size() && motion.mesh.ends[end] < until; ++end)
            for (std::size_t b = 0; b < n && left_out > 0; ++b) {
                found.position[end * n + b] += left_out;
                if (!model.bodies()[b].is_point) found.orientation[end * n + b] += left_out;
            }
        // one that was hit and did not stay where it was at once
        if (k < events.size() && events[k].rests_at > events[k].t) left_out += lowest_hop;
    }
    if (left_out > 0) found.find_largest(motion.mesh);
}

}   // namespace livens
