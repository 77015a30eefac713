// SPDX-License-Identifier: BSD-3-Clause
// Rows G that touch few columns each: the Cholesky factor of G G^T, and the projection onto the null space of
// G. Serves rank and least reactions along long chains (theory.md, "Rank is geometry").
#include "livens/solvers/sparse_rows.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

#define EIGEN_MPL2_ONLY   // nothing of the LGPL, be it in some version of Eigen
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

namespace livens::inline solvers_internal {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

Matrix sum_of(std::span<const SparseEntry> entries, int n_rows, int n_columns, bool keep_zeros)
{
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (const SparseEntry& entry : entries)
        if (keep_zeros || entry.value != 0) triplets.emplace_back(entry.row, entry.column, entry.value);
    Matrix sum(n_rows, n_columns);
    sum.setFromTriplets(triplets.begin(), triplets.end());
    return sum;
}

}   // namespace

struct SparseRows::Matrices {
    Matrix G;
    Eigen::SimplicialLDLT<Matrix> factor;
};

SparseRows::SparseRows(int n_rows, int n_columns, std::span<const Entry> entries)
    : matrices_(std::make_unique<Matrices>())
{
    matrices_->G = sum_of(entries, n_rows, n_columns, false);
    const Matrix S = matrices_->G * matrices_->G.transpose();
    matrices_->factor.compute(S);
    if (matrices_->factor.info() != Eigen::Success) return;
    const Eigen::VectorXd pivots = matrices_->factor.vectorD(),
                          order = matrices_->factor.permutationP() * Eigen::VectorXd(S.diagonal());
    double smallest = 1;
    for (Eigen::Index i = 0; i < pivots.size(); ++i) {
        // A pivot of G G^T over the row's own square is the squared sine of the angle to the rows before it.
        const double ratio = pivots[i] / order[i];
        if (!(ratio >= smallest)) smallest = ratio > 0 ? ratio : 0;   // nan is no pivot
    }
    smallest_pivot_ = std::sqrt(smallest);
}

SparseRows::~SparseRows() = default;

std::vector<double> SparseRows::project(std::span<double> y, std::span<const double> wanted) const
{
    Eigen::Map<Eigen::VectorXd> to(y.data(), static_cast<Eigen::Index>(y.size()));
    const Eigen::Map<const Eigen::VectorXd> aim(wanted.data(), static_cast<Eigen::Index>(wanted.size()));
    // Each pass leaves eps / pivot^2 of what it was to take off, so smaller pivots need more passes.
    const int n_passes = smallest_pivot_ > 1e-3 ? 2 : 4;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(aim.size());
    for (int pass = 0; pass < n_passes; ++pass) {
        const Eigen::VectorXd mu = matrices_->factor.solve(matrices_->G * to - aim);
        to -= matrices_->G.transpose() * mu;
        sum += mu;
    }
    return {sum.begin(), sum.end()};
}

std::optional<std::vector<double>> sparse_solution(std::span<const SparseEntry> A, std::span<const double> b)
{
    const int n = static_cast<int>(b.size());
    if (n == 0) return std::vector<double>{};
    if (!std::ranges::all_of(A, [](const SparseEntry& e) { return std::isfinite(e.value); })) return {};
    const Eigen::SparseLU<Matrix> lu(sum_of(A, n, n, true));
    if (lu.lastErrorMessage().starts_with("UNABLE")) throw std::bad_alloc();   // to allocate working memory
    if (lu.info() != Eigen::Success) return {};
    const Eigen::VectorXd x = lu.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    return std::vector<double>(x.begin(), x.end());
}

}   // namespace livens::inline solvers_internal
