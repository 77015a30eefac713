// SPDX-License-Identifier: BSD-3-Clause
// Whether the rows of a mechanism have turned over between two places, det G_a G_b^T < 0: theory.md,
// "Singular positions", Branches. Of the determinant only the sign is wanted, so no product can overflow.
#include "livens/dynamics/start/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "livens/solvers/short_rows.h"

namespace livens {

namespace {

/// The sign of the determinant of an n x n matrix, column by column, which is spent; 0: it is none, or no
/// number.
int sign_of_determinant(double* A, int n)
{
    int sign = 1;
    for (int k = 0; k < n; ++k) {   // elimination, of which nothing but the signs is wanted
        double* column = A + k * n;
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
        if (!(std::abs(column[pivot]) > 0)) return 0;
        if (pivot != k) {
            sign = -sign;
            for (int j = k; j < n; ++j) std::swap(A[j * n + k], A[j * n + pivot]);
        }
        if (column[k] < 0) sign = -sign;
        const double by = 1 / column[k];
        for (int i = k + 1; i < n; ++i) column[i] *= by;
        for (int j = k + 1; j < n; ++j) {
            double* other = A + j * n;
            const double factor = other[k];
            if (factor == 0) continue;   // rows of bodies that do not touch
            subtract_scaled(other + k + 1, factor, column + k + 1, n - k - 1);
        }
    }
    return sign;
}

}   // namespace

/// By body, so that only rows which share one are multiplied: the product stays as sparse as the mechanism.
void Orientation::arrange(const ModelTables& tables, const std::vector<int>& rows)
{
    rows_ = rows;
    sides_.clear();
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const int body : tables.rows[rows[i]].bodies) sides_.push_back({body, static_cast<int>(i), {}});
    std::vector<int> at(sides_.size());   // of each place, which side comes there
    std::iota(at.begin(), at.end(), 0);
    std::ranges::stable_sort(at, {}, [this](int side) { return sides_[side].body; });
    order_.resize(at.size());
    std::vector<Side> sorted;
    for (const int side : at) {
        order_[side] = static_cast<int>(sorted.size());
        sorted.push_back(sides_[side]);
    }
    sides_ = std::move(sorted);
    gradient_.resize(RowTables::gradient_size);
}

/// Rows of norm 1. One without a gradient stays zero: the determinant then has no sign.
void Orientation::place(const ModelTables& tables, const std::vector<int>& rows, Instant at, const double* X)
{
    if (rows != rows_ || order_.empty()) arrange(tables, rows);
    auto place = order_.begin();
    for (const int row : rows) {
        const auto first = place;
        tables.rows.gradient(row, at, X, gradient_.data());
        double square = 0;
        for (int side = 0; side < tables.rows[row].n_sides; ++side) {
            double* const entries = sides_[*place++].entries;
            tables.scaled_wrench(row, side, X, gradient_.data(), entries);
            for (int i = 0; i < 6; ++i) square += entries[i] * entries[i];
        }
        const double scale = square > 0 ? 1 / std::sqrt(square) : 0;
        for (auto side = first; side < place; ++side)
            for (double& x : sides_[*side].entries) x *= scale;
    }
}

bool Orientation::is_turned_over(const Orientation& before)
{
    const auto n = static_cast<int>(rows_.size());
    if (n == 0 || before.rows_.size() != rows_.size() || before.sides_.size() != sides_.size()) return false;
    product_.assign(count(n, n), 0.0);
    for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
        while (last < sides_.size() && sides_[last].body == sides_[first].body) ++last;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = first; j < last; ++j) {
                const double *a = before.sides_[i].entries, *b = sides_[j].entries;
                product_[static_cast<std::size_t>(sides_[j].row * n + before.sides_[i].row)] +=
                    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
            }
    }
    return sign_of_determinant(product_.data(), n) < 0;
}

}   // namespace livens
