// SPDX-License-Identifier: BSD-3-Clause
// Some bodies along the polynomials of an element, for whoever looks between its nodes.
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/nodal/stretch.h"
#include "livens/time/basis.h"

namespace livens {

class Nodes;

/// X and V = X' of bodies along an element of a window, at any share of its length.
class Way {
public:
    /// References must outlive it.
    Way(const Tables& tables, const ElementRule& rule);

    /// Goes to a share, with the bodies that are named; what others have there is of no use.
    void go(const Stretch& stretch, const Nodes& nodes, int e, double share, const std::vector<int>& bodies);
    Instant at() const { return at_; }
    const double* X() const { return X_.data(); }
    const double* V() const { return V_.data(); }

private:
    LagrangeBasis basis_;
    Instant at_;
    std::vector<double> X_, V_, values_, slopes_;
};

}   // namespace livens
