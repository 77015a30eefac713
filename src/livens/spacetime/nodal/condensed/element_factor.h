// SPDX-License-Identifier: BSD-3-Clause
// What is inside of one element, eliminated along the joints (docs/theory.md, "The whole matrix of lobatto").
#pragma once

#include <span>
#include <vector>

#include "livens/spacetime/nodal/condensed/joint_forest.h"
#include "livens/spacetime/nodal/kernel/lane_blocks.h"

namespace livens::inline spacetime_internal {

/// The tangent of an element by bodies: their rows and twists at the q nodes inside, (i, A) as lane_blocks.h
/// has them, and the free motions at its ends.
struct ElementBlocks {
    struct OfBody {
        Numbers own;                    ///< by itself
        Numbers by_parent, of_parent;   ///< rows by the parent's twists, its rows by its own; or empty
        Numbers by_ends, of_ends;       ///< rows by free motions at the ends, and, transposed, rows there
    };
    std::vector<OfBody> bodies;
    Numbers ends;   ///< rows at the ends by free motions there
};

/// Sizes of all that belongs to an element.
struct ElementSizes {
    int q = 0;                       ///< nodes inside
    int n_rows = 0, n_columns = 0;   ///< of free motions at its ends
};

/// A body moves with its parent and by its own freedoms, y_b = T y_p + z theta at each node; from the leaves
/// inwards the freedoms at all nodes inside are eliminated together.
class ElementFactor {
public:
    void resize(const JointForest& forest, const ElementSizes& sizes);

    /// How the body moves at these nodes, from the gradients of the rows that hold it (m, d; A) and those by
    /// its parent (m, n; A). False: they hang together.
    bool set_motion(const JointForest& forest, int body, const double* own, const double* above);
    /// Uses the blocks up; their `ends` become what is left of them. False: a block is singular, or entries
    /// have grown.
    bool factorise(const JointForest& forest, ElementBlocks& blocks);

    /// Numbers of all bodies inside; of a body from here on.
    int n_numbers() const { return first_.empty() ? 0 : first_.back(); }
    int first(int body) const { return first_[static_cast<std::size_t>(body)]; }
    /// Of rows inside, which are used up: what they take off rows at the ends, and freedoms for ends that do
    /// not move. Transposed, of unknowns inside.
    void go_inwards(const JointForest& forest, bool is_transposed, std::span<double> inside, double* ends);
    /// Then twists inside, for ends that move so.
    void go_outwards(const JointForest& forest, bool is_transposed, const double* ends,
                     std::span<double> inside);
    long long n_entries() const;

private:
    /// D = z^T J z of a body's freedoms, what others have by them, and D^-1 of what they have by others.
    struct Gone {
        Numbers T, z;
        SquareFactor D;
        Numbers of_parent, by_parent, of_ends, by_ends;
        Numbers theta;
    };

    bool eliminate(const JointForest& forest, int body, ElementBlocks& blocks);
    void pass_to_parent(const JointForest& forest, int body, const Numbers& Jz, ElementBlocks& blocks);

    ElementSizes sizes_;
    std::vector<int> first_;
    std::vector<Gone> gone_;
    const lanes::BlockFunctions* functions_ = nullptr;
};

}   // namespace livens::inline spacetime_internal
