// SPDX-License-Identifier: BSD-3-Clause
// Factorisations of dense matrices on plain arrays: pivoted QR for rank (theory.md, "Rank is geometry"),
// least squares, null spaces, Cholesky and LU. What is not finite comes out as nan instead of whatever a
// pivot search would make of it.
#include "livens/solvers/factors.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "livens/solvers/detail/eigen_views.h"

namespace livens::inline solvers_internal {

namespace {

DenseMatrix all_nan(int rows, int cols)
{
    DenseMatrix A(rows, cols);
    std::ranges::fill(A.a, nan);
    return A;
}

/// Q applied to the columns first, first + 1, .. of the identity.
template <typename QR>
DenseMatrix columns_of_Q(const QR& qr, Index first, Index n)
{
    // Only the columns that are asked for are formed: a null space of a long chain has few of many.
    MatrixXd Q = MatrixXd::Identity(qr.rows(), first + n).rightCols(n);
    if (Q.size() > 0) Q.applyOnTheLeft(qr.householderQ());   // Eigen would step into what has no memory
    return stored(Q);
}

}   // namespace

struct PivotedQR::Factors {
    int rows, cols;
    std::optional<Eigen::ColPivHouseholderQR<MatrixXd>> qr;   // not of what is empty or not finite
};

PivotedQR::PivotedQR(DenseView A) : factors_(new Factors{A.rows, A.cols, std::nullopt})
{
    if (A.rows > 0 && A.cols > 0 && all_finite(A.entries())) factors_->qr.emplace(seen(A));
}

PivotedQR::~PivotedQR() = default;

int PivotedQR::n_pivots() const { return std::min(factors_->rows, factors_->cols); }

double PivotedQR::pivot(int k) const
{
    assert(k >= 0 && k < n_pivots());
    // The pivots descend in size; callers compare them with what rounding could have made of zero.
    return factors_->qr ? std::abs(factors_->qr->matrixQR()(k, k)) : nan;
}

int PivotedQR::column(int k) const
{
    assert(k >= 0 && k < factors_->cols);
    return factors_->qr ? factors_->qr->colsPermutation().indices()[k] : k;
}

DenseMatrix PivotedQR::basis(int first, int n) const
{
    assert(first >= 0 && n >= 0 && first + n <= factors_->rows);
    if (factors_->qr) return columns_of_Q(*factors_->qr, first, n);
    if (factors_->cols > 0) return all_nan(factors_->rows, n);
    // A matrix without columns leaves everything free: Q is the identity.
    DenseMatrix of_nothing(factors_->rows, n);
    for (int k = 0; k < n; ++k) of_nothing(first + k, k) = 1;
    return of_nothing;
}

std::vector<double> PivotedQR::solve(std::span<const double> b) const
{
    assert(static_cast<int>(b.size()) == factors_->rows);
    // A matrix of zeros has rank 0, for which the solution of least size is zero; Eigen would divide 0 by 0.
    const bool is_zero = n_pivots() == 0 || pivot(0) == 0;
    if (is_zero || !factors_->qr || !all_finite(b))
        return std::vector<double>(static_cast<std::size_t>(factors_->cols), is_zero ? 0 : nan);
    return values_of(factors_->qr->solve(VectorXd(seen(b))));
}

DenseMatrix orthonormal_columns(DenseView A)
{
    assert(A.rows >= A.cols);
    if (A.cols == 0) return {A.rows, 0};
    if (!all_finite(A.entries())) return all_nan(A.rows, A.cols);
    const Eigen::HouseholderQR<MatrixXd> qr(seen(A));
    return stored(qr.householderQ() * MatrixXd::Identity(A.rows, A.cols));
}

DenseMatrix upper_factor(DenseView A)
{
    assert(A.rows >= A.cols);
    if (A.cols == 0) return {};
    if (!all_finite(A.entries())) return all_nan(A.cols, A.cols);
    const Eigen::HouseholderQR<MatrixXd> qr(seen(A));
    return stored(qr.matrixQR().topRows(A.cols).triangularView<Eigen::Upper>());
}

DenseMatrix least_squares(DenseView A, DenseView B)
{
    assert(A.rows == B.rows && A.rows >= A.cols);
    if (A.cols == 0 || B.cols == 0) return {A.cols, B.cols};
    if (!all_finite(A.entries()) || !all_finite(B.entries())) return all_nan(A.cols, B.cols);
    return stored(Eigen::HouseholderQR<MatrixXd>(seen(A)).solve(MatrixXd(seen(B))));
}

DenseMatrix upper_solution(DenseView R, DenseView B)
{
    assert(R.rows == R.cols && R.rows == B.rows);
    if (R.rows == 0 || B.cols == 0) return {R.rows, B.cols};
    return stored(seen(R).triangularView<Eigen::Upper>().solve(MatrixXd(seen(B))));
}

std::vector<double> upper_solution(DenseView R, std::span<const double> b)
{
    assert(R.rows == R.cols && R.rows == static_cast<int>(b.size()));
    if (R.rows == 0) return {};
    return values_of(seen(R).triangularView<Eigen::Upper>().solve(VectorXd(seen(b))));
}

DenseMatrix null_space(DenseView A, double threshold)
{
    if (A.cols == 0 || !all_finite(A.entries())) return {A.cols, 0};
    if (A.rows == 0) return stored(MatrixXd::Identity(A.cols, A.cols));
    // Full pivoting tells rank where columns differ in size; the basis it gives is not orthonormal.
    Eigen::FullPivLU<MatrixXd> lu(seen(A));
    lu.setThreshold(threshold);
    if (lu.dimensionOfKernel() == 0) return {A.cols, 0};
    return stored(lu.kernel());
}

DenseMatrix cholesky(DenseView A)
{
    assert(A.rows == A.cols);
    if (A.rows == 0) return {};
    if (!all_finite(A.entries())) return all_nan(A.rows, A.cols);
    // A matrix that is not positive definite comes out as nan, which callers find by one look at the result.
    const Eigen::LLT<MatrixXd> factor(seen(A));
    if (factor.info() != Eigen::Success) return all_nan(A.rows, A.cols);
    return stored(factor.matrixL());
}

DenseMatrix cholesky_solution(DenseView L, DenseView B)
{
    assert(L.rows == L.cols && L.rows == B.rows);
    MatrixXd X = seen(B);
    seen(L).triangularView<Eigen::Lower>().solveInPlace(X);
    seen(L).adjoint().triangularView<Eigen::Upper>().solveInPlace(X);
    return stored(X);
}

std::vector<double> cholesky_solution(DenseView L, std::span<const double> b)
{
    assert(L.rows == L.cols && L.rows == static_cast<int>(b.size()));
    VectorXd x = seen(b);
    seen(L).triangularView<Eigen::Lower>().solveInPlace(x);
    seen(L).adjoint().triangularView<Eigen::Upper>().solveInPlace(x);
    return values_of(x);
}

Matrix4 inverse_of_positive(const Matrix4& A)
{
    const DenseMatrix factor = cholesky({4, 4, A.data()});
    const Matrix4 one = identity<4>();
    Matrix4 inverse;
    std::ranges::copy(cholesky_solution(factor, {4, 4, one.data()}).a, inverse.data());
    return inverse;
}

LUSolution lu_solution(DenseView A, std::span<const double> b)
{
    assert(A.rows == A.cols && A.rows == static_cast<int>(b.size()));
    if (A.rows == 0) return {};
    if (!all_finite(A.entries()) || !all_finite(b)) return {std::vector<double>(b.size(), nan), nan, nan};
    const Eigen::PartialPivLU<MatrixXd> lu(seen(A));
    // The quotient of the smallest and the largest pivot is a cheap, rough measure of singularity.
    const VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
    return {values_of(lu.solve(VectorXd(seen(b)))), pivots.minCoeff(), pivots.maxCoeff()};
}

}   // namespace livens::inline solvers_internal
