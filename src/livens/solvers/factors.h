// SPDX-License-Identifier: BSD-3-Clause
// Factorisations of dense matrices that are made once and asked a few questions: rank, bases, solutions.
// Those that are made a thousand times a second stand in dense.h.
//
// Everywhere: sizes must fit, which is asserted; where an entry is not finite, all that follows from it is
// nan. Memory that ends is std::bad_alloc, and nothing else is thrown.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/base/linear.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::inline solvers_internal {

/// A P = Q R by Householder reflections, of what is left the longest column first.
class PivotedQR {
public:
    explicit PivotedQR(DenseView A);
    ~PivotedQR();
    PivotedQR(const PivotedQR&) = delete;
    PivotedQR& operator=(const PivotedQR&) = delete;

    /// min(rows, cols)
    int n_pivots() const;
    /// |R_kk|, descending but for rounding; k < n_pivots().
    double pivot(int k) const;
    /// Which column of A came k-th; k < cols.
    int column(int k) const;
    /// The columns first, first + 1, .. of Q, n of them: rows x n.
    DenseMatrix basis(int first, int n) const;
    /// x of A x = b in the least squares, with zeros beyond the rank.
    std::vector<double> solve(std::span<const double> b) const;

private:
    struct Factors;
    std::unique_ptr<Factors> factors_;
};

/// Without exchanges, of a matrix with at least as many rows as columns: the first `cols` columns of Q, and
/// the upper triangle R, cols x cols.
DenseMatrix orthonormal_columns(DenseView A);
DenseMatrix upper_factor(DenseView A);
/// X of A X = B in the least squares, for independent columns of A.
DenseMatrix least_squares(DenseView A, DenseView B);
/// R^-1 B and R^-1 b with an upper triangle R; infinite or nan where its diagonal has a zero.
DenseMatrix upper_solution(DenseView R, DenseView B);
std::vector<double> upper_solution(DenseView R, std::span<const double> b);

/// A basis of the x with A x = 0, one in each column, by LU with exchanges of rows and columns: pivots of
/// `threshold` of the largest and less are zeros. None where an entry is not finite.
DenseMatrix null_space(DenseView A, double threshold);

/// L with A = L L^T, a lower triangle; nan all over where A is not positive definite. The lower triangle of A
/// is read. Then A^-1 B and A^-1 b.
DenseMatrix cholesky(DenseView A);
DenseMatrix cholesky_solution(DenseView L, DenseView B);
std::vector<double> cholesky_solution(DenseView L, std::span<const double> b);
/// A^-1 by the same.
Matrix4 inverse_of_positive(const Matrix4& A);

/// A^-1 b by LU with row exchanges; not finite where A is singular.
struct LUSolution {
    std::vector<double> x;
    double smallest_pivot = 1, largest_pivot = 1;   ///< |U_kk|; 1 where the size is 0
};
LUSolution lu_solution(DenseView A, std::span<const double> b);

}   // namespace livens::inline solvers_internal
