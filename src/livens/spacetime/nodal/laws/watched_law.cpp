// SPDX-License-Identifier: BSD-3-Clause
// A law with pieces along the polynomials of an element: the number of each guard, which changes its piece
// where it passes one of its places, and the vector at whose zero the law is not smooth (docs/theory.md,
// "Laws that bend").
#include "livens/spacetime/nodal/laws/watched_law.h"

#include <algorithm>
#include <utility>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// Of the force some way behind: at a bend it may be none.
constexpr double jump = 1e-6;

}   // namespace

/// Of a load, or, where that is negative, of a row, whose one guard follows a function of its coordinates.
WatchedLaw::WatchedLaw(const ModelTables& tables, int load, int row) : tables_(tables), load_(load), row_(row)
{
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
    std::vector<double> change(between.size()), far(change);
    tables_.loads.add_one(load_, instant, X, V.second, 1, far.data(), first.angles);
    tables_.loads.add_one(load_, instant, X, go(outside), 1, change.data(), first.angles);
    tables_.loads.add_one(load_, instant, X, go(inside), -1, change.data(), first.angles);
    const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const double of_all = std::abs(std::ranges::max(far, smaller));
    if (!(std::abs(std::ranges::max(change, smaller)) > jump * of_all)) change.clear();
    return change;
}

/// `before` and `after` are as near as numbers are: a force that goes on has not changed there. Rows of
/// constraints are not taken to jump.
bool WatchedLaw::jumps(ElementPath& path, const LawState& before, const LawState& after,
                       const LawState& end) const
{
    if (load_ < 0) return false;
    const LoadForces a = forces(path, before), b = forces(path, after), c = forces(path, end);
    for (std::size_t side = 0; side < a.size(); ++side)
        if (norm(b[side] - a[side]) > jump * std::max({norm(a[side]), norm(b[side]), norm(c[side])}))
            return true;
    return false;
}

}   // namespace livens
