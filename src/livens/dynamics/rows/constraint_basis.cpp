// SPDX-License-Identifier: BSD-3-Clause
// The twist Jacobian at one configuration as [Y Z][R; 0]: theory.md, "Eliminating the joint multipliers".
// Rows are scaled to norm 1 first, so that pivots tell angles between rows and not their units.
#include "livens/dynamics/rows/constraint_basis.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/rows/tables.h"

namespace livens {

double KnownColumns::take(int row, double* column, int n_twists) const
{
    std::fill_n(column, n_twists, 0.0);
    for (int e = begin[2 * row]; e < begin[2 * row + 2]; ++e) column[twist[e]] = values[e * apart];
    return scales[row * apart];
}

void ConstraintBasis::resize(const ModelTables& tables, bool all_rows)
{
    const int most = all_rows ? tables.n_rows() : tables.rank;
    q.resize(tables.n_twists, most);
    rows.assign(static_cast<std::size_t>(tables.rank), 0);
    longest_gradient = tables.rows.longest_gradient();
    gradients.assign(static_cast<std::size_t>((longest_gradient + 1) * most), 0.0);
}

void ConstraintBasis::fill(const ModelTables& tables, int column, int row, Instant at, const double* X,
                           const double* maps, const KnownColumns& known)
{
    double* g = gradients.data() + (longest_gradient + 1) * column;
    double* out = q.column(column);
    tables.rows.gradient(row, at, X, g);
    const auto [first, end] = tables.reaches[row];
    q.reach_of(column, first, end);
    if (known.knows(column)) {
        g[longest_gradient] = known.take(column, out, tables.n_twists);
        return;
    }
    const double square = tables.scaled_gradient(row, X, maps, g, out);
    // A row without a gradient stays zero: its pivot then says that rank is lost.
    const double scale = square > 0 ? 1 / std::sqrt(square) : 1;
    for (int i = first; i < end; ++i) out[i] *= scale;
    g[longest_gradient] = scale;
}

/// keep_choices: Z has to vary smoothly while a tangent is in use that an earlier basis was made for.
double ConstraintBasis::build(const ModelTables& tables, Instant at, const double* X, const double* maps,
                              const std::vector<int>& which, bool keep_choices, const KnownColumns& known)
{
    rows = which;
    for (int c = 0; c < tables.rank; ++c) fill(tables, c, which[c], at, X, maps, known);
    return smallest_pivot = q.factorise(tables.rank, keep_choices);
}

double ConstraintBasis::choose(const ModelTables& tables, Instant at, const double* X, const double* maps)
{
    const int all = tables.n_rows();
    std::vector<int> order(static_cast<std::size_t>(all));
    for (int r = 0; r < all; ++r) fill(tables, r, r, at, X, maps, {});
    // Column exchanges choose the rows that hold best here; their number is known from the start.
    smallest_pivot = q.factorise_pivoted(tables.rank, order);
    const std::vector<double> unsorted = gradients;
    const int of_row = longest_gradient + 1;
    for (int c = 0; c < tables.rank; ++c) {
        rows[c] = order[c];
        std::copy_n(unsorted.begin() + of_row * order[c], of_row, gradients.begin() + of_row * c);
    }
    return smallest_pivot;
}

}   // namespace livens
