// SPDX-License-Identifier: BSD-3-Clause
// Matrices for the tests of what is made of Eigen, and their differences.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/solvers/dense_matrix.h"
#include "sparse_matrices.h"

namespace livens {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

inline DenseMatrix random_dense(int rows, int cols, unsigned seed)
{
    Random random(seed);
    DenseMatrix A(rows, cols);
    for (double& entry : A.a) entry = random.next();
    return A;
}

inline DenseMatrix random_symmetric(int n, unsigned seed) { return symmetric_part(random_dense(n, n, seed)); }

/// B^T B + 1
inline DenseMatrix random_positive(int n, unsigned seed)
{
    const DenseMatrix B = random_dense(n, n, seed);
    DenseMatrix A = transposed_product(B, B);
    for (int i = 0; i < n; ++i) A(i, i) += 1;
    return A;
}

inline DenseMatrix unit_matrix(int n)
{
    DenseMatrix A(n, n);
    for (int i = 0; i < n; ++i) A(i, i) = 1;
    return A;
}

inline DenseMatrix diagonal_matrix(const Values& d)
{
    DenseMatrix A = unit_matrix(static_cast<int>(d.size()));
    for (int i = 0; i < A.rows; ++i) A(i, i) = d[i];
    return A;
}

/// The sum of products, one after the other.
inline DenseMatrix plain_product(DenseView A, DenseView B)
{
    DenseMatrix C(A.rows, B.cols);
    for (int i = 0; i < A.rows; ++i)
        for (int j = 0; j < B.cols; ++j)
            for (int k = 0; k < A.cols; ++k) C(i, j) += A(i, k) * B(k, j);
    return C;
}

/// Infinite where sizes differ, nan where an entry is.
inline double difference(DenseView A, DenseView B)
{
    if (A.rows != B.rows || A.cols != B.cols) return std::numeric_limits<double>::infinity();
    Values gap(A.entries().begin(), A.entries().end());
    add_scaled(gap, -1, B.entries());
    return largest_size(gap);
}
inline double difference(const Values& x, const Values& y)
{
    return difference(DenseView{static_cast<int>(x.size()), 1, x.data()},
                      DenseView{static_cast<int>(y.size()), 1, y.data()});
}

inline bool all_nan(std::span<const double> x)
{
    return std::ranges::all_of(x, [](double entry) { return std::isnan(entry); });
}

inline bool is_orthonormal(DenseView Q)
{
    return difference(transposed_product(Q, Q), unit_matrix(Q.cols)) < 1e-13;
}

}   // namespace livens
