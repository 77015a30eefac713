// SPDX-License-Identifier: BSD-3-Clause
// Loads at all load points of an element, in lanes.
#pragma once

#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/dynamics/lanes/lanes.h"

namespace livens::lanes {
namespace {

/// Lanes that go through all steps at a time: more would only be more instructions in memory.
template <int W>
constexpr int load_batch = W <= 8                ? W
                           : LIVENS_REGISTER < 4 ? 4
                                                 : LIVENS_REGISTER;

/// Three quantities in a row.
template <int W, int B>
LIVENS_INLINE Three<B> three_of(const double* x)
{
    return {{load<B>(x), load<B>(x + W), load<B>(x + 2 * W)}};
}
template <int W, int B>
LIVENS_INLINE void store_three(double* x, const Three<B>& v)
{
    for (int i = 0; i < 3; ++i) store(x + i * W, v.x[i]);
}

template <int W, int B>
LIVENS_INLINE Three<B> sum_of_terms(const Term* term, const Term* end, const double* numbers)
{
    Three<B> s{{all<B>(0), all<B>(0), all<B>(0)}};
    for (; term != end; ++term) {
        const Three<B> x = three_of<W, B>(numbers + term->number * W);
        for (int i = 0; i < 3; ++i) s.x[i] += term->factor * x.x[i];
    }
    return s;
}

/// act(lane) in the lanes from `first` on that stand for points; those behind are as the last of these.
template <int W, int B, class Act>
LIVENS_INLINE void for_lanes(int n, int first, double* to, const Act& act)
{
    for (int l = first; l < first + B; ++l) to[l] = l < n ? act(l) : to[n - 1];
}

/// Next to what it is in the lane before.
template <int W, int B>
void unwrap(const LoadProgram& p, const LoadStep& step, int first)
{
    constexpr double turn = 6.283185307179586;
    const double* a = p.registers + step.a * W;
    for_lanes<W, B>(p.n_lanes, first, p.registers + step.to * W, [&](int l) LIVENS_LAMBDA {
        double& near = p.turns[step.begin];
        return near = a[l] + turn * __builtin_round((near - a[l]) / turn);
    });
}

template <int W, int B>
void call_outer(const LoadProgram& p, const LoadStep& step, int first)
{
    for (int l = first; l < first + B && l < p.n_lanes; ++l) p.call(p.caller, step, l);
    for (int k = 0; k < step.end; ++k) {
        double* to = p.registers + (step.to + k) * W;
        for (int l = first; l < first + B; ++l)
            if (l >= p.n_lanes) to[l] = to[p.n_lanes - 1];
    }
}

template <int B, class Choose>
LIVENS_INLINE Lanes<B> lane_by_lane(const Lanes<B>& a, const Lanes<B>& b, const Choose& choose)
{
    Lanes<B> v;
    for (int i = 0; i < v.count; ++i) {
        if constexpr (Lanes<B>::size == 1)
            v.part[i] = choose(a.part[i], b.part[i]);
        else
            for (int j = 0; j < v.size; ++j) v.part[i][j] = choose(a.part[i][j], b.part[i][j]);
    }
    return v;
}

/// Steps of numbers. False: it is none of these.
template <int W, int B>
LIVENS_INLINE bool step_number(const LoadProgram& p, const LoadStep& step, int first)
{
    double* const r = p.registers + first;
    const auto a = [&]() LIVENS_LAMBDA { return load<B>(r + step.a * W); };
    const auto b = [&]() LIVENS_LAMBDA { return load<B>(r + step.b * W); };
    const auto put = [&](const Lanes<B>& v) LIVENS_LAMBDA {
        store(r + step.to * W, v);
        return true;
    };
    switch (step.kind) {
    case LoadKind::plus:
        return put(a() + b());
    case LoadKind::minus:
        return put(a() - b());
    case LoadKind::times:
        return put(a() * b());
    case LoadKind::divided:
        return put(a() / b());
    case LoadKind::scaled:
        return put(step.number * a());
    case LoadKind::shifted:
        return put(step.number + a());
    case LoadKind::root:
        return put(root(a()));
    case LoadKind::absolute:
        return put(lane_by_lane(a(), a(), [](double x, double) { return x < 0 ? -x : x; }));
    case LoadKind::inverse:
        return put(lane_by_lane(a(), 1.0 / a(), [](double x, double y) { return x > 0 ? y : 0; }));
    case LoadKind::least:
        return put(lane_by_lane(a(), b(), [](double x, double y) { return y < x ? y : x; }));
    case LoadKind::greatest:
        return put(lane_by_lane(a(), b(), [](double x, double y) { return y > x ? y : x; }));
    case LoadKind::chosen:
        return put(lane_by_lane(a(), b(), [](double x, double y) { return x != 0 ? y : 0; }));
    default:
        return false;
    }
}

/// Steps of vectors, and what has to go lane by lane.
template <int W, int B>
LIVENS_INLINE void step_vector(const LoadProgram& p, const LoadStep& step, const double* X, const double* V,
                               int first)
{
    double* const r = p.registers + first;
    const auto a = [&]() LIVENS_LAMBDA { return three_of<W, B>(r + step.a * W); };
    const auto b = [&]() LIVENS_LAMBDA { return three_of<W, B>(r + step.b * W); };
    const auto factor = [&]() LIVENS_LAMBDA { return load<B>(r + step.a * W); };
    Three<B> v;
    switch (step.kind) {
    case LoadKind::arm:
        v = sum_of_terms<W, B>(p.terms + step.begin, p.terms + step.end, X + first);
        break;
    case LoadKind::arm_rate:
        v = sum_of_terms<W, B>(p.terms + step.begin, p.terms + step.end, V + first);
        break;
    case LoadKind::sum:
        for (int i = 0; i < 3; ++i) v.x[i] = a().x[i] + b().x[i];
        break;
    case LoadKind::difference:
        for (int i = 0; i < 3; ++i) v.x[i] = a().x[i] - b().x[i];
        break;
    case LoadKind::stretched:
        for (int i = 0; i < 3; ++i) v.x[i] = factor() * b().x[i];
        break;
    case LoadKind::cross: {
        const Three<B> x = a(), y = b();
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            v.x[i] = x.x[j] * y.x[k] - x.x[k] * y.x[j];
        }
        break;
    }
    case LoadKind::dot:
        return store(r + step.to * W, dot(a(), b()));
    case LoadKind::first_pull:
        for (int i = 0; i < 3; ++i) v.x[i] = factor() * b().x[i];
        break;
    case LoadKind::pull:
        v = three_of<W, B>(r + step.to * W);
        for (int i = 0; i < 3; ++i) v.x[i] += factor() * b().x[i];
        break;
    case LoadKind::function: {
        const double *x = p.registers + step.a * W, *y = p.registers + step.b * W;
        return for_lanes<W, B>(p.n_lanes, first, p.registers + step.to * W,
                               [&](int l) LIVENS_LAMBDA { return step.function(x[l], y[l]); });
    }
    case LoadKind::unwrapped:
        return unwrap<W, B>(p, step, first);
    default:
        return call_outer<W, B>(p, step, first);
    }
    store_three<W>(r + step.to * W, v);
}

/// F of the columns at X and X', times `factors`; null: steps alone. Numbers of X, X' and F as those of a
/// pattern.
template <int W>
void run_loads(const LoadProgram& p, const double* X, const double* V, const double* factors, double* F)
{
    constexpr int B = load_batch<W>;
    for (int first = 0; first < W; first += B) {
        for (const LoadStep* step = p.steps; step != p.steps + p.n_steps; ++step)
            if (!step_number<W, B>(p, *step, first)) step_vector<W, B>(p, *step, X, V, first);
        for (int c = 0; F != nullptr && c < p.n_columns; ++c) {
            const LoadColumn& column = p.columns[c];
            const Three<B> f =
                sum_of_terms<W, B>(p.terms + column.begin, p.terms + column.end, p.registers + first);
            const Lanes<B> by = load<B>(factors + first);
            for (int i = 0; i < 3; ++i) store(F + (column.number + i) * W + first, by * f.x[i]);
        }
    }
}

}   // namespace
}   // namespace livens::lanes
