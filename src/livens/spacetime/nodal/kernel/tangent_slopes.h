// SPDX-License-Identifier: BSD-3-Clause
// What an element's tangent has besides inertia.
#pragma once

#include "livens/spacetime/nodal/kernel/joint_slopes.h"
#include "livens/spacetime/nodal/kernel/lane_blocks.h"
#include "livens/spacetime/nodal/kernel/load_slopes.h"

namespace livens::inline spacetime_internal {

struct TangentSlopes {
    LoadSlopes loads;
    JointSlopes joints;
    bool has_joints = true;   ///< whether joints are asked

    TangentSlopes(const ModelTables& tables, const ElementRule& rule, int width)
        : loads(tables, rule, width), joints(tables, rule, width)
    {}
};

/// The last node at which joints' forces count: one that has rows and columns.
inline int last_with_joints(const ElementRule& rule, const TangentSlopes& slopes)
{
    if (!slopes.has_joints) return 0;
    return rule.points == Points::lobatto ? rule.degree - 1 : rule.degree;
}

}   // namespace livens::inline spacetime_internal
