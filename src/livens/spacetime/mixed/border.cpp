// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component", Mixed elements: of an increment of X at an end the twist tells how
// far free motion j goes, p_j . xi with p_j the momenta of a unit free motion, for M p_j has length one.
#include "livens/spacetime/mixed/border.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/projection.h"

namespace livens::mixed {

namespace {

/// Six numbers by each of twelve of X: the reference point moves, and the directors turn by
/// 1/2 sum d_a x dd_a.
Matrix<6, 12> twist_of_increments(const Matrix34& X)
{
    Matrix<6, 12> T{};
    for (int i = 0; i < 3; ++i) T(i, i) = 1;
    for (int a = 1; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
            Vector3 e{};
            e[i] = 0.5;
            const Vector3 turn = cross(X.column(a), e);
            for (int k = 0; k < 3; ++k) T(3 + k, 3 * a + i) = turn[k];
        }
    return T;
}

}   // namespace

Border::Border(const Model& model, const Ends& ends)
    : tables_(model, ends.independent), conditions_(tables_, ends)
{}

/// As motions tell velocities at the ends of blocks.
std::vector<Matrix34> Border::told(const Coordinates& m, const std::vector<Matrix34>& X,
                                   const std::vector<double>& momenta) const
{
    std::vector<Matrix34> V;
    for (std::size_t b = 0; b < X.size(); ++b)
        V.push_back(TurningMomentum(m.tables.model->bodies()[b],
                                    momenta.data() + tables_.bodies[static_cast<int>(b)].first)
                        .at(X[b]) *
                    m.inverse_masses[b]);
    return nearest_rates(*m.tables.model, X, V, m.tables.independent);
}

bool Border::evaluate(Equations& equations, const Fields& fields)
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    const std::vector<double>& ends = space.functions.space().ends();
    std::array<std::vector<Matrix34>, 2> X{space.end_position(fields, false),
                                           space.end_position(fields, true)};
    const std::size_t n = ends.size() - 1;
    const auto at = [&](std::size_t end, std::size_t knot, std::size_t element) {
        return EndPlaces{
            ends[knot], X[end].data()->data(), nullptr, ends[element + 1] - ends[element],
            [this, &m, &places = X[end]](const std::vector<double>& p) { return told(m, places, p); }};
    };
    const auto followed = [&](const NamedCoordinate& coordinate, double from) {
        FollowedAngle angle(coordinate, conditions_.stated(), from);
        std::vector<double> x(static_cast<std::size_t>(m.size)), all(static_cast<std::size_t>(m.n_X()));
        for (int e = 0; e < static_cast<int>(n); ++e)
            for (const double s : {0.0, 0.5, 1.0}) {
                space.evaluate_X(fields, e, s, x.data());
                m.spread(x.data(), all.data());
                angle.pass(all.data());
            }
        return angle.now();
    };
    if (!conditions_.evaluate({at(0, 0, 0), at(1, n, n - 1)}, followed)) return false;
    for (const bool at_end : {false, true}) {
        EndMomentum given;
        for (int b = 0; b < m.n_bodies(); ++b)
            given.turning.emplace_back(m.tables.model->bodies()[static_cast<std::size_t>(b)],
                                       conditions_.momenta(at_end).data() + tables_.bodies[b].first);
        equations.give(at_end, std::move(given));
    }
    return true;
}

/// Rows dX at both ends by momenta along the free motions: -P at the start, P at the end.
void Border::add_momenta(const Equations& equations, const Fields& fields, std::span<const double> row_scales,
                         Columns& columns) const
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    for (const bool at_end : {false, true}) {
        const int row = space.numbering.row_dX(at_end ? space.numbering.n_functions() - 1 : 0);
        const std::vector<Matrix34> X = space.end_position(fields, at_end);
        const DenseMatrix& along = conditions_.along(at_end);
        for (int j = 0; j < along.cols; ++j) {
            columns.emplace_back();
            for (int b = 0; b < m.n_bodies(); ++b) {
                const auto at = static_cast<std::size_t>(b);
                const Matrix34 P = TurningMomentum(m.tables.model->bodies()[at],
                                                   along.column(j).data() + tables_.bodies[b].first)
                                       .at(X[at]);
                for (int c = 0; c < m.n_numbers(b); ++c) {
                    const int r = row + m.first[at] + c;
                    columns.back().emplace_back(r, (at_end ? P.a[c] : -P.a[c]) *
                                                       row_scales[static_cast<std::size_t>(r)]);
                }
            }
        }
    }
}

/// Rows of the conditions by X at both ends, and by momenta along the free motions.
void Border::add_conditions(const Equations& equations, const Fields& fields,
                            std::span<const double> column_scales, int first_row, Columns& columns) const
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    const std::span<const double> closing = conditions_.closing();
    const int f = tables_.freedoms(), n = size();
    for (const bool at_end : {false, true}) {
        const int first = space.numbering.X(at_end ? space.numbering.n_functions() - 1 : 0);
        const std::vector<Matrix34> X = space.end_position(fields, at_end);
        const DenseMatrix& along = conditions_.along(at_end);
        for (int b = 0; b < m.n_bodies(); ++b) {
            const auto at = static_cast<std::size_t>(b);
            const Matrix<6, 12> T = twist_of_increments(X[at]);
            for (int c = 0; c < m.n_numbers(b); ++c) {
                const int column = first + m.first[at] + c;
                std::vector<double> moved(static_cast<std::size_t>(f), 0.0);   // of each free motion
                for (int j = 0; j < f; ++j)
                    for (int k = 0; k < tables_.bodies[b].dofs; ++k)
                        moved[static_cast<std::size_t>(j)] += along(tables_.bodies[b].first + k, j) * T(k, c);
                for (int i = 0; i < n; ++i) {
                    const double* row =
                        closing.data() + static_cast<std::ptrdiff_t>(i) * 4 * f + (at_end ? f : 0);
                    double sum = 0;
                    for (int j = 0; j < f; ++j) sum += row[j] * moved[static_cast<std::size_t>(j)];
                    columns[static_cast<std::size_t>(column)].emplace_back(
                        first_row + i, sum * column_scales[static_cast<std::size_t>(column)]);
                }
            }
        }
        for (int j = 0; j < f; ++j)
            for (int i = 0; i < n; ++i)
                columns[static_cast<std::size_t>(first_row + (at_end ? f : 0) + j)].emplace_back(
                    first_row + i, closing[static_cast<std::size_t>(i) * 4 * static_cast<std::size_t>(f) +
                                           static_cast<std::size_t>(2 * f + (at_end ? f : 0) + j)]);
    }
}

void Border::add_to(ScaledMatrix& matrix, const Equations& equations, const Fields& fields)
{
    conditions_.differentiate({&conditions_.point(false).basis(), &conditions_.point(true).basis()});
    const SparseMatrix& A = matrix.inner;
    Columns columns(static_cast<std::size_t>(A.size));
    for (int c = 0; c < A.size; ++c)
        for (int k = A.column_starts[c]; k < A.column_starts[c + 1]; ++k)
            columns[c].emplace_back(A.rows[k], A.values[k]);
    add_momenta(equations, fields, matrix.rows, columns);
    add_conditions(equations, fields, matrix.columns, A.size, columns);
    // Rows of conditions to a largest entry of one, as others are of about that size.
    std::vector<double> largest(static_cast<std::size_t>(size()), 0.0);
    const auto for_rows = [&](const auto& act) {
        for (auto& column : columns)
            for (auto& [row, value] : column)
                if (row >= A.size) act(static_cast<std::size_t>(row - A.size), value);
    };
    for_rows([&](std::size_t i, double value) { largest[i] = std::max(largest[i], std::abs(value)); });
    for (double& one : largest) one = one > 0 ? 1 / one : 1;
    for_rows([&](std::size_t i, double& value) { value *= largest[i]; });
    matrix.rows.insert(matrix.rows.end(), largest.begin(), largest.end());
    matrix.columns.resize(matrix.columns.size() + largest.size(), 1.0);
    matrix.all = sparse_from_columns(columns);
}

}   // namespace livens::mixed
