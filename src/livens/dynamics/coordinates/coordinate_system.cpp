// SPDX-License-Identifier: BSD-3-Clause
// [G; C] J = [0; 1]: theory.md, "States in coordinates". Unknowns are [v, L w] of each body with the model's
// length L, and rows are of norm 1.
#include <algorithm>
#include <cmath>

#include "livens/dynamics/coordinates/mechanism.h"
#include "livens/dynamics/rows/twist.h"

namespace livens::inline dynamics_internal {

namespace {

using Of = GeneralisedCoordinate::Of;

}   // namespace

/// A row of the matrix from a gradient by X.
void CoordinateSystem::add_gradient(const ConstraintRow& row, const Configuration& X)
{
    const RowGradient gradient = constraint_gradient(row, {placed_t_}, X);
    std::vector<Entry> entries;
    for (int side = 0; side < gradient.bodies.size; ++side) {
        const int b = gradient.bodies.bodies[side];
        double twist[6];
        twist::rows(X[b].a, gradient.by[side].a, twist);
        for (int i = 0; i < mechanism_.bodies[b].dofs; ++i)
            entries.push_back(
                {mechanism_.bodies[b].first + i, i < 3 ? twist[i] : twist[i] / mechanism_.length});
    }
    add(std::move(entries));
}

/// By columns, as the sparse LU takes them. A row without a gradient keeps the scale 1.
void CoordinateSystem::add(std::vector<Entry> entries)
{
    double square = 0;
    for (const Entry& entry : entries) square += entry.value * entry.value;
    const double scale = square > 0 ? 1 / std::sqrt(square) : 1;
    const int row = static_cast<int>(scales_.size());
    scales_.push_back(scale);
    for (const Entry& entry : entries)
        if (entry.value != 0) columns_[entry.column].emplace_back(row, scale * entry.value);
}

/// Rows of joints first, then one for each rate; of a place or a turn it is a single unknown. For least
/// squares all rows of redundant joints are given: the matrix is not square then, and not factorised.
CoordinateSystem::CoordinateSystem(const Mechanism& mechanism, const Configuration& X, std::vector<int> rows)
    : mechanism_(mechanism), rows_(std::move(rows)), placed_t_(mechanism.placed.t)
{
    const int n = mechanism.bodies.n_twists();
    columns_.resize(static_cast<std::size_t>(n));
    for (const int r : rows_) add_gradient(mechanism.model.row(r), X);
    for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
        const GeneralisedCoordinate& c = mechanism.coordinates[i];
        if (c.of == Of::joint) {
            add_gradient(mechanism.rows[i].row, X);
            continue;
        }
        const int first = mechanism.bodies[c.part].first;
        for (int k = 0; k < c.n_rates(); ++k)
            add({{first + (c.of == Of::place ? c.index : 3 + k),
                  c.of == Of::place ? 1 : 1 / mechanism.length}});
    }
    is_regular_ = static_cast<int>(scales_.size()) == n;
    if (!is_regular_ || n == 0) return;
    matrix_ = sparse_from_columns(columns_);
    lu_.analyse(matrix_);
    is_regular_ = lu_.factorise(matrix_);
}

DenseMatrix CoordinateSystem::entries() const
{
    DenseMatrix A(static_cast<int>(scales_.size()), static_cast<int>(columns_.size()));
    for (int c = 0; c < A.cols; ++c)
        for (const auto& [row, value] : columns_[c]) A(row, c) = value;
    return A;
}

/// Rates are of the rows before these were scaled; of the solution [v, L w] the length is taken off.
std::vector<double> CoordinateSystem::twists(std::span<const double> rates) const
{
    std::vector<double> b(rates.begin(), rates.end()), x(b.size());
    if (b.empty()) return x;
    for (std::size_t i = 0; i < b.size(); ++i) b[i] *= scales_[i];
    solve_refined(lu_, matrix_, b, x);
    for (const BodyTable& body : mechanism_.bodies)
        for (int i = 3; i < body.dofs; ++i) x[body.first + i] /= mechanism_.length;
    return x;
}

DenseMatrix CoordinateSystem::twists_by_rates() const
{
    DenseMatrix J(mechanism_.bodies.n_twists(), mechanism_.n_rates);
    std::vector<double> unit(scales_.size(), 0.0);
    for (int k = 0; k < mechanism_.n_rates; ++k) {
        const std::size_t at = rows_.size() + static_cast<std::size_t>(k);
        unit[at] = 1;
        std::ranges::copy(twists(unit), J.column(k).begin());
        unit[at] = 0;
    }
    return J;
}

}   // namespace livens::inline dynamics_internal
