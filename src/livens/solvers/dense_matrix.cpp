// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices whose size is known when they are made, in plain arrays, column by column. Eigen computes
// the products; it is seen in the sources of this room alone (docs/architecture.md, "The rooms").
#include "livens/solvers/dense_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "livens/solvers/detail/eigen_views.h"

namespace livens::inline solvers_internal {

DenseMatrix::DenseMatrix(int n_rows, int n_columns)
    : rows(n_rows), cols(n_columns), a(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols), 0.0)
{}

DenseMatrix::DenseMatrix(DenseView from)
    : rows(from.rows), cols(from.cols), a(from.entries().begin(), from.entries().end())
{}

void DenseMatrix::append_column(std::span<const double> entries)
{
    // The first column says how long all are: matrices are often gathered column by column.
    if (cols == 0) rows = static_cast<int>(entries.size());
    assert(static_cast<int>(entries.size()) == rows);
    a.insert(a.end(), entries.begin(), entries.end());
    ++cols;
}

DenseMatrix DenseMatrix::middle_rows(int first, int n) const
{
    assert(first >= 0 && first + n <= rows);
    DenseMatrix part(n, cols);
    for (int j = 0; j < cols; ++j) std::copy_n(column(j).data() + first, n, part.column(j).data());
    return part;
}

void DenseMatrix::set_rows(int first, DenseView from)
{
    assert(first >= 0 && first + from.rows <= rows && from.cols == cols);
    for (int j = 0; j < cols; ++j) std::ranges::copy(from.column(j), column(j).data() + first);
}

DenseMatrix transpose(DenseView A)
{
    DenseMatrix T(A.cols, A.rows);
    for (int j = 0; j < A.cols; ++j)
        for (int i = 0; i < A.rows; ++i) T(j, i) = A(i, j);
    return T;
}

namespace {

// (A + A^T)/2 or (A - A^T)/2; their sum is A.
DenseMatrix half_with_transposed(DenseView A, double sign)
{
    assert(A.rows == A.cols);
    DenseMatrix S(A.rows, A.cols);
    for (int j = 0; j < A.cols; ++j)
        for (int i = 0; i < A.rows; ++i) S(i, j) = 0.5 * (A(i, j) + sign * A(j, i));
    return S;
}

}   // namespace

DenseMatrix symmetric_part(DenseView A) { return half_with_transposed(A, 1); }
DenseMatrix skew_part(DenseView A) { return half_with_transposed(A, -1); }

DenseMatrix product(DenseView A, DenseView B)
{
    assert(A.cols == B.rows);
    DenseMatrix C(A.rows, B.cols);
    // The result is a new matrix and aliases nothing, so that Eigen needs no temporary one.
    seen(C).noalias() = seen(A) * seen(B);
    return C;
}

DenseMatrix transposed_product(DenseView A, DenseView B)
{
    assert(A.rows == B.rows);
    DenseMatrix C(A.cols, B.cols);
    seen(C).noalias() = seen(A).transpose() * seen(B);
    return C;
}

std::vector<double> product(DenseView A, std::span<const double> x)
{
    assert(A.cols == static_cast<int>(x.size()));
    std::vector<double> y(static_cast<std::size_t>(A.rows), 0.0);
    seen(y).noalias() = seen(A) * seen(x);
    return y;
}

std::vector<double> transposed_product(DenseView A, std::span<const double> x)
{
    assert(A.rows == static_cast<int>(x.size()));
    std::vector<double> y(static_cast<std::size_t>(A.cols), 0.0);
    seen(y).noalias() = seen(A).transpose() * seen(x);
    return y;
}

namespace {

template <int R, int C>
Eigen::Map<const Eigen::Matrix<double, R, C>> seen(const Matrix<R, C>& A)
{
    return Eigen::Map<const Eigen::Matrix<double, R, C>>(A.data());
}
Eigen::Map<Eigen::Matrix<double, 6, 6>> seen(Matrix<6, 6>& A)
{
    return Eigen::Map<Eigen::Matrix<double, 6, 6>>(A.data());
}

}   // namespace

Matrix<6, 6> congruence(double factor, const Matrix<12, 6>& A, const Matrix<12, 12>& K,
                        const Matrix<12, 6>& B)
{
    double KB[12][6] = {};   // of forms of joints nine tenths of K are zero
    for (int c = 0; c < 12; ++c)
        for (int r = 0; r < 12; ++r) {
            const double k = factor * K(r, c);
            if (k == 0) continue;
            for (int j = 0; j < 6; ++j) KB[r][j] += k * B(c, j);
        }
    Matrix<6, 6> C{};
    for (int i = 0; i < 6; ++i)
        for (int r = 0; r < 12; ++r) {
            const double a = A(r, i);
            if (a == 0) continue;
            for (int j = 0; j < 6; ++j) C(i, j) += a * KB[r][j];
        }
    return C;
}

// A^T K A: the form K in the coordinates that A maps from.
Matrix<6, 6> congruence(const Matrix<6, 6>& A, const Matrix<6, 6>& K)
{
    Matrix<6, 6> C;
    seen(C) = seen(A).transpose() * seen(K) * seen(A);
    return C;
}

double dot(std::span<const double> x, std::span<const double> y)
{
    assert(x.size() == y.size());
    return seen(x).dot(seen(y));
}

double norm(std::span<const double> x) { return seen(x).norm(); }

double squared_norm(std::span<const double> x) { return seen(x).squaredNorm(); }

std::vector<double> row_norms(DenseView A)
{
    std::vector<double> norms(static_cast<std::size_t>(A.rows), 0.0);
    if (A.cols > 0) seen(norms) = seen(A).rowwise().norm();
    return norms;
}

double largest_size(std::span<const double> x)
{
    double largest = 0;
    for (const double entry : x) {
        // std::max drops a nan, and a caller would take the largest of the others for finite.
        if (std::isnan(entry)) return entry;
        largest = std::max(largest, std::abs(entry));
    }
    return largest;
}

bool all_finite(std::span<const double> x)
{
    return std::ranges::all_of(x, [](double entry) { return std::isfinite(entry); });
}

void add_scaled(std::span<double> y, double factor, std::span<const double> x)
{
    assert(x.size() == y.size());
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * x[i];
}

}   // namespace livens::inline solvers_internal
