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

Border::Border(const Model& model, const Ends& ends, Ranks* ranks)
    : tables_(model, ends.independent), ends_(ends), ranks_(ranks), conditions_(tables_, ends)
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

Border::End Border::end_of(const FieldSpace& space, const Fields& fields, bool at_end) const
{
    const std::vector<double>& ends = space.functions.space().ends();
    const std::size_t knot = at_end ? ends.size() - 1 : 0, element = at_end ? knot - 1 : 0;
    End end{ends[knot], ends[element + 1] - ends[element], space.end_position(fields, at_end)};
    if (ranks_ == nullptr) return end;
    std::vector<double> numbers{end.t, end.length};
    for (const Matrix34& X : end.X) numbers.insert(numbers.end(), X.a, X.a + 12);
    ranks_->broadcast(at_end ? ranks_->size() - 1 : 0, numbers);
    end.t = numbers[0];
    end.length = numbers[1];
    for (std::size_t b = 0; b < end.X.size(); ++b) std::copy_n(numbers.data() + 2 + 12 * b, 12, end.X[b].a);
    return end;
}

/// Where an angle is at the end of time. Every rank follows it over its own elements; as neighbours have the
/// same places at their border, turns add up.
double Border::followed(const FieldSpace& space, const Fields& fields, const NamedCoordinate& coordinate,
                        double from, const End& end) const
{
    FollowedAngle angle(coordinate, conditions_.stated(), from);
    std::vector<double> x(static_cast<std::size_t>(space.coordinates.size)),
        all(static_cast<std::size_t>(space.coordinates.n_X()));
    double begin = from;
    for (int e = 0; e < space.functions.n_elements(); ++e)
        for (const double s : {0.0, 0.5, 1.0}) {
            space.evaluate_X(fields, e, s, x.data());
            space.coordinates.spread(x.data(), all.data());
            angle.pass(all.data());
            if (e == 0 && s == 0 && !has(false)) begin = angle.now();
        }
    if (ranks_ == nullptr) return angle.now();
    double turned = angle.now() - begin;
    ranks_->sum({&turned, 1});
    FollowedAngle last(coordinate, conditions_.stated(), from + turned);
    last.pass(end.X.data()->data());
    return last.now();
}

/// Conditions are evaluated before rows: the momenta that close the law are those that joints leave at the
/// places at hand.
bool Border::evaluate(Equations& equations, const Fields& fields)
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    const std::array<End, 2> ends{end_of(space, fields, false), end_of(space, fields, true)};
    const auto places = [&](const End& end) {
        return EndPlaces{end.t, end.X.data()->data(), nullptr, end.length,
                         [this, &m, &end](const std::vector<double>& p) { return told(m, end.X, p); }};
    };
    const auto follow = [&](const NamedCoordinate& coordinate, double from) {
        return followed(space, fields, coordinate, from, ends[1]);
    };
    if (!conditions_.evaluate({places(ends[0]), places(ends[1])}, follow)) return false;
    for (const bool at_end : {false, true}) {
        if (!has(at_end)) continue;
        EndMomentum given;
        for (int b = 0; b < m.n_bodies(); ++b)
            given.turning.emplace_back(m.tables.model->bodies()[static_cast<std::size_t>(b)],
                                       conditions_.momenta(at_end).data() + tables_.bodies[b].first);
        equations.give(at_end, std::move(given));
    }
    return true;
}

void Border::differentiate()
{
    conditions_.differentiate({&conditions_.point(false).basis(), &conditions_.point(true).basis()});
}

void Border::take_momenta(bool at_end, const Equations& equations, const Fields& fields,
                          const Take& take) const
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    const int row = space.numbering.row_dX(at_end ? space.numbering.n_functions() - 1 : 0);
    const std::vector<Matrix34> X = space.end_position(fields, at_end);
    const DenseMatrix& along = conditions_.along(at_end);
    for (int j = 0; j < along.cols; ++j)
        for (int b = 0; b < m.n_bodies(); ++b) {
            const auto at = static_cast<std::size_t>(b);
            const Matrix34 P = TurningMomentum(m.tables.model->bodies()[at],
                                               along.column(j).data() + tables_.bodies[b].first)
                                   .at(X[at]);
            for (int c = 0; c < m.n_numbers(b); ++c)
                take(row + m.first[at] + c, j, at_end ? P.a[c] : -P.a[c]);
        }
}

void Border::take_conditions(bool at_end, const Equations& equations, const Fields& fields,
                             const Take& take) const
{
    const FieldSpace& space = equations.space();
    const Coordinates& m = space.coordinates;
    const std::span<const double> closing = conditions_.closing();
    const int f = n_free(), n = size();
    const int first = space.numbering.X(at_end ? space.numbering.n_functions() - 1 : 0);
    const std::vector<Matrix34> X = space.end_position(fields, at_end);
    const DenseMatrix& along = conditions_.along(at_end);
    for (int b = 0; b < m.n_bodies(); ++b) {
        const auto at = static_cast<std::size_t>(b);
        const Matrix<6, 12> T = twist_of_increments(X[at]);
        for (int c = 0; c < m.n_numbers(b); ++c) {
            std::vector<double> moved(static_cast<std::size_t>(f), 0.0);   // of each free motion
            for (int j = 0; j < f; ++j)
                for (int k = 0; k < tables_.bodies[b].dofs; ++k)
                    moved[static_cast<std::size_t>(j)] += along(tables_.bodies[b].first + k, j) * T(k, c);
            for (int i = 0; i < n; ++i) {
                const double* row =
                    closing.data() + static_cast<std::ptrdiff_t>(i) * 4 * f + (at_end ? f : 0);
                double sum = 0;
                for (int j = 0; j < f; ++j) sum += row[j] * moved[static_cast<std::size_t>(j)];
                take(i, first + m.first[at] + c, sum);
            }
        }
    }
}

void Border::take_closing(bool at_end, const Take& take) const
{
    const int f = n_free();
    for (int j = 0; j < f; ++j)
        for (int i = 0; i < size(); ++i)
            take(i, j,
                 conditions_.closing()[static_cast<std::size_t>(i) * 4 * static_cast<std::size_t>(f) +
                                       static_cast<std::size_t>(2 * f + (at_end ? f : 0) + j)]);
}

void Border::add_to(ScaledMatrix& matrix, const Equations& equations, const Fields& fields)
{
    differentiate();
    const SparseMatrix& A = matrix.inner;
    const int n = A.size, f = n_free();
    std::vector<std::vector<std::pair<int, double>>> columns(static_cast<std::size_t>(n + size()));
    const auto add = [&](int row, int column, double value) {
        columns[static_cast<std::size_t>(column)].emplace_back(row, value);
    };
    for (int c = 0; c < n; ++c)
        for (int k = A.column_starts[c]; k < A.column_starts[c + 1]; ++k) add(A.rows[k], c, A.values[k]);
    for (const bool at_end : {false, true}) {
        const int first = n + (at_end ? f : 0);
        take_momenta(at_end, equations, fields, [&](int row, int j, double value) {
            add(row, first + j, value * matrix.rows[static_cast<std::size_t>(row)]);
        });
        take_conditions(at_end, equations, fields, [&](int i, int column, double value) {
            add(n + i, column, value * matrix.columns[static_cast<std::size_t>(column)]);
        });
        take_closing(at_end, [&](int i, int j, double value) { add(n + i, first + j, value); });
    }
    const DenseMatrix by_numbers = numbers();
    for (int j = 0; j < by_numbers.cols; ++j)
        for (int r = 0; r < by_numbers.rows; ++r)
            if (const double value = by_numbers(r, j); value != 0)
                add(r, n + 2 * f + j, value * (r < n ? matrix.rows[static_cast<std::size_t>(r)] : 1));
    // Rows of conditions to a largest entry of one, as others are of about that size.
    std::vector<double> largest(static_cast<std::size_t>(size()), 0.0);
    const auto for_rows = [&](const auto& act) {
        for (auto& column : columns)
            for (auto& [row, value] : column)
                if (row >= n) act(static_cast<std::size_t>(row - n), value);
    };
    for_rows([&](std::size_t i, double value) { largest[i] = std::max(largest[i], std::abs(value)); });
    for (double& one : largest) one = one > 0 ? 1 / one : 1;
    for_rows([&](std::size_t i, double& value) { value *= largest[i]; });
    matrix.rows.insert(matrix.rows.end(), largest.begin(), largest.end());
    matrix.columns.resize(matrix.columns.size() + largest.size(), 1.0);
    matrix.all = sparse_from_columns(columns);
}

}   // namespace livens::mixed
