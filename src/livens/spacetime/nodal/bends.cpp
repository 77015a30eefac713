// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/bends.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// Of an element's length: nearer to its start is where the one before ended, for a law bends there.
constexpr double behind_start = 1e-7;
/// Looks for each degree and one more.
constexpr int looks_a_degree = 4;
/// Of the way between two looks: a look so near to the first and to the last tells whether a guard comes
/// nearer there.
constexpr double beside_ends = 0.05;
/// Of the change from one of the few first looks to the next: what is farther from its places is not near.
constexpr double far = 2;
/// Of the change between two looks: how near a centre comes to zero that passes through it.
constexpr double is_through = 1e-9;

}   // namespace

Bends::Bends(const Tables& tables, const ElementRule& rule) : tables_(tables), way_(tables, rule)
{
    if (!tables.model->has_pieces()) return;
    for (std::size_t l = 0; l < tables.model->loads().size(); ++l) watch(static_cast<int>(l), -1);
    for (int r = 0; r < tables.model->n_rows(); ++r) watch(-1, r);
    const int n = looks_a_degree * rule.size();
    shares_ = {behind_start, beside_ends / n};
    for (int i = 1; i < n; ++i) shares_.push_back(static_cast<double>(i) / n);
    shares_.push_back(1 - beside_ends / n);
    shares_.push_back(1);
}

void Bends::watch(int load, int row)
{
    Watch one{load, row, {}, {}, false};
    if (load >= 0) {
        const Load& of = tables_.model->loads()[static_cast<std::size_t>(load)];
        one.guards = of.guards;
        one.has_centre = of.bends_at_centre;
        one.bodies = of.bodies;
        std::erase(one.bodies, world);
    } else if (const ConstraintRow& of = tables_.model->row(row); of.guard) {
        one.guards = {of.guard->guard};
        const RowBodies bodies = row_bodies(of);
        one.bodies.assign(bodies.begin(), bodies.end());
    }
    if (!one.guards.empty() || one.has_centre) watches_.push_back(std::move(one));
}

Bends::Look Bends::look(const Watch& watch, double share, const Look& from)
{
    way_.go(*stretch_, *nodes_, 0, share, watch.bodies);
    Look look{share, std::vector<double>(watch.guards.size()), {}, from.angles};
    if (watch.load >= 0) {
        const Load& load = tables_.model->loads()[static_cast<std::size_t>(watch.load)];
        if (!load.angles.empty())
            tables_.loads.turns.follow_of(watch.load, Configurations(way_.X()), look.angles);
        const LoadArguments arguments =
            tables_.loads.arguments(watch.load, way_.at(), way_.X(), way_.V(), look.angles);
        if (load.guarded) load.guarded(arguments, look.numbers);
        if (watch.has_centre) look.centre = load.centre(arguments);
    } else {
        const ConstraintRow& row = tables_.model->row(watch.row);
        look.numbers[0] = row.guard->value(function_point(row, Configurations(way_.X())));
    }
    for (std::size_t k = 0; k < from.numbers.size(); ++k)
        look.numbers[k] = watch.guards[k].following(look.numbers[k], from.numbers[k]);
    return look;
}

LoadForces Bends::forces(const Watch& watch, const Look& at)
{
    way_.go(*stretch_, *nodes_, 0, at.share, watch.bodies);
    LoadForces F{};
    tables_.model->loads()[static_cast<std::size_t>(watch.load)].forces(
        tables_.loads.arguments(watch.load, way_.at(), way_.X(), way_.V(), at.angles), F);
    return F;
}

bool Bends::is_jump(const Watch& watch, const Passage& passage)
{
    constexpr double jump = 1e-6;   // of the force where the look ends: at a bend it may be none
    if (watch.load < 0) return false;
    const LoadForces a = forces(watch, passage.before), b = forces(watch, passage.after),
                     c = forces(watch, passage.end);
    for (std::size_t side = 0; side < 2; ++side)
        if (norm(b[side] - a[side]) > jump * std::max({norm(a[side]), norm(b[side]), norm(c[side])}))
            return true;
    return false;
}

namespace {

template <class Look>
bool is_inside(const std::vector<Guard::Piece>& pieces, const Look& look)
{
    for (std::size_t k = 0; k < pieces.size(); ++k)
        if (!(pieces[k].margin(look.numbers[k]) >= 0)) return false;
    return true;
}

}   // namespace

bool Bends::is_calm(const Watch& watch, const Pieces& pieces, const Look& start, double until)
{
    const int n = pieces.empty() ? 2 : static_cast<int>(shares_.size() - 3) / looks_a_degree;
    std::vector<double> nearest(pieces.size()), change(pieces.size(), 0.0);
    for (std::size_t k = 0; k < pieces.size(); ++k) nearest[k] = pieces[k].margin(start.numbers[k]);
    double distance = norm(start.centre), way = 0;
    Look before = start;
    for (int i = 1; before.share < until; ++i) {
        Look after = look(watch, std::min(static_cast<double>(i) / n, until), before);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            nearest[k] = std::min(nearest[k], pieces[k].margin(after.numbers[k]));
            change[k] = std::max(change[k], std::abs(after.numbers[k] - before.numbers[k]));
        }
        distance = std::min(distance, norm(after.centre));
        way = std::max(way, norm(after.centre - before.centre));
        before = std::move(after);
    }
    for (std::size_t k = 0; k < pieces.size(); ++k)
        if (!(nearest[k] > far * change[k])) return false;
    return !watch.has_centre || distance > far * way;
}

Bends::Passage Bends::bisect(const Watch& watch, const Pieces& pieces, Look inside, Look outside)
{
    Passage passage;
    passage.end = outside;
    for (double middle = 0; middle = inside.share + 0.5 * (outside.share - inside.share),
                middle > inside.share && middle < outside.share;) {
        Look between = look(watch, middle, inside);
        (is_inside(pieces, between) ? inside : outside) = std::move(between);
    }
    passage.share = outside.share;
    passage.before = std::move(inside);
    passage.after = std::move(outside);
    return passage;
}

Bends::Passage Bends::graze(const Watch& watch, const Pieces& pieces, const Look* three)
{
    constexpr double golden = 0.381966011250105;
    constexpr int most = 60;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const auto margin = [&](const Look& look) { return pieces[k].margin(look.numbers[k]); };
        const double a = margin(three[0]), b = margin(three[1]), c = margin(three[2]);
        if (!(b <= a && b <= c && b < (a - b) + (c - b))) continue;   // else it does not come near
        Look low = three[0], middle = three[1], high = three[2];
        for (int i = 0; i < most && high.share - low.share > 1e-10; ++i) {
            const bool is_left = middle.share - low.share > high.share - middle.share;
            const double to = is_left ? low.share : high.share;
            Look next = look(watch, middle.share + golden * (to - middle.share), middle);
            if (!is_inside(pieces, next)) return bisect(watch, pieces, low, next);
            if (margin(next) < margin(middle)) {
                (is_left ? high : low) = std::move(middle);
                middle = std::move(next);
            } else {
                (is_left ? low : high) = std::move(next);
            }
        }
    }
    return {};
}

Bends::Passage Bends::through_centre(const Watch& watch, const Look& from, const Look& to)
{
    constexpr int most = 12;
    constexpr double beside = 1e-3;   // of the way between two looks
    const Vector3 change = to.centre - from.centre;
    const double width = to.share - from.share, way = norm(change);
    const double place = -dot(from.centre, change) / (way * way);
    if (!(place > -0.5 && place < 1.5) || norm(from.centre + place * change) > 0.5 * way) return {};
    double s = from.share + std::clamp(place, 0.0, 1.0) * width;
    Passage passage;
    for (int i = 0; i < most; ++i) {   // the nearest place, by Newton's iteration
        passage.before = look(watch, s - beside * width, from);
        passage.after = look(watch, s + beside * width, from);
        const Vector3 slope = (0.5 / (beside * width)) * (passage.after.centre - passage.before.centre);
        const Vector3 here = look(watch, s, from).centre;
        const double step = -dot(here, slope) / dot(slope, slope);
        if (!(std::abs(step) < width)) return {};
        s += step;
        if (!(std::abs(step) > 1e-15)) break;
    }
    if (!(s > behind_start && s >= from.share && s < to.share)) return {};
    if (!(norm(look(watch, s, from).centre) <= is_through * way)) return {};
    passage.share = s;
    passage.end = to;
    return passage;
}

Bends::Passage Bends::first_of(const Watch& watch, double until)
{
    Look start;
    start.angles = stretch_->angles;
    start = look(watch, behind_start, start);
    Pieces pieces;
    for (std::size_t k = 0; k < watch.guards.size(); ++k)
        pieces.push_back(watch.guards[k].piece_at(start.numbers[k]));
    if (is_calm(watch, pieces, start, until)) return {};
    Look three[3];
    three[2] = start;
    const double step = shares_[3] - shares_[2];
    for (std::size_t i = 1; three[2].share < until; ++i) {
        three[0] = std::move(three[1]);
        three[1] = std::move(three[2]);
        const double share = i < shares_.size() ? shares_[i] : three[1].share + step;
        three[2] = look(watch, std::min(share, until), three[1]);
        Passage found;
        if (watch.has_centre) found = through_centre(watch, three[1], three[2]);
        if (i > 1 && std::isinf(found.share)) found = graze(watch, pieces, three);
        if (std::isinf(found.share) && !is_inside(pieces, three[2]))
            found = bisect(watch, pieces, three[1], three[2]);
        if (!std::isinf(found.share)) return found;
    }
    return {};
}

double Bends::first(const Stretch& stretch, const Nodes& nodes, double until)
{
    stretch_ = &stretch;
    nodes_ = &nodes;
    double share = std::numeric_limits<double>::infinity();
    for (const Watch& watch : watches_) {
        const Passage found = first_of(watch, std::min(until, share));
        if (!(found.share < share)) continue;
        share = found.share;
        jumping_ = is_jump(watch, found) ? watch.load : -1;
    }
    return share;
}

}   // namespace livens
