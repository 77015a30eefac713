// SPDX-License-Identifier: BSD-3-Clause
// Whether the rows of a mechanism have turned over between two places, det G_a G_b^T < 0: theory.md,
// "Singular positions", Branches. Of the determinant only the sign is wanted, so no product can overflow.
#include "livens/dynamics/start/orientation.h"

#include <algorithm>
#include <cmath>

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
            for (int i = k + 1; i < n; ++i) other[i] -= factor * column[i];
        }
    }
    return sign;
}

}   // namespace

void Orientation::place(const ModelTables& tables, const std::vector<int>& rows, Instant at, const double* X)
{
    n_rows_ = static_cast<int>(rows.size());
    sides_.clear();
    gradient_.resize(RowTables::gradient_size);
    for (int i = 0; i < n_rows_; ++i) {
        tables.rows.gradient(rows[i], at, X, gradient_.data());
        const std::size_t first = sides_.size();
        double square = 0;
        for (int side = 0; side < tables.rows[rows[i]].n_sides; ++side) {
            Side& one = sides_.emplace_back(Side{tables.rows[rows[i]].bodies[side], i, {}});
            tables.scaled_wrench(rows[i], side, X, gradient_.data(), one.entries);
            for (const double x : one.entries) square += x * x;
        }
        const double scale = square > 0 ? 1 / std::sqrt(square) : 0;
        for (std::size_t s = first; s < sides_.size(); ++s)
            for (double& x : sides_[s].entries) x *= scale;
    }
    // By body, so that only rows which share one are multiplied: the product stays as sparse as the
    // mechanism.
    std::ranges::stable_sort(sides_, {}, &Side::body);
}

bool Orientation::is_turned_over(const Orientation& before)
{
    if (n_rows_ == 0 || before.n_rows_ != n_rows_ || before.sides_.size() != sides_.size()) return false;
    product_.assign(static_cast<std::size_t>(n_rows_) * static_cast<std::size_t>(n_rows_), 0.0);
    for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
        while (last < sides_.size() && sides_[last].body == sides_[first].body) ++last;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = first; j < last; ++j) {
                const double *a = before.sides_[i].entries, *b = sides_[j].entries;
                product_[static_cast<std::size_t>(sides_[j].row * n_rows_ + before.sides_[i].row)] +=
                    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
            }
    }
    return sign_of_determinant(product_.data(), n_rows_) < 0;
}

}   // namespace livens
