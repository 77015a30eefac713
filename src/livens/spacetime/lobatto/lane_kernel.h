// SPDX-License-Identifier: BSD-3-Clause
// The functions of kernel_functions.h, for whatever instructions a source that includes this is compiled
// with.
#pragma once

#include "livens/multibody/lane_rows.h"
#include "livens/spacetime/lobatto/kernel_functions.h"

namespace livens::lanes {
namespace {

template <int W>
void place_numbers(const Pattern& p, const Values& start, const Values& v)
{
    for (int b = 0; b < p.n_bodies; ++b) {
        const double *place = v.place + 7 * b * W, *X0 = start.numbers + 12 * b;
        double *dX = v.increments + 12 * b * W, *X = v.numbers + 12 * b * W;
        for (int i = 0; i < 3; ++i) {
            const Lanes<W> u = load<W>(place + i * W);
            store(dX + i * W, u);
            store(X + i * W, X0[i] + u);
        }
        if (p.bodies[b].dofs == 3) continue;
        const auto s = load<W>(place + 3 * W), x = load<W>(place + 4 * W), y = load<W>(place + 5 * W),
                   z = load<W>(place + 6 * W);
        // the turn less 1, its diagonal without cancellation
        const auto xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z, sx = s * x,
                   sy = s * y, sz = s * z;
        const Lanes<W> t[9] = {-2 * (yy + zz), 2 * (xy + sz), 2 * (xz - sy), 2 * (xy - sz), -2 * (xx + zz),
                               2 * (yz + sx),  2 * (xz + sy), 2 * (yz - sx), -2 * (xx + yy)};
        for (int a = 0; a < 3; ++a)
            for (int i = 0; i < 3; ++i) {
                const Lanes<W> d = X0[3 + i] * t[3 * a] + X0[6 + i] * t[3 * a + 1] + X0[9 + i] * t[3 * a + 2];
                store(dX + (3 + 3 * a + i) * W, d);
                store(X + (3 + 3 * a + i) * W, X0[3 + 3 * a + i] + d);
            }
    }
}

template <int W>
void configure(const Pattern& p, const Values& start, const Values& v)
{
    place_numbers<W>(p, start, v);
    form_products<W>(p, start, v, true);
    form_gradients<W>(p, v);
    form_violations<W>(p, start.violations, v.increments, v.violations);
    factorise<W>(p, v);
}

template <int W>
void interpolate(const Pattern& p, const Values& start, const Values& v, const Rule& rule)
{
    for (int b = 0; b < p.n_bodies; ++b)
        for (int i = 12 * b; p.bodies[b].loaded && i < 12 * b + (p.bodies[b].dofs == 6 ? 12 : 3); ++i) {
            store(v.load_X + i * W, start.numbers[i] + times<W>(v.increments + i * W, rule.M));
            store(v.load_V + i * W, times<W>(v.increments + i * W, rule.dM));
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
            if (body.loaded) g[a].x[i] += times<W>(loads + (3 * a + i) * W, rule.M_rows);
        }
}

template <int W>
void form_rows(const Pattern& p, const Values& start, const Values& v, const Rule& rule)
{
    const Lanes<W> weights = load<W>(rule.weights);
    const At<W, true> numbers{v.numbers, start.numbers};
    for (int b = 0; b < p.n_bodies; ++b) {
        const Body& body = p.bodies[b];
        const double *dX = v.increments + 12 * b * W, *loads = v.loads + 12 * b * W,
                     *momentum = rule.momentum + body.first;
        Lanes<W> y[6];
        for (int i = 0; i < 3; ++i) {
            y[i] = body.root_mass * times<W>(dX + i * W, rule.k) + body.weight[i] * weights;
            if (body.loaded) y[i] += body.inverse_root_mass * times<W>(loads + i * W, rule.M_rows);
        }
        if (body.dofs == 6) {
            Three<W> g[3], t;
            form_columns(body, dX + 3 * W, loads + 3 * W, rule, g);
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

template <int W>
void balance(const Pattern& p, const Values& start, const Values& v, const Rule& rule, bool first,
             Sizes& sizes)
{
    const At<W, true> G{v.gradients, start.gradients}, factor{v.factor, start.factor};
    form_rows<W>(p, start, v, rule);
    Lanes<W> size = all<W>(0), finite = size;
    for (int i = 0; i < p.n_twists; ++i) raise_to_size(size, load<W>(v.rows + i * W));
    sizes.terms = largest(size);
    if (first)
        for (int r = 0; r < p.n_rows; ++r) store(v.impulses + r * W, all<W>(0));
    else
        take_off(p, G, v.impulses, v.rows);   // what is left is small where it counts
    multiply(p, G, v.rows, nullptr, v.work);
    solve(p, factor, v.work);
    take_off(p, G, v.work, v.rows);
    for (int r = 0; r < p.n_rows; ++r)
        store(v.impulses + r * W, load<W>(v.impulses + r * W) + load<W>(v.work + r * W));
    size = all<W>(0);
    for (int i = 0; i < p.n_twists; ++i) {
        const Lanes<W> y = load<W>(v.rows + i * W);
        raise_to_size(size, y);
        finite += y - y;
    }
    sizes.rows = largest(size);
    sizes.finite = sum(finite);
}

/// Turns a body by a small rotation vector in its own axes, whose half is t.
template <int W>
LIVENS_INLINE void turn(double* place, const Three<W>& t)
{
    const auto s = load<W>(place), x = load<W>(place + W), y = load<W>(place + 2 * W),
               z = load<W>(place + 3 * W);
    const auto ns = s - (x * t.x[0] + y * t.x[1] + z * t.x[2]),
               nx = x + (s * t.x[0] + (y * t.x[2] - z * t.x[1])),
               ny = y + (s * t.x[1] + (z * t.x[0] - x * t.x[2])),
               nz = z + (s * t.x[2] + (x * t.x[1] - y * t.x[0]));
    const auto inverse = 1 / root(ns * ns + nx * nx + ny * ny + nz * nz);
    store(place, ns * inverse);
    store(place + W, nx * inverse);
    store(place + 2 * W, ny * inverse);
    store(place + 3 * W, nz * inverse);
}

template <int W>
void move(const Pattern& p, const Values& v, const Rule& rule, Sizes& sizes)
{
    Lanes<W> far = all<W>(0), wide = far, moved = far, turned = far, finite = far;
    for (int b = 0; b < p.n_bodies; ++b) {
        const Body& body = p.bodies[b];
        const double* y = v.step + body.first * W;
        double* place = v.place + 7 * b * W;
        for (int i = 0; i < 3; ++i) {
            const Lanes<W> u = body.inverse_root_mass * load<W>(y + i * W),
                           all_of_it = load<W>(place + i * W) + u;
            raise_to_size(far, u);
            raise_to_size(moved, all_of_it);
            finite += u - u;
            store(place + i * W, all_of_it);
        }
        if (body.dofs == 3) continue;
        Three<W> t;
        for (int i = 0; i < 3; ++i) {
            const double* s = body.spin + i;   // w = L^-T y_2
            Lanes<W> w = s[3 * i] * load<W>(y + (3 + i) * W);
            if (!body.principal)
                w = s[0] * load<W>(y + 3 * W) + s[3] * load<W>(y + 4 * W) + s[6] * load<W>(y + 5 * W);
            raise_to_size(wide, w);
            finite += w - w;
            t.x[i] = 0.5 * w;
        }
        turn(place + 3 * W, t);
        for (int i = 4; i < 7; ++i) raise_to_size(turned, load<W>(place + i * W));
    }
    const double a = largest(far) / rule.length, c = largest(wide), d = largest(moved) / rule.length,
                 e = 2 * largest(turned);
    sizes.step = a < c ? c : a;
    sizes.motion = d < e ? e : d;
    sizes.finite = sum(finite);
}

template <int W>
void propose(const Pattern& p, const Values& v, const Rule& rule)
{
    const At<W, false> G{v.gradients, nullptr}, factor{v.factor, nullptr};
    for (int i = 0; i < p.n_twists; ++i) store(v.step + i * W, times<W>(v.rows + i * W, rule.inverse));
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
constexpr Functions functions_of{W,          configure<W>, interpolate<W>, balance<W>,
                                 propose<W>, move<W>,      sum_impulses<W>};

/// For degrees up to 18, with as few lanes as registers have room for.
template <int W = LIVENS_REGISTER>
const Functions* functions_for(int n)
{
    if (n <= W) return &functions_of<W>;
    if constexpr (W < 18)
        return functions_for<W + LIVENS_REGISTER>(n);
    else
        return nullptr;
}

}   // namespace
}   // namespace livens::lanes
