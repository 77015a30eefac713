// SPDX-License-Identifier: BSD-3-Clause
// Bodies that are held on each other as the branches of trees are.
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::inline spacetime_internal {

/// Every row holds a body on its parent, or on the world, and what loads couple are those as well: so what is
/// inside of elements can be eliminated body by body, from the leaves inwards, and fills nothing in.
struct JointForest {
    struct Body {
        int parent = world;
        std::vector<int> rows{};   ///< that hold it there; none: it floats
        int d = 0, f = 0;          ///< numbers of its twist, and of what its rows leave free
    };
    std::vector<Body> bodies;   ///< by their numbers
    std::vector<int> order;     ///< outer ones first
    std::vector<int> held;      ///< of each row the body that it holds

    /// None: joints close loops, rows are redundant, or something couples other bodies.
    static std::optional<JointForest> of(const ModelTables& tables);

private:
    bool grow(const ModelTables& tables);
    bool are_loads_between(const ModelTables& tables) const;
};

}   // namespace livens::inline spacetime_internal
