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

    TangentSlopes(const ModelTables& tables, const ElementRule& rule, int width)
        : loads(tables, rule, width), joints(tables, rule, width)
    {}
};

/// The last node that has rows, of those that have columns.
inline int last_of_rows(const ElementRule& rule)
{
    return rule.points == Points::lobatto ? rule.degree - 1 : rule.degree;
}

}   // namespace livens::inline spacetime_internal
