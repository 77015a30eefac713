// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices whose rows and columns are numbers at p nodes: (i, A) is row i p + A.
#pragma once

#include <vector>

namespace livens::inline spacetime_internal {

using Numbers = std::vector<double>;

struct LaneBlock {
    const Numbers& of;
    int rows, columns;
};

/// out (k, A; .) = sum_i M (i, k; A) J (i, A; .), i < n, k < f: rows of J taken together, node by node.
Numbers from_left(const Numbers& M, int n, int f, int p, const LaneBlock& J);
/// out (.; k, B) = sum_j J (.; j, B) M (j, k; B).
Numbers from_right(const LaneBlock& J, const Numbers& M, int n, int f, int p);
void add(Numbers& to, const Numbers& more);
/// to -= a b
void subtract_product(Numbers& to, const Numbers& a, const Numbers& b, int rows, int inner, int columns);

/// A square matrix as its factor with exchanged rows.
struct SquareFactor {
    Numbers A;
    std::vector<int> exchanged;

    /// Of what stands in A, n rows. False: singular, or no number.
    bool factorise(int n);
    /// x <- A^-1 x for all columns.
    void solve(double* x, int columns) const;
};

}   // namespace livens::inline spacetime_internal
