// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows in lanes: gradients, violations, and projections by a factor of G G^T.
#pragma once

#include "livens/multibody/lane_arithmetic.h"
#include "livens/multibody/lanes.h"

namespace livens::lanes {
namespace {

/// Where number i begins. It is never negative, which saves an instruction.
template <int W, class T>
LIVENS_INLINE T* at(T* x, std::int32_t i)
{
    return x + static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) * W;
}

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

template <int W>
void form_gradients(const Pattern& p, const Values& v)
{
    for (int e = 0; e < p.n_entries; ++e) {
        const int first = p.entries.begin[e], last = p.entries.begin[e + 1];
        if (first == last) continue;
        Lanes<W> g = p.entries.terms[first].factor * load<W>(v.numbers + p.entries.terms[first].number * W);
        for (int t = first + 1; t < last; ++t)
            g += p.entries.terms[t].factor * load<W>(v.numbers + p.entries.terms[t].number * W);
        if (p.entries.constants[e] != 0) g = p.entries.constants[e] + g;
        store(v.gradients + e * W, g);
    }
}

template <int W>
void form_violations(const Pattern& p, const double* constants, const double* numbers, double* violations)
{
    for (int r = 0; r < p.n_rows; ++r) {
        Lanes<W> phi = all<W>(0);
        for (int t = p.violations.begin[r]; t < p.violations.begin[r + 1]; ++t)
            phi += p.violations.terms[t].factor * load<W>(numbers + p.violations.terms[t].number * W);
        store(violations + r * W, constants[r] + phi);
    }
}

/// The lower triangle of a Cholesky factor of G G^T, row by row, and its pivots over the rows' own squares.
template <int W>
void factorise(const Pattern& p, const Values& v)
{
    Lanes<W> pivot = all<W>(1);
    const Pair *g = p.factor.gradients, *f = p.factor.products;
    for (int r = 0; r < p.n_rows; ++r) {
        for (int t = p.factor.begin[r]; t < p.factor.begin[r + 1]; ++t) {
            const Entry& entry = p.factor.entries[t];
            Lanes<W> s = all<W>(0);
            for (const Pair* end = p.factor.gradients + entry.gradients_end; g != end; ++g)
                s += load<W>(at<W>(v.gradients, g->a)) * load<W>(at<W>(v.gradients, g->b));
            const Lanes<W> own = s;
            for (const Pair* end = p.factor.products + entry.entries_end; f != end; ++f)
                s -= load<W>(at<W>(v.factor, f->a)) * load<W>(at<W>(v.factor, f->b));
            if (entry.pivot >= 0) {
                store(v.factor + t * W, s * load<W>(v.factor + entry.pivot * W));
                continue;
            }
            Lanes<W> left = s / own;
            for (int i = 0; i < left.count; ++i) {   // what is not positive, or no number, is no pivot
                left.part[i] = s.part[i] > 0 ? left.part[i] : typename Lanes<W>::Part{};
                pivot.part[i] = pivot.part[i] < left.part[i] ? pivot.part[i] : left.part[i];
            }
            store(v.factor + t * W, 1 / root(s));
        }
    }
    store(v.pivots, pivot);
}

/// x <- (G G^T)^-1 x
template <int W, bool rows>
void solve(const Pattern& p, const At<W, rows>& factor, double* x)
{
    for (int r = 0; r < p.n_rows; ++r) {
        const int last = p.factor.begin[r + 1] - 1;
        Lanes<W> s = load<W>(x + r * W);
        for (int t = p.factor.begin[r]; t < last; ++t) s -= factor[t] * load<W>(at<W>(x, p.factor.column[t]));
        store(x + r * W, s * factor[last]);
    }
    for (int r = p.n_rows - 1; r >= 0; --r) {
        const int last = p.factor.begin[r + 1] - 1;
        const Lanes<W> s = load<W>(x + r * W) * factor[last];
        store(x + r * W, s);
        for (int t = p.factor.begin[r]; t < last; ++t) {
            double* other = at<W>(x, p.factor.column[t]);
            store(other, load<W>(other) - factor[t] * s);
        }
    }
}

/// out <- G y + rates, which may be null.
template <int W, bool rows>
void multiply(const Pattern& p, const At<W, rows>& G, const double* y, const double* rates, double* out)
{
    for (int r = 0; r < p.n_rows; ++r) {
        Lanes<W> s = rates != nullptr ? load<W>(rates + r * W) : all<W>(0);
        for (int e = p.row_begin[r]; e < p.row_begin[r + 1]; ++e) s += G[e] * load<W>(at<W>(y, p.twist[e]));
        store(out + r * W, s);
    }
}

/// y <- y - G^T x
template <int W, bool rows>
void take_off(const Pattern& p, const At<W, rows>& G, const double* x, double* y)
{
    for (int r = 0; r < p.n_rows; ++r) {
        const Lanes<W> s = load<W>(x + r * W);
        for (int e = p.row_begin[r]; e < p.row_begin[r + 1]; ++e) {
            double* out = at<W>(y, p.twist[e]);
            store(out, load<W>(out) - G[e] * s);
        }
    }
}

}   // namespace
}   // namespace livens::lanes
