// SPDX-License-Identifier: BSD-3-Clause
// X of a body as twelve free numbers, or three of a point mass, with the rows of joints (P27) and of rigidity
// (P4) (docs/theory.md, "The elements of the paper", "Joints are quadratic forms"). Rows are quadratic, so
// that Hessians are constant; which entries of them and of gradients can differ from zero is found once.
#include "livens/spacetime/mixed/coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/mass_properties.h"
#include "livens/multibody/model.h"
#include "livens/solvers/dense.h"
#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/sparse.h"

namespace livens::mixed {

namespace {

/// Beyond, multipliers are found by a sparse matrix.
constexpr int most_dense_rows = 48;

void refuse_singular(const Body& body)
{
    if (!is_singular(body.mass, body.is_point)) return;
    throw InputError(
        {"mass-singular", "body[" + body.name + "].inertia",
         "the mass matrix of body '" + body.name + "' is singular, and the elements 'mixed' divide by it", "",
         "J1 + J2 > J3 for every principal moment",
         "a lamina or a needle has no extent along some axis, so one of its directors has no inertia",
         "use the method lobatto, or give the body a little thickness"});
}

}   // namespace

/// The Hessian of a form is K x 1_3: an entry by two columns of X stands there for each of three components.
Coordinates::Coordinates(const ModelTables& the_tables) : tables(the_tables), rows(the_tables.independent)
{
    for (int b = 0; b < static_cast<int>(tables.bodies.size()); ++b) {
        const Body& body = tables.model->bodies()[b];
        refuse_singular(body);
        first.push_back(size);
        size += n_numbers(b);
        inverse_masses.push_back(inverse_mass(body.mass, body.is_point));
        for (int c = 0; c < n_numbers(b); ++c) root_masses.push_back(std::sqrt(body.mass(c / 3, c / 3)));
    }
    for (int r = tables.n_rows(); r < static_cast<int>(tables.rows.size()); ++r) rows.push_back(r);
    for (int k = 0; k < n_rows(); ++k) {
        const RowTable& row = tables.rows[rows[k]];
        for (int side = 0; side < row.n_sides; ++side)
            for (const int column : row.columns[side])
                for (int c = column; c < column + 3; ++c) {
                    bool is_used = !row.is_quadratic || row.B[side].a[c] != 0;
                    for (const auto& entry : row.form)
                        is_used = is_used || (entry.to_side == side && entry.to == column);
                    if (is_used && c < n_numbers(row.bodies[side]))
                        gradient_entries.push_back({k, side, c, first[row.bodies[side]] + c});
                }
        for (const auto& entry : row.form) {
            const int i = row.bodies[entry.to_side], j = row.bodies[entry.from_side];
            if (entry.to >= n_numbers(i) || entry.from >= n_numbers(j)) continue;
            for (int d = 0; d < 3; ++d)
                hessian_entries.push_back(
                    {k, first[i] + entry.to + d, first[j] + entry.from + d, entry.value});
        }
    }
}

std::string Coordinates::row_name(int row) const
{
    const int r = rows[row];
    if (r < tables.n_rows()) return tables.model->row_name(r);
    return "the rigidity of body '" + tables.model->body_name(tables.rows[r].bodies[0]) + "'";
}

void Coordinates::spread(const double* coordinates, double* X) const
{
    std::fill_n(X, n_X(), 0.0);
    for (int b = 0; b < n_bodies(); ++b) std::copy_n(coordinates + first[b], n_numbers(b), X + 12 * b);
}

void Coordinates::gather(const double* X, double* coordinates) const
{
    for (int b = 0; b < n_bodies(); ++b) std::copy_n(X + 12 * b, n_numbers(b), coordinates + first[b]);
}

std::vector<double> Coordinates::gather(std::span<const Matrix34> X) const
{
    std::vector<double> coordinates(static_cast<std::size_t>(size));
    for (int b = 0; b < n_bodies(); ++b) std::copy_n(X[b].a, n_numbers(b), coordinates.begin() + first[b]);
    return coordinates;
}

std::vector<Matrix34> Coordinates::bodies(const double* coordinates) const
{
    std::vector<Matrix34> X(first.size());
    for (int b = 0; b < n_bodies(); ++b) std::copy_n(coordinates + first[b], n_numbers(b), X[b].a);
    return X;
}

void Coordinates::gradients(const double* X, std::vector<double>& values) const
{
    values.resize(gradient_entries.size());
    double g[RowTables::gradient_size];
    for (std::size_t i = 0; i < values.size(); ++i) {
        const GradientEntry& entry = gradient_entries[i];
        if (i == 0 || gradient_entries[i - 1].row != entry.row)
            tables.rows.gradient(rows[entry.row], {}, X, g);
        values[i] = g[12 * entry.side + entry.component];
    }
}

void Coordinates::forces(double t, const double* X, const double* V, const double* lambda, double* F) const
{
    std::fill_n(F, n_X(), 0.0);
    tables.bodies.add_weight(1.0, F);
    tables.loads.add({t, Side::middle}, X, V, 1.0, F);
    double g[RowTables::gradient_size];
    for (int k = 0; k < n_rows(); ++k) {
        if (lambda[k] == 0) continue;
        const RowTable& row = tables.rows[rows[k]];
        tables.rows.gradient(rows[k], {}, X, g);
        for (int side = 0; side < row.n_sides; ++side)
            for (const int column : row.columns[side])
                for (int c = column; c < column + 3; ++c)
                    F[12 * row.bodies[side] + c] -= lambda[k] * g[12 * side + c];
    }
}

/// [m G^T; G 0] (X'', lambda) = (F, -curvature), sparse; of few rows their Schur complement, dense.
std::vector<double> Coordinates::multipliers(const State& state) const
{
    const int n = size + n_rows();
    std::vector<double> X, V, F(static_cast<std::size_t>(n_X())), x(static_cast<std::size_t>(n));
    for (int b = 0; b < n_bodies(); ++b) {
        X.insert(X.end(), state.X[b].a, state.X[b].a + 12);
        V.insert(V.end(), state.V[b].a, state.V[b].a + 12);
    }
    std::vector<double> values;
    gradients(X.data(), values);
    const std::vector<double> none(static_cast<std::size_t>(n_rows()), 0.0);
    forces(state.t, X.data(), V.data(), none.data(), F.data());
    gather(F.data(), x.data());
    for (int k = 0; k < n_rows(); ++k) x[size + k] = -tables.rows.curvature(rows[k], {}, X.data(), V.data());
    if (n_rows() <= most_dense_rows)
        return multipliers_of_few({x.begin(), x.begin() + size}, {x.begin() + size, x.end()}, values);
    std::vector<std::vector<std::pair<int, double>>> columns(static_cast<std::size_t>(n));
    for (int b = 0; b < n_bodies(); ++b)
        for (int c = 0; c < n_numbers(b); ++c)
            for (int i = c % 3; i < n_numbers(b); i += 3)
                columns[first[b] + c].emplace_back(first[b] + i,
                                                   tables.model->bodies()[b].mass(i / 3, c / 3));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const GradientEntry& entry = gradient_entries[i];
        columns[entry.coordinate].emplace_back(size + entry.row, values[i]);
        columns[size + entry.row].emplace_back(entry.coordinate, values[i]);
    }
    for (auto& column : columns) std::sort(column.begin(), column.end());   // joints name bodies in any order
    const SparseMatrix A = sparse_from_columns(columns);
    SparseLU lu(SparseBackend::eigen);
    lu.analyse(A);
    if (lu.factorise(A))
        lu.solve(x, x);
    else
        std::fill(x.begin(), x.end(), std::numeric_limits<double>::quiet_NaN());
    return {x.begin() + size, x.end()};
}

/// G m^-1 G^T lambda = G m^-1 F - (G X''), dense but for bodies that a row does not see.
std::vector<double> Coordinates::multipliers_of_few(const std::vector<double>& F,
                                                    std::vector<double> right_side,
                                                    const std::vector<double>& values) const
{
    const int n = n_rows();
    const auto wide = static_cast<std::size_t>(size);
    std::vector<double> G(static_cast<std::size_t>(n) * wide, 0.0), T(wide);
    std::vector<char> sees(static_cast<std::size_t>(n * n_bodies()), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto [row, coordinate] = std::pair(gradient_entries[i].row, gradient_entries[i].coordinate);
        G[static_cast<std::size_t>(row) * wide + static_cast<std::size_t>(coordinate)] = values[i];
        sees[row * n_bodies() + (std::ranges::upper_bound(first, coordinate) - first.begin()) - 1] = 1;
    }
    Cholesky schur;
    schur.resize(n);
    for (int k = 0; k < n; ++k) {
        const double* g = G.data() + static_cast<std::size_t>(k) * wide;
        for (int j = 0; j <= k; ++j) schur.row(k)[j] = 0;
        double along = 0;
        for (int b = 0; b < n_bodies(); ++b) {
            if (!sees[k * n_bodies() + b]) continue;
            const int begin = first[b], m = n_numbers(b);
            std::fill_n(T.begin() + begin, m, 0.0);
            for (int i = 0; i < m; i += 3)
                for (int c = 0; c < m; c += 3) {
                    const double inverse = inverse_masses[b](i / 3, c / 3);
                    if (inverse == 0) continue;
                    for (int q = 0; q < 3; ++q) T[begin + i + q] += inverse * g[begin + c + q];
                }
            const std::span<const double> own(T.data() + begin, static_cast<std::size_t>(m));
            for (int j = 0; j <= k; ++j)
                if (sees[j * n_bodies() + b])
                    schur.row(k)[j] +=
                        dot({G.data() + static_cast<std::size_t>(j) * wide + begin, own.size()}, own);
            along += dot(own, {F.data() + begin, own.size()});
        }
        right_side[static_cast<std::size_t>(k)] = along - right_side[static_cast<std::size_t>(k)];
    }
    if (schur.factorise())
        schur.solve(right_side.data());
    else
        std::ranges::fill(right_side, std::numeric_limits<double>::quiet_NaN());
    return right_side;
}

}   // namespace livens::mixed
