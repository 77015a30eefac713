// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices whose rows and columns are numbers at p nodes: (i, A) is row i p + A.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::inline spacetime_internal {

using Numbers = std::vector<double>;

/// A square matrix as its factor with exchanged rows.
struct SquareFactor {
    Numbers A;
    std::vector<int> exchanged;

    /// Of what stands in A, n rows. False: singular, or no number.
    bool factorise(const lanes::BlockFunctions& functions, int n)
    {
        exchanged.resize(static_cast<std::size_t>(n));
        return functions.factorise_square(A.data(), exchanged.data(), n);
    }
    /// x <- A^-1 x for all columns.
    void solve(const lanes::BlockFunctions& functions, double* x, int columns) const
    {
        functions.solve_square(A.data(), exchanged.data(), static_cast<int>(exchanged.size()), x, columns);
    }
    /// x <- A^-T x.
    void solve_transposed(double* x) const
    {
        const int n = static_cast<int>(exchanged.size());
        const auto take_off = [&](int k, int first, int end) {
            for (int i = first; i < end; ++i) x[i] -= A[static_cast<std::size_t>(k * n + i)] * x[k];
        };
        for (int k = 0; k < n; ++k) {
            x[k] /= A[static_cast<std::size_t>(k * n + k)];
            take_off(k, k + 1, n);
        }
        for (int k = n; k-- > 0;) take_off(k, 0, k);
        for (int k = n; k-- > 0;) std::swap(x[k], x[exchanged[static_cast<std::size_t>(k)]]);
    }
};

}   // namespace livens::inline spacetime_internal
