// SPDX-License-Identifier: BSD-3-Clause
// The triangles of a surface in a tree of boxes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "livens/geometry/detail/facets.h"

namespace livens::inline geometry_internal {

/// Three numbers of 20 bits each, with a bit between them that is free.
using Packed = std::uint64_t;
constexpr int lane = 21;
constexpr Packed lane_mask = (Packed{1} << 20) - 1;
constexpr Packed guards = Packed{1} << 20 | Packed{1} << 41 | Packed{1} << 62;
constexpr Packed ones = Packed{1} | Packed{1} << 21 | Packed{1} << 42;

/// Free bits of the numbers of a that are not below those of b.
inline Packed not_below(Packed a, Packed b) { return ((a | guards) - b) & guards; }
/// Those of a where the free bit is set, else those of b.
inline Packed select(Packed free_bits, Packed a, Packed b)
{
    const Packed mask = free_bits - (free_bits >> 20);
    return (a & mask) | (b & ~mask);
}

/// In units of a millionth of the surface's size along each axis.
struct Box {
    Packed low, high;

    bool meets(const Box& other) const
    {
        return (not_below(other.high, low) & not_below(high, other.low)) == guards;
    }
    void add(const Box& other)
    {
        low = select(not_below(low, other.low), other.low, low);
        high = select(not_below(high, other.high), high, other.high);
    }
};

/// A triangle: its points, its face.
using Four = std::int32_t __attribute__((vector_size(16)));
/// One number of each triangle of a leaf.
using Lanes = std::int16_t __attribute__((vector_size(16)));

template <class Vector>
bool any(Vector x)
{
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(x);
    return (halves[0] | halves[1]) != 0;
}

/// A box in units that are 2^5 times coarser: what meets still does.
struct CoarseBox {
    std::array<std::int16_t, 3> low, high;

    explicit CoarseBox(const Box& box)
    {
        for (int i = 0; i < 3; ++i) low[i] = coarse(box.low, i), high[i] = coarse(box.high, i);
    }
    static std::int16_t coarse(Packed x, int i)
    {
        return static_cast<std::int16_t>((x >> (lane * i) & lane_mask) >> 5);
    }
};

/// Boxes of the triangles of a leaf. All are compared at once, without branches, as none of them can be
/// foreseen.
struct Leaf {
    static constexpr int n = 8;
    std::array<Lanes, 3> low, high;
    Lanes directions;   ///< in which all their points have a fan, Rings::directions

    void set(int k, const Box& box)
    {
        const CoarseBox b(box);
        for (int i = 0; i < 3; ++i) low[i][k] = b.low[i], high[i][k] = b.high[i];
    }
    CoarseBox box(int k) const
    {
        CoarseBox b({0, 0});
        for (int i = 0; i < 3; ++i) b.low[i] = low[i][k], b.high[i] = high[i][k];
        return b;
    }
    /// Lanes of those that do not meet a box.
    Lanes apart(const CoarseBox& other) const
    {
        Lanes apart{};
        for (int i = 0; i < 3; ++i)
            apart |= (low[i] > Lanes{} + other.high[i]) | (high[i] < Lanes{} + other.low[i]);
        return apart;
    }
    /// Bits of those that meet it.
    unsigned met(const CoarseBox& other) const { return ~bits(apart(other)) & 255; }

    static unsigned bits(Lanes all_or_none)
    {
        const auto bytes = std::bit_cast<std::array<std::uint64_t, 2>>(all_or_none);
        // Of each lane one bit, gathered by a product whose terms do not overlap.
        const auto gathered = [](std::uint64_t x) {
            return static_cast<unsigned>((x & 0x0001000100010001) * 0x0001000200040008 >> 48);
        };
        return gathered(bytes[0]) | gathered(bytes[1]) << 4;
    }
};

/// Triangles along a curve that fills space [Morton 1966], and boxes around them: a full binary tree in one
/// array, in which node k has the nodes 2 k and 2 k + 1 and leaves are the last level. The triangles must
/// stay.
struct BoxTree {
    BoxTree(const std::vector<Vector3>& points, const Triangles& triangles, const Rings& rings);

    std::vector<Leaf> leaves;
    std::vector<Box> boxes;
    std::vector<std::uint8_t> directions;   ///< of each node those of all its triangles
    std::size_t n_leaves = 1;

    /// By its place in the leaves.
    Four triangle(std::size_t place) const
    {
        const std::uint32_t t = numbers_[place];
        const std::int32_t* c = &from_.corners[3 * std::size_t{t}];
        return Four{c[0], c[1], c[2], from_.face(t)};
    }
    bool is_empty(std::size_t leaf) const { return Leaf::n * leaf >= numbers_.size(); }
    /// Leaves that are left out meet nothing.
    void leave_out(std::span<const std::uint8_t> is_out);
    /// Every coordinate is rounded down in the same way, so that what meets still does.
    Packed pack(const Vector3& p) const;
    double length(int axis) const { return half_[axis]; }   ///< of the box of all, halved

private:
    void measure(const std::vector<Vector3>& points, std::span<const std::int32_t> corners);
    Box box_of(const std::int32_t* triangle) const;
    std::uint64_t code_of(const std::int32_t* triangle) const;
    std::vector<std::uint64_t> sorted(std::span<const std::int32_t> corners) const;
    void make_leaf(std::size_t l, std::span<const std::uint64_t> order, const Rings& rings);
    void join();

    const Triangles& from_;
    std::vector<std::uint32_t> numbers_;   ///< of triangles, in the order of the leaves
    std::vector<Packed> packed_;           ///< points
    Vector3 low_{}, half_{}, scale_{};
    std::array<std::uint32_t, 3> shares_{};   ///< of each edge of the box in the longest, times 256
};

/// Of each leaf: its triangles are known to touch no other but where they share corners.
std::vector<std::uint8_t> lone_sheets(const BoxTree& tree, const std::vector<Vector3>& points);

}   // namespace livens::inline geometry_internal
