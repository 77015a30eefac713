// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows in lanes: gradients, violations, and projections by a factor of G G^T.
#pragma once

#include "livens/dynamics/lanes/lane_factor.h"

namespace livens::lanes {
namespace {

template <int W>
void form_products(const Pattern& p, const Values& start, const Values& v, bool changes)
{
    const At<W, false> X{v.numbers, nullptr}, dX{v.increments, nullptr};
    for (int m = 0; m < p.n_products; ++m) {
        const Columns& of = p.products[m];
        const int at = (12 * p.n_bodies + m) * W;
        const Three<W> x = X.column(of.x);
        store(v.numbers + at, dot(x, X.column(of.y)));
        if (!changes) continue;
        const Three<W> dx = dX.column(of.x), dy = dX.column(of.y);
        const double* y0 = start.numbers + of.y;
        store(v.increments + at, y0[0] * dx.x[0] + y0[1] * dx.x[1] + y0[2] * dx.x[2] + dot(x, dy));
    }
}

/// The terms of a sum, without its constant.
template <int W>
LIVENS_INLINE Lanes<W> sum_of(const Sums& sums, int i, const double* numbers)
{
    Lanes<W> sum = all<W>(0);
    for (int t = sums.begin[i]; t < sums.begin[i + 1]; ++t)
        sum += sums.terms[t].factor * load<W>(numbers + sums.terms[t].number * W);
    return sum;
}

/// What forms add to gradients, by their weights.
template <int W>
void add_weighted(const Pattern& p, const Values& v)
{
    const Sums& constant = p.gradients.entries;
    for (int i = 0; i < p.forms.n_entries; ++i) {
        const WeightedEntry& of = p.forms.entries[i];
        double* g = v.gradients + of.entry * W;
        const bool stays = of.is_first && constant.begin[of.entry] == constant.begin[of.entry + 1];
        const Lanes<W> before = stays ? all<W>(constant.constants[of.entry]) : load<W>(g);
        const Lanes<W> of_form = p.forms.gradients.constants[i] + sum_of<W>(p.forms.gradients, i, v.numbers);
        store(g, before + load<W>(v.forms.weights + of.form * W) * of_form);
    }
}

template <int W>
void form_gradients(const Pattern& p, const Values& v)
{
    for (int e = 0; e < p.n_entries; ++e) {
        const int first = p.gradients.entries.begin[e], last = p.gradients.entries.begin[e + 1];
        if (first == last) continue;
        Lanes<W> g = p.gradients.entries.terms[first].factor *
                     load<W>(v.numbers + p.gradients.entries.terms[first].number * W);
        for (int t = first + 1; t < last; ++t)
            g += p.gradients.entries.terms[t].factor *
                 load<W>(v.numbers + p.gradients.entries.terms[t].number * W);
        if (p.gradients.entries.constants[e] != 0) g = p.gradients.entries.constants[e] + g;
        store(v.gradients + e * W, g);
    }
    add_weighted<W>(p, v);
}

/// The sum of squares does not depend on which of two bodies comes first. A row without a gradient stays
/// zero.
template <int W>
LIVENS_INLINE Lanes<W> scale_of(const std::int32_t* begin, const double* entries)
{
    Lanes<W> squares[2];
    for (int side = 0; side < 2; ++side) {
        squares[side] = all<W>(0);
        for (int e = begin[side]; e < begin[side + 1]; ++e) {
            const Lanes<W> y = load<W>(entries + e * W);
            squares[side] += y * y;
        }
    }
    const Lanes<W> square = squares[0] + squares[1];
    Lanes<W> scale = 1 / root(square);
    for (int i = 0; i < scale.count; ++i)
        scale.part[i] = square.part[i] > 0 ? scale.part[i] : spread<W>(1);
    return scale;
}

template <int W>
void unit_rows(const Pattern& p, const Values& v, const UnitRows& to)
{
    form_products<W>(p, v, v, false);
    form_gradients<W>(p, v);
    const std::int32_t* begin = to.begin;
    for (int r = 0; r < p.n_rows; ++r, begin += 2) {
        const Lanes<W> scale = scale_of<W>(begin, v.gradients);
        store(to.scales + r * W, scale);
        for (int e = begin[0]; e < begin[2]; ++e)
            store(to.entries + e * W, scale * load<W>(v.gradients + e * W));
    }
}

template <int W>
void form_violations(const Pattern& p, const double* constants, const double* numbers, const Values& v)
{
    for (int r = 0; r < p.n_rows; ++r)
        store(v.violations + r * W, constants[r] + sum_of<W>(p.violations, r, numbers));
    for (int i = 0; i < p.forms.n_rows; ++i) {
        double* phi = v.violations + p.forms.rows[i] * W;
        store(phi, load<W>(phi) + load<W>(v.forms.by_rows + i * W));
    }
}

/// How forms have changed; then their weights, and what they make of violations.
template <int W>
void weigh_forms(const Pattern& p, const Values& start, const Values& v)
{
    if (p.forms.n_rows == 0) return;
    for (int k = 0; k < p.forms.n_forms; ++k)
        store(v.forms.values + k * W, sum_of<W>(p.forms.values, k, v.increments));
    p.forms.weigh(p.forms.caller, start, v, W);
}

template <int m, bool is_start, int W, bool rows>
LIVENS_INLINE void solve_down(const Pattern& p, const Part& part, const At<W, rows>& factor, double* x)
{
    using Some = Batch<W, m>;
    const Group& group = part.group;
    const int n = is_unrolled<W> ? m : group.n, first = part.first;
    const auto entry = [&](int r, int k) LIVENS_LAMBDA {
        return get<Some, is_start>(factor, group.diagonal + triangle(r, k));
    };
    Some s[m];
    each<m>([&](auto r) LIVENS_LAMBDA { s[r.value] = get<Some, W>(x, group.first + first + r.value); });
    for (const Block* b = p.factor.blocks + group.blocks; b != p.factor.blocks + (&group)[1].blocks; ++b)
        count_to<m>(b->n, [&](int j) LIVENS_LAMBDA {
            const Some y = get<Some, W>(x, b->first + j);
            each<m>([&](auto r) LIVENS_LAMBDA {
                s[r.value] -= get<Some, is_start>(factor, b->entry + j * n + first + r.value) * y;
            });
        });
    each<m>([&](auto r) LIVENS_LAMBDA {
        for (int k = 0; k < first; ++k)
            s[r.value] -= entry(first + r.value, k) * get<Some, W>(x, group.first + k);
        each<r.value>([&](auto k) LIVENS_LAMBDA {
            s[r.value] -= entry(first + r.value, first + k.value) * s[k.value];
        });
        s[r.value] = s[r.value] * entry(first + r.value, first + r.value);
        put<W>(x, group.first + first + r.value, s[r.value]);
    });
}

template <int m, bool is_start, int W, bool rows>
LIVENS_INLINE void solve_up(const Pattern& p, const Part& part, const At<W, rows>& factor, double* x)
{
    using Some = Batch<W, m>;
    const Group& group = part.group;
    const int n = is_unrolled<W> ? m : group.n, first = part.first;
    const auto entry = [&](int r, int k) LIVENS_LAMBDA {
        return get<Some, is_start>(factor, group.diagonal + triangle(r, k));
    };
    Some s[m];
    each<m>([&](auto r) LIVENS_LAMBDA { s[r.value] = get<Some, W>(x, group.first + first + r.value); });
    each<m>([&](auto i) LIVENS_LAMBDA {
        constexpr int r = m - 1 - i.value;
        s[r] = s[r] * entry(first + r, first + r);
        each<r>([&](auto k) LIVENS_LAMBDA { s[k.value] -= entry(first + r, first + k.value) * s[r]; });
        for (int k = 0; k < first; ++k)
            put<W>(x, group.first + k, get<Some, W>(x, group.first + k) - entry(first + r, k) * s[r]);
        put<W>(x, group.first + first + r, s[r]);
    });
    for (const Block* b = p.factor.blocks + group.blocks; b != p.factor.blocks + (&group)[1].blocks; ++b)
        count_to<m>(b->n, [&](int j) LIVENS_LAMBDA {
            Some y = get<Some, W>(x, b->first + j);
            each<m>([&](auto r) LIVENS_LAMBDA {
                y -= get<Some, is_start>(factor, b->entry + j * n + first + r.value) * s[r.value];
            });
            put<W>(x, b->first + j, y);
        });
}

/// x <- (G G^T)^-1 x
template <int W, bool rows>
void solve(const Pattern& p, const At<W, rows>& factor, double* x)
{
    for_groups<W, false>(p, [&](const Part& part, auto m, auto is_start, int l) LIVENS_LAMBDA {
        solve_down<m.value, rows && is_start.value>(p, part, from_lane(factor, l), x + l);
    });
    for_groups<W, true>(p, [&](const Part& part, auto m, auto is_start, int l) LIVENS_LAMBDA {
        solve_up<m.value, rows && is_start.value>(p, part, from_lane(factor, l), x + l);
    });
}

/// out <- G y + rates, which may be null.
template <int W, bool rows>
void multiply(const Pattern& p, const At<W, rows>& G, const double* y, const double* rates, double* out)
{
    for_groups<W, false>(p, [&](const Part& part, auto m, auto is_start, int l) LIVENS_LAMBDA {
        using Some = Batch<W, m.value>;
        const Group& group = part.group;
        const int first = group.first + part.first;
        const std::int32_t* begin = p.gradients.unit_begin + first;
        const At<W, rows> of = from_lane(G, l);
        Some s[m.value];
        each<m.value>([&](auto r) LIVENS_LAMBDA {
            s[r.value] = rates != nullptr ? get<Some, W>(rates + l, first + r.value) : all<Some::width>(0);
            for (const Unit* u = p.gradients.units + begin[r.value];
                 u != p.gradients.units + begin[r.value + 1]; ++u)
                s[r.value] += u->value * get<Some, W>(y + l, u->twist);
        });
        for (const Column* g = p.gradients.columns + group.columns;
             g != p.gradients.columns + (&group)[1].columns; ++g) {
            const Some by = get<Some, W>(y + l, g->twist);
            each<m.value>([&](auto r) LIVENS_LAMBDA {
                s[r.value] += get < Some, rows && is_start.value > (of, g->entry + part.first + r.value) * by;
            });
        }
        each<m.value>([&](auto r) LIVENS_LAMBDA { put<W>(out + l, first + r.value, s[r.value]); });
    });
}

/// y <- y - G^T x
template <int W, bool rows>
void take_off(const Pattern& p, const At<W, rows>& G, const double* x, double* y)
{
    for_groups<W, false>(p, [&](const Part& part, auto m, auto is_start, int l) LIVENS_LAMBDA {
        using Some = Batch<W, m.value>;
        const Group& group = part.group;
        const int first = group.first + part.first;
        const std::int32_t* begin = p.gradients.unit_begin + first;
        const At<W, rows> of = from_lane(G, l);
        Some s[m.value];
        each<m.value>([&](auto r) LIVENS_LAMBDA {
            s[r.value] = get<Some, W>(x + l, first + r.value);
            for (const Unit* u = p.gradients.units + begin[r.value];
                 u != p.gradients.units + begin[r.value + 1]; ++u)
                put<W>(y + l, u->twist, get<Some, W>(y + l, u->twist) - u->value * s[r.value]);
        });
        for (const Column* g = p.gradients.columns + group.columns;
             g != p.gradients.columns + (&group)[1].columns; ++g) {
            Some left = get<Some, W>(y + l, g->twist);
            each<m.value>([&](auto r) LIVENS_LAMBDA {
                left -= get < Some,
                    rows && is_start.value > (of, g->entry + part.first + r.value) * s[r.value];
            });
            put<W>(y + l, g->twist, left);
        }
    });
}

}   // namespace
}   // namespace livens::lanes
