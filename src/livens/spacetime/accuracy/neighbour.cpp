// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/accuracy/neighbour.h"

#include <algorithm>
#include <utility>

#include "livens/base/error.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/multibody/body.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/nodal/window.h"
#include "livens/spacetime/solve_mesh.h"

namespace livens {

namespace {

/// Of the iteration. Less is rounding, for which no steps are to be taken; more would be seen in differences.
constexpr double least_tolerance = 1e-14, most_tolerance = 1e-10;

/// With triads that are none by what bends as such.
State rigid(const Model& model, State state)
{
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        const Vector3 w = angular_velocity(state.X[b], state.V[b]);
        state.X[b] = configuration(state.X[b].column(0), project_directors(directors(state.X[b])));
        state.V[b] = rate(state.X[b], state.V[b].column(0), w);
    }
    return state;
}

}   // namespace

/// A window that goes on from piece to piece: what is made once is made once, and its guesses know the past.
struct Neighbour::March {
    Ends ends;
    ModelTables tables;
    NodalWindow window;

    March(const Model& model, Prepared& prepared, const Method& method, const Ends& closed,
          const TimeMesh& mesh)
        : ends(closed), tables(model, ends.independent, false, prepared.pattern(model)),
          window(tables, mesh, ends, rule_of(method))
    {}
};

Neighbour::Neighbour(const Model& model, const Method& method, const SolveOptions& options,
                     const Motion& beside, std::shared_ptr<Prepared> prepared, const Ends* closed,
                     bool has_bends)
    : model_(model), method_(method), options_(options), beside_(beside), prepared_(std::move(prepared)),
      closed_(closed), has_bends_(has_bends)
{}
Neighbour::Neighbour(Neighbour&&) noexcept = default;
Neighbour::~Neighbour() = default;

bool Neighbour::march(const State& start, const Motion& near, double left)
{
    const bool is_new = march_ == nullptr;
    if (is_new) march_ = std::make_unique<March>(model_, *prepared_, method_, *closed_, mesh_);
    march_->ends.start = rigid(model_, start);
    if (!is_new) march_->window.restart();
    march_->window.follow(near);
    WindowOptions w = window_options(model_, options_);
    w.solve.tolerance = std::clamp(left, least_tolerance, most_tolerance);
    w.may_divide = options_.divide;
    w.criteria = {acceptable_velocity_jump, true, true};
    w.ends_at_bends = !mesh_.bends.empty();
    SolveReport report;
    solve_windows(march_->window, mesh_, w, report);
    motion_ = march_->window.take_motion();
    return report.converged();
}

bool Neighbour::solve(const State& start, const Motion& near, int first, int last, double left)
{
    mesh_.ends.assign(beside_.mesh.ends.begin() + first, beside_.mesh.ends.begin() + last + 1);
    mesh_.required = mesh_.ends;
    mesh_.bends.clear();
    states_.clear();
    if (has_bends_)
        for (const double t : beside_.mesh.bends)
            if (t > mesh_.start() && t <= mesh_.end()) mesh_.bends.push_back(t);
    if (closed_ != nullptr) return march(start, near, left);
    // where no start beside the motion closes, or it has come to a singular position, there is none
    Problem problem{{start}, {}, &near, prepared_};
    problem.ends_by_events = false;
    Solution one = solve_unjudged(model_, problem, mesh_, method_, options_);
    motion_ = std::move(one.motion);
    return one.report.converged();
}

bool Neighbour::begin(NeighbourElements& elements, const State& start, int first, double share)
{
    first_ = first;
    states_.assign(1, rigid(model_, start));
    return elements.begin(here_, states_.front(), share);
}

bool Neighbour::go_on(NeighbourElements& elements, const BesideLimits& limits, const Neighbour* mirror)
{
    try {
        Patience::ask();
    } catch (const Stopped&) {   // windows end likewise
        return false;
    }
    if (!elements.solve(here_, limits, mirror != nullptr ? &mirror->here_ : nullptr)) return false;
    states_.push_back(elements.state(here_));
    const int done = first_ + static_cast<int>(states_.size()) - 1;
    return !options_.progress ||
           options_.progress({done, beside_.n_elements(), beside_.mesh.ends[done], 0, 0});
}

bool Neighbour::has_end(int end) const
{
    if (!states_.empty()) return true;
    const double t = beside_.mesh.ends[end];
    // Among impacts that follow each other faster than it has them earlier or later it is not beside it.
    if (beside_.impacts.at(end) >= 0 && near_impact(end) < 0) return false;
    return std::ranges::binary_search(motion_.mesh.ends, t);
}

State Neighbour::at_end(int end) const
{
    if (!states_.empty()) return states_[end - first_];
    const double t = beside_.mesh.ends[end];
    const int impact = beside_.impacts.at(end) >= 0 ? near_impact(end) : -1;
    if (impact < 0) return motion_.at(t);
    // Behind impacts both are compared, though one of them has it later.
    State state = motion_.at_end(impact);
    for (std::size_t b = 0; b < state.X.size(); ++b) state.X[b] += (t - state.t) * state.V[b];
    state.t = t;
    return state;
}

/// Its element end with the impact that is nearest to one of the motion; -1: none is within a part of the
/// elements beside it.
int Neighbour::near_impact(int end) const
{
    const TimeMesh& mesh = beside_.mesh;
    const double t = mesh.ends[end], length = std::min(mesh.length(end - 1), mesh.length(end));
    int nearest = -1;
    double least = 0.1 * length;
    for (const int own : motion_.impacts.ends) {
        const double apart = std::abs(motion_.mesh.ends[own] - t);
        if (apart >= least) continue;
        least = apart;
        nearest = own;
    }
    return nearest;
}

void Neighbour::apart_from(const State& other, int end, double share, Difference& apart) const
{
    if (states_.empty())
        apart.set(at_end(end), other, share);
    else
        apart.set(states_[end - first_], other, share);
}

}   // namespace livens
