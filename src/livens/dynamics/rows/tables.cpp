// SPDX-License-Identifier: BSD-3-Clause
// Tables of a model, and gradients of rows by scaled twists: y = D^T [f; m] with the moment m about the
// centre of mass (docs/theory.md, "Eliminating the joint multipliers").
#include "livens/dynamics/rows/tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/multibody/model.h"

namespace livens {

namespace {

/// The rows of twist::rows, of the columns that are touched: about the reference point.
inline void plain_wrench(const RowTable& t, int side, const double* X, const double* g, double* q)
{
    const double *x = X + 12 * t.bodies[side], *load = g + 12 * side;
    std::fill(q, q + 6, 0.0);
    for (const int a : t.columns[side]) {
        if (a == 0) {
            for (int i = 0; i < 3; ++i) q[i] = load[i];
            continue;
        }
        q[3] += x[a + 1] * load[a + 2] - x[a + 2] * load[a + 1];
        q[4] += x[a + 2] * load[a] - x[a] * load[a + 2];
        q[5] += x[a] * load[a + 1] - x[a + 1] * load[a];
    }
}

}   // namespace

ModelTables::ModelTables(const Model& the_model, std::vector<int> rows_to_solve, bool with_rigidity,
                         std::shared_ptr<KnownPattern> known)
    : model(&the_model), bodies(the_model), rows(the_model, with_rigidity), loads(the_model),
      length(the_model.length()), n_twists(bodies.n_twists()), independent(std::move(rows_to_solve)),
      rank(static_cast<int>(independent.size())),
      known_pattern(known != nullptr ? std::move(known) : std::make_shared<KnownPattern>())
{
    // Outside of its reach a row is zero; inside too, where other bodies lie between its own.
    for (const RowTable& table : rows) {
        auto& [first, end] = reaches.emplace_back(std::array{n_twists, 0});
        for (const int b : table.bodies) {
            first = std::min(first, bodies[b].first);
            end = std::max(end, bodies[b].first + bodies[b].dofs);
        }
    }
}

int ModelTables::n_rows() const { return model->n_rows(); }

/// What is no number counts as violated.
int ModelTables::first_violated_beside(const std::vector<int>& held, Instant at, const double* X,
                                       double most) const
{
    std::vector<char> is_held(static_cast<std::size_t>(n_rows()), 0);
    for (const int r : held) is_held[r] = 1;
    for (int r = 0; r < n_rows(); ++r)
        if (is_held[r] == 0 && !(std::abs(rows.value(r, at, X)) <= most * rows[r].row->scale)) return r;
    return -1;
}

void ModelTables::wrench(int r, int side, const double* X, const double* maps, const double* g,
                         double* q) const
{
    const int body = rows[r].bodies[side];
    plain_wrench(rows[r], side, X, g, q);
    if (bodies[body].offset) BodyTables::to_centre(maps + 12 * body, q);
}

void ModelTables::scaled_wrench(int r, int side, const double* X, const double* g, double* y) const
{
    const int body = rows[r].bodies[side];
    double map[12] = {}, q[6];
    bodies.map_twist(body, X, map);
    plain_wrench(rows[r], side, X, g, q);
    if (bodies[body].offset) BodyTables::to_centre(map, q);
    std::fill(y, y + 6, 0.0);
    scale_row(bodies[body], map, q, y);
}

void ModelTables::add_wrenches(int r, const double* X, const double* maps, const double* g, double factor,
                               double* q) const
{
    for (int side = 0; side < rows[r].n_sides; ++side) {
        const BodyTable& body = bodies[rows[r].bodies[side]];
        double of_side[6];
        wrench(r, side, X, maps, g, of_side);
        for (int i = 0; i < body.dofs; ++i) q[body.first + i] += factor * of_side[i];
    }
}

double ModelTables::scaled_gradient(int r, const double* X, const double* maps, const double* g,
                                    double* out) const
{
    const RowTable& table = rows[r];
    int n_own = 0;   // which are set below
    for (const int b : table.bodies) n_own += bodies[b].dofs;
    if (n_own < n_twists) std::fill_n(out, n_twists, 0.0);
    double square = 0;
    for (int side = 0; side < table.n_sides; ++side) {
        const BodyTable& body = bodies[table.bodies[side]];
        const double* map = maps + 12 * table.bodies[side];
        double *y = out + body.first, of_side = 0, q[6];
        plain_wrench(table, side, X, g, q);
        if (body.offset) BodyTables::to_centre(map, q);
        scale_row(body, map, q, y);
        // Each side by itself: the sum of two sides is the same to the bit in either order.
        for (int i = 0; i < 3; ++i) of_side += y[i] * y[i];
        for (int i = 3; i < 6 && body.dofs == 6; ++i) of_side += y[i] * y[i];
        square += of_side;
    }
    return square;
}

}   // namespace livens
