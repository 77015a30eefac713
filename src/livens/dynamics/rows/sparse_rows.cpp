// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/rows/sparse_rows.h"

#include <cmath>

#include <Eigen/Sparse>

namespace livens {

struct SparseRows::Matrices {
    using Matrix = Eigen::SparseMatrix<double>;
    Matrix G;
    Eigen::SimplicialLDLT<Matrix> factor;
};

SparseRows::SparseRows(int n_rows, int n_columns, std::span<const Entry> entries)
    : matrices_(std::make_unique<Matrices>())
{
    std::vector<Eigen::Triplet<double>> triplets;
    for (const Entry& entry : entries)
        if (entry.value != 0) triplets.emplace_back(entry.row, entry.column, entry.value);
    matrices_->G.resize(n_rows, n_columns);
    matrices_->G.setFromTriplets(triplets.begin(), triplets.end());
    const Matrices::Matrix S = matrices_->G * matrices_->G.transpose();
    matrices_->factor.compute(S);
    if (matrices_->factor.info() != Eigen::Success) return;
    const Eigen::VectorXd pivots = matrices_->factor.vectorD(),
                          order = matrices_->factor.permutationP() * Eigen::VectorXd(S.diagonal());
    double smallest = 1;
    for (Eigen::Index i = 0; i < pivots.size(); ++i) {
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
    const int n_passes = smallest_pivot_ > 1e-3 ? 2 : 4;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(aim.size());
    for (int pass = 0; pass < n_passes; ++pass) {
        const Eigen::VectorXd mu = matrices_->factor.solve(matrices_->G * to - aim);
        to -= matrices_->G.transpose() * mu;
        sum += mu;
    }
    return {sum.begin(), sum.end()};
}

}   // namespace livens
