// SPDX-License-Identifier: BSD-3-Clause
// The twist Jacobian at one configuration as [Y Z][R; 0]: theory.md, "Eliminating the joint multipliers".
// Rows are scaled to norm 1 first, so that pivots tell angles between rows and not their units.
#include "livens/dynamics/rows/constraint_basis.h"

#include <algorithm>
#include <cmath>

namespace livens {

void ConstraintBasis::resize(const ModelTables& tables, bool all_rows)
{
    const int most = all_rows ? tables.n_rows() : tables.rank;
    q.resize(tables.n_twists, most);
    rows.assign(static_cast<std::size_t>(tables.rank), 0);
    row_scale.assign(static_cast<std::size_t>(most), 1.0);
    longest_gradient = tables.rows.longest_gradient();
    gradients.assign(static_cast<std::size_t>(longest_gradient * most), 0.0);
}

double ConstraintBasis::fill(const ModelTables& tables, int column, int row, Instant at, const double* X,
                             const double* maps)
{
    double* g = gradients.data() + longest_gradient * column;
    double* out = q.column(column);
    tables.rows.gradient(row, at, X, g);
    tables.scaled_gradient(row, X, maps, g, out);
    // Of few bodies their entries alone, upwards, whichever body comes first in the joint.
    const RowTable& table = tables.rows[row];
    const bool are_few = table.n_sides == 1 || table.n_sides == 2;
    const int low = are_few ? std::min(table.bodies[0], table.bodies[table.n_sides - 1]) : 0,
              high = are_few ? std::max(table.bodies[0], table.bodies[table.n_sides - 1])
                             : tables.n_bodies() - 1;
    const auto end_of = [&](int body) { return tables.bodies[body].first + tables.bodies[body].dofs; };
    q.reach_of(column, tables.bodies[low].first, end_of(high));
    const auto for_entries = [&](const auto& act) {
        const auto run = [&](int first, int end) {
            for (int i = first; i < end; ++i) act(out[i]);
        };
        if (!are_few) return run(0, tables.n_twists);
        run(tables.bodies[low].first, end_of(low));
        if (high != low) run(tables.bodies[high].first, end_of(high));
    };
    double sum = 0;
    for_entries([&](double entry) { sum += entry * entry; });
    // A row without a gradient stays zero: its pivot then says that rank is lost.
    const double scale = sum > 0 ? 1 / std::sqrt(sum) : 1.0;
    for_entries([&](double& entry) { entry *= scale; });
    return scale;
}

double ConstraintBasis::build(const ModelTables& tables, Instant at, const double* X, const double* maps,
                              const std::vector<int>& which, bool keep_choices)
{
    rows = which;
    for (int c = 0; c < tables.rank; ++c) row_scale[c] = fill(tables, c, which[c], at, X, maps);
    return smallest_pivot = q.factorise(tables.rank, keep_choices);
}

double ConstraintBasis::choose(const ModelTables& tables, Instant at, const double* X, const double* maps)
{
    const int all = tables.n_rows();
    std::vector<int> order(static_cast<std::size_t>(all));
    for (int r = 0; r < all; ++r) row_scale[r] = fill(tables, r, r, at, X, maps);
    // Column exchanges choose the rows that hold best here; their number is known from the start.
    smallest_pivot = q.factorise_pivoted(tables.rank, order);
    const std::vector<double> unsorted = gradients, scales = row_scale;
    for (int c = 0; c < tables.rank; ++c) {
        rows[c] = order[c];
        row_scale[c] = scales[order[c]];
        std::copy_n(unsorted.begin() + longest_gradient * order[c], longest_gradient,
                    gradients.begin() + longest_gradient * c);
    }
    return smallest_pivot;
}

}   // namespace livens
