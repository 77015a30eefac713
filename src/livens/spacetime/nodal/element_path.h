// SPDX-License-Identifier: BSD-3-Clause
// Bodies along the polynomials of an element, between its nodes.
#pragma once

#include <span>
#include <vector>

#include "livens/spacetime/elements/window_layout.h"
#include "livens/time/basis.h"

namespace livens::inline dynamics_internal {
struct ModelTables;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

class NodePositions;

/// X and V = X' of bodies along an element of a window, at any share of its length.
class ElementPath {
public:
    ElementPath(const ModelTables& tables, const ElementRule& rule);

    /// Shares, ascending, to which it will go in every element: their basis is found once for all paths.
    void expect(const ElementRule& rule, const std::vector<double>& shares);
    /// Along element e from now on. References must outlive the calls of go().
    void begin(const WindowLayout& layout, const NodePositions& nodes, int e);
    /// Goes to a share, with the bodies that are named; what others have there is of no use.
    void go(double share, const std::vector<int>& bodies);
    Instant at() const { return at_; }
    const double* X() const { return X_.data(); }
    const double* V() const { return V_.data(); }
    double start() const { return layout_->times[element_]; }
    double h() const { return layout_->h(element_); }

private:
    struct KnownBasis {
        double share;
        std::vector<double> values, slopes;
    };
    void find_basis(double share);

    LagrangeBasis basis_;
    std::span<const KnownBasis> known_;
    const WindowLayout* layout_ = nullptr;
    const NodePositions* nodes_ = nullptr;
    int element_ = 0;
    Instant at_;
    std::vector<double> X_, V_, values_, slopes_;
};

}   // namespace livens::inline spacetime_internal
