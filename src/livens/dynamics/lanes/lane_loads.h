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

/// Of a turn by the square of its sine and its cosine: itself over its sine, and twice the slope of that by
/// the square. Closed forms cancel for small turns, and in lanes are slower than the series of atan(sqrt(x))
/// / sqrt(x), of which ten terms leave 1e-20.
template <int W, int B>
void turn(const LoadProgram& p, const LoadStep& step, int first)
{
    constexpr double small = 0.01;
    const double *sigma = p.registers + step.a * W, *cosine = p.registers + step.b * W;
    double *value = p.registers + step.to * W, *slope = value + W;
    bool is_small = true;
    for (int l = first; l < first + B; ++l)
        is_small = is_small && cosine[l] > 0 && sigma[l] < small * cosine[l] * cosine[l];
    if (!is_small) {
        double both[2] = {};
        for (int l = first; l < first + B; ++l) {
            if (l < p.n_lanes) step.turn(sigma[l], cosine[l], both);
            value[l] = l < p.n_lanes ? both[0] : value[p.n_lanes - 1];
            slope[l] = l < p.n_lanes ? both[1] : slope[p.n_lanes - 1];
        }
        return;
    }
    const Lanes<B> by_c = 1.0 / load<B>(cosine + first), by_c2 = by_c * by_c,
                   x = load<B>(sigma + first) * by_c2;
    Lanes<B> sum = all<B>(1.0 / 19), of_slope = all<B>(20.0 / 21);
    for (int k = 8; k >= 0; --k) {
        sum = all<B>(1.0 / (2 * k + 1)) - x * sum;
        of_slope = all<B>((2.0 * k + 2) / (2 * k + 3)) - x * of_slope;
    }
    store(value + first, by_c * sum);
    store(slope + first, -1.0 * (by_c * by_c2 * of_slope));
}

/// Steps of which there are few.
template <int W, int B>
LIVENS_INLINE void run_rare_step(const LoadProgram& p, const LoadStep& step, int first)
{
    double *const r = p.registers + first, *const to = r + step.to * W;
    const auto a = [&]() LIVENS_LAMBDA { return load<B>(r + step.a * W); };
    const auto b = [&]() LIVENS_LAMBDA { return load<B>(r + step.b * W); };
    const auto put = [&](const Lanes<B>& v) LIVENS_LAMBDA { store(to, v); };
    switch (step.kind) {
    case LoadKind::divided:
        return put(a() / b());
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
    case LoadKind::function: {
        const double *x = p.registers + step.a * W, *y = p.registers + step.b * W;
        return for_lanes<W, B>(p.n_lanes, first, p.registers + step.to * W,
                               [&](int l) LIVENS_LAMBDA { return step.function(x[l], y[l]); });
    }
    case LoadKind::turn:
        return turn<W, B>(p, step, first);
    case LoadKind::unwrapped:
        return unwrap<W, B>(p, step, first);
    default:
        return call_outer<W, B>(p, step, first);
    }
}

/// One step in B lanes from `first` on. To choose costs as much as most of them do.
template <int W, int B>
LIVENS_INLINE void run_step(const LoadProgram& p, const LoadStep& step, int first)
{
    double *const r = p.registers + first, *const to = r + step.to * W;
    const auto number = [&](int of) LIVENS_LAMBDA { return load<B>(r + of * W); };
    const auto vector = [&](int of) LIVENS_LAMBDA { return three_of<W, B>(r + of * W); };
    const auto a = [&]() LIVENS_LAMBDA { return number(step.a); };
    const auto b = [&]() LIVENS_LAMBDA { return number(step.b); };
    const auto put = [&](const Lanes<B>& v) LIVENS_LAMBDA { store(to, v); };
    const auto put_each = [&](const auto& part) LIVENS_LAMBDA {
        Three<B> v;
        for (int i = 0; i < 3; ++i) v.x[i] = part(i);
        store_three<W>(to, v);
    };
    switch (step.kind) {
    case LoadKind::arm:
        return store_three<W>(to, sum_of_terms<W, B>(p.terms + step.begin, p.terms + step.end, r));
    case LoadKind::plus:
        return put(a() + b());
    case LoadKind::minus:
        return put(a() - b());
    case LoadKind::times:
        return put(a() * b());
    case LoadKind::scaled:
        return put(step.number * a());
    case LoadKind::shifted:
        return put(step.number + a());
    case LoadKind::plus_scaled:
        return put(a() + step.number * b());
    case LoadKind::plus_product:
        return put(step.number < 0 ? a() - b() * number(step.begin) : a() + b() * number(step.begin));
    case LoadKind::plus_dot:
        return put(a() + dot(vector(step.b), vector(step.begin)));
    case LoadKind::dot:
        return put(dot(vector(step.a), vector(step.b)));
    case LoadKind::sum:
        return put_each([&](int i) LIVENS_LAMBDA { return number(step.a + i) + number(step.b + i); });
    case LoadKind::difference:
        return put_each([&](int i) LIVENS_LAMBDA { return number(step.a + i) - number(step.b + i); });
    case LoadKind::stretched:
    case LoadKind::first_pull:
        return put_each([&](int i) LIVENS_LAMBDA { return a() * number(step.b + i); });
    case LoadKind::pull:
        return put_each([&](int i) LIVENS_LAMBDA { return number(step.to + i) + a() * number(step.b + i); });
    case LoadKind::pull_one:
        return put(number(step.to) + step.number * a());
    case LoadKind::cross: {
        const Three<B> x = vector(step.a), y = vector(step.b);
        return put_each([&](int i) LIVENS_LAMBDA {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            return x.x[j] * y.x[k] - x.x[k] * y.x[j];
        });
    }
    default:
        return run_rare_step<W, B>(p, step, first);
    }
}

/// F of the columns, times `factors`; null: steps alone. X and X' at load points; null: arms are known.
/// Numbers of X, X' and F as those of a pattern.
template <int W>
void run_loads(const LoadProgram& p, const double* X, const double* V, const double* factors, double* F)
{
    constexpr int B = load_batch<W>;
    for (int first = 0; first < W; first += B) {
        for (const LoadArm* arm = p.arms; X != nullptr && arm != p.arms + p.n_arms; ++arm) {
            double* const r = p.registers + first;
            const Term *begin = p.terms + arm->begin, *end = p.terms + arm->end;
            if (arm->to >= 0) store_three<W>(r + arm->to * W, sum_of_terms<W, B>(begin, end, X + first));
            if (arm->rate >= 0) store_three<W>(r + arm->rate * W, sum_of_terms<W, B>(begin, end, V + first));
        }
        for (const LoadStep* step = p.steps; step != p.steps + p.n_steps; ++step)
            run_step<W, B>(p, *step, first);
        for (int c = 0; F != nullptr && c < p.n_columns; ++c) {
            const LoadColumn& column = p.columns[c];
            const Three<B> f =
                sum_of_terms<W, B>(p.terms + column.begin, p.terms + column.end, p.registers + first);
            const Lanes<B> by = load<B>(factors + first);
            for (int i = 0; i < 3; ++i) store(F + (column.number + i) * W + first, by * f.x[i]);
        }
    }
}

/// Arms at load points from what nodes have moved by: M and dM a row of lanes for each node.
template <int W>
void interpolate_arms(const LoadProgram& p, const double* start, const double* increments, const double* M,
                      const double* dM)
{
    alignas(64) double moved[3 * W];
    for (const LoadArm* arm = p.arms; arm != p.arms + p.n_arms; ++arm)
        for (int i = 0; i < 3; ++i) {
            double at_start = 0;
            Lanes<W> sum = all<W>(0);
            for (const Term* term = p.terms + arm->begin; term != p.terms + arm->end; ++term) {
                at_start += term->factor * start[term->number + i];
                sum += term->factor * load<W>(increments + (term->number + i) * W);
            }
            store(moved + i * W, sum);
            double* const r = p.registers + i * W;
            if (arm->to >= 0) store(r + arm->to * W, at_start + times<W>(moved + i * W, M));
            if (arm->rate >= 0) store(r + arm->rate * W, times<W>(moved + i * W, dM));
        }
}

/// Forces at load points, times `factors`, at the nodes of rows: `M_rows` one row for each point.
template <int W>
void share_out(const LoadProgram& p, const double* factors, const double* M_rows, double* loads)
{
    constexpr int B = load_batch<W>;
    alignas(64) double at_points[3 * W];
    for (int c = 0; c < p.n_columns; ++c)
        for (int i = 0; i < 3; ++i) store(loads + (p.columns[c].number + i) * W, all<W>(0));
    for (const LoadForce* force = p.forces; force != p.forces + p.n_forces; ++force) {
        for (int first = 0; first < W; first += B) {
            const Three<B> f =
                sum_of_terms<W, B>(p.terms + force->begin, p.terms + force->end, p.registers + first);
            const Lanes<B> by = load<B>(factors + first);
            for (int i = 0; i < 3; ++i) store(at_points + i * W + first, by * f.x[i]);
        }
        for (int i = 0; i < 3; ++i) {
            const Lanes<W> at_rows = times<W>(at_points + i * W, M_rows);
            for (const Term* to = p.terms + force->first; to != p.terms + force->last; ++to) {
                double* f = loads + (to->number + i) * W;
                store(f, load<W>(f) + to->factor * at_rows);
            }
        }
    }
}

/// The same of forces that are there by columns; `loads` has others.
template <int W>
void share_columns(const LoadProgram& p, const double* at_points, const double* M_rows, double* loads)
{
    for (int c = 0; c < p.n_columns; ++c)
        for (int i = p.columns[c].number; i < p.columns[c].number + 3; ++i)
            store(loads + i * W, load<W>(loads + i * W) + times<W>(at_points + i * W, M_rows));
}

}   // namespace
}   // namespace livens::lanes
