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

    std::vector<int> order;           ///< of elimination: bodies, outer ones first, and loops between them
    std::vector<int> parent;          ///< of each unknown; world: it hangs there, or on nothing
    std::vector<JointRows> held;      ///< what holds each body on its parent; no rows: it floats
    std::vector<JointRows> closing;   ///< loops, and couplings of more than two bodies
    std::vector<std::vector<int>>
        coupled;   ///< of each unknown, those that are eliminated later; the parent first

private:
    void collect(const ModelTables& tables, const RowPattern& pattern, std::vector<JointRows>& joints);
    void grow(int n_bodies, std::vector<JointRows>& joints);
    void insert_loops(const ModelTables& tables);
    std::vector<int> inside(const JointRows& loop, const ModelTables& tables) const;
    void couple(const ModelTables& tables, const RowPattern& pattern);
};

/// Whether the unknown is a body that holds rotors (Body::is_rotor): its axes know nothing of each other.
bool is_point_of_rotors(const ModelTables& tables, int unknown);

}   // namespace livens::inline spacetime_internal
