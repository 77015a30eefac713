// SPDX-License-Identifier: BSD-3-Clause
// Wrenches on the bodies over an element, of loads and of multipliers, and the momentum that they leave.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/nodal/window_layout.h"

namespace livens::inline dynamics_internal {
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// About the centres of mass, six numbers a body, summed over the element.
class KernelWrenches {
public:
    KernelWrenches(const ModelTables& tables, const ElementRule& rule);

    /// Of loads at their points, where X and X' were interpolated, `width` lanes: into nodes.loads and the
    /// sum.
    void evaluate_loads(const WindowLayout& layout, const lanes::Pattern& pattern, const lanes::Values& nodes,
                        int width);
    /// Room for those that multipliers take.
    double* taken() { return taken_.data(); }
    /// p <- momentum and spin at the end, the balance of all rows.
    void momentum(const WindowLayout& layout, const InstantState& start, double* p) const;

private:
    const ModelTables& tables_;
    const ElementRule& rule_;
    std::vector<double> X_, V_, raw_;   // at a load point
    std::vector<double> angles_;        // of loads, see Turns
    std::vector<double> of_loads_, taken_;
};

}   // namespace livens::inline spacetime_internal
