// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/orientation.h"

#include <cmath>

#include <Eigen/Dense>

namespace livens {

void Orientation::place(const Tables& tables, const std::vector<int>& rows, Instant at, const double* X)
{
    n_rows_ = static_cast<int>(rows.size());
    n_twists_ = tables.n_twists;
    gradients_.resize(rows.size() * static_cast<std::size_t>(n_twists_));
    maps_.resize(12 * tables.bodies.size());
    one_.resize(Tables::gradient_size);
    tables.map_twists(X, maps_.data());
    for (int i = 0; i < n_rows_; ++i) {
        double* g = gradients_.data() + i * n_twists_;
        tables.gradient(rows[i], at, X, one_.data());
        tables.scaled_gradient(rows[i], X, maps_.data(), one_.data(), g);
        double size = 0;
        for (int k = 0; k < n_twists_; ++k) size += g[k] * g[k];
        const double scale = size > 0 ? 1 / std::sqrt(size) : 0;
        for (int k = 0; k < n_twists_; ++k) g[k] *= scale;
    }
}

bool Orientation::is_turned_over(const Orientation& before) const
{
    if (n_rows_ == 0 || before.n_rows_ != n_rows_) return false;
    using Columns = Eigen::Map<const Eigen::MatrixXd>;   // a column for each row
    Eigen::MatrixXd A = Columns(before.gradients_.data(), n_twists_, n_rows_)
                            .transpose()
                            .lazyProduct(Columns(gradients_.data(), n_twists_, n_rows_));
    bool is_negative = false;
    for (int k = 0; k < n_rows_; ++k) {   // elimination, of which nothing but the signs is wanted
        Eigen::Index pivot;
        A.col(k).tail(n_rows_ - k).cwiseAbs().maxCoeff(&pivot);
        if (pivot != 0) A.row(k).tail(n_rows_ - k).swap(A.row(k + pivot).tail(n_rows_ - k));
        is_negative ^= (pivot != 0) != (A(k, k) < 0);
        if (A(k, k) == 0) return false;
        const int rest = n_rows_ - k - 1;
        A.col(k).tail(rest) /= A(k, k);
        for (int j = k + 1; j < n_rows_; ++j)
            if (A(k, j) != 0) A.col(j).tail(rest) -= A(k, j) * A.col(k).tail(rest);
    }
    return is_negative;
}

}   // namespace livens
