// SPDX-License-Identifier: BSD-3-Clause
// Where a surface is the graph of one function over a rectangle: there it does not meet itself.
//
// Take a box of which the surface leaves neither top nor bottom, and the triangles that meet it. If seen from
// above all of them turn the same way, and go once round each of their points, then what lies of them in the
// box covers its base as sheets do that have no fold, branch or border inside; a rectangle has no hole round
// which one sheet could pass into the next. So each is the graph of a function, and their number is that of
// the triangles above any one point [a proper local homeomorphism is a covering]. If it is one, no two points
// of the box's surface lie above each other, and triangles have nothing in common but the corners and edges
// that they share.
#include <algorithm>
#include <cmath>

#include "livens/geometry/detail/box_tree.h"
#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

constexpr int up = 6, down = 2;   // levels above the leaves at which is asked first and last

/// Asks whether the surface is one sheet in the box of a node.
class Sheet {
public:
    Sheet(const BoxTree& tree, const std::vector<Vector3>& points, std::size_t node)
        : tree_(tree), points_(points), node_(node), box_(tree.boxes[node]), base_(box_)
    {
        choose_direction();
    }

    bool is_lone()
    {
        if (sign_ == 0) return false;
        // A triangle of the node, and a point in it.
        std::size_t first = node_;
        while (first < tree_.n_leaves) first *= 2;
        if (tree_.is_empty(first - tree_.n_leaves)) return true;
        const Four t = tree_.triangle(Leaf::n * (first - tree_.n_leaves));
        for (int i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax({points_[t[0]][i], points_[t[1]][i], points_[t[2]][i]});
            const double middle = points_[t[0]][i] / 3 + points_[t[1]][i] / 3 + points_[t[2]][i] / 3;
            above_[i] = std::clamp(middle, low, high);   // in the box, whatever is rounded
        }
        const Packed at = tree_.pack(above_);
        pillar_ = CoarseBox(Box{at, at + ones});
        pillar_.low[axis_] = base_.low[axis_];
        pillar_.high[axis_] = base_.high[axis_];
        return go(1) && n_above_ == 1;
    }

private:
    /// Along which the box is flattest.
    void choose_direction()
    {
        double least = HUGE_VAL;
        for (int i = 0; i < 3; ++i)
            for (const int sign : {1, -1}) {
                const int bit = 1 << (i + (sign > 0 ? 0 : 3));
                const double height = (base_.high[i] - base_.low[i]) * tree_.length(i);
                if ((tree_.directions[node_] & bit) == 0 || !(height < least)) continue;
                least = height;
                axis_ = i;
                sign_ = sign;
                bit_ = static_cast<std::int16_t>(bit);
            }
        // Room for what leans out at the rim.
        const int room = 4 + 2 * (base_.high[axis_] - base_.low[axis_]);
        constexpr int top = static_cast<int>(lane_mask >> 5);
        base_.low[axis_] = static_cast<std::int16_t>(std::max(0, base_.low[axis_] - room));
        base_.high[axis_] = static_cast<std::int16_t>(std::min(top, base_.high[axis_] + room));
        const Packed of_axis = lane_mask << (lane * axis_);
        const auto widened = [&](Packed x, std::int16_t to, Packed fill) {
            return (x & ~of_axis) | ((static_cast<Packed>(to) << 5 | fill) << (lane * axis_));
        };
        box_.low = widened(box_.low, base_.low[axis_], 0);
        box_.high = widened(box_.high, base_.high[axis_], 31);
    }

    /// False where something is not as it must be.
    bool go(std::size_t node)
    {
        if (!tree_.boxes[node].meets(box_)) return true;
        if (node < tree_.n_leaves) return go(2 * node) && go(2 * node + 1);
        const Leaf& leaf = tree_.leaves[node - tree_.n_leaves];
        const Lanes met = ~leaf.apart(base_);
        const Lanes bad = ((leaf.directions & (Lanes{} + bit_)) == Lanes{}) |
                          (leaf.low[axis_] <= Lanes{} + base_.low[axis_]) |
                          (leaf.high[axis_] >= Lanes{} + base_.high[axis_]);
        if (any(met & bad)) return false;
        for (unsigned near = leaf.met(pillar_); near != 0; near &= near - 1)
            n_above_ +=
                lies_above(tree_.triangle(Leaf::n * (node - tree_.n_leaves) + std::countr_zero(near)));
        return true;
    }

    /// Unless it clearly does not.
    bool lies_above(Four t) const
    {
        const int x = (axis_ + 1) % 3, y = (axis_ + 2) % 3;
        for (int k = 0; k < 3; ++k) {
            const Vector3& from = points_[t[k]];
            const Vector3 edge = points_[t[(k + 1) % 3]] - from, to = above_ - from;
            const double one = edge[x] * to[y], other = edge[y] * to[x];
            // In doubt a triangle counts as lying above: two instead of one only means that the box is looked
            // at pair by pair.
            if (sign_ * (one - other) < -1e-14 * (std::abs(one) + std::abs(other))) return false;
        }
        return true;
    }

    const BoxTree& tree_;
    const std::vector<Vector3>& points_;
    std::size_t node_;
    Box box_;
    CoarseBox base_;   ///< the same
    int axis_ = 0, sign_ = 0;
    std::int16_t bit_ = 0;
    Vector3 above_{};
    CoarseBox pillar_{Box{0, 0}};
    int n_above_ = 0;
};

void ask(const BoxTree& tree, const std::vector<Vector3>& points, std::size_t node, std::size_t n_below,
         std::vector<std::uint8_t>& is_lone)
{
    if (Sheet(tree, points, node).is_lone()) {
        const std::size_t first = node * n_below - tree.n_leaves;
        std::fill_n(is_lone.begin() + static_cast<std::ptrdiff_t>(first), n_below, 1);
    } else if (n_below > std::size_t{1} << down)
        for (const std::size_t half : {2 * node, 2 * node + 1}) ask(tree, points, half, n_below / 2, is_lone);
}

}   // namespace

std::vector<std::uint8_t> lone_sheets(const BoxTree& tree, const std::vector<Vector3>& points)
{
    std::vector<std::uint8_t> is_lone(tree.n_leaves, 0);
    const std::size_t n_below = std::min<std::size_t>(tree.n_leaves, std::size_t{1} << up),
                      n = tree.n_leaves / n_below;   // nodes of that level
    in_parts(n, 8, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t k = begin; k < end; ++k)
            if (!tree.is_empty(k * n_below)) ask(tree, points, n + k, n_below, is_lone);
    });
    return is_lone;
}

}   // namespace livens::inline geometry_internal
