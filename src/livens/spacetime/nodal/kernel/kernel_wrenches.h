// SPDX-License-Identifier: BSD-3-Clause
// Wrenches on the bodies over an element, of loads and of multipliers, and the momentum that they leave.
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline dynamics_internal {
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// About the centres of mass, six numbers a body, summed over the element.
class KernelWrenches {
public:
    /// Functions null: it is not asked for.
    KernelWrenches(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);

    /// An element, whose load points are new.
    void begin(const WindowLayout& layout);
    /// Of loads at their points, into nodes.at_loads.F.
    void evaluate_loads(const WindowLayout& layout, const lanes::Pattern& pattern, const lanes::Values& start,
                        const lanes::Values& nodes, const lanes::Rule& rule);
    /// Which evaluates them; null: there are none.
    const LoadLanes* loads() const { return loads_ ? &*loads_ : nullptr; }
    /// Room for those that multipliers take.
    double* taken() { return taken_.data(); }
    /// p <- momentum and spin at the end, the balance of all rows, with the loads that were evaluated last.
    void momentum(const WindowLayout& layout, const InstantState& start, const lanes::Values& nodes,
                  const lanes::Rule& rule, double* p);

private:
    void add_loads(int body, const InstantState& start, const lanes::Values& nodes, double* wrench) const;

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;
    AlignedDoubles others_;        // F of loads that are in no program
    std::vector<double> totals_;   // of all load points, 12 a body
    std::optional<LoadLanes> loads_;
    std::vector<double> taken_;
};

}   // namespace livens::inline spacetime_internal
