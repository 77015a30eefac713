// SPDX-License-Identifier: BSD-3-Clause
// What loads and forces of joints add to a tangent that is eliminated along the joints.
#pragma once

#include <vector>

#include "livens/spacetime/nodal/kernel/tangent_slopes.h"
#include "livens/spacetime/nodal/kernel/tree_joints.h"

namespace livens::inline spacetime_internal {

/// Slopes of what a body's joint bears in the middle, by its parent and of its parent, 6 x 6 row by row.
struct BetweenBodies {
    double by_parent[36] = {}, of_parent[36] = {};
    std::vector<const SlopesOfProduct*> products{};
};

/// A force along coordinates, by freedoms: its directions (i; A) at row nodes, and slopes (A; j, B).
struct ForceAlongTree {
    Numbers on_own, on_parent, by_own, by_parent;
};

/// What is between a body and its parent alone stays apart until that body is eliminated: of the freedoms
/// that are left then it makes little, and whole blocks are spared.
class TreeForces {
public:
    /// References must outlive it.
    TreeForces(const ModelTables& tables, const ElementRule& rule) : tables_(tables), rule_(rule) {}

    /// All at the numbers of the kernel; what is not between a body and its parent goes to blocks.
    void find(const WindowLayout& layout, const RowPattern& pattern, const lanes::Values& nodes,
              TangentSlopes& slopes);
    void put(const TreePlan& plan, TreeBlocks& blocks);

    /// A body at hand that moves like this, and its parent, or the world.
    void reduce(int body, int parent, const JointMotion& motion);
    // Of that body:
    /// J_bp, and J_pp as far as it does not come from there.
    void add_to_parent(TreeBlocks& blocks) const;
    /// z^T J_bb z
    void add_to_own(Numbers& D) const;
    /// J_pb z + T^T J_bb z
    void add_by_own(Numbers& E) const;
    /// z^T J_bp + z^T J_bb T, but for what add_to_parent() gave to J_bp.
    void add_by_parent(Numbers& W) const;

private:
    void put_pair(const SlopesOfPair& pair, TreeBlocks& blocks) const;
    void put_of_joint(const SlopesOfPair& pair, const TreePlan& plan, TreeBlocks& blocks);
    int held_body(const SlopesOfProduct& product, const TreePlan& plan) const;
    ForceAlongTree reduced(const SlopesOfProduct& product) const;
    void add_outer(const Numbers& on, const Numbers& by, Numbers& to) const;

    const ModelTables& tables_;
    const ElementRule& rule_;
    const TangentSlopes* slopes_ = nullptr;
    const std::vector<SlopesOfPair>* of_joints_ = nullptr;   // null: they do not count
    Numbers weights_;   // of nodes, in those of the one where joints were asked
    double h_ = 0;
    std::vector<BetweenBodies> between_;   // of each body
    int body_ = 0, parent_ = 0;
    const JointMotion* motion_ = nullptr;
    std::vector<ForceAlongTree> forces_;
};

}   // namespace livens::inline spacetime_internal
