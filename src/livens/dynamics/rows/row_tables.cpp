// SPDX-License-Identifier: BSD-3-Clause
// Rows as tables of what is not zero: a joint's row touches few columns of its bodies (docs/theory.md,
// "Joints are quadratic forms").
#include "livens/dynamics/rows/row_tables.h"

#include <algorithm>

#include "livens/multibody/model.h"

namespace livens {

namespace {

/// Whether the gradient of a form by X_i, or X_j, may have a column other than zero.
bool touches(const QuadraticForm& form, bool is_i, int column)
{
    bool touched = norm((is_i ? form.b_i : form.b_j).column(column)) > 0;
    for (int k = 0; k < 4; ++k) {
        const double cross = is_i ? form.c_ij(column, k) : form.c_ij(k, column);
        touched = touched || cross != 0 || (is_i ? form.c_ii : form.c_jj)(k, column) != 0;
    }
    return touched;
}

/// Of all forms of a row, those of drives and coordinates too.
void find_columns(const RowBodies& bodies, RowTable& table)
{
    bool touched[RowBodies::most][4];
    std::fill_n(touched[0], 4 * bodies.size, false);
    const auto look = [&](const QuadraticForm& form, int i, int j) {
        for (int column = 0; column < 4; ++column) {
            if (i != world && touches(form, true, column)) touched[bodies.find(i)][column] = true;
            if (touches(form, false, column)) touched[bodies.find(j)][column] = true;
        }
    };
    const ConstraintRow& row = *table.row;
    look(row, row.body_i, row.body_j);
    for (const Drive& drive : row.drives) look(drive.form, row.body_i, row.body_j);
    for (const PairForm& q : row.coordinates) look(q, q.body_i, q.body_j);
    table.columns.resize(static_cast<std::size_t>(bodies.size));
    for (int side = 0; side < bodies.size; ++side) {
        RowTable::Columns& columns = table.columns[side];
        for (int column = 0; column < 4; ++column)
            if (touched[side][column]) columns.at[columns.n++] = 3 * column;
    }
}

/// Terms with the world are in B and c already, so that such a row has one side.
RowTable row_table(const ConstraintRow& row)
{
    RowTable table;
    table.row = &row;
    const RowBodies bodies = row_bodies(row);
    table.n_sides = bodies.size;
    table.bodies.assign(bodies.begin(), bodies.end());
    find_columns(bodies, table);
    table.is_quadratic = row.is_quadratic();
    if (!table.is_quadratic) return table;
    const int last = table.n_sides - 1;   // body_j; body_i is side 0 unless it is the world
    if (last == 1) {
        table.K[0][0] = row.c_ii;
        table.K[0][1] = row.c_ij;
        table.K[1][0] = transpose(row.c_ij);
        table.B[0] = row.b_i;
    }
    table.K[last][last] = row.c_jj;
    table.B[last] = row.b_j;
    for (int from = 0; from < table.n_sides; ++from)
        for (int to = 0; to < table.n_sides; ++to)
            for (int b = 0; b < 4; ++b)
                for (int a = 0; a < 4; ++a)
                    if (table.K[from][to](a, b) != 0)
                        table.form.push_back({from, 3 * a, to, 3 * b, table.K[from][to](a, b)});
    return table;
}

/// x^T K x of a quadratic form.
double form_at(const RowTable& t, const double* X)
{
    double sum = 0;
    for (const auto& entry : t.form) {
        const double* from = X + 12 * t.bodies[entry.from_side] + entry.from;
        const double* to = X + 12 * t.bodies[entry.to_side] + entry.to;
        sum += entry.value * (from[0] * to[0] + from[1] * to[1] + from[2] * to[2]);
    }
    return sum;
}

}   // namespace

RowTables::RowTables(const Model& model, bool with_rigidity)
{
    for (int b = 0; with_rigidity && b < model.n_bodies(); ++b)
        if (!model.bodies()[b].is_point)
            for (const ConstraintRow& row : rigidity_rows(b)) rigidity_.push_back(row);
    for (int r = 0; r < model.n_rows(); ++r) tables_.push_back(row_table(model.row(r)));
    for (const ConstraintRow& row : rigidity_) tables_.push_back(row_table(row));
    for (const RowTable& table : tables_) longest_gradient_ = std::max(longest_gradient_, 12 * table.n_sides);
}

bool RowTables::are_quadratic() const { return std::ranges::all_of(tables_, &RowTable::is_quadratic); }

void RowTables::gradient(int r, Instant at, const double* X, double* g) const
{
    const RowTable& t = tables_[r];
    if (!t.is_quadratic) {
        const RowGradient gradient = constraint_gradient(*t.row, at, Configurations(X));
        for (int side = 0; side < t.n_sides; ++side) std::copy_n(gradient.by[side].a, 12, g + 12 * side);
        return;
    }
    for (int side = 0; side < t.n_sides; ++side)
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i) g[12 * side + a + i] = t.B[side].a[a + i];
    for (const auto& entry : t.form) {
        const double* x = X + 12 * t.bodies[entry.from_side] + entry.from;
        double* out = g + 12 * entry.to_side + entry.to;
        for (int i = 0; i < 3; ++i) out[i] += entry.value * x[i];
    }
}

/// A quadratic polynomial has Phi(X) - Phi(X_0) = 1/2 <grad Phi(X_0) + grad Phi(X), X - X_0>, which does not
/// lose the digits of a small increment.
double RowTables::change(int r, const double* g_from, const double* g_to, const double* step) const
{
    const RowTable& t = tables_[r];
    double sum = 0;
    for (int side = 0; side < t.n_sides; ++side) {
        const double* d = step + 12 * t.bodies[side];
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i)
                sum += (g_from[12 * side + a + i] + g_to[12 * side + a + i]) * d[a + i];
    }
    return 0.5 * sum;
}

/// A row with drives is no quadratic form alone.
double RowTables::rate(int r, Instant at, const double* X) const
{
    return tables_[r].is_quadratic ? 0 : constraint_rate(*tables_[r].row, at, Configurations(X));
}

/// <g, X> = <X K, X> + <B, X>: half of it lacks half of the linear part.
double RowTables::value(int r, Instant at, const double* X, const double* g) const
{
    const RowTable& t = tables_[r];
    if (!t.is_quadratic) return constraint_value(*t.row, at, Configurations(X));
    double sum = 0;
    for (int side = 0; side < t.n_sides; ++side) {
        const double* x = X + 12 * t.bodies[side];
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i) sum += (g[12 * side + a + i] + t.B[side].a[a + i]) * x[a + i];
    }
    return 0.5 * sum + t.row->c;
}

double RowTables::value(int r, Instant at, const double* X) const
{
    // By the gradient, which has the differences of places: squares of these would have no digits far away.
    double g[gradient_size];
    if (tables_[r].is_quadratic) gradient(r, at, X, g);   // others do not look at it
    return value(r, at, X, g);
}

double RowTables::curvature(int r, Instant at, const double* X, const double* V) const
{
    const RowTable& t = tables_[r];
    if (!t.is_quadratic) return constraint_curvature(*t.row, at, Configurations(X), Configurations(V));
    return form_at(t, V);
}

}   // namespace livens
