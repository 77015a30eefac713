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

/// Gradients of a joint's rows by twists of the body that it holds (m, d; A), and of that one's parent
/// (m, n; A).
struct HoldingRows {
    const double *own, *above;
};

/// z (d, d - m; A) and T (d, n; A) at all nodes. False: rows hang together.
bool find_motion(const lanes::BlockFunctions& functions, const lanes::JointSize& size,
                 const HoldingRows& rows, double* z, double* T);

/// Where the gradients of a joint's rows by the twists of one of its bodies stand in those of a pattern.
struct GradientPlaces {
    struct Part {
        int to;         ///< row times dofs plus twist
        int from;       ///< in gradients; -1: it is a constant
        double value;   ///< that constant
    };
    int size = 0;   ///< rows times dofs
    std::vector<Part> parts;

    GradientPlaces() = default;
    GradientPlaces(const ModelTables& tables, const RowPattern& pattern, const JointRows& joint, int body);
};

/// Gradients of a pattern in lanes of `width`, of which p are nodes; column 0 is the last node.
struct NodeGradients {
    const lanes::Values &start, &nodes;
    const lanes::BlockFunctions& functions;
    int width, p;
    bool has_first_row;   ///< rows are those of the nodes before columns (lobatto), else those of columns

    bool is_row(int node) const { return has_first_row ? node < p : node > 0; }
    /// Of the rows of a joint by the twists of a body, row by row.
    void of(const GradientPlaces& places, int node, double* G) const;
};

/// What holds a body on its parent.
class HeldBody {
public:
    HeldBody(const ModelTables& tables, const RowPattern& pattern, const TreePlan& plan, int body);

    /// How it moves. False: its rows hang together.
    bool find(const NodeGradients& gradients, JointMotion& motion) const;

private:
    bool find_columns(const NodeGradients& gradients, JointMotion& motion) const;
    bool find_at(const NodeGradients& gradients, int node, Numbers& z, Numbers& T) const;

    lanes::JointSize size_;
    GradientPlaces own_, above_;
};

}   // namespace livens::inline spacetime_internal
