// SPDX-License-Identifier: BSD-3-Clause
// A binary tree of boxes over triangles in the order of a space-filling curve (Morton's), for the search of
// contacts: theory.md, "Bodies from meshes", Is it a solid? Coordinates are packed into lanes of one word, so
// that two boxes are compared by a few operations.
#include "livens/geometry/detail/box_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/geometry/detail/workers.h"

namespace livens {

namespace {

constexpr Box nothing{lane_mask * ones, 0};
constexpr double first = 256, most = lane_mask - 256;   // what is nothing meets nothing, and all have room
constexpr std::size_t some = 65536;                     // triangles or points at a time

/// Every third bit.
std::uint32_t spread(std::uint32_t x)
{
    x = (x | (x << 16)) & 0x030000ff;
    x = (x | (x << 8)) & 0x0300f00f;
    x = (x | (x << 4)) & 0x030c30c3;
    return (x | (x << 2)) & 0x09249249;
}

}   // namespace

BoxTree::BoxTree(const std::vector<Vector3>& points, const Triangles& from, const Rings& rings) : from_(from)
{
    measure(points, from.corners);
    packed_ = filled<Packed>(points.size(), 0);
    in_parts(points.size(), some, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t k = begin; k < end; ++k) packed_[k] = pack(points[k]);
    });
    const std::vector<std::uint64_t> order = sorted(from.corners);
    n_leaves = std::bit_ceil((order.size() + Leaf::n - 1) / Leaf::n);
    numbers_ = filled<std::uint32_t>(order.size(), 0);
    boxes = filled<Box>(2 * n_leaves, nothing);
    directions = filled<std::uint8_t>(2 * n_leaves, 255);
    leaves = filled(n_leaves, Leaf{});
    in_parts(n_leaves, some / Leaf::n, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t l = begin; l < end; ++l) make_leaf(l, order, rings);
    });
    packed_ = {};
    join();
}

void BoxTree::measure(const std::vector<Vector3>& points, std::span<const std::int32_t> corners)
{
    Vector3 high;
    low_ = high = points[corners[0]];
    for (const std::int32_t c : corners)
        for (int i = 0; i < 3; ++i) {
            low_[i] = std::min(low_[i], points[c][i]);
            high[i] = std::max(high[i], points[c][i]);
        }
    half_ = 0.5 * high - 0.5 * low_;
    const double size = std::max({half_[0], half_[1], half_[2]});
    for (int i = 0; i < 3; ++i) {
        scale_[i] = std::isfinite(most / half_[i]) ? (most - first) / half_[i] : 0;
        shares_[i] = static_cast<std::uint32_t>(size > 0 ? 256 * (half_[i] / size) : 0);
    }
}

Packed BoxTree::pack(const Vector3& p) const
{
    Packed packed = 0;
    for (int i = 0; i < 3; ++i) {   // points of no triangle may lie outside
        const double x = std::clamp(first + (0.5 * p[i] - 0.5 * low_[i]) * scale_[i], first, most);
        // Corners are rounded down and boxes widened by one unit: a box may be too large, never too small.
        packed |= static_cast<Packed>(x) << (lane * i);
    }
    return packed;
}

/// One unit larger above, for gaps that are as good as none.
Box BoxTree::box_of(const std::int32_t* t) const
{
    Box box{packed_[t[0]], packed_[t[0]]};
    for (int i = 1; i < 3; ++i) box.add({packed_[t[i]], packed_[t[i]]});
    return {box.low, box.high + ones};
}

/// Place of its first corner on the curve: 8 bits of each coordinate, in which all are as long.
std::uint64_t BoxTree::code_of(const std::int32_t* t) const
{
    std::uint64_t code = 0;
    for (int i = 0; i < 3; ++i) {
        // Scaled by the longest edge, cells of the curve are cubes; else flat parts would be cut into
        // slivers.
        const auto x = static_cast<std::uint32_t>(packed_[t[0]] >> (lane * i) & lane_mask);
        code |= std::uint64_t{spread(x * shares_[i] >> 20)} << i;
    }
    return code;
}

/// Numbers of the triangles, by the digits of their codes, the lowest first.
std::vector<std::uint64_t> BoxTree::sorted(std::span<const std::int32_t> corners) const
{
    const std::size_t n = corners.size() / 3;
    constexpr int digits = 4096;
    std::vector<std::uint64_t> order = filled<std::uint64_t>(n, 0), other = filled<std::uint64_t>(n, 0);
    std::vector<std::uint32_t> begins(2 * digits, 0);
    in_parts(n, some, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t k = begin; k < end; ++k) order[k] = code_of(&corners[3 * k]) << 32 | k;
    });
    for (const std::uint64_t item : order)
        for (int pass = 0; pass < 2; ++pass)
            ++begins[pass * digits + (item >> (32 + 12 * pass) & (digits - 1))];
    for (int pass = 0; pass < 2; ++pass) {
        std::uint32_t* const at = &begins[pass * digits];
        std::uint32_t begin = 0;
        for (int d = 0; d < digits; ++d) begin += std::exchange(at[d], begin);
        for (const std::uint64_t item : order) other[at[item >> (32 + 12 * pass) & (digits - 1)]++] = item;
        order.swap(other);
    }
    return order;
}

void BoxTree::make_leaf(std::size_t l, std::span<const std::uint64_t> order, const Rings& rings)
{
    std::uint8_t all = 255;
    for (int j = 0; j < Leaf::n; ++j) {
        Box box = nothing;
        std::uint8_t own = 255;
        if (const std::size_t k = Leaf::n * l + j; k < order.size()) {
            const std::size_t t = order[k] & 0xffffffff;
            const std::int32_t* c = &from_.corners[3 * t];
            box = box_of(c);
            numbers_[k] = static_cast<std::uint32_t>(t);
            own = rings.directions[c[0]] & rings.directions[c[1]] & rings.directions[c[2]];
        }
        leaves[l].set(j, box);
        leaves[l].directions[j] = own;
        boxes[n_leaves + l].add(box);
        all &= own;
    }
    directions[n_leaves + l] = all;
}

void BoxTree::join()
{
    for (std::size_t k = n_leaves; k-- > 1;) {
        // Children of node k are 2 k and 2 k + 1, so going down from the last one every child is ready before
        // its parent.
        boxes[k] = boxes[2 * k];
        boxes[k].add(boxes[2 * k + 1]);
        directions[k] = directions[2 * k] & directions[2 * k + 1];
    }
}

void BoxTree::leave_out(std::span<const std::uint8_t> is_out)
{
    for (std::size_t l = 0; l < n_leaves; ++l)
        if (is_out[l] != 0) boxes[n_leaves + l] = nothing;
    join();
}

}   // namespace livens
