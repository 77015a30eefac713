// SPDX-License-Identifier: BSD-3-Clause
// In which order bodies are eliminated along their joints, and which of them are coupled then.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/dynamics/rows/tables.h"

namespace livens::inline spacetime_internal {

/// Rows of a joint between two bodies, of which the first may be the world, or of what couples more.
struct JointRows {
    std::vector<int> bodies{world, world};
    std::vector<int> rows;   ///< places in the pattern

    int n() const { return static_cast<int>(rows.size()); }
};

/// Unknowns are bodies, by their numbers, and behind them joints that close loops. A tree needs no more room
/// than its bodies; a load between two of them that no joint couples, or a loop, couples what lies between.
struct TreePlan {
    TreePlan(const ModelTables& tables, const RowPattern& pattern);

    std::vector<int> order;           ///< of elimination: bodies, outer ones first
    std::vector<int> parent;          ///< of each body; world: it hangs there, or on nothing
    std::vector<JointRows> held;      ///< what holds each body on its parent; no rows: it floats
    std::vector<JointRows> closing;   ///< loops, and couplings of more than two bodies
    std::vector<std::vector<int>>
        coupled;   ///< of each body, unknowns that are eliminated later; the parent first

private:
    void collect(const ModelTables& tables, const RowPattern& pattern, std::vector<JointRows>& joints);
    void grow(int n_bodies, std::vector<JointRows>& joints);
    void couple(const ModelTables& tables, const RowPattern& pattern);
};

}   // namespace livens::inline spacetime_internal
