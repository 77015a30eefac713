// SPDX-License-Identifier: BSD-3-Clause
// Sums over short rows of dense matrices, and how large these are.
#pragma once

#include <cstddef>

#include "livens/solvers/row_functions.h"

namespace livens::inline solvers_internal {

/// sum of x_i y_i, two running sums so that two multiplications are in flight.
inline double inner(const double* x, const double* y, int n)
{
    double s0 = 0, s1 = 0;
    int i = 0;
    for (; i + 1 < n; i += 2) {
        s0 += x[i] * y[i];
        s1 += x[i + 1] * y[i + 1];
    }
    if (i < n) s0 += x[i] * y[i];
    return s0 + s1;
}

/// y <- y - a x, in pairs: most calls are too short for the compiler's own blocking to pay.
inline void subtract_scaled(double* __restrict y, double a, const double* __restrict x, int n)
{
    int i = 0;
    for (; i + 1 < n; i += 2) {
        y[i] -= a * x[i];
        y[i + 1] -= a * x[i + 1];
    }
    if (i < n) y[i] -= a * x[i];
}

/// Shorter rows are done where they stand.
inline constexpr int few = 8;

inline double inner(const RowFunctions& rows, const double* x, const double* y, int n)
{
    return n < few ? inner(x, y, n) : rows.inner(x, y, n);
}

inline void subtract_scaled(const RowFunctions& rows, double* __restrict y, double a,
                            const double* __restrict x, int n)
{
    n < few ? subtract_scaled(y, a, x, n) : rows.subtract_scaled(y, a, x, n);
}

inline std::size_t count(int rows, int cols)
{
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
}

inline constexpr int large = 256;   // smaller ones are done before anyone could ask

}   // namespace livens::inline solvers_internal
