// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/lobatto/branches.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace livens {

namespace {

constexpr int few_rows = 60, most_rows = 300;   // orientations cost their cube
constexpr double dip = 0.5;   // of pivots in an element: nodes beside a singular position have less
constexpr double open_at_end = 1e-9, open_between = 1e-10;   // of a row's scale
constexpr int looks = 8;                                     // between two nodes

}   // namespace

Branches::Branches(const Tables& tables, const ElementRule& rule) : tables_(tables), rule_(rule)
{
    const Model& model = *tables.model;
    has_loops_ = static_cast<int>(model.joints().size()) > model.n_bodies() && tables.rank <= most_rows;
    if (!has_loops_) return;
    basis_ = basis_on(rule.points, rule.degree);
    values_.assign(rule.nodes.size(), 0.0);
    X_.assign(12 * tables.bodies.size(), 0.0);
}

Instant Branches::at(const Place& place, double share) const
{
    return {place.stretch.times[place.element] + share * place.stretch.h(place.element), Side::middle};
}

const double* Branches::X(const Place& place, int node) const
{
    return place.nodes.X(place.element * rule_.degree + node);
}

bool Branches::is_open(const std::vector<int>& rows, Instant at, double most) const
{
    return std::ranges::any_of(rows, [&](int r) {
        return !(std::abs(tables_.value(r, at, X_.data())) <= most * tables_.rows[r].row->scale);
    });
}

/// Rows that are linear in X hold between nodes as well: there it is the directors that give way.
bool Branches::is_bent() const
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
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

bool Branches::is_open_between(const Place& place, int from)
{
    const double first = rule_.nodes[from], length = rule_.nodes[from + 1] - first;
    for (int i = 1; i < looks; ++i) {
        const double share = first + length * i / looks;
        basis_->values(share, values_);
        std::ranges::fill(X_, 0.0);
        for (int a = 0; a <= rule_.degree; ++a)
            for (std::size_t k = 0; k < X_.size(); ++k) X_[k] += values_[a] * X(place, a)[k];
        if (is_open(place.rows, at(place, share), open_between) || is_bent()) return true;
    }
    return false;
}

const Orientation& Branches::orientation(const Place& place, int node, const Orientation* beside)
{
    const Instant when = at(place, rule_.nodes[node]);
    const std::span<const double> where(X(place, node), X_.size());
    for (Known& known : known_)
        if (known.t == when.t && known.rows == place.rows && std::ranges::equal(known.X, where))
            return known.of;
    Known& known = known_[beside == &known_[0].of ? 1 : 0];
    known.t = when.t;
    known.rows = place.rows;
    known.X.assign(where.begin(), where.end());
    known.of.place(tables_, place.rows, when, where.data());
    return known.of;
}

bool Branches::is_turned_over(const Place& place, int from, int to)
{
    const Orientation& before = orientation(place, from, nullptr);
    return orientation(place, to, &before).is_turned_over(before);
}

/// Over the whole element; of many rows only where their smallest pivot says that it is worth a look.
bool Branches::may_cross(const Place& place)
{
    const int p = rule_.degree;
    if (static_cast<int>(place.rows.size()) <= few_rows) return is_turned_over(place, 0, p);
    double smallest = place.nodes.pivot(place.element * p), largest = smallest;
    for (int a = 1; a <= p; ++a) {
        smallest = std::min(smallest, place.nodes.pivot(place.element * p + a));
        largest = std::max(largest, place.nodes.pivot(place.element * p + a));
    }
    return smallest <= dip * largest;
}

bool Branches::leaves(const Stretch& stretch, const Nodes& nodes, const std::vector<int>& rows, int e)
{
    const Place place{stretch, nodes, rows, e};
    if (!has_loops_) return false;
    std::copy_n(X(place, rule_.degree), X_.size(), X_.begin());
    if (is_open(rows, at(place, 1), open_at_end)) return true;
    if (!may_cross(place)) return false;
    for (int a = 0; a < rule_.degree; ++a)
        if (is_turned_over(place, a, a + 1) && is_open_between(place, a)) return true;
    return false;
}

}   // namespace livens
