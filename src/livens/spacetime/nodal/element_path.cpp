// SPDX-License-Identifier: BSD-3-Clause
// X_h(s) = X_0 + sum_B M_B(s) (X_B - X_0) and its derivative, with the Lagrange basis M_B of the element's
// nodes: the motion between nodes, of order p + 1, and X' of order p (docs/theory.md, "The element").
#include "livens/spacetime/nodal/element_path.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

ElementPath::ElementPath(const ModelTables& tables, const ElementRule& rule)
    : basis_(basis_on(rule.points, rule.degree)), X_(12 * tables.bodies.size()), V_(X_),
      values_(rule.nodes.size()), slopes_(values_)
{}

/// Made once, as rules are, and they stay (element_rule()).
void ElementPath::expect(const ElementRule& rule, const std::vector<double>& shares)
{
    static std::mutex in_use;
    static auto& made = *new std::map<std::tuple<Points, int, std::vector<double>>, std::vector<KnownBasis>>;
    const std::scoped_lock lock(in_use);
    std::vector<KnownBasis>& all = made[{rule.points, rule.degree, shares}];
    for (std::size_t k = all.size(); k < shares.size(); ++k) {
        basis_.values(shares[k], values_);
        basis_.derivatives(shares[k], slopes_);
        all.push_back({shares[k], values_, slopes_});
    }
    known_ = all;   // whose place does not change
}

void ElementPath::begin(const WindowLayout& layout, const NodePositions& nodes, int e)
{
    layout_ = &layout;
    nodes_ = &nodes;
    element_ = e;
}

void ElementPath::go(double share, const std::vector<int>& bodies)
{
    at_ = {start() + share * h(), Side::middle};
    find_basis(share);
    const double inverse = 1 / h();
    for (double& slope : slopes_) slope *= inverse;
    for (const int body : bodies) {
        double *X = X_.data() + 12 * body, *V = V_.data() + 12 * body;
        std::copy_n(nodes_->X(element_ * layout_->degree) + 12 * body, 12, X);
        std::fill_n(V, 12, 0.0);
        for (std::size_t A = 1; A < values_.size(); ++A) {
            const double* dX = nodes_->dX(element_, static_cast<int>(A)) + 12 * body;
            for (int i = 0; i < 12; ++i) {
                X[i] += values_[A] * dX[i];
                V[i] += slopes_[A] * dX[i];
            }
        }
    }
}

void ElementPath::find_basis(double share)
{
    const auto known = std::ranges::lower_bound(known_, share, {}, &KnownBasis::share);
    if (known != known_.end() && known->share == share) {
        values_ = known->values;
        slopes_ = known->slopes;
        return;
    }
    basis_.values(share, values_);
    basis_.derivatives(share, slopes_);
}

}   // namespace livens
