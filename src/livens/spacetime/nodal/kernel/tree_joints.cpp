// SPDX-License-Identifier: BSD-3-Clause
// Bodies move by their joints (HeldBody). Of a joint that closes a loop the unknowns are its multipliers at
// the nodes of rows: all are free, z = 1, and they hang on nothing (docs/theory.md, "Without a tangent",
// Stiff loads).
#include "livens/spacetime/nodal/kernel/tree_joints.h"

#include <algorithm>

namespace livens {

TreeJoints::TreeJoints(const ModelTables& tables, const RowPattern& pattern, int p)
    : tables_(tables), plan_(tables, pattern), motions_(plan_.parent.size())
{
    for (int b = 0; b < tables.n_bodies(); ++b) held_.emplace_back(tables, pattern, plan_, b);
    for (std::size_t k = 0; k < plan_.closing.size(); ++k) {
        const JointRows& joint = plan_.closing[k];
        std::vector<GradientPlaces>& places = closing_.emplace_back();
        for (const int b : joint.bodies) places.emplace_back(tables, pattern, joint, b);
        JointMotion& motion = motions_[static_cast<std::size_t>(tables.n_bodies()) + k];
        const int m = motion.f = joint.n();
        motion.z_rows.assign(static_cast<std::size_t>(m * m * p), 0.0);
        for (int r = 0; r < m; ++r) std::fill_n(motion.z_rows.begin() + (r * m + r) * p, p, 1.0);
        motion.z_columns = motion.z_rows;
    }
}

std::vector<int> TreeJoints::sizes() const
{
    std::vector<int> sizes;
    for (const BodyTable& body : tables_.bodies) sizes.push_back(body.dofs);
    for (const JointRows& joint : plan_.closing) sizes.push_back(joint.n());
    return sizes;
}

bool TreeJoints::find(int u, const NodeGradients& gradients)
{
    const auto at = static_cast<std::size_t>(u);
    return u >= tables_.n_bodies() || held_[at].find(gradients, motions_[at]);
}

/// G_A^T in the rows of bodies, G_B in those of loops, each diagonal in the nodes. node % p is the lane both
/// ways: node 0 is a row alone (lobatto), and node p a column, with radau also a row.
void TreeJoints::add_loops(const NodeGradients& gradients, TreeBlocks& blocks) const
{
    const int p = gradients.p;
    for (std::size_t k = 0; k < plan_.closing.size(); ++k) {
        const JointRows& joint = plan_.closing[k];
        const int u = tables_.n_bodies() + static_cast<int>(k), m = joint.n();
        for (std::size_t end = 0; end < joint.bodies.size(); ++end) {
            const int b = joint.bodies[end];
            if (b == world) continue;
            const int d = blocks.size(b);
            Numbers &J = blocks.of(b, u), &G = blocks.of(u, b);
            Numbers of(static_cast<std::size_t>(m * d));
            for (int node = 0; node <= p; ++node) {
                gradients.of(closing_[k][end], node, of.data());
                const int lane = node % p;
                for (int r = 0; r < m; ++r)
                    for (int i = 0; i < d; ++i) {
                        if (gradients.is_row(node)) J[(i * p + lane) * m * p + r * p + lane] = of[r * d + i];
                        if (node > 0) G[(r * p + lane) * d * p + i * p + lane] = of[r * d + i];
                    }
            }
        }
    }
}

}   // namespace livens
