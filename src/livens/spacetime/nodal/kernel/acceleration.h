// SPDX-License-Identifier: BSD-3-Clause
// Fixed-point iterations that shrink slowly, or grow: the best of the last steps together.
#pragma once

#include <cstddef>
#include <vector>

#include "livens/solvers/dense.h"

namespace livens::inline spacetime_internal {

/// Anderson's acceleration [Anderson1965]: the combination of the last steps whose proposals cancel best.
/// Where proposals are linear in what was taken it is a minimal residual method without the matrix
/// [WalkerNi2011].
class Acceleration {
public:
    /// Steps of n numbers from here on; nothing was seen yet.
    void begin(std::size_t n);
    /// Replaces the step that the iteration proposes by the one to take.
    void apply(double* step);

private:
    static constexpr int depth = 12;

    std::size_t n_ = 0;
    int n_seen_ = 0;
    std::vector<double> changes_[depth];   // of proposals, from one to the next
    std::vector<double> ways_[depth];      // what was taken before, and that change
    double products_[depth][depth] = {};   // of the changes
    std::vector<double> proposed_, taken_;
    Cholesky gram_;
};

}   // namespace livens::inline spacetime_internal
