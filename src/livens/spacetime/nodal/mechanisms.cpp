// SPDX-License-Identifier: BSD-3-Clause
// Bodies that hang together by rows, as sets that are united row by row. A tree has as many joints as bodies,
// one less where it floats: it has no position in which it locks. Whatever has more joints is a mechanism of
// loops or drives (docs/theory.md, "Singular positions").
#include "livens/spacetime/nodal/mechanisms.h"

#include <numeric>

namespace livens {

namespace {

/// The first of the bodies that hang together with this one.
int first_of(std::vector<int>& before, int body)
{
    while (before[body] != body) body = before[body] = before[before[body]];
    return body;
}

}   // namespace

std::vector<Mechanism> closed_mechanisms(const Tables& tables)
{
    const int n = tables.n_bodies();
    std::vector<int> before(n);
    std::iota(before.begin(), before.end(), 0);
    for (const auto& row : tables.rows)
        for (int side = 1; side < row.n_sides; ++side)
            before[first_of(before, row.bodies[side])] = first_of(before, row.bodies[0]);
    std::vector<int> n_bodies(n, 0), n_joints(n, 0), place(n, -1);
    std::vector<bool> is_tied(n, false);
    for (int b = 0; b < n; ++b) ++n_bodies[first_of(before, b)];
    for (int r = 0; r < tables.n_rows(); ++r) {
        const int first = first_of(before, tables.rows[r].bodies[0]);
        if (r == tables.model->first_row(tables.model->row_joint(r))) ++n_joints[first];
        if (tables.rows[r].n_sides == 1) is_tied[first] = true;   // to the world
    }
    std::vector<Mechanism> found;
    for (int b = 0; b < n; ++b) {
        const int first = first_of(before, b);
        if (n_joints[first] < n_bodies[first] + (is_tied[first] ? 1 : 0)) continue;
        if (place[first] < 0) {
            place[first] = static_cast<int>(found.size());
            found.emplace_back();
        }
        found[place[first]].bodies.push_back(b);
    }
    for (int r = 0; r < tables.n_rows(); ++r)
        if (const int at = place[first_of(before, tables.rows[r].bodies[0])]; at >= 0)
            found[at].rows.push_back(r);
    return found;
}

}   // namespace livens
