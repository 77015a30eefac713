// SPDX-License-Identifier: BSD-3-Clause
// Dense LU and Cholesky factors of the sizes that one element has: dozens of rows, millions
// of times. Written out for short rows, for which the blocking of a library does not pay; nothing is
// allocated.
#include "livens/solvers/dense.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"

namespace livens {

void DenseLU::resize(int n)
{
    n_ = n;
    a_.assign(count(n, n), 0.0);
    pivot_.assign(static_cast<std::size_t>(n), 0);
}

/// Brings the row with the largest entry in column k of rows k.. to place k.
bool DenseLU::choose_pivot(int k)
{
    int best = k;
    double largest = -1;
    for (int i = k; i < n_; ++i) {
        const double size = std::abs(row(i)[k]);
        if (size > largest) {
            largest = size;
            best = i;
        }
    }
    pivot_[k] = best;
    if (best != k) {
        std::swap_ranges(row(k), row(k) + n_, row(best));
    }
    failed_ = k;   // stays so if this is the last
    return largest > 0 && std::isfinite(largest);
}

/// Takes two pivots off all rows below in one pass over them.
void DenseLU::eliminate_pair(int k)
{
    const double* __restrict u0 = row(k) + k + 2;
    const double* __restrict u1 = row(k + 1) + k + 2;
    const int m = n_ - k - 2;
    for (int i = k + 2; i < n_; ++i) {
        double* a = row(i) + k;
        const double l0 = a[0], l1 = a[1];
        if (l0 == 0 && l1 == 0) continue;
        double* __restrict y = a + 2;
        for (int j = 0; j < m; ++j) y[j] -= l0 * u0[j] + l1 * u1[j];
    }
}

bool DenseLU::factorise()
{
    int k = 0;
    // Columns are eliminated in pairs: each row below is then read and written once for two pivots.
    for (; k + 1 < n_; k += 2) {
        if (n_ >= large) Patience::ask();
        if (!choose_pivot(k)) return false;
        const double d0 = 1 / row(k)[k], top = row(k)[k + 1];
        for (int i = k + 1; i < n_; ++i) {
            double* a = row(i) + k;
            a[0] *= d0;
            a[1] -= a[0] * top;
        }
        if (!choose_pivot(k + 1)) return false;
        const double d1 = 1 / row(k + 1)[k + 1];
        for (int i = k + 2; i < n_; ++i) row(i)[k + 1] *= d1;
        // the second pivot row itself still lacks the first elimination
        subtract_scaled(row(k + 1) + k + 2, row(k + 1)[k], row(k) + k + 2, n_ - k - 2);
        eliminate_pair(k);
    }
    return k >= n_ || choose_pivot(k);
}

void DenseLU::solve(double* x) const
{
    for (int k = 0; k < n_; ++k) {
        if (pivot_[k] != k) std::swap(x[k], x[pivot_[k]]);
    }
    row_functions().solve_factors(x, a_.data(), n_);
}

/// A^T = U^T L^T P, without a column of U or L: their rows are taken off what is left.
void DenseLU::solve_transposed(double* x) const
{
    for (int i = 0; i < n_; ++i) {
        const double* r = row(i);
        x[i] /= r[i];
        subtract_scaled(x + i + 1, x[i], r + i + 1, n_ - i - 1);
    }
    for (int i = n_ - 1; i > 0; --i) subtract_scaled(x, x[i], row(i), i);
    for (int k = n_ - 1; k >= 0; --k) {
        if (pivot_[k] != k) std::swap(x[k], x[pivot_[k]]);
    }
}

void DenseLU::exchange(std::vector<double>& entries)
{
    assert(entries.size() == a_.size());
    a_.swap(entries);
}

double DenseLU::smallest_pivot() const
{
    double smallest = n_ > 0 ? std::abs(row(0)[0]) : 1;
    for (int k = 1; k < n_; ++k) smallest = std::min(smallest, std::abs(row(k)[k]));
    return smallest;
}

double DenseLU::largest_in_U() const
{
    double largest = 0;
    for (int i = 0; i < n_; ++i)
        for (int j = i; j < n_; ++j) largest = std::max(largest, std::abs(row(i)[j]));
    return largest;
}

void Cholesky::resize(int n)
{
    n_ = n;
    a_.assign(count(n, n), 0.0);
}

bool Cholesky::factorise()
{
    for (int j = 0; j < n_; ++j) {
        if (n_ >= large) Patience::ask();
        double* rj = row(j);
        const double d = rj[j] - inner(rj, rj, j);
        if (!(d > 0)) return false;
        rj[j] = std::sqrt(d);
        const double s = 1 / rj[j];
        for (int i = j + 1; i < n_; ++i) {
            double* ri = row(i);
            ri[j] = (ri[j] - inner(ri, rj, j)) * s;
        }
    }
    return true;
}

void Cholesky::solve(double* x) const
{
    for (int i = 0; i < n_; ++i) x[i] = (x[i] - inner(row(i), x, i)) / row(i)[i];
    for (int i = n_ - 1; i >= 0; --i) {
        x[i] /= row(i)[i];
        subtract_scaled(x, x[i], row(i), i);
    }
}

}   // namespace livens
