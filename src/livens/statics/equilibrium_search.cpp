// SPDX-License-Identifier: BSD-3-Clause
// What the search for an equilibrium does at one configuration: forces of the mechanism at rest, principal
// stiffnesses of what joints leave free, and where a step leads with the joints closed (docs/theory.md,
// "Equilibrium").
#include "livens/statics/equilibrium_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"

namespace livens::inline statics_internal {

namespace {

using Values = std::vector<double>;

/// Without stops: all joints act, and rows keep their numbers.
ActingModel all_of(const Model& model)
{
    ActingModel all{model, std::vector<int>(model.joints().size()),
                    std::vector<int>(static_cast<std::size_t>(model.n_rows()))};
    std::iota(all.joints.begin(), all.joints.end(), 0);
    std::iota(all.rows.begin(), all.rows.end(), 0);
    return all;
}

}   // namespace

HeldAtRest::HeldAtRest(const Model& model, const RestingStops& all, std::vector<int> which)
    : whole(&model), stops(&all), closed(std::move(which)),
      part(all.size() == 0 ? all_of(model) : all.watching(closed))
{}

Search::Search(const HeldAtRest& held, const ConsistentStart& closed)
    : held_(held), tables_(held.part.model, closed.independent), instant_(tables_),
      rows_(all_rows(held.part.model)), t_(closed.start.t)
{
    state_.resize(tables_);
    State start = closed.start;
    // Loads that watch stops come behind the model's own, and their angles have not turned yet.
    if (held.stops->size() > 0)
        start.angles.resize(start.angles.empty() ? 0 : tables_.loads.turns.size(), 0.0);
    state_.angles = tables_.loads.turns.begin(start);
    const std::vector<Matrix34> stated = held.whole->start().X;
    for (const Joint& joint : held.whole->joints())
        for (const NamedCoordinate& q : joint.coordinates) {
            const double value = coordinate_value(q.coordinate, stated);
            counted_.push_back({&q, value, value});
        }
}

/// At rest: only what holds states has velocities, which are these states.
bool Search::look(std::vector<Matrix34> X, RestPoint& point)
{
    point.X = std::move(X);
    state_.t = t_;
    std::copy_n(point.X.data()->data(), state_.X.size(), state_.X.begin());
    std::fill(state_.velocity.begin(), state_.velocity.end(), 0.0);
    std::ranges::copy(point.states, state_.velocity.begin());
    tables_.loads.turns.follow(point.X, state_.angles);
    follow_joints(point.X);
    if (!instant_.prepare(state_, tables_.independent)) return false;
    instant_.accelerate(state_, Side::right);
    // Kept here, since Statics sets it to zero.
    acceleration_ = state_.acceleration[1];
    instant_.add_basis(state_);
    point.maps = state_.maps;
    point.statics = std::make_unique<const Statics>(tables_, state_, Side::right);
    return std::isfinite(point.residual());
}

std::vector<double> Search::depths() const
{
    std::vector<Matrix34> X(static_cast<std::size_t>(tables_.n_bodies()));
    std::copy_n(state_.X.begin(), 12 * X.size(), X.data()->data());
    return held_.stops->depths(held_.part.model, tables_.loads, X, state_.angles);
}

Search::Depth Search::deepest() const
{
    Depth most;
    if (held_.stops->size() == 0) return most;
    const std::vector<double> all = depths();
    for (int k = 0; k < held_.stops->size(); ++k) {
        const bool is_closed = std::ranges::find(held_.closed, k) != held_.closed.end();
        const double depth = all[static_cast<std::size_t>(k)];
        if (!is_closed && (most.stop < 0 || depth > most.depth)) most = {k, depth};
    }
    return most;
}

std::vector<std::vector<double>> Search::coordinates() const
{
    std::vector<std::vector<double>> all(held_.whole->joints().size());
    auto next = counted_.begin();
    for (std::size_t j = 0; j < all.size(); ++j)
        for (const NamedCoordinate& q : held_.whole->joints()[j].coordinates)
            all[j].push_back(q.at_stated + next->value - next->stated), ++next;
    return all;
}

void Search::add_stiffness(RestPoint& point) const
{
    const Statics& statics = *point.statics;
    if (statics.free.n == 0) return;
    const DenseMatrix K = statics.free.reduced(tables_, statics.stiffness);
    const SymmetricSpectrum principal = symmetric_spectrum(symmetric_part(K));
    point.scale = statics.largest_stiffness;
    point.stiffness = principal.values;
    point.directions = product(statics.free.Z, principal.vectors);
    point.forces = transposed_product(point.directions, statics.rows);
    // Where it is rounding of the terms of K it is left out, and steps go direction by direction.
    const DenseMatrix skew = skew_part(K);
    point.skew = {};
    if (largest_size(skew.a) > 1e-13 * point.scale)
        point.skew = product(transposed_product(principal.vectors, skew), principal.vectors);
}

double Search::size_of(const RestPoint& point, const Values& step) const
{
    const Values y = product(point.directions, step);
    Values xi(static_cast<std::size_t>(tables_.n_twists));
    tables_.bodies.to_twist(point.maps.data(), y.data(), xi.data());
    return largest_displacement(tables_, xi.data());
}

bool Search::move(const RestPoint& from, const Values& step, std::vector<Matrix34>& X) const
{
    const Values y = product(from.directions, step);
    Values xi(static_cast<std::size_t>(tables_.n_twists));
    tables_.bodies.to_twist(from.maps.data(), y.data(), xi.data());
    return move_by(from, xi, X);
}

/// Bodies move by finite translations and turns; a step of Newton's for the polar factor takes rounding off
/// directors, and joints are closed behind it.
bool Search::move_by(const RestPoint& from, const Values& xi, std::vector<Matrix34>& X) const
{
    X = from.X;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        if (holds_states(b)) continue;
        const double* v = xi.data() + tables_.bodies[b].first;
        const Vector3 shift{v[0], v[1], v[2]};
        if (tables_.bodies[b].dofs == 3) {
            X[b].set_column(0, X[b].column(0) + shift);
            continue;
        }
        X[b] = twist::moved(X[b], shift, {v[3], v[4], v[5]});
        const Matrix3 D = directors(X[b]);   // rounding does not gather
        X[b] = configuration(X[b].column(0), 0.5 * (D * (3.0 * identity<3>() - transpose(D) * D)));
    }
    Closing closing = close_rows(held_.part.model, X, rows_, false);
    X = std::move(closing.X);
    return closing.closed;
}

Values Search::twists(const RestPoint& at, const Values& free) const
{
    const Values y = product(at.statics->free.Z, free);
    Values xi(static_cast<std::size_t>(tables_.n_twists));
    tables_.bodies.to_twist(at.maps.data(), y.data(), xi.data());
    return xi;
}

Values Search::states_of(const State& state) const
{
    Values states(static_cast<std::size_t>(tables_.n_twists));
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int k = 0; holds_states(b) && k < 3; ++k)
            states[static_cast<std::size_t>(tables_.bodies[b].first + k)] =
                state.V[static_cast<std::size_t>(b)](k, 0);
    return states;
}

std::vector<Matrix34> Search::velocities_of(const Values& states) const
{
    std::vector<Matrix34> V(static_cast<std::size_t>(tables_.n_bodies()));
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int k = 0; holds_states(b) && k < 3; ++k)
            V[static_cast<std::size_t>(b)](k, 0) =
                states[static_cast<std::size_t>(tables_.bodies[b].first + k)];
    return V;
}

double Search::size_of_states(const Values& xi) const
{
    double size = 0;
    for (int b = 0; b < tables_.n_bodies(); ++b)
        if (const Body& body = model().bodies()[static_cast<std::size_t>(b)]; body.holds_states())
            for (int k = 0; k < 3; ++k)
                size = std::max(size, std::abs(xi[static_cast<std::size_t>(tables_.bodies[b].first + k)]) /
                                          body.state_speed);
    return size;
}

double Search::work(const RestPoint& from, const RestPoint& to, const Values& step, double size)
{
    if (size < 1e-3) {
        Values both = from.statics->rows;
        add_scaled(both, 1, to.statics->rows);
        return 0.5 * dot(product(from.directions, step), both);
    }
    double sum = 0;
    for (std::size_t b = 0; b < from.X.size(); ++b)
        for (int i = 0; i < 12; ++i)
            sum += 0.5 * (from.statics->given[12 * b + i] + to.statics->given[12 * b + i]) *
                   (to.X[b].a[i] - from.X[b].a[i]);
    return sum;
}

int Search::bad_load(const std::vector<Matrix34>& X) const
{
    const std::vector<double> V(12 * X.size(), 0.0);
    return tables_.loads.bad({t_, Side::right}, X.data()->data(), V.data(), state_.angles);
}

void Search::follow_joints(std::span<const Matrix34> X)
{
    for (Counted& one : counted_) {
        const double x = coordinate_value(one.q->coordinate, X);
        one.value = one.q->coordinate.counts_turns() ? turned_to(x, one.value) : x;
    }
}

}   // namespace livens::inline statics_internal
