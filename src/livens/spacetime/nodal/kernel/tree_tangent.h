// SPDX-License-Identifier: BSD-3-Clause
// The tangent of an element with its loads, eliminated along the joints (docs/theory.md, "Without a
// tangent", Stiff loads).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "livens/spacetime/nodal/kernel/tree_forces.h"

namespace livens::inline spacetime_internal {

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

    bool eliminate(int unknown);
    void pass_to_parent(int body);
    void eliminate_from(int unknown, std::size_t k, const Numbers& Jz);
    void go_inwards(int unknown);
    void go_outwards(int unknown, const lanes::Values& nodes);
    const lanes::BlockFunctions& of_blocks() const { return *functions_->blocks; }
    int parent(int u) const { return joints_->plan().parent[static_cast<std::size_t>(u)]; }
    const std::vector<int>& coupled(int u) const
    {
        return joints_->plan().coupled[static_cast<std::size_t>(u)];
    }

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;
    std::shared_ptr<const RowPattern> pattern_;
    std::optional<TreeJoints> joints_;
    TreeForces forces_;
    TreeBlocks blocks_;
    std::vector<Eliminated> gone_;
    Numbers right_, left_, theta_;
};

}   // namespace livens::inline spacetime_internal
