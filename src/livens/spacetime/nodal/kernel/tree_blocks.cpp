// SPDX-License-Identifier: BSD-3-Clause
// J_uv with rows (i, A) and columns (j, l), row by row: A is the lane of a row's node, l that of a column's,
// where lane 0 is node p (docs/theory.md, "Without a tangent", All nodes at once). Blocks stay, as zeros, for
// the next factor; a row of them is a deque, so that references survive when others are made.
#include "livens/spacetime/nodal/kernel/tree_blocks.h"

#include <algorithm>

namespace livens {

void TreeBlocks::resize(const std::vector<int>& sizes, int n_bodies, int p)
{
    p_ = p;
    n_bodies_ = n_bodies;
    sizes_ = sizes;
    first_ = {0};
    for (const int size : sizes) first_.push_back(first_.back() + size * p);
    rows_.assign(sizes.size(), {});
}

/// The mass of bodies that do not turn, which is 1 in scaled twists: what turns within the element make of it
/// is O(1) beside k / h, and left to the iteration.
void TreeBlocks::reset(const ElementRule& rule, double h)
{
    Numbers k(static_cast<std::size_t>(p_ * p_));
    for (int A = 0; A < p_; ++A)
        for (int l = 0; l < p_; ++l)
            k[static_cast<std::size_t>(A * p_ + l)] =
                rule.k[row_in_lane(rule, A) * rule.size() + (l == 0 ? p_ : l)] / h;
    for (int u = 0; u < n_unknowns(); ++u)
        for (auto& [v, block] : rows_[static_cast<std::size_t>(u)]) {
            const int columns = size(v) * p_;
            for (int r = 0; r < size(u) * p_; ++r) std::fill_n(block.data() + r * columns, columns, 0.0);
        }
    for (int b = 0; b < n_bodies_; ++b) {
        Numbers& J = of(b, b);
        const int d = size(b);
        for (int i = 0; i < d; ++i)
            for (int A = 0; A < p_; ++A)
                std::copy_n(k.data() + A * p_, p_, J.data() + (i * p_ + A) * d * p_ + i * p_);
    }
}

Numbers* TreeBlocks::find(int u, int v)
{
    auto& row = rows_[static_cast<std::size_t>(u)];
    const auto found = std::ranges::find(row, v, &std::pair<int, Numbers>::first);
    return found != row.end() ? &found->second : nullptr;
}

Numbers& TreeBlocks::of(int u, int v)
{
    if (Numbers* found = find(u, v)) return *found;
    const auto n = static_cast<std::size_t>(size(u) * p_ * size(v) * p_);
    return rows_[static_cast<std::size_t>(u)].emplace_back(v, Numbers(n, 0.0)).second;
}

}   // namespace livens
