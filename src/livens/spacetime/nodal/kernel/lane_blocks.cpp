// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/kernel/lane_blocks.h"

#include <algorithm>
#include <cmath>

namespace livens::inline spacetime_internal {

Numbers from_left(const Numbers& M, int n, int f, int p, const LaneBlock& J)
{
    Numbers out(static_cast<std::size_t>(f * p * J.columns), 0.0);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < f; ++k)
            for (int A = 0; A < p; ++A) {
                const double m = M[(i * f + k) * p + A];
                if (m == 0) continue;
                const double* x = J.of.data() + (i * p + A) * J.columns;
                double* to = out.data() + (k * p + A) * J.columns;
                for (int c = 0; c < J.columns; ++c) to[c] += m * x[c];
            }
    return out;
}

Numbers from_right(const LaneBlock& J, const Numbers& M, int n, int f, int p)
{
    Numbers out(static_cast<std::size_t>(J.rows * f * p), 0.0);
    for (int r = 0; r < J.rows; ++r)
        for (int j = 0; j < n; ++j) {
            const double* x = J.of.data() + r * J.columns + j * p;
            for (int k = 0; k < f; ++k) {
                const double* m = M.data() + (j * f + k) * p;
                double* to = out.data() + (r * f + k) * p;
                for (int B = 0; B < p; ++B) to[B] += x[B] * m[B];
            }
        }
    return out;
}

void add(Numbers& to, const Numbers& more)
{
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += more[i];
}

void subtract_product(Numbers& to, const Numbers& a, const Numbers& b, int rows, int inner, int columns)
{
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < inner; ++k) {
            const double m = a[r * inner + k];
            const double* x = b.data() + k * columns;
            double* out = to.data() + r * columns;
            for (int c = 0; c < columns; ++c) out[c] -= m * x[c];
        }
}

bool SquareFactor::factorise(int n)
{
    exchanged.resize(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(A[i * n + k]) > std::abs(A[pivot * n + k])) pivot = i;
        exchanged[static_cast<std::size_t>(k)] = pivot;
        if (!(std::abs(A[pivot * n + k]) > 0) || !std::isfinite(A[pivot * n + k])) return false;
        if (pivot != k) std::swap_ranges(A.begin() + k * n, A.begin() + (k + 1) * n, A.begin() + pivot * n);
        const double inverse = 1 / A[k * n + k];
        for (int i = k + 1; i < n; ++i) {
            const double m = A[i * n + k] *= inverse;
            for (int j = k + 1; m != 0 && j < n; ++j) A[i * n + j] -= m * A[k * n + j];
        }
    }
    return true;
}

void SquareFactor::solve(double* x, int columns) const
{
    const int n = static_cast<int>(exchanged.size());
    for (int k = 0; k < n; ++k) {
        const int other = exchanged[static_cast<std::size_t>(k)];
        if (other != k) std::swap_ranges(x + k * columns, x + (k + 1) * columns, x + other * columns);
    }
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < i; ++k)
            for (int c = 0; c < columns; ++c) x[i * columns + c] -= A[i * n + k] * x[k * columns + c];
    for (int i = n; i-- > 0;) {
        for (int k = i + 1; k < n; ++k)
            for (int c = 0; c < columns; ++c) x[i * columns + c] -= A[i * n + k] * x[k * columns + c];
        const double inverse = 1 / A[i * n + i];
        for (int c = 0; c < columns; ++c) x[i * columns + c] *= inverse;
    }
}

}   // namespace livens::inline spacetime_internal
