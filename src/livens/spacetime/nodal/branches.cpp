// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/branches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

constexpr int few_rows = 120, most_rows = 300;   // of a mechanism: orientations cost their cube
constexpr double dip = 0.5;   // of pivots in an element: nodes beside a singular position have less
constexpr double open_at_end = 1e-9, open_between = 1e-10;   // of a row's scale
constexpr int looks = 8;                                     // between two nodes

/// The first of the bodies that hang together with this one.
int first_of(std::vector<int>& before, int body)
{
    while (before[body] != body) body = before[body] = before[before[body]];
    return body;
}

}   // namespace

Branches::Branches(const Tables& tables, const ElementRule& rule) : tables_(tables), rule_(rule)
{
    find_mechanisms();
    if (mechanisms_.empty()) return;
    basis_ = basis_on(rule.points, rule.degree);
    values_.assign(rule.nodes.size(), 0.0);
    X_.assign(12 * tables.bodies.size(), 0.0);
}

/// A tree has as many joints as bodies, one less where it floats: it has no position in which it locks.
void Branches::find_mechanisms()
{
    const Model& model = *tables_.model;
    const auto n = tables_.bodies.size();
    std::vector<int> before(n);
    std::iota(before.begin(), before.end(), 0);
    for (int r = 0; r < tables_.n_rows(); ++r)
        for (int side = 1; side < tables_.rows[r].n_sides; ++side)
            before[first_of(before, tables_.rows[r].bodies[side])] =
                first_of(before, tables_.rows[r].bodies[0]);
    std::vector<int> n_bodies(n, 0), n_joints(n, 0), n_rows(n, 0), place(n, -1);
    std::vector<bool> is_tied(n, false);
    for (std::size_t b = 0; b < n; ++b) ++n_bodies[first_of(before, static_cast<int>(b))];
    for (int r = 0; r < tables_.n_rows(); ++r) {
        const int first = first_of(before, tables_.rows[r].bodies[0]);
        ++n_rows[first];
        if (r == model.first_row(model.row_joint(r))) ++n_joints[first];
        if (tables_.rows[r].n_sides == 1) is_tied[first] = true;   // to the world
    }
    for (std::size_t b = 0; b < n; ++b) {
        const int first = first_of(before, static_cast<int>(b));
        if (n_joints[first] < n_bodies[first] + (is_tied[first] ? 1 : 0)) continue;
        if (place[first] < 0) {
            place[first] = static_cast<int>(mechanisms_.size());
            mechanisms_.emplace_back();
        }
        mechanisms_[place[first]].bodies.push_back(static_cast<int>(b));
    }
    mechanism_of_.assign(static_cast<std::size_t>(tables_.n_rows()), -1);
    for (int r = 0; r < tables_.n_rows(); ++r)
        mechanism_of_[r] = place[first_of(before, tables_.rows[r].bodies[0])];
}

void Branches::take(const std::vector<int>& rows)
{
    if (rows == rows_) return;
    rows_ = rows;
    for (Mechanism& one : mechanisms_) {
        one.rows.clear();
        for (Known& known : one.known) known.t = std::numeric_limits<double>::quiet_NaN();
    }
    for (const int r : rows)
        if (mechanism_of_[r] >= 0) mechanisms_[mechanism_of_[r]].rows.push_back(r);
}

const double* Branches::X(const Place& place, int node) const
{
    return place.nodes.X(place.element * rule_.degree + node);
}

bool Branches::is_open(const Mechanism& one, Instant at, const double* X, double most) const
{
    return std::ranges::any_of(one.rows, [&](int r) {
        return !(std::abs(tables_.rows.value(r, at, X)) <= most * tables_.rows[r].row->scale);
    });
}

/// Rows that are linear in X hold between nodes as well: there it is the directors that give way.
bool Branches::is_bent(const Mechanism& one) const
{
    for (const int b : one.bodies) {
        if (tables_.bodies[b].dofs == 3) continue;
        const double* d = X_.data() + 12 * b + 3;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) {
                double product = i == j ? -1 : 0;
                for (int k = 0; k < 3; ++k) product += d[3 * i + k] * d[3 * j + k];
                if (!(std::abs(product) <= open_between)) return true;
            }
    }
    return false;
}

bool Branches::is_open_between(const Mechanism& one, const Place& place, int from)
{
    const double first = rule_.nodes[from], length = rule_.nodes[from + 1] - first;
    for (int i = 1; i < looks; ++i) {
        const double share = first + length * i / looks;
        basis_->values(share, values_);
        for (const int b : one.bodies) {
            double* at = X_.data() + 12 * b;
            std::fill(at, at + 12, 0.0);
            for (int a = 0; a <= rule_.degree; ++a)
                for (int k = 0; k < 12; ++k) at[k] += values_[a] * X(place, a)[12 * b + k];
        }
        const double t = place.stretch.times[place.element] + share * place.stretch.h(place.element);
        if (is_open(one, {t, Side::middle}, X_.data(), open_between) || is_bent(one)) return true;
    }
    return false;
}

Orientation& Branches::orientation(Mechanism& one, const Place& place, int node, const Orientation* beside)
{
    const Instant when = place.nodes.at(place.element * rule_.degree + node);
    const double* X_there = X(place, node);
    const auto is_there = [&](const Known& known) {
        const double* kept = known.X.data();
        return known.t == when.t && std::ranges::all_of(one.bodies, [&](int b) {
                   kept += 12;
                   return std::equal(kept - 12, kept, X_there + 12 * b);
               });
    };
    for (Known& known : one.known)
        if (is_there(known)) return known.of;
    Known& known = one.known[beside == &one.known[0].of ? 1 : 0];
    known.t = when.t;
    known.X.clear();
    for (const int b : one.bodies) known.X.insert(known.X.end(), X_there + 12 * b, X_there + 12 * (b + 1));
    known.of.place(tables_, one.rows, when, X_there);
    return known.of;
}

bool Branches::is_turned_over(Mechanism& one, const Place& place, int from, int to)
{
    const Orientation& before = orientation(one, place, from, nullptr);
    return orientation(one, place, to, &before).is_turned_over(before);
}

/// Over the whole element; of many rows only where their smallest pivot says that it is worth a look.
bool Branches::may_cross(Mechanism& one, const Place& place)
{
    const int p = rule_.degree;
    if (static_cast<int>(one.rows.size()) <= few_rows) return is_turned_over(one, place, 0, p);
    if (static_cast<int>(one.rows.size()) > most_rows) return false;
    double smallest = place.nodes.pivot(place.element * p), largest = smallest;
    for (int a = 1; a <= p; ++a) {
        smallest = std::min(smallest, place.nodes.pivot(place.element * p + a));
        largest = std::max(largest, place.nodes.pivot(place.element * p + a));
    }
    return smallest <= dip * largest;
}

bool Branches::leaves(Mechanism& one, const Place& place)
{
    if (is_open(one, place.nodes.at((place.element + 1) * rule_.degree), X(place, rule_.degree), open_at_end))
        return true;
    if (!may_cross(one, place)) return false;
    for (int a = 0; a < rule_.degree; ++a)
        if (is_turned_over(one, place, a, a + 1) && is_open_between(one, place, a)) return true;
    return false;
}

bool Branches::leaves(const Stretch& stretch, const Nodes& nodes, const std::vector<int>& rows, int e)
{
    if (mechanisms_.empty()) return false;
    take(rows);
    const Place place{stretch, nodes, e};
    return std::ranges::any_of(mechanisms_, [&](Mechanism& one) { return leaves(one, place); });
}

}   // namespace livens
