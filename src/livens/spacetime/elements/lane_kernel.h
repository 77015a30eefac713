// SPDX-License-Identifier: BSD-3-Clause
// The functions of kernel_functions.h, for whatever instructions a source that includes this is compiled
// with.
#pragma once

#include "livens/dynamics/lanes/lane_loads.h"
#include "livens/dynamics/lanes/lane_rows.h"
#include "livens/spacetime/elements/lane_blocks.h"
#include "livens/spacetime/elements/lane_places.h"

namespace livens::lanes {
namespace {

template <int W>
void configure(const Pattern& p, const Values& start, const Values& v)
{
    place_numbers<W>(p, start, v);
    form_products<W>(p, start, v, true);
    weigh_forms<W>(p, start, v);
    form_gradients<W>(p, v);
    form_violations<W>(p, start.violations, v.increments, v);
}

template <int W>
void interpolate(const Pattern& p, const Values& start, const Values& v, const Rule& rule)
{
    for (int b = 0; b < p.n_bodies; ++b)
        for (int i = 12 * b; p.bodies[b].loaded && i < 12 * b + (p.bodies[b].dofs == 6 ? 12 : 3); ++i) {
            store(v.at_loads.X + i * W, start.numbers[i] + times<W>(v.increments + i * W, rule.M));
            store(v.at_loads.V + i * W, times<W>(v.increments + i * W, rule.dM));
        }
}

/// y_2 <- L^-1 t
template <int W>
LIVENS_INLINE Lanes<W> scaled(const Body& body, const Three<W>& t, int a)
{
    const double* s = body.spin + 3 * a;
    if (body.principal) return s[a] * t.x[a];
    return s[0] * t.x[0] + s[1] * t.x[1] + s[2] * t.x[2];
}

/// The torque of the columns g in body axes, component a.
template <int W>
LIVENS_INLINE Lanes<W> moment(const Three<W>* d, const Three<W>* g, int a)
{
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    return dot(d[c], g[b]) - dot(d[b], g[c]);
}

/// Columns of h^-1 sum_B k_AB (X_B - X_0) m and of the loads: directors.
template <int W>
LIVENS_INLINE void form_columns(const Body& body, const double* dX, const double* loads, const Rule& rule,
                                Three<W>* g)
{
    Three<W> S[3];
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i) S[a].x[i] = times<W>(dX + (3 * a + i) * W, rule.k);
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i) {
            const double* e = body.euler + 3 * a;
            g[a].x[i] =
                body.principal ? e[a] * S[a].x[i] : e[0] * S[0].x[i] + e[1] * S[1].x[i] + e[2] * S[2].x[i];
            if (body.loaded) g[a].x[i] += load<W>(loads + (3 * a + i) * W);
        }
}

/// What each row has of the momentum at the start: directors.
template <int W>
LIVENS_INLINE void add_start(const Body& body, const double* rates, const Rule& rule, Three<W>* g)
{
    const Lanes<W> share = load<W>(rule.share);
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i) {
            const double* e = body.euler + 3 * a;
            g[a].x[i] += (e[0] * rates[i] + e[1] * rates[3 + i] + e[2] * rates[6 + i]) * share;
        }
}

template <int W>
LIVENS_INLINE void form_rows(const Pattern& p, const Values& start, const Values& v, const Rule& rule)
{
    const Lanes<W> weights = load<W>(rule.weights);
    const At<W, true> numbers{v.numbers, start.numbers};
    for (int b = 0; b < p.n_bodies; ++b) {
        const Body& body = p.bodies[b];
        const double *dX = v.increments + 12 * b * W, *loads = v.at_loads.F + 12 * b * W,
                     *momentum = rule.momentum + body.first;
        Lanes<W> y[6];
        for (int i = 0; i < 3; ++i) {
            y[i] = body.root_mass * times<W>(dX + i * W, rule.k) + body.weight[i] * weights;
            if (body.loaded) y[i] += body.inverse_root_mass * load<W>(loads + i * W);
            if (rule.share != nullptr)
                y[i] += body.root_mass * rule.start_rates[12 * b + i] * load<W>(rule.share);
        }
        if (body.dofs == 6) {
            Three<W> g[3], t;
            form_columns(body, dX + 3 * W, loads + 3 * W, rule, g);
            if (rule.share != nullptr) add_start(body, rule.start_rates + 12 * b + 3, rule, g);
            const Three<W> d[3] = {numbers.column(12 * b + 3), numbers.column(12 * b + 6),
                                   numbers.column(12 * b + 9)};
            for (int a = 0; a < 3; ++a) t.x[a] = moment(d, g, a);
            for (int a = 0; a < 3; ++a) y[3 + a] = scaled(body, t, a);
        }
        for (int i = 0; i < body.dofs; ++i) {
            double* row = v.rows + (body.first + i) * W;
            store(row, y[i]);
            row[0] += momentum[i];
        }
    }
}

/// The largest of n numbers by size; of what they are less themselves 0, or no number, is added to `finite`.
/// They stand one behind the other: fewer lanes than a register has are taken as more.
template <int W, bool asks_finite>
LIVENS_INLINE double size_of(const double* x, int n, double& finite)
{
    constexpr int B = W < LIVENS_REGISTER ? LIVENS_REGISTER : W;
    Lanes<B> most = all<B>(0), left = most;
    int i = 0;
    for (; i + B <= n; i += B) {
        const Lanes<B> part = load<B>(x + i);
        raise_to_size(most, part);
        if constexpr (asks_finite) left += part - part;
    }
    double size = largest(most);
    finite += sum(left);
    for (; B > W && i < n; ++i) {
        const double own = __builtin_fabs(x[i]);
        size = size < own ? own : size;
        finite += x[i] - x[i];
    }
    return size;
}

template <int W>
void balance(const Pattern& p, const Values& start, const Values& v, const Rule& rule, bool first,
             Sizes& sizes)
{
    const At<W, true> G{v.gradients, start.gradients}, factor{v.factor, start.factor};
    form_rows<W>(p, start, v, rule);
    sizes.finite = 0;
    sizes.terms = size_of<W, false>(v.rows, p.n_twists * W, sizes.finite);
    if (first)
        for (int r = 0; r < p.n_rows; ++r) store(v.impulses + r * W, all<W>(0));
    else
        take_off(p, G, v.impulses, v.rows);   // what is left is small where it counts
    multiply(p, G, v.rows, nullptr, v.work);
    solve(p, factor, v.work);
    take_off(p, G, v.work, v.rows);
    for (int r = 0; r < p.n_rows; ++r)
        store(v.impulses + r * W, load<W>(v.impulses + r * W) + load<W>(v.work + r * W));
    sizes.rows = size_of<W, true>(v.rows, p.n_twists * W, sizes.finite);
}

template <int W>
LIVENS_INLINE Lanes<W> cross(const Three<W>& a, const Three<W>& b, int i)
{
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    return a.x[j] * b.x[k] - a.x[k] * b.x[j];
}

template <int W, int B>
LIVENS_INLINE Three<B> three(const double* x)
{
    return {{load<B>(x), load<B>(x + W), load<B>(x + 2 * W)}};
}

/// One register: more would not stay in registers.
template <int W>
constexpr int one = W < LIVENS_REGISTER ? W : LIVENS_REGISTER;

/// y, three numbers W apart: from still axes into those of the body, or rows from these into still axes.
template <int W, bool are_rows, int B = one<W>>
LIVENS_INLINE void change_axes_here(const Body& body, const double* place, bool is_first, double* y)
{
    constexpr double at_start[4] = {};   // nothing is turned there
    const Three<B> q = three<W, B>(place + 4 * W), v = three<W, B>(y);
    Three<B> g, once;   // the tangent of half the turn, along its axis
    for (int i = 0; i < 3; ++i) {
        const double* s = body.still + i;
        if (body.principal)
            g.x[i] = (are_rows ? -s[3 * i] : s[3 * i]) * q.x[i];
        else
            g.x[i] = (are_rows ? -1.0 : 1.0) * (s[0] * q.x[0] + s[3] * q.x[1] + s[6] * q.x[2]);
        if (are_rows && is_first) g.x[i] = with_start(g.x[i], at_start);
    }
    const Lanes<B> twice = 2 / (1 + dot(g, g));
    for (int i = 0; i < 3; ++i) once.x[i] = v.x[i] + cross(g, v, i);
    for (int i = 0; i < 3; ++i) store(y + i * W, v.x[i] + twice * cross(g, once, i));
}

template <int W, bool are_rows>
__attribute__((noinline)) void change_axes_apart(const Body& body, const double* place, bool is_first,
                                                 double* y)
{
    change_axes_here<W, are_rows>(body, place, is_first, y);
}
template <int W, bool are_rows>
LIVENS_INLINE void change_axes(const Body& body, const double* place, bool is_first, double* y)
{
    if constexpr (W > 8)   // as for times(): in one place
        change_axes_apart<W, are_rows>(body, place, is_first, y);
    else
        change_axes_here<W, are_rows>(body, place, is_first, y);
}

/// - h sum_A (K^-1)_BA r_A, turns in still axes, where this is nearest to what inertia asks for. Leaves rows
/// in these axes.
template <int W>
LIVENS_INLINE void form_step(const Body& body, const double* place, const Rule& rule, double* rows,
                             double* step)
{
    const bool changes = body.dofs == 6 && rule.in_still_axes;
    for (int l = 0; changes && l < W; l += one<W>)
        change_axes<W, true>(body, place + l, l == 0, rows + 3 * W + l);
    for (int i = 0; i < body.dofs; ++i) store(step + i * W, times<W>(rows + i * W, rule.inverse));
    for (int l = 0; changes && l < W; l += one<W>)
        change_axes<W, false>(body, place + l, l == 0, step + 3 * W + l);
}

template <int W>
void propose(const Pattern& p, const Values& v, const Rule& rule)
{
    for (int b = 0; b < p.n_bodies; ++b) {
        const int first = p.bodies[b].first * W;
        form_step<W>(p.bodies[b], v.place + 7 * b * W, rule, v.rows + first, v.step + first);
    }
}

template <int W>
void project(const Pattern& p, const Values& v)
{
    const At<W, false> G{v.gradients, nullptr}, factor{v.factor, nullptr};
    multiply(p, G, v.step, v.violations, v.work);
    solve(p, factor, v.work);
    take_off(p, G, v.work, v.step);
}

template <int W>
void sum_impulses(const Pattern& p, const Values& start, const Values& v, double* out)
{
    const At<W, true> G{v.gradients, start.gradients}, numbers{v.numbers, start.numbers};
    for (int i = 0; i < p.n_twists; ++i) store(v.rows + i * W, all<W>(0));
    take_off(p, G, v.impulses, v.rows);
    for (int b = 0; b < p.n_bodies; ++b) {
        const Body& body = p.bodies[b];
        const double* y = v.rows + body.first * W;
        for (int i = 0; i < 3; ++i) out[6 * b + i] = body.root_mass * sum(load<W>(y + i * W));
        for (int i = 0; body.dofs == 6 && i < 3; ++i) {
            Lanes<W> torque = all<W>(0);
            for (int a = 0; a < 3; ++a) {   // L y_2 in body axes, turned
                const double* s = body.root_spin + a;
                torque += numbers[12 * b + 3 + 3 * a + i] *
                          (s[0] * load<W>(y + 3 * W) + s[3] * load<W>(y + 4 * W) + s[6] * load<W>(y + 5 * W));
            }
            out[6 * b + 3 + i] = sum(torque);
        }
    }
}

template <int W>
constexpr LoadFunctions loads_of{interpolate_arms<W>, run_loads<W>, share_out<W>, share_columns<W>};

template <int W>
constexpr Functions functions_of{
    W,          extrapolate<W>, configure<W>, unit_rows<W>,    factorise<W>, interpolate<W>, balance<W>,
    propose<W>, project<W>,     move<W>,      sum_impulses<W>, &loads_of<W>, &blocks_of};

/// For degrees up to 18, with as few lanes as registers have room for.
template <int W = LIVENS_REGISTER>
const Functions* functions_for(int n)
{
    if (n <= W) return &functions_of<W>;
        // Of registers of two every other width above eight: they are for old processors, and most of the
        // code.
#ifdef LIVENS_FEW_WIDTHS   // where size counts: (2,) 4, 8, 12, 20
    constexpr int step = W == 12 ? 8 : W >= 4 && LIVENS_REGISTER == 2 ? 4 : LIVENS_REGISTER;
#else
    constexpr int step = W >= 8 && LIVENS_REGISTER == 2 ? 4 : LIVENS_REGISTER;
#endif
    if constexpr (W < 18)
        return functions_for<W + step>(n);
    else
        return nullptr;
}

}   // namespace
}   // namespace livens::lanes
