// SPDX-License-Identifier: BSD-3-Clause
// Loads on the elements of a window: their quadrature on X and X' of the elements' own polynomials.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

class NodePositions;

/// F_A = h sum_c w_c M_A(s_c) F(X(s_c), X'(s_c)) of the nodes A of every element (docs/theory.md, "The
/// element").
class ElementLoads {
public:
    ElementLoads(const ModelTables& tables, const ElementRule& rule);

    void evaluate(const WindowLayout& layout, const NodePositions& nodes);
    /// F_A of element e, local node A, without weight; 12 numbers a body. Only where there are loads.
    const double* forces(int e, int A) const { return forces_.data() + (e * rule_.size() + A) * n_; }
    /// X and X' at load point c.
    void interpolate(const WindowLayout& layout, const NodePositions& nodes, int e, int c, double* X,
                     double* V) const;
    /// Follows the angles of loads through all nodes, as evaluate() does; see Turns.
    void count_turns(const WindowLayout& layout, const NodePositions& nodes);
    /// Approximate angles at load point c of element e: those at the node before.
    std::span<const double> angles(int e, int c) const;
    /// A message about a load that is not finite; empty if all are.
    std::string bad_load(const WindowLayout& layout, const NodePositions& nodes) const;

private:
    /// Of a thread; in lanes, about the centres of mass.
    struct Workspace {
        explicit Workspace(const ModelTables& tables, const ElementRule& rule);

        std::unique_ptr<LoadLanes> lanes;
        AlignedDoubles X, V, F, factors;
    };
    void interpolate_all(const WindowLayout& layout, const NodePositions& nodes, int e, Workspace& at) const;
    void add_element(const WindowLayout& layout, const NodePositions& nodes, int e, Workspace& at);

    const ModelTables& tables_;
    const ElementRule& rule_;
    std::ptrdiff_t n_;                    // numbers of all bodies
    std::vector<Workspace> workspaces_;   // none without loads
    AlignedDoubles M_, dM_;               // M_B(s_c) and its slope, a row of lanes over c for each B
    std::vector<double> forces_;          // F_A, element after element
    std::vector<double> angles_;          // node after node
};

/// sum += factor * x, 12 numbers a body, for arrays that do not overlap.
inline void accumulate(double* __restrict sum, double factor, const double* __restrict x, std::size_t n)
{
    for (std::size_t b = 0; b < n; b += 12)
        for (std::size_t i = b; i < b + 12; ++i) sum[i] += factor * x[i];
}

}   // namespace livens::inline spacetime_internal
