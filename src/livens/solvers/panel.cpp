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

/// Pivots that rows below are read and written once for; and numbers that rows are gone through by, the last
/// of them into zeros behind the row.
constexpr int at_once = 4;   // as eliminate_block() has it

}   // namespace

void Panel::resize(int n_rows, int n_pivots, int n_others)
{
    n_rows_ = n_rows;
    n_pivots_ = n_pivots;
    width_ = n_pivots + n_others;
    stride_ = width_ + at_once - 1;
    a_.assign(static_cast<std::size_t>(n_rows) * static_cast<std::size_t>(stride_), 0.0);
    exchanged_.assign(static_cast<std::size_t>(n_pivots), 0);
    reach_.assign(static_cast<std::size_t>(n_rows), width_);
    is_first_.assign(static_cast<std::size_t>(n_rows), 0);
    beta_.clear();
}

void Panel::clear()
{
    for (int i = 0; i < n_rows_; ++i) std::fill_n(row(i), stride_, 0.0);
}

double Panel::largest() const
{
    const RowFunctions& rows = row_functions();
    double found = 0;
    for (int i = 0; i < n_rows_; ++i) found = std::max(found, rows.largest(row(i), width_));
    return found;
}

double Panel::largest_left() const
{
    const RowFunctions& rows = row_functions();
    double found = 0;
    for (int i = n_pivots_; i < n_rows_; ++i)
        found = std::max(found, rows.largest(row(i) + n_pivots_, width_ - n_pivots_));
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

Panel::Candidate Panel::candidate(int k, bool first_alone) const
{
    Candidate found;
    const double* a = row(k) + k;
    for (int i = k; i < n_rows_; ++i, a += stride_)
        if (!first_alone || is_first_[i]) found.look(i, std::abs(*a));
    return found;
}

/// `best` is the largest of the column.
/// Preferred rows are an element's own, which keeps what passes between elements out (theory.md, "The
/// chain").
bool Panel::choose_pivot(int k, const Candidate& best)
{
    failed_ = k;   // stays so if this is the last
    if (!(best.size > 0) || !std::isfinite(best.size)) return false;
    int taken = best.row;
    if (!is_first_[taken]) {
        const Candidate first = candidate(k, true);
        if (first.size * preferred >= best.size) taken = first.row;
    }
    exchanged_[k] = taken;
    exchange(k, taken);
    return true;
}

/// Pivot k in its own column and in n others behind it. The largest of the first of these.
template <int n>
Panel::Candidate Panel::eliminate_column(int k)
{
    double pivots[n + 1];
    std::copy_n(row(k) + k, n + 1, pivots);
    const double inverse = 1 / pivots[0];
    Candidate found;
    double* own = row(k) + k;
    for (int i = k + 1; i < n_rows_; ++i) {
        own += stride_;
        const double l = own[0] * inverse;
        own[0] = l;
        for (int j = 1; j <= n; ++j) own[j] -= l * pivots[j];
        if constexpr (n > 0) found.look(i, std::abs(own[1]));
    }
    return found;
}

/// Pivots first..end - 1 in their own columns.
bool Panel::eliminate_block(int first, int end)
{
    Candidate best = candidate(first, false);
    for (int k = first; k < end; ++k) {
        if (!choose_pivot(k, best)) return false;
        switch (end - k) {
        case 4:
            best = eliminate_column<3>(k);
            break;
        case 3:
            best = eliminate_column<2>(k);
            break;
        case 2:
            best = eliminate_column<1>(k);
            break;
        default:
            eliminate_column<0>(k);
        }
    }
    return true;
}

/// Rows first..last - 1 less what pivot rows `of` .. end - 1 have of them, in the columns from `from` on.
void Panel::subtract(int first, int last, std::pair<int, int> of, int from)
{
    const RowFunctions& rows = row_functions();
    const auto [pivot, end] = of;
    if (first >= last || pivot >= end) return;
    const int behind = std::max(from, *std::max_element(reach_.begin() + pivot, reach_.begin() + end));
    const int n = (behind - from + at_once - 1) / at_once * at_once;
    if (end - pivot == at_once) {
        rows.subtract_fours(row(first) + from, row(first) + pivot, row(pivot) + from, stride_, last - first,
                            n);
    } else {
        for (int i = first; i < last; ++i)
            for (int k = pivot; k < end; ++k)
                if (row(i)[k] != 0) rows.subtract_scaled(row(i) + from, row(i)[k], row(k) + from, n);
    }
    for (int i = first; i < last; ++i) reach_[i] = std::max(reach_[i], behind);
}

/// Four pivots at a time: in their own columns, then in those behind, where each pivot row is finished by the
/// pivots before it, and all rows below by the four together.
bool Panel::eliminate(int n_first, int reach)
{
    beta_.clear();
    for (int i = 0; i < n_rows_; ++i) {
        is_first_[i] = i < n_first;
        reach_[i] = i < n_first ? reach : width_;
    }
    for (int first = 0; first < n_pivots_; first += at_once) {
        const int end = std::min(first + at_once, n_pivots_);
        if (!eliminate_block(first, end)) return false;
        for (int k = first + 1; k < end; ++k) subtract(k, k + 1, {first, k}, end);
        subtract(end, n_rows_, {first, end}, end);
    }
    return true;
}

/// The diagonal takes the sign that adds in v_0 = a_kk - diagonal, so that no digits are lost; with v_k = 1
/// it is beta = 2 / v^T v = -v_0 / diagonal. Squares are of entries over the largest one, and cannot
/// overflow.
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

void Panel::solve(double* x) const
{
    const RowFunctions& rows = row_functions();
    for (int k = n_pivots_ - 1; k >= 0; --k) {
        const double* u = row(k);
        x[k] = (x[k] - inner(rows, u + k + 1, x + k + 1, width_ - k - 1)) / u[k];
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
