// SPDX-License-Identifier: BSD-3-Clause
// Plain arrays in Eigen's eyes, and back. For sources of this room that include Eigen, which compile as one
// group: what several of them ask of Eigen is made once.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "livens/solvers/dense_matrix.h"

namespace livens::inline solvers_internal {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of what is not finite.
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline Eigen::Map<const MatrixXd> seen(DenseView A) { return {A.a, A.rows, A.cols}; }
inline Eigen::Map<MatrixXd> seen(DenseMatrix& A) { return {A.a.data(), A.rows, A.cols}; }
inline Eigen::Map<const VectorXd> seen(std::span<const double> x)
{
    return {x.data(), static_cast<Index>(x.size())};
}
inline Eigen::Map<VectorXd> seen(std::vector<double>& x) { return {x.data(), static_cast<Index>(x.size())}; }

inline DenseMatrix stored(const MatrixXd& A)
{
    return DenseMatrix({static_cast<int>(A.rows()), static_cast<int>(A.cols()), A.data()});
}
inline std::vector<double> values_of(const VectorXd& x) { return {x.begin(), x.end()}; }

}   // namespace livens::inline solvers_internal
