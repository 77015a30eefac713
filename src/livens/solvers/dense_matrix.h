// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices whose size is known when they are made, and their products. Vectors are spans.
//
// Sums of products are Eigen's, which takes two or more of them at a time: written as a loop they round
// otherwise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "livens/base/linear.h"

namespace livens::inline solvers_internal {

/// A matrix that somebody else keeps: rows x cols, column by column, without gaps.
struct DenseView {
    int rows = 0, cols = 0;
    const double* a = nullptr;

    double operator()(int i, int j) const { return column(j)[static_cast<std::size_t>(i)]; }
    std::span<const double> column(int j) const
    {
        const auto n = static_cast<std::size_t>(rows);
        return {a + n * static_cast<std::size_t>(j), n};
    }
    std::span<const double> entries() const
    {
        return {a, static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)};
    }
    DenseView left_columns(int n) const { return {rows, n, a}; }
};

/// A matrix, column by column; zero when it is made. All sizes may be 0.
struct DenseMatrix {
    int rows = 0, cols = 0;
    std::vector<double> a;   ///< rows cols of them

    DenseMatrix() = default;
    DenseMatrix(int n_rows, int n_columns);
    explicit DenseMatrix(DenseView from);

    operator DenseView() const { return {rows, cols, a.data()}; }
    bool is_empty() const { return a.empty(); }
    double& operator()(int i, int j) { return column(j)[static_cast<std::size_t>(i)]; }
    double operator()(int i, int j) const { return DenseView(*this)(i, j); }
    std::span<double> column(int j)
    {
        const auto n = static_cast<std::size_t>(rows);
        return {a.data() + n * static_cast<std::size_t>(j), n};
    }
    std::span<const double> column(int j) const { return DenseView(*this).column(j); }
    DenseView left_columns(int n) const { return DenseView(*this).left_columns(n); }

    /// Behind the last column, of `rows` entries; the first one says how many rows there are.
    void append_column(std::span<const double> entries);
    /// The rows first, first + 1, .. of all columns, n of them; and these taken from another matrix.
    DenseMatrix middle_rows(int first, int n) const;
    void set_rows(int first, DenseView from);
};

DenseMatrix transpose(DenseView A);
/// (A + A^T) / 2 and (A - A^T) / 2 of a square matrix.
DenseMatrix symmetric_part(DenseView A);
DenseMatrix skew_part(DenseView A);

/// A B and A^T B, A x and A^T x. Sizes must fit, which is asserted.
DenseMatrix product(DenseView A, DenseView B);
DenseMatrix transposed_product(DenseView A, DenseView B);
std::vector<double> product(DenseView A, std::span<const double> x);
std::vector<double> transposed_product(DenseView A, std::span<const double> x);

/// factor A^T K B, and A^T K A: from the 12 coordinates of a body, and from 6, to 6 others.
Matrix<6, 6> congruence(double factor, const Matrix<12, 6>& A, const Matrix<12, 12>& K,
                        const Matrix<12, 6>& B);
Matrix<6, 6> congruence(const Matrix<6, 6>& A, const Matrix<6, 6>& K);

/// x . y, |x| and x . x; of nothing 0. Squares may overflow.
double dot(std::span<const double> x, std::span<const double> y);
double norm(std::span<const double> x);
double squared_norm(std::span<const double> x);
/// The norms of the rows.
std::vector<double> row_norms(DenseView A);

/// The largest |x_i|; of nothing 0, nan where one is nan.
double largest_size(std::span<const double> x);
bool all_finite(std::span<const double> x);
/// y <- y + factor x.
void add_scaled(std::span<double> y, double factor, std::span<const double> x);

}   // namespace livens::inline solvers_internal
