// SPDX-License-Identifier: BSD-3-Clause
// The tangent of an element in blocks of bodies and of joints that close loops.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/nodal/kernel/lane_blocks.h"

namespace livens::inline spacetime_internal {

/// Blocks of pairs of unknowns, made as they are asked for.
class TreeBlocks {
public:
    /// `sizes`: numbers at a node, of the bodies first; p nodes.
    void resize(const std::vector<int>& sizes, int n_bodies, int p);
    /// Nothing but k_AB / h of each body: scaled twists have the mass 1.
    void reset(const ElementRule& rule, double h);
    /// Stays where it is until resize().
    Numbers& of(int u, int v);
    /// Null: it was not asked for.
    Numbers* find(int u, int v);
    int size(int u) const { return sizes_[static_cast<std::size_t>(u)]; }
    /// Where its numbers begin, and those of the one behind the last.
    int first(int u) const { return first_[static_cast<std::size_t>(u)]; }
    int n_unknowns() const { return static_cast<int>(sizes_.size()); }
    int n_bodies() const { return n_bodies_; }
    int p() const { return p_; }

private:
    int p_ = 0, n_bodies_ = 0;
    std::vector<int> sizes_, first_;
    std::vector<std::deque<std::pair<int, Numbers>>> rows_;   // of each, few others
};

}   // namespace livens::inline spacetime_internal
