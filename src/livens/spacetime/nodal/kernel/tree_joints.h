// SPDX-License-Identifier: BSD-3-Clause
// The joints of a tangent that is eliminated along them, and how bodies move by them.
#pragma once

#include <memory>
#include <vector>

#include "livens/spacetime/nodal/kernel/joint_motion.h"
#include "livens/spacetime/nodal/kernel/tree_blocks.h"

namespace livens::inline spacetime_internal {

/// Unknowns as TreePlan has them.
class TreeJoints {
public:
    /// p nodes; the pattern has to outlive it.
    TreeJoints(const ModelTables& tables, const RowPattern& pattern, int p);

    const TreePlan& plan() const { return plan_; }
    /// Numbers of each unknown at a node.
    std::vector<int> sizes() const;
    /// Of an unknown at the nodes at hand; all multipliers of a loop are free. False: rows hang together.
    bool find(int u, const NodeGradients& gradients);
    const JointMotion& motion(int u) const { return motions_[static_cast<std::size_t>(u)]; }
    /// The rows of what closes loops, at row nodes by multipliers and at columns by twists.
    void add_loops(const NodeGradients& gradients, TreeBlocks& blocks) const;

private:
    const ModelTables& tables_;
    TreePlan plan_;
    std::vector<HeldBody> held_;
    std::vector<std::vector<GradientPlaces>> closing_;   // of each loop, by each of its bodies
    std::vector<JointMotion> motions_;
};

}   // namespace livens::inline spacetime_internal
