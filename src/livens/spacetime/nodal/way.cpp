// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/way.h"

#include <algorithm>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

Way::Way(const Tables& tables, const ElementRule& rule)
    : basis_(basis_on(rule.points, rule.degree)), X_(12 * tables.bodies.size()), V_(X_),
      values_(rule.nodes.size()), slopes_(values_)
{}

void Way::go(const Stretch& stretch, const Nodes& nodes, int e, double share, const std::vector<int>& bodies)
{
    at_ = {stretch.times[static_cast<std::size_t>(e)] + share * stretch.h(e), Side::middle};
    basis_.values(share, values_);
    basis_.derivatives(share, slopes_);
    const double inverse = 1 / stretch.h(e);
    for (double& slope : slopes_) slope *= inverse;
    for (const int body : bodies) {
        double *X = X_.data() + 12 * body, *V = V_.data() + 12 * body;
        std::copy_n(nodes.X(e * stretch.degree) + 12 * body, 12, X);
        std::fill_n(V, 12, 0.0);
        for (std::size_t A = 1; A < values_.size(); ++A) {
            const double* dX = nodes.dX(e, static_cast<int>(A)) + 12 * body;
            for (int i = 0; i < 12; ++i) {
                X[i] += values_[A] * dX[i];
                V[i] += slopes_[A] * dX[i];
            }
        }
    }
}

}   // namespace livens
