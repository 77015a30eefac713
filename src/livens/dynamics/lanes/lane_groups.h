// SPDX-License-Identifier: BSD-3-Clause
// How lanes of the rows of groups are gone through.
#pragma once

#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/dynamics/lanes/lanes.h"

#ifndef LIVENS_UNROLLED
#define LIVENS_UNROLLED 8   // lanes, of which much is unrolled
#endif

namespace livens::lanes {
namespace {

/// Where number i begins. It is never negative, which saves an instruction.
template <int W, class T>
LIVENS_INLINE T* at(T* x, std::int32_t i)
{
    return x + static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) * W;
}

template <int n>
struct Size {
    static constexpr int value = n;
};

/// Whether loops over the rows of a group are unrolled, so that their sums stay in registers: where it
/// counts, since it is much code. Else rows are gone through one by one.
#ifdef LIVENS_FEW_WIDTHS   // where size counts: the usual width
template <int W>
constexpr bool is_unrolled = W == 1 || W == LIVENS_UNROLLED;
#else
template <int W>
constexpr bool is_unrolled = W == 1 || W <= LIVENS_UNROLLED;
#endif

/// Lanes that are gone through at a time for m rows: ten registers of sums at most.
template <int W, int m>
constexpr int lanes_at_once()
{
    int count = Lanes<W>::count;
    while (count > 1 && (m * count > 10 || Lanes<W>::count % count != 0)) --count;
    return count * Lanes<W>::size;
}
template <int W, int m>
using Batch = Lanes<lanes_at_once<W, m>()>;

/// act(Size<m>{}, r) for parts of m rows from r on of a group of n: all of them, or one after the other, also
/// upwards.
template <int W, bool up = false, class Act>
LIVENS_INLINE void for_parts(int n, const Act& act)
{
    if constexpr (is_unrolled<W>) {
        switch (n) {
        case 1:
            return act(Size<1>{}, 0);
        case 2:
            return act(Size<2>{}, 0);
        case 3:
            return act(Size<3>{}, 0);
        default:
            return act(Size<Group::most>{}, 0);
        }
    } else {
        for (int r = 0; r < n; ++r) act(Size<1>{}, up ? n - 1 - r : r);
    }
}

/// act(Size<0>{}) .. act(Size<n - 1>{}), so that what is indexed by them may stay in registers.
template <int n, class Act>
LIVENS_INLINE void each(const Act& act)
{
    if constexpr (n > 0) {
        each<n - 1>(act);
        act(Size<n - 1>{});
    }
}

/// act(0) .. act(n - 1), unrolled for balls in a row, where counting costs most; more is too much code.
template <int m, class Act>
LIVENS_INLINE void count_to(int n, const Act& act)
{
    if (m == 3 && n == m)
        each<m>([&](auto j) LIVENS_LAMBDA { act(j.value); });
    else
        for (int j = 0; j < n; ++j) act(j);
}

/// Quantity i, of which `Some` takes as many lanes as it has; where rows are, lane 0 is the start.
template <class Some, int W>
LIVENS_INLINE Some get(const double* x, std::int32_t i)
{
    return load<Some::width>(at<W>(x, i));
}
template <class Some, bool is_start, int W, bool rows>
LIVENS_INLINE Some get(const At<W, rows>& of, std::int32_t i)
{
    const Some v = get<Some, W>(of.nodes, i);
    if constexpr (is_start) return with_start(v, of.start + i);
    return v;
}
template <int W, class Some>
LIVENS_INLINE void put(double* x, std::int32_t i, const Some& v)
{
    store(at<W>(x, i), v);
}

/// Rows first .. first + m - 1 of a group.
struct Part {
    const Group& group;
    int first;
};

/// act(part, Size<its rows>, Size<whether lane 0 is one of them>, first lane) for all batches of lanes and
/// parts of groups, in their order or upwards.
template <int W, bool up, class Act>
LIVENS_INLINE void for_groups(const Pattern& p, const Act& act)
{
    for (int i = 0; i < p.n_groups; ++i) {
        const Group& group = p.groups[up ? p.n_groups - 1 - i : i];
        for_parts<W, up>(group.n, [&](auto m, int first) LIVENS_LAMBDA {
            constexpr int batch = lanes_at_once<W, m.value>();
            act(Part{group, first}, m, Size<1>{}, 0);
            for (int l = batch; l < W; l += batch) act(Part{group, first}, m, Size<0>{}, l);
        });
    }
}

template <int W, bool rows>
LIVENS_INLINE At<W, rows> from_lane(const At<W, rows>& of, int l)
{
    return {of.nodes + l, of.start};
}

}   // namespace
}   // namespace livens::lanes
