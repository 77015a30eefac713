// SPDX-License-Identifier: BSD-3-Clause
// A law with pieces along the polynomials of an element: the number of each guard, which changes its piece
// where it passes one of its places, and the vector at whose zero the law is not smooth (docs/theory.md,
// "Laws that bend").
#include "livens/spacetime/nodal/laws/watched_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/diagnostics/rounding.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"

namespace livens {

/// Of a load, or, where that is negative, of a row, whose one guard follows a function of its coordinates.
WatchedLaw::WatchedLaw(const ModelTables& tables, int load, int row)
    : tables_(tables), load_(load), row_(row), all_(tables.bodies.size())
{
    std::iota(all_.begin(), all_.end(), 0);
    if (load >= 0) {
        const Load& of = tables.model->loads()[load];
        guards_ = of.guards;
        has_centre_ = of.bends_at_centre;
        bodies_ = of.bodies;
        std::erase(bodies_, world);
    } else if (const ConstraintRow& of = tables.model->row(row); of.guard) {
        guards_ = {of.guard->guard};
        const RowBodies bodies = row_bodies(of);
        bodies_.assign(bodies.begin(), bodies.end());
    }
}

LawState WatchedLaw::at(ElementPath& path, double share, const LawState& from) const
{
    path.go(share, bodies_);
    std::vector<double> angles = from.angles;
    if (load_ >= 0 && !tables_.model->loads()[load_].angles.empty())
        tables_.loads.turns.follow_of(load_, Configurations(path.X()), angles);
    LawState state = at(path.at(), path.X(), path.V(), std::move(angles), from);
    state.share = share;
    return state;
}

LawState WatchedLaw::at(Instant instant, const double* X, const double* V, std::vector<double> angles,
                        const LawState& from) const
{
    LawState state{0, std::vector<double>(guards_.size()), {}, std::move(angles)};
    if (load_ >= 0) {
        const Load& load = tables_.model->loads()[load_];
        const LoadArguments arguments = tables_.loads.arguments(load_, instant, X, V, state.angles);
        if (load.guarded) load.guarded(arguments, state.numbers);
        if (has_centre_) state.centre = load.centre(arguments);
    } else {
        const ConstraintRow& row = tables_.model->row(row_);
        state.numbers[0] = row.guard->value(function_point(row, row.functions[0], 0, Configurations(X)));
    }
    // an angle goes on through half a turn instead of coming back from the other side
    for (std::size_t k = 0; k < from.numbers.size(); ++k)
        state.numbers[k] = guards_[k].following(state.numbers[k], from.numbers[k]);
    return state;
}

/// Some spacings. Rates of all bodies round alike, as joints hand them on, all along an element.
std::vector<double> WatchedLaw::rounding(ElementPath& path, const LawState& from) const
{
    constexpr double digits = 64 * std::numeric_limits<double>::epsilon();
    double place = tables_.length, rate[2] = {};   // of points, and of directors
    for (const double share : {0.0, 0.5, 1.0, from.share}) {
        path.go(share, all_);
        for (std::size_t i = 0; i < 12 * all_.size(); ++i) {
            if (i % 12 < 3) place = std::max(place, std::abs(path.X()[i]));
            double& largest = rate[i % 12 < 3 ? 0 : 1];
            largest = std::max(largest, std::abs(path.V()[i]));
        }
    }
    const std::vector<double> X(path.X(), path.X() + 12 * all_.size()), V(path.V(), path.V() + X.size());
    std::vector<double> change = changes_by_rounding(from.numbers, [&](const auto& shift) {
        std::vector<double> there = X, moving = V;
        for (const int body : bodies_)
            for (int i = 0; i < 12; ++i) {
                there[12 * body + i] += shift(i < 3 ? place : 1);
                moving[12 * body + i] += shift(rate[i < 3 ? 0 : 1]);
            }
        return at(path.at(), there.data(), moving.data(), from.angles, from).numbers;
    });
    for (double& now : change) now *= digits;
    return change;
}

std::vector<double> WatchedLaw::angles_at(ElementPath& path, double share, std::vector<double> from) const
{
    if (load_ < 0 || tables_.model->loads()[load_].angles.empty()) return from;
    path.go(share, bodies_);
    tables_.loads.turns.follow_of(load_, Configurations(path.X()), from);
    return from;
}

LoadForces WatchedLaw::forces(ElementPath& path, const LawState& at) const
{
    path.go(at.share, bodies_);
    LoadForces F(tables_.model->loads()[load_].n_acted);
    tables_.model->loads()[load_].forces(
        tables_.loads.arguments(load_, path.at(), path.X(), path.V(), at.angles), F);
    return F;
}

std::vector<double> WatchedLaw::jump_between(Instant instant, const double* X,
                                             std::pair<const double*, const double*> V,
                                             const LawState& first) const
{
    constexpr double beside = 1e-3, part = 0.1;   // of all that changes, which at a kink is `beside` of it
    std::vector<double> between(12 * tables_.bodies.size());
    const auto go = [&](double share) -> const double* {
        for (const int body : bodies_)
            for (int i = 12 * body; i < 12 * body + 12; ++i)
                between[i] = V.first[i] + share * (V.second[i] - V.first[i]);
        return between.data();
    };
    const auto is_inside = [&](double share) {
        const LawState state = at(instant, X, go(share), first.angles, first);
        for (std::size_t k = 0; k < guards_.size(); ++k)
            if (!(guards_[k].piece_at(first.numbers[k]).margin(state.numbers[k]) >= 0)) return false;
        return true;
    };
    double inside = 0, outside = 1;
    for (double middle = 0.5; middle > inside && middle < outside; middle = inside + 0.5 * (outside - inside))
        (is_inside(middle) ? inside : outside) = middle;
    const auto difference = [&](double from, double to) {
        std::vector<double> force(between.size());
        tables_.loads.add_one(load_, instant, X, go(to), 1, force.data(), first.angles);
        tables_.loads.add_one(load_, instant, X, go(from), -1, force.data(), first.angles);
        return force;
    };
    const auto largest = [](const std::vector<double>& force) {
        double most = 0;
        for (const double f : force) raise_to(most, std::abs(f));
        return most;
    };
    // beside the place itself, where a law like x/abs(x) has no value
    std::vector<double> change = difference(std::max(0.0, inside - beside), std::min(1.0, outside + beside));
    if (!(largest(change) > part * largest(difference(0, 1)))) change.clear();
    return change;
}

/// `before` and `after` are as near as numbers are: a force that goes on has not changed there. Rows of
/// constraints are not taken to jump.
bool WatchedLaw::jumps(ElementPath& path, const LawState& before, const LawState& after,
                       const LawState& end) const
{
    constexpr double jump = 1e-6;   // of the force where the look ends: at a bend it may be none
    if (load_ < 0) return false;
    const LoadForces a = forces(path, before), b = forces(path, after), c = forces(path, end);
    for (std::size_t side = 0; side < a.size(); ++side)
        if (norm(b[side] - a[side]) > jump * std::max({norm(a[side]), norm(b[side]), norm(c[side])}))
            return true;
    return false;
}

}   // namespace livens
