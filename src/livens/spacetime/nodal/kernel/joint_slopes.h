// SPDX-License-Identifier: BSD-3-Clause
// What the forces of joints add to the tangent of an element.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/spacetime/nodal/kernel/load_slopes.h"

namespace livens::inline spacetime_internal {

/// Slopes of - G^T mu at fixed multipliers, by scaled twists of the same node: forces of joints turn with the
/// bodies whose axes they have, and arms turn under them, as those of a link that is drawn do.
class JointSlopes {
public:
    JointSlopes(const ModelTables& tables, const ElementRule& rule, int width);

    /// At a node where there are rows and columns, with the kernel's numbers and multipliers there.
    const std::vector<SlopesOfPair>& find(int node, const WindowLayout& layout, const RowPattern& pattern,
                                          const lanes::Values& nodes);
    /// Likewise, for all nodes from 1 to `last`, of which it is one in the middle.
    const std::vector<SlopesOfPair>& find_middle(int last, const WindowLayout& layout,
                                                 const RowPattern& pattern, const lanes::Values& nodes);
    /// Largest share of one row in the balances, over all nodes since begin(): what rounding leaves of them.
    double terms() const { return terms_; }
    void begin() { terms_ = 0; }
    static int middle_of(int last) { return (last + 1) / 2; }

private:
    /// Forces on columns of body i by columns of body j: gradients are X K.
    struct Pair {
        int i, j;
        Matrix4 K;
    };

    void place(int lane, const lanes::Values& nodes);
    void collect(int node, const WindowLayout& layout, const RowPattern& pattern, const lanes::Values& nodes,
                 const auto& largest);
    void add_row(int r, double mu, double largest, Instant at);
    void add_hessian(int r, double mu, Instant at);
    void add_function(const ConstraintRow& row, const SmoothFunction& function, std::size_t first, double mu);
    void add_form(const QuadraticForm& form, int i, int j, double factor);
    Matrix4& of(int i, int j);
    SlopesOfPair by_twists(const Pair& pair) const;
    void add_turning(int body);

    const ModelTables& tables_;
    const ElementRule& rule_;
    int width_;
    std::vector<double> X_, maps_, forces_;   // 12 a body, about reference points
    std::vector<Pair> pairs_;
    std::vector<SlopesOfPair> slopes_;
    double terms_ = 0;
};

}   // namespace livens::inline spacetime_internal
