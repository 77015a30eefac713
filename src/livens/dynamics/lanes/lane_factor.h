// SPDX-License-Identifier: BSD-3-Clause
// The factor of G G^T in lanes.
#pragma once

#include "livens/dynamics/lanes/lane_groups.h"

namespace livens::lanes {
namespace {

LIVENS_INLINE constexpr int triangle(int r, int c) { return r * (r + 1) / 2 + c; }

/// Row r of a block of the factor: (G_r . G_j - sum_k L_rk L_jk) L_jj^-T at the m rows j from `first` on of a
/// group before.
template <int W, int m>
LIVENS_INLINE void factorise_block(const Pattern& p, const Values& v, int rows, const Block& block, int r,
                                   int first, int l)
{
    using Some = Batch<W, m>;
    const int n = is_unrolled<W> ? m : block.n;
    const double* gradients = v.gradients + l;
    double *const factor = v.factor + l, *diagonal = at<W>(factor, block.diagonal);
    Some s[m];
    each<m>([&](auto j) LIVENS_LAMBDA {
        s[j.value] = all<Some::width>(p.factor.constants[block.entry + (first + j.value) * rows + r]);
    });
    for (const Pair *g = p.factor.pairs + block.pairs, *end = p.factor.pairs + (&block)[1].pairs; g != end;
         ++g) {
        const Some a = get<Some, W>(gradients, g->a + r);
        const double* b = at<W>(gradients, g->b + first);
        each<m>([&](auto j) LIVENS_LAMBDA { s[j.value] += a * get<Some, W>(b, j.value); });
    }
    const Product* end = p.factor.products + (&block)[1].products;
    for (const Product* f = p.factor.products + block.products; f != end; ++f) {
        const double *a = at<W>(factor, f->a + r), *b = at<W>(factor, f->b + first);
        count_to<m>(f->n, [&](int k) LIVENS_LAMBDA {
            const Some of_row = load<Some::width>(a + k * rows * W);
            each<m>([&](auto j) LIVENS_LAMBDA { s[j.value] -= of_row * get<Some, W>(b, k * n + j.value); });
        });
    }
    each<m>([&](auto j) LIVENS_LAMBDA {
        for (int k = 0; k < first; ++k)
            s[j.value] -= get<Some, W>(factor, block.entry + k * rows + r) *
                          get<Some, W>(diagonal, triangle(first + j.value, k));
        each<j.value>([&](auto k) LIVENS_LAMBDA {
            s[j.value] -= s[k.value] * get<Some, W>(diagonal, triangle(first + j.value, first + k.value));
        });
        s[j.value] = s[j.value] * get<Some, W>(diagonal, triangle(first + j.value, first + j.value));
        put<W>(factor, block.entry + (first + j.value) * rows + r, s[j.value]);
    });
}

/// What is not positive, or no number, is no pivot.
template <class Some>
LIVENS_INLINE void keep_smallest(double* pivots, const Some& left, const Some& own)
{
    Some pivot = load<Some::width>(pivots), share = left / own;
    for (int i = 0; i < Some::count; ++i) {
        share.part[i] = left.part[i] > 0 ? share.part[i] : typename Some::Part{};
        pivot.part[i] = pivot.part[i] < share.part[i] ? pivot.part[i] : share.part[i];
    }
    store(pivots, pivot);
}

/// Row r of a group's triangle, m entries from `first` on; the last may be the pivot.
template <int W, int m>
LIVENS_INLINE void factorise_row(const Pattern& p, const Values& v, const Group& group, int r, int first,
                                 int l)
{
    using Some = Batch<W, m>;
    double* const diagonal = at<W>(v.factor, group.diagonal) + l;
    Some s[m];
    each<m>([&](auto c) LIVENS_LAMBDA {
        s[c.value] = all<Some::width>(p.factor.constants[group.diagonal + triangle(r, first + c.value)]);
    });
    for (const Column* g = p.gradients.columns + group.columns;
         g != p.gradients.columns + (&group)[1].columns; ++g) {
        const double* column = at<W>(v.gradients, g->entry) + l;
        const Some a = get<Some, W>(column, r);
        each<m>([&](auto c) LIVENS_LAMBDA { s[c.value] += a * get<Some, W>(column, first + c.value); });
    }
    const Some own = s[m - 1];
    for (const Block* b = p.factor.blocks + group.blocks; b != p.factor.blocks + (&group)[1].blocks; ++b) {
        const double* column = at<W>(v.factor, b->entry) + l;
        count_to<m>(b->n, [&](int k) LIVENS_LAMBDA {
            const Some a = get<Some, W>(column, k * group.n + r);
            each<m>([&](auto c) LIVENS_LAMBDA {
                s[c.value] -= a * get<Some, W>(column, k * group.n + first + c.value);
            });
        });
    }
    for (int k = 0; k < first; ++k) {
        const Some a = get<Some, W>(diagonal, triangle(r, k));
        each<m>([&](auto c) LIVENS_LAMBDA {
            s[c.value] -= a * get<Some, W>(diagonal, triangle(first + c.value, k));
        });
    }
    const auto take = [&](auto c) LIVENS_LAMBDA {
        each<c.value>([&](auto k) LIVENS_LAMBDA {
            s[c.value] -= s[k.value] * get<Some, W>(diagonal, triangle(first + c.value, first + k.value));
        });
        s[c.value] = s[c.value] * get<Some, W>(diagonal, triangle(first + c.value, first + c.value));
        put<W>(diagonal, triangle(r, first + c.value), s[c.value]);
        if constexpr (c.value < m - 1) s[m - 1] -= s[c.value] * s[c.value];
    };
    each<m - 1>(take);
    if (first + m - 1 != r) return take(Size<m - 1>{});
    keep_smallest(v.pivots + l, s[m - 1], own);
    put<W>(diagonal, triangle(r, r), 1 / root(s[m - 1]));
}

/// The lower triangle of a Cholesky factor of G G^T, group by group, and its pivots over the rows' own
/// squares.
template <int W>
void factorise(const Pattern& p, const Values& v)
{
    store(v.pivots, all<W>(1));
    for (const Group* group = p.groups; group != p.groups + p.n_groups; ++group) {
        for (const Block* b = p.factor.blocks + group->blocks; b != p.factor.blocks + group[1].blocks; ++b)
            for_parts<W>(b->n, [&](auto m, int first) LIVENS_LAMBDA {
                for (int l = 0; l < W; l += lanes_at_once<W, m.value>())
                    for (int r = 0; r < group->n; ++r)
                        factorise_block<W, m.value>(p, v, group->n, *b, r, first, l);
            });
        for_parts<W>(group->n, [&](auto m, int first) LIVENS_LAMBDA {
            for (int l = 0; l < W; l += lanes_at_once<W, m.value>()) {
                if constexpr (is_unrolled<W>)
                    each<m.value>([&](auto r) LIVENS_LAMBDA {
                        factorise_row<W, r.value + 1>(p, v, *group, r.value, 0, l);
                    });
                else
                    for (int c = 0; c <= first; ++c) factorise_row<W, 1>(p, v, *group, first, c, l);
            }
        });
    }
}

}   // namespace
}   // namespace livens::lanes
