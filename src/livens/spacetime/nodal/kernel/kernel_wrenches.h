// SPDX-License-Identifier: BSD-3-Clause
// Wrenches on the bodies over an element, of loads and of multipliers, and the momentum that they leave.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/nodal/stretch.h"

namespace livens {

struct InstantState;

/// About the centres of mass, six numbers a body, summed over the element.
class KernelWrenches {
public:
    KernelWrenches(const Tables& tables, const ElementRule& rule);

    /// Of loads at their points, where X and X' were interpolated, `width` lanes: into nodes.loads and the
    /// sum.
    void evaluate_loads(const Stretch& stretch, const lanes::Pattern& pattern, const lanes::Values& nodes,
                        int width);
    /// Room for those that multipliers take.
    double* taken() { return taken_.data(); }
    /// p <- momentum and spin at the end, the balance of all rows.
    void momentum(const Stretch& stretch, const InstantState& start, double* p) const;

private:
    const Tables& tables_;
    const ElementRule& rule_;
    std::vector<double> X_, V_, raw_;   // at a load point
    std::vector<double> angles_;        // of loads, see Turns
    std::vector<double> of_loads_, taken_;
};

}   // namespace livens
