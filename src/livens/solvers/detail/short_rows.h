// SPDX-License-Identifier: BSD-3-Clause
// Sums over short rows of dense matrices.
#pragma once

#include <cstddef>

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

inline std::size_t count(int rows, int cols)
{
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
}

inline constexpr int large = 256;   // smaller ones are done before anyone could ask

}   // namespace livens::inline solvers_internal
