// SPDX-License-Identifier: BSD-3-Clause
// Joint rows along trees, and those that close loops: where rank needs no numbers but those of single joints.
#pragma once

#include <vector>

#include "livens/solvers/sparse_rows.h"

namespace livens::inline dynamics_internal {

/// A row by the bodies that it touches: its six entries on each, [force, moment / length] (rank.h).
struct BodyRow {
    struct Part {
        int body;
        double entries[6];
    };
    std::vector<Part> parts;
    double size = 1;   ///< norm before it was scaled to one
};

/// Rows along a spanning forest of the bodies, and the others.
///
/// Joints are taken in the order of their first rows; one that joins bodies that hang together already closes
/// a loop. Outwards from the world, or from any body of what floats, the rows of the forest are block
/// triangular: independent if those of each joint are so on its outer body alone, however long a chain is.
struct Forest {
    std::vector<int> rows;      ///< of the forest, ascending
    std::vector<int> closing;   ///< of loops, of more than two bodies, and what says nothing new in its joint
    double smallest_pivot = 1;   ///< of the rows of the forest, joint by joint; above `least`
};
/// `rows`: of norm 1. A row whose pivot in its joint is at most `least` goes to `closing`.
Forest spanning_forest(const std::vector<BodyRow>& rows, int n_bodies, double least);

/// Entries of the given rows in the order of `which`, six columns a body.
std::vector<SparseRows::Entry> entries_of(const std::vector<BodyRow>& rows, const std::vector<int>& which);

}   // namespace livens::inline dynamics_internal
