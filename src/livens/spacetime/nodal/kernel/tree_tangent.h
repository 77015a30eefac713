// SPDX-License-Identifier: BSD-3-Clause
// The tangent of an element with its loads, eliminated along the joints (docs/theory.md, "Without a
// tangent", Stiff loads).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "livens/spacetime/nodal/kernel/joint_motion.h"
#include "livens/spacetime/nodal/kernel/tangent_slopes.h"

namespace livens::inline spacetime_internal {

/// Blocks of pairs of unknowns, made as they are asked for.
class TreeBlocks {
public:
    /// `sizes`: numbers at a node; p nodes.
    void resize(const std::vector<int>& sizes, int p);
    void clear();
    /// Stays where it is until resize().
    Numbers& of(int u, int v);
    int size(int u) const { return sizes_[static_cast<std::size_t>(u)]; }
    /// Where its numbers begin, and those of the one behind the last.
    int first(int u) const { return first_[static_cast<std::size_t>(u)]; }
    int n_unknowns() const { return static_cast<int>(sizes_.size()); }

private:
    int p_ = 0;
    std::vector<int> sizes_, first_;
    std::vector<std::deque<std::pair<int, Numbers>>> rows_;   // of each, few others
};

/// The tangent of KernelTangent, all nodes of a body together, from the leaves inwards.
class TreeTangent {
public:
    TreeTangent(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);

    /// For the rows of this pattern.
    void use(const std::shared_ptr<const RowPattern>& pattern);
    /// See KernelTangent.
    bool factorise(const WindowLayout& layout, const lanes::Values& start, const lanes::Values& nodes,
                   TangentSlopes& slopes);
    void propose(const lanes::Values& nodes);

private:
    /// What is left of an unknown when it is gone: D = z^T J z, and for each unknown that it is coupled with
    /// J z, its transpose, and D^-1 z^T J.
    struct Eliminated {
        SquareFactor D;
        std::vector<Numbers> E, Et, W;
    };

    void add_mass(double h);
    void add_loads(const WindowLayout& layout, const lanes::Values& nodes, LoadSlopes& slopes);
    void add_forces_of_joints(const WindowLayout& layout, const lanes::Values& nodes, TangentSlopes& slopes);
    void add_loops(const NodeGradients& gradients);
    bool eliminate(int unknown);
    void pass_to_parent(int body);
    void go_inwards(int unknown);
    void go_outwards(int unknown, const lanes::Values& nodes);
    const lanes::BlockFunctions& of_blocks() const { return *functions_->blocks; }
    int first_loop() const { return tables_.n_bodies(); }

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;
    std::shared_ptr<const RowPattern> pattern_;
    std::optional<TreePlan> plan_;
    TreeBlocks blocks_;
    std::vector<JointMotion> motions_;
    std::vector<Eliminated> gone_;
    Numbers right_, left_, theta_;
};

}   // namespace livens::inline spacetime_internal
