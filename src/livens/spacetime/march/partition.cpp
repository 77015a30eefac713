// SPDX-License-Identifier: BSD-3-Clause
// Remedies for windows that were not accepted, as changes of the mesh: an element is divided, ends elsewhere,
// or is tried again with another length.
// docs/theory.md: "Spurious elements", "Singular positions", "To an accuracy".
#include "livens/spacetime/march/partition.h"

#include <algorithm>

namespace livens::inline spacetime_internal {

namespace {

/// Of the duration: what a divided element is not divided below.
constexpr double shortest_element = 1e-9;

/// Where an element is divided that has a singular position at an inner node: nodes of halves might meet it
/// again.
constexpr double uneven = 0.4;

/// Of an element by which its end is moved off a singular position.
constexpr double shift = 0.1;

}   // namespace

/// Ends of windows to come wait on a stack: a remedy that divides a window puts one more on top.
GivenMesh::GivenMesh(TimeMesh& mesh, ElementMonitor& monitor, const DivisionOptions& options)
    : mesh_(mesh), monitor_(monitor), options_(options), most_divided_(200 + 4 * mesh.n_elements())
{
    const std::vector<int> division = divide(mesh.n_elements(), options.length, options.shortest);
    far_ends_.reserve(division.size());
    for (std::size_t k = 0; k < division.size(); ++k) far_ends_.push_back(mesh.ends[division[k]]);
    if (options.direction > 0) std::ranges::reverse(far_ends_);
    far_ends_.pop_back();   // where the first one begins
}

std::optional<Elements> GivenMesh::next(double t)
{
    while (!far_ends_.empty() && far_ends_.back() == t) far_ends_.pop_back();
    if (far_ends_.empty()) return {};
    // ends are compared as they are, for each was taken from the mesh; windows follow each other as a rule
    const auto index = [&](double end, int likely) {
        if (likely >= 0 && likely <= mesh_.n_elements() && mesh_.ends[likely] == end) return likely;
        return static_cast<int>(std::ranges::lower_bound(mesh_.ends, end) - mesh_.ends.begin());
    };
    const int near = index(t, last_), far = index(far_ends_.back(), near + options_.direction);
    last_ = far;
    return Elements{std::min(near, far), std::max(near, far)};
}

bool GivenMesh::may_move_end(const Elements& of) const
{
    const int end = far(of);
    return end > 0 && end < mesh_.n_elements() &&
           !std::ranges::binary_search(mesh_.required, mesh_.ends[end]);
}

bool GivenMesh::may_shorten(const Elements& of) const
{
    return options_.may_divide && n_divided_ < most_divided_ && of.size() == 1 &&
           mesh_.length(of.first) > shortest_element * (mesh_.end() - mesh_.start());
}

double GivenMesh::wanted_end(const Elements& of, bool is_found) const
{
    return mesh_.ends[is_found && of.last < mesh_.n_elements() ? of.last + 1 : of.last];
}

void GivenMesh::insert(const Elements& of, double t)
{
    mesh_.ends.insert(mesh_.ends.begin() + of.last, t);
    far_ends_.push_back(t);
    monitor_.divided(of.first);
}

void GivenMesh::end_at(const Elements& of, double t, bool is_found)
{
    if (!is_found || of.last == mesh_.n_elements()) return insert(of, t);
    mesh_.ends[of.last] = far_ends_.back() = t;
}

void GivenMesh::avoid(const Elements& of, RankLoss loss)
{
    const double length = mesh_.length(of.first);
    if (loss == RankLoss::inside) return insert(of, mesh_.ends[of.first] + uneven * length);
    far_ends_.back() = mesh_.ends[far(of)] -= options_.direction * shift * length;
}

/// In two halves, of which the near one comes first: the far end is on the stack already.
bool GivenMesh::reject(const Elements& of, double, bool can_help, SolveReport& report)
{
    if (!can_help || !may_shorten(of)) return false;
    const double start = mesh_.ends[of.first], end = mesh_.ends[of.last];
    ++n_divided_;
    if (report.divided++ == 0) report.divided_at = options_.direction > 0 ? start : end;
    insert(of, start + 0.5 * (end - start));
    return true;
}

void GivenMesh::split(const Elements&, int middle) { far_ends_.push_back(mesh_.ends[middle]); }

std::optional<Elements> AdaptiveElements::next(double t)
{
    if (t >= controller_.end() || !controller_.ascends()) return {};
    wanted_end_ = controller_.next_end(t);
    mesh_.ends.push_back(events_.end(t, wanted_end_));
    return Elements{mesh_.n_elements() - 1, mesh_.n_elements()};
}

AcceptanceCriteria AdaptiveElements::criteria(const Elements& of) const
{
    return {controller_.largest_jump(mesh_.ends[of.first], mesh_.ends[of.last]), true, true};
}

bool AdaptiveElements::may_move_end(const Elements& of) const
{
    const double end = mesh_.ends[of.last];
    return !controller_.is_stop(end) || controller_.may_leave(end);
}

void AdaptiveElements::avoid(const Elements& of, RankLoss loss)
{
    if (loss == RankLoss::at_end) controller_.leave(mesh_.ends[of.last]);
    controller_.shorten((1 - shift) * mesh_.length(of.first));
    mesh_.ends.pop_back();
}

bool AdaptiveElements::reject(const Elements& of, double velocity_jump, bool can_help, SolveReport& report)
{
    ++report.rejected;
    const double most = criteria(of).velocity_jump;
    if (!can_help || !controller_.rejected(mesh_.length(of.first), velocity_jump, most)) return false;
    mesh_.ends.pop_back();
    return true;
}

void AdaptiveElements::accepted(const Elements& of, const AcceptedElements& closed,
                                const NewtonReport& outcome)
{
    const double length = mesh_.length(of.first);
    controller_.accepted(length, closed.velocity_jump, outcome.iterations, outcome.has_dear_factor);
    if (outcome.is_dearer_than_short) controller_.too_dear(length);
}

/// The last window takes a rest of fewer than `shortest` elements along.
std::vector<int> divide(int n_elements, int length, int shortest)
{
    if (length <= 0) length = n_elements;
    std::vector<int> ends;
    for (int e = 0; e < n_elements; e += length) ends.push_back(e);
    if (ends.size() > 1 && n_elements - ends.back() < shortest) ends.pop_back();
    ends.push_back(n_elements);
    return ends;
}

}   // namespace livens::inline spacetime_internal
