// SPDX-License-Identifier: BSD-3-Clause
// Anderson's acceleration: factors by which the last changes of proposals cancel the present proposal best,
// from the normal equations of least squares with changes scaled to 1; the steps that led to these changes
// are subtracted with the same factors (docs/theory.md, "Without a tangent", Many bodies).
#include "livens/spacetime/nodal/kernel/acceleration.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace livens {

void Acceleration::begin(std::size_t n)
{
    n_ = n;
    n_seen_ = 0;
    proposed_.resize(n);
    taken_.resize(n);
}

/// With the proposal g, its changes dg_j and what was taken before these, dx_j: the factors c make
/// |g - sum c_j dg_j| least, and the step is g - sum c_j (dx_j + dg_j). The oldest of `depth` pairs gives its
/// place to the new one; a change that is zero takes no part.
void Acceleration::apply(double* step)
{
    const auto product = [this](const double* a, const double* b) {
        return std::inner_product(a, a + n_, b, 0.0);
    };
    if (n_seen_ > 0) {
        const int slot = (n_seen_ - 1) % depth;
        std::vector<double>&change = changes_[slot], &way = ways_[slot];
        change.resize(n_);
        way.resize(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            change[i] = step[i] - proposed_[i];
            way[i] = taken_[i] + change[i];
        }
        for (int j = 0; j < std::min(n_seen_, depth); ++j)
            products_[slot][j] = products_[j][slot] = product(change.data(), changes_[j].data());
    }
    std::copy_n(step, n_, proposed_.begin());
    const int m = std::min(n_seen_++, depth);
    double factors[depth], scale[depth];
    gram_.resize(m);
    for (int i = 0; i < m; ++i) {
        scale[i] = products_[i][i] > 0 ? 1 / std::sqrt(products_[i][i]) : 0;
        factors[i] = scale[i] * product(changes_[i].data(), step);
        for (int j = 0; j < i; ++j) gram_.row(i)[j] = scale[i] * scale[j] * products_[i][j];
        gram_.row(i)[i] = 1 + 1e-12;   // changes that are nearly alike count together
    }
    if (m > 0 && gram_.factorise()) {
        gram_.solve(factors);
        for (int j = 0; j < m; ++j)
            for (std::size_t i = 0; i < n_; ++i) step[i] -= scale[j] * factors[j] * ways_[j][i];
    }
    std::copy_n(step, n_, taken_.begin());
}

}   // namespace livens
