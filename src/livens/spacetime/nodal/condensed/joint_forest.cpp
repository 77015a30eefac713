// SPDX-License-Identifier: BSD-3-Clause
// Breadth first from the world. All rows between a body and the one from which it was reached hold it; a row
// that is left over closes a loop, and then there is no forest (docs/theory.md, "The whole matrix of
// lobatto", Along the joints).
#include "livens/spacetime/nodal/condensed/joint_forest.h"

#include <algorithm>

#include "livens/multibody/model.h"

namespace livens {

std::optional<JointForest> JointForest::of(const ModelTables& tables)
{
    JointForest forest;
    if (tables.rank != static_cast<int>(tables.rows.size())) return {};
    if (!forest.grow(tables) || !forest.are_loads_between(tables)) return {};
    return forest;
}

/// From the world, and from a body of each part that floats.
bool JointForest::grow(const ModelTables& tables)
{
    const int n = tables.n_bodies();
    std::vector<std::vector<int>> rows_of(static_cast<std::size_t>(n));
    for (std::size_t r = 0; r < tables.rows.size(); ++r) {
        if (tables.rows[r].n_sides > 2) return false;
        for (const int b : tables.rows[r].bodies) rows_of[b].push_back(static_cast<int>(r));
    }
    bodies.assign(static_cast<std::size_t>(n), {});
    held.assign(tables.rows.size(), world);
    std::vector<char> is_reached(static_cast<std::size_t>(n), 0);
    // the rows by which a body hangs on this parent become its own
    const auto reach = [&](int b, int parent) {
        is_reached[b] = 1;
        bodies[b].parent = parent;
        for (const int r : rows_of[b]) {
            const std::vector<int>& of_row = tables.rows[r].bodies;
            const int other = of_row.size() == 1 ? world : of_row[0] == b ? of_row[1] : of_row[0];
            if (other != parent) continue;
            held[r] = b;
            bodies[b].rows.push_back(r);
        }
        order.push_back(b);
    };
    const auto reach_from = [&](std::size_t at) {
        for (; at < order.size(); ++at)
            for (const int r : rows_of[order[at]])
                for (const int b : tables.rows[r].bodies)
                    if (!is_reached[b]) reach(b, order[at]);
    };
    for (std::size_t r = 0; r < tables.rows.size(); ++r)
        if (tables.rows[r].n_sides == 1 && !is_reached[tables.rows[r].bodies[0]])
            reach(tables.rows[r].bodies[0], world);
    reach_from(0);
    for (int b = 0; b < n; ++b) {
        if (is_reached[b]) continue;
        reach(b, world);
        reach_from(order.size() - 1);
    }
    std::ranges::reverse(order);
    for (int b = 0; b < n; ++b) {
        bodies[b].d = tables.bodies[b].dofs;
        bodies[b].f = bodies[b].d - static_cast<int>(bodies[b].rows.size());
        if (bodies[b].f < 0) return false;
    }
    return std::ranges::find(held, world) == held.end();   // else it closes a loop
}

/// A slope between other bodies than a child and its parent would fill in blocks that nobody has.
bool JointForest::are_loads_between(const ModelTables& tables) const
{
    for (const int l : tables.loads.with_tangent)
        for (const int a : tables.model->loads()[l].bodies)
            for (const int b : tables.model->loads()[l].bodies)
                if (a != b && a != world && b != world && bodies[a].parent != b && bodies[b].parent != a)
                    return false;
    return true;
}

}   // namespace livens
