// SPDX-License-Identifier: BSD-3-Clause
// What the joints of a tree let bodies do at the nodes of an element.
#pragma once

#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/spacetime/nodal/kernel/lane_blocks.h"
#include "livens/spacetime/nodal/kernel/tree_plan.h"

namespace livens::inline spacetime_internal {

/// A body moves with its parent and by its own f freedoms, y = T y_parent + z theta, at row nodes and at
/// columns: (i, k) in p lanes.
struct JointMotion {
    int f = 0;
    Numbers T_rows, T_columns, z_rows, z_columns;
};

/// Gradients of a pattern in lanes of `width`, of which p are nodes; column 0 is the last node.
struct NodeGradients {
    const ModelTables& tables;
    const RowPattern& pattern;
    const lanes::Values &start, &nodes;
    int width, p;
    bool has_first_row;   ///< rows are those of the nodes before columns (lobatto), else those of columns

    bool is_row(int node) const { return has_first_row ? node < p : node > 0; }
    /// Of the rows of a joint by the twists of one of its bodies, row by row.
    void of(const JointRows& joint, int b, int node, double* G) const;
    /// How body b moves by what holds it on its parent. False: its rows hang together.
    bool find(int b, const TreePlan& plan, JointMotion& motion) const;
};

}   // namespace livens::inline spacetime_internal
