// SPDX-License-Identifier: BSD-3-Clause
// Bodies along the polynomials of an element, between its nodes.
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/elements/window_layout.h"
#include "livens/time/basis.h"

namespace livens::inline spacetime_internal {

class NodePositions;

/// X and V = X' of bodies along an element of a window, at any share of its length.
class ElementPath {
public:
    ElementPath(const ModelTables& tables, const ElementRule& rule);

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
    LagrangeBasis basis_;
    const WindowLayout* layout_ = nullptr;
    const NodePositions* nodes_ = nullptr;
    int element_ = 0;
    Instant at_;
    std::vector<double> X_, V_, values_, slopes_;
};

}   // namespace livens::inline spacetime_internal
