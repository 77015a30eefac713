// SPDX-License-Identifier: BSD-3-Clause
// A spanning forest of the joints: rows along it are judged joint by joint on six columns, whatever the
// length of a chain. theory.md, "Rank is geometry", says why that suffices, and what is left to the other
// judge.
#include "livens/dynamics/rows/forest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "livens/multibody/constraint.h"
#include "livens/multibody/motion.h"

namespace livens::inline dynamics_internal {

namespace {

/// Rows between the same two bodies; the world is -1.
struct Edge {
    int ends[2];
    std::vector<int> rows;
};

/// In the order of their first rows. Rows of other than one or two bodies go to `rest`.
std::vector<Edge> edges_of(const std::vector<BodyRow>& rows, int n_bodies, std::vector<int>& rest)
{
    std::vector<Edge> edges;
    std::vector<std::vector<int>> of_body(static_cast<std::size_t>(n_bodies));   // by the larger end
    for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
        const auto& parts = rows[k].parts;
        if (parts.empty() || parts.size() > 2) {
            rest.push_back(k);
            continue;
        }
        const int one = parts[0].body, two = parts.size() > 1 ? parts[1].body : world;
        std::vector<int>& known = of_body[std::max(one, two)];
        const auto found =
            std::ranges::find(known, std::min(one, two), [&](int e) { return edges[e].ends[0]; });
        if (found != known.end()) {
            edges[*found].rows.push_back(k);
            continue;
        }
        known.push_back(static_cast<int>(edges.size()));
        edges.push_back({{std::min(one, two), std::max(one, two)}, {k}});
    }
    return edges;
}

/// Of the rows of one joint those that are independent on one body, in their order, by orthogonalisation,
/// twice for what rounding leaves.
class JointRows {
public:
    /// The pivot of a row that is taken, else 0.
    double take(const BodyRow& row, int body, double least)
    {
        if (n_ == 6) return 0;
        const auto part = std::ranges::find(row.parts, body, &BodyRow::Part::body);
        double* x = taken_[n_];
        std::copy_n(part->entries, 6, x);
        for (int pass = 0; pass < 2; ++pass)
            for (int k = 0; k < n_; ++k) {
                const double along = std::inner_product(x, x + 6, taken_[k], 0.0);
                for (int i = 0; i < 6; ++i) x[i] -= along * taken_[k][i];
            }
        const double pivot = std::sqrt(std::inner_product(x, x + 6, x, 0.0));
        if (!(pivot > least)) return 0;
        for (int i = 0; i < 6; ++i) x[i] /= pivot;
        ++n_;
        return pivot;
    }

private:
    double taken_[6][6];
    int n_ = 0;
};

/// Bodies that hang together.
class Groups {
public:
    explicit Groups(int n_bodies) : next_(static_cast<std::size_t>(n_bodies + 1))
    {
        std::iota(next_.begin(), next_.end(), 0);
    }
    /// False if they are together already.
    bool join(int one, int two)
    {
        const int a = root(one + 1), b = root(two + 1);
        next_[std::max(a, b)] = std::min(a, b);   // the world stays a root
        return a != b;
    }

private:
    int root(int i)
    {
        for (; next_[i] != i; i = next_[i]) next_[i] = next_[next_[i]];
        return i;
    }
    std::vector<int> next_;
};

}   // namespace

Forest spanning_forest(const std::vector<BodyRow>& rows, int n_bodies, double least)
{
    Forest forest;
    const std::vector<Edge> edges = edges_of(rows, n_bodies, forest.closing);
    std::vector<std::vector<const Edge*>> at(static_cast<std::size_t>(n_bodies + 1));
    Groups groups(n_bodies);
    for (const Edge& edge : edges) {
        // A joint between bodies that hang together already closes a loop, and has no outer body of its own.
        if (groups.join(edge.ends[0], edge.ends[1])) {
            for (const int end : edge.ends) at[end + 1].push_back(&edge);
        } else {
            forest.closing.insert(forest.closing.end(), edge.rows.begin(), edge.rows.end());
        }
    }
    std::vector<bool> is_reached(static_cast<std::size_t>(n_bodies + 1), false);
    std::vector<int> front;
    for (int root = world; root < n_bodies; ++root) {
        if (is_reached[root + 1]) continue;
        is_reached[root + 1] = true;
        for (front.assign(1, root); !front.empty();) {
            const int inner = front.back();
            front.pop_back();
            for (const Edge* edge : at[inner + 1]) {
                const int outer = edge->ends[edge->ends[0] == inner ? 1 : 0];
                if (is_reached[outer + 1]) continue;
                is_reached[outer + 1] = true;
                front.push_back(outer);
                JointRows joint;
                for (const int k : edge->rows) {
                    const double pivot = joint.take(rows[k], outer, least);
                    if (pivot > 0) forest.smallest_pivot = std::min(forest.smallest_pivot, pivot);
                    (pivot > 0 ? forest.rows : forest.closing).push_back(k);
                }
            }
        }
    }
    std::ranges::sort(forest.rows);
    std::ranges::sort(forest.closing);
    return forest;
}

std::vector<SparseRows::Entry> entries_of(const std::vector<BodyRow>& rows, const std::vector<int>& which)
{
    std::vector<SparseRows::Entry> entries;
    for (int k = 0; k < static_cast<int>(which.size()); ++k)
        for (const BodyRow::Part& part : rows[which[k]].parts)
            for (int i = 0; i < 6; ++i) entries.push_back({k, 6 * part.body + i, part.entries[i]});
    return entries;
}

}   // namespace livens::inline dynamics_internal
