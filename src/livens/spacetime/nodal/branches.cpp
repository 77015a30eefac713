// SPDX-License-Identifier: BSD-3-Clause
// An element has passed a position in which rows lose rank if det G_a G_b^T < 0 between two of its nodes.
// Samples of the polynomial between these nodes then decide whether the mechanism passed through, with joints
// closed and bodies rigid, or jumped to another branch (docs/theory.md, "Singular positions", Branches).
#include "livens/spacetime/nodal/branches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "livens/multibody/model.h"
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

Branches::Branches(const ModelTables& tables, const ElementRule& rule) : tables_(tables), rule_(rule)
{
    find_mechanisms();
    if (!mechanisms_.empty()) path_.emplace(tables, rule);
}

/// A tree has as many joints as bodies, one less if it floats, and cannot lock. Connected bodies with more
/// joints form a mechanism of loops or drives.
void Branches::find_mechanisms()
{
    const int n = tables_.n_bodies();
    std::vector<int> before(n);
    std::iota(before.begin(), before.end(), 0);
    for (const auto& row : tables_.rows)
        for (int side = 1; side < row.n_sides; ++side)
            before[first_of(before, row.bodies[side])] = first_of(before, row.bodies[0]);
    std::vector<int> n_bodies(n, 0), n_joints(n, 0), place(n, -1);
    std::vector<bool> is_tied(n, false);
    for (int b = 0; b < n; ++b) ++n_bodies[first_of(before, b)];
    for (int r = 0; r < tables_.n_rows(); ++r) {
        const int first = first_of(before, tables_.rows[r].bodies[0]);
        if (r == tables_.model->first_row(tables_.model->row_joint(r))) ++n_joints[first];
        if (tables_.rows[r].n_sides == 1) is_tied[first] = true;   // to the world
    }
    for (int b = 0; b < n; ++b) {
        const int first = first_of(before, b);
        if (n_joints[first] < n_bodies[first] + (is_tied[first] ? 1 : 0)) continue;
        if (place[first] < 0) {
            place[first] = static_cast<int>(mechanisms_.size());
            mechanisms_.emplace_back();
        }
        mechanisms_[place[first]].bodies.push_back(b);
    }
    for (int r = 0; r < tables_.n_rows(); ++r)
        if (const int at = place[first_of(before, tables_.rows[r].bodies[0])]; at >= 0)
            mechanisms_[at].all_rows.push_back(r);
}

void Branches::take(const std::vector<int>& rows)
{
    if (rows == rows_) return;
    rows_ = rows;
    for (Mechanism& one : mechanisms_) {
        one.rows.clear();
        for (Known& known : one.known) known.t = std::numeric_limits<double>::quiet_NaN();
        for (const int r : rows)
            if (std::ranges::binary_search(one.all_rows, r)) one.rows.push_back(r);
    }
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
        const double* d = path_->X() + 12 * b + 3;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) {
                double product = i == j ? -1 : 0;
                for (int k = 0; k < 3; ++k) product += d[3 * i + k] * d[3 * j + k];
                if (!(std::abs(product) <= open_between)) return true;
            }
    }
    return false;
}

bool Branches::is_open_between(const Mechanism& one, int from)
{
    const double first = rule_.nodes[from], length = rule_.nodes[from + 1] - first;
    for (int i = 1; i < looks; ++i) {
        path_->go(first + length * i / looks, one.bodies);
        if (is_open(one, path_->at(), path_->X(), open_between) || is_bent(one)) return true;
    }
    return false;
}

Orientation& Branches::orientation(Mechanism& one, int node, const Orientation* beside)
{
    const Instant when = nodes_->at(first_ + node);
    const double* X_there = nodes_->X(first_ + node);
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

bool Branches::is_turned_over(Mechanism& one, int from, int to)
{
    const Orientation& before = orientation(one, from, nullptr);
    return orientation(one, to, &before).is_turned_over(before);
}

/// Over the whole element; of many rows only where their smallest pivot says that it is worth a look.
bool Branches::may_cross(Mechanism& one)
{
    const int p = rule_.degree;
    if (static_cast<int>(one.rows.size()) <= few_rows) return is_turned_over(one, 0, p);
    if (static_cast<int>(one.rows.size()) > most_rows) return false;
    double smallest = nodes_->pivot(first_), largest = smallest;
    for (int a = 1; a <= p; ++a) {
        smallest = std::min(smallest, nodes_->pivot(first_ + a));
        largest = std::max(largest, nodes_->pivot(first_ + a));
    }
    return smallest <= dip * largest;
}

bool Branches::leaves(Mechanism& one)
{
    const int end = first_ + rule_.degree;
    if (is_open(one, nodes_->at(end), nodes_->X(end), open_at_end)) return true;
    if (!may_cross(one)) return false;
    for (int a = 0; a < rule_.degree; ++a)
        if (is_turned_over(one, a, a + 1) && is_open_between(one, a)) return true;
    return false;
}

bool Branches::leaves(const WindowLayout& layout, const Nodes& nodes, const std::vector<int>& rows, int e)
{
    if (mechanisms_.empty()) return false;
    take(rows);
    path_->begin(layout, nodes, e);
    nodes_ = &nodes;
    first_ = e * rule_.degree;
    return std::ranges::any_of(mechanisms_, [this](Mechanism& one) { return leaves(one); });
}

}   // namespace livens
