// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices whose rows and columns are numbers at p nodes: (i, A) is row i p + A.
#pragma once

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
};

}   // namespace livens::inline spacetime_internal
