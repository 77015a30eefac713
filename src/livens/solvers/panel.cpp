// SPDX-License-Identifier: BSD-3-Clause
// LU with row exchanges of a tall panel [Golub2013, 3.4], or Householder reflections [5.2], with the columns
// behind it; for a few dozen rows, where blocks of a library do not pay.
#include "livens/solvers/detail/panel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/solvers/short_rows.h"

namespace livens::inline solvers_internal {

namespace {

/// A pivot of the first rows is taken unless another one is larger by this.
constexpr double preferred = 8;

}   // namespace

void Panel::resize(int n_rows, int n_pivots, int n_others)
{
    n_rows_ = n_rows;
    n_pivots_ = n_pivots;
    width_ = n_pivots + n_others;
    a_.assign(static_cast<std::size_t>(n_rows) * static_cast<std::size_t>(width_), 0.0);
    exchanged_.assign(static_cast<std::size_t>(n_pivots), 0);
    reach_.assign(static_cast<std::size_t>(n_rows), width_);
    is_first_.assign(static_cast<std::size_t>(n_rows), 0);
    beta_.clear();
}

void Panel::clear() { std::fill(a_.begin(), a_.end(), 0.0); }

double Panel::largest() const
{
    double found = 0;
    for (const double v : a_) found = std::max(found, std::abs(v));
    return found;
}

double Panel::largest_left() const
{
    double found = 0;
    for (int i = n_pivots_; i < n_rows_; ++i)
        for (int j = n_pivots_; j < width_; ++j) found = std::max(found, std::abs(row(i)[j]));
    return found;
}

double Panel::smallest_pivot() const
{
    double found = std::numeric_limits<double>::infinity();
    for (int k = 0; k < n_pivots_; ++k) found = std::min(found, std::abs(row(k)[k]));
    return found;
}

void Panel::exchange(int i, int j)
{
    if (i == j) return;
    std::swap_ranges(row(i), row(i) + width_, row(j));
    std::swap(reach_[i], reach_[j]);
    std::swap(is_first_[i], is_first_[j]);
}

bool Panel::choose_pivot(int k)
{
    int best[2] = {-1, -1};   // of all rows, of the first ones
    double size[2] = {-1, -1};
    for (int i = k; i < n_rows_; ++i) {
        const double here = std::abs(row(i)[k]);
        if (here > size[0]) size[0] = here, best[0] = i;
        if (is_first_[i] && here > size[1]) size[1] = here, best[1] = i;
    }
    failed_ = k;   // stays so if this is the last
    if (!(size[0] > 0) || !std::isfinite(size[0])) return false;
    const int taken = size[1] * preferred >= size[0] ? best[1] : best[0];
    exchanged_[k] = taken;
    exchange(k, taken);
    return true;
}

/// Row i less what pivot row k has of it, from a column on.
void Panel::subtract(int i, int k, int from)
{
    const double l = row(i)[k];
    if (l == 0) return;
    const int end = reach_[k];
    subtract_scaled(row_functions(), row(i) + from, l, row(k) + from, end - from);
    reach_[i] = std::max(reach_[i], end);
}

bool Panel::eliminate(int n_first, int reach)
{
    beta_.clear();
    const auto subtract_pair = row_functions().subtract_pair;
    for (int i = 0; i < n_rows_; ++i) {
        is_first_[i] = i < n_first;
        reach_[i] = i < n_first ? reach : width_;
    }
    // Columns are eliminated in pairs: each row below is then read and written once for two pivots.
    for (int k = 0; k < n_pivots_; k += 2) {
        const bool is_pair = k + 1 < n_pivots_;
        if (!choose_pivot(k)) return false;
        const double d = 1 / row(k)[k];
        for (int i = k + 1; i < n_rows_; ++i) {
            double* a = row(i) + k;
            a[0] *= d;
            if (is_pair) a[1] -= a[0] * row(k)[k + 1];
        }
        if (!is_pair) {
            for (int i = k + 1; i < n_rows_; ++i) subtract(i, k, k + 1);
            break;
        }
        if (!choose_pivot(k + 1)) return false;
        const double e = 1 / row(k + 1)[k + 1];
        for (int i = k + 2; i < n_rows_; ++i) row(i)[k + 1] *= e;
        subtract(k + 1, k, k + 2);
        const double *u = row(k) + k, *v = row(k + 1) + k;
        const int end = std::max(reach_[k], reach_[k + 1]);
        for (int i = k + 2; i < n_rows_; ++i) {
            double* y = row(i) + k;
            if (y[0] == 0 && y[1] == 0) continue;
            subtract_pair(y + 2, y[0], u + 2, y[1], v + 2, end - k - 2);
            reach_[i] = std::max(reach_[i], end);
        }
    }
    return true;
}

bool Panel::reflect_column(int k)
{
    double square = 0, largest = 0;
    for (int i = k; i < n_rows_; ++i) largest = std::max(largest, std::abs(row(i)[k]));
    failed_ = k;
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    for (int i = k; i < n_rows_; ++i) square += (row(i)[k] / largest) * (row(i)[k] / largest);
    const double norm = largest * std::sqrt(square), head = row(k)[k];
    const double diagonal = head > 0 ? -norm : norm, v0 = head - diagonal;
    beta_[k] = -v0 / diagonal;
    for (int i = k + 1; i < n_rows_; ++i) row(i)[k] /= v0;
    row(k)[k] = diagonal;
    std::vector<double> sums(row(k) + k + 1, row(k) + width_);
    for (int i = k + 1; i < n_rows_; ++i) {
        const double v = row(i)[k];
        for (int j = k + 1; v != 0 && j < width_; ++j) sums[j - k - 1] += v * row(i)[j];
    }
    for (int j = k + 1; j < width_; ++j) row(k)[j] -= beta_[k] * sums[j - k - 1];
    for (int i = k + 1; i < n_rows_; ++i) {
        const double v = beta_[k] * row(i)[k];
        for (int j = k + 1; v != 0 && j < width_; ++j) row(i)[j] -= v * sums[j - k - 1];
    }
    return true;
}

bool Panel::reflect()
{
    beta_.assign(static_cast<std::size_t>(n_pivots_), 0.0);
    for (int k = 0; k < n_pivots_; ++k)
        if (!reflect_column(k)) return false;
    return true;
}

void Panel::reflect_vector(int k, double* x) const
{
    double sum = x[k];
    for (int i = k + 1; i < n_rows_; ++i) sum += row(i)[k] * x[i];
    sum *= beta_[k];
    x[k] -= sum;
    for (int i = k + 1; i < n_rows_; ++i) x[i] -= row(i)[k] * sum;
}

void Panel::apply(double* x) const
{
    for (int k = 0; k < n_pivots_; ++k) {
        if (beta_.empty()) {
            std::swap(x[k], x[exchanged_[k]]);
            continue;
        }
        reflect_vector(k, x);
    }
    if (!beta_.empty()) return;
    const RowFunctions& rows = row_functions();
    for (int i = 1; i < n_rows_; ++i) x[i] -= inner(rows, row(i), x, std::min(i, n_pivots_));
}

void Panel::apply_transposed(double* x) const
{
    for (int k = n_pivots_ - 1; k >= 0 && !beta_.empty(); --k)   // a reflection is its own inverse
        reflect_vector(k, x);
    if (!beta_.empty()) return;
    const RowFunctions& rows = row_functions();
    for (int i = n_rows_ - 1; i > 0; --i) subtract_scaled(rows, x, x[i], row(i), std::min(i, n_pivots_));
    for (int k = n_pivots_ - 1; k >= 0; --k) std::swap(x[k], x[exchanged_[k]]);
}

void Panel::solve(double* x, const double* others) const
{
    const RowFunctions& rows = row_functions();
    for (int k = n_pivots_ - 1; k >= 0; --k) {
        const double* u = row(k);
        const double sum = inner(rows, u + n_pivots_, others, width_ - n_pivots_) +
                           inner(rows, u + k + 1, x + k + 1, n_pivots_ - k - 1);
        x[k] = (x[k] - sum) / u[k];
    }
}

void Panel::solve_transposed(double* x, double* others) const
{
    const RowFunctions& rows = row_functions();
    for (int k = 0; k < n_pivots_; ++k) {
        const double* u = row(k);
        x[k] /= u[k];
        subtract_scaled(rows, x + k + 1, x[k], u + k + 1, n_pivots_ - k - 1);
        subtract_scaled(rows, others, x[k], u + n_pivots_, width_ - n_pivots_);
    }
}

}   // namespace livens::inline solvers_internal
