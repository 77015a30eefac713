// SPDX-License-Identifier: BSD-3-Clause
// Places of bodies at all nodes, in lanes: guessed, moved, and the numbers that follow from them.
#pragma once

#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::lanes {
namespace {

/// Lanes that are gone through at a time where none knows of others: more would only be more instructions in
/// memory.
template <int W>
constexpr int batch = W <= 8 ? W : LIVENS_REGISTER;

/// Numbers of a body, W apart, from its place.
template <int W, int B = batch<W>>
LIVENS_INLINE void place_body(bool is_point, const double* place, const double* X0, double* dX, double* X)
{
    for (int i = 0; i < 3; ++i) {
        const Lanes<B> u = load<B>(place + i * W);
        store(dX + i * W, u);
        store(X + i * W, X0[i] + u);
    }
    if (is_point) return;
    const auto s = load<B>(place + 3 * W), x = load<B>(place + 4 * W), y = load<B>(place + 5 * W),
               z = load<B>(place + 6 * W);
    // the turn less 1, its diagonal without cancellation
    const auto xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z, sx = s * x, sy = s * y,
               sz = s * z;
    const Lanes<B> t[9] = {-2 * (yy + zz), 2 * (xy + sz), 2 * (xz - sy), 2 * (xy - sz), -2 * (xx + zz),
                           2 * (yz + sx),  2 * (xz + sy), 2 * (yz - sx), -2 * (xx + yy)};
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i) {
            const Lanes<B> d = X0[3 + i] * t[3 * a] + X0[6 + i] * t[3 * a + 1] + X0[9 + i] * t[3 * a + 2];
            store(dX + (3 + 3 * a + i) * W, d);
            store(X + (3 + 3 * a + i) * W, X0[3 + 3 * a + i] + d);
        }
}

template <int W>
void place_numbers(const Pattern& p, const Values& start, const Values& v)
{
    for (int b = 0; b < p.n_bodies; ++b)
        for (int l = 0; l < W; l += batch<W>)
            place_body<W>(p.bodies[b].dofs == 3, v.place + 7 * b * W + l, start.numbers + 12 * b,
                          v.increments + 12 * b * W + l, v.numbers + 12 * b * W + l);
}

/// One body's place on, turned back by its end: numbers W apart.
template <int W, int B = batch<W>>
LIVENS_INLINE void extrapolate_body(const double* before, const double* weights, double* place)
{
    Lanes<B> sums[7];
    for (int c = 0; c < 7; ++c) {
        sums[c] = before[c * W] * load<B>(weights);
        for (int l = 1; l < W; ++l) sums[c] += before[c * W + l] * load<B>(weights + l * W);
    }
    for (int i = 0; i < 3; ++i) store(place + i * W, -before[i * W] + sums[i]);
    // where nothing is turned
    const Lanes<B> qs = load<B>(weights + W * W) + sums[3], qx = sums[4], qy = sums[5], qz = sums[6];
    const double s = before[3 * W], x = before[4 * W], y = before[5 * W], z = before[6 * W];
    const Lanes<B> size = 1 / root(qs * qs + qx * qx + qy * qy + qz * qz);
    store(place + 3 * W, size * (s * qs + x * qx + y * qy + z * qz));
    store(place + 4 * W, size * (s * qx - x * qs - (y * qz - z * qy)));
    store(place + 5 * W, size * (s * qy - y * qs - (z * qx - x * qz)));
    store(place + 6 * W, size * (s * qz - z * qs - (x * qy - y * qx)));
}

template <int W>
void extrapolate(int n_bodies, int n, const double* before, const double* weights, double* place)
{
    for (int b = 0; b < n_bodies; ++b, before += 7 * W, place += 7 * W) {
        for (int l = 0; l < W; l += batch<W>) extrapolate_body<W>(before, weights + l, place + l);
        for (int l = n; l < W; ++l)
            for (int i = 0; i < 7; ++i) place[i * W + l] = i == 3 ? 1 : 0;
    }
}

/// Turns a body by a small rotation vector in its own axes, whose half is t; numbers W apart.
template <int W, int B>
LIVENS_INLINE void turn(double* place, const Three<B>& t)
{
    const auto s = load<B>(place), x = load<B>(place + W), y = load<B>(place + 2 * W),
               z = load<B>(place + 3 * W);
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

/// How far bodies move and have moved.
template <int B>
struct Extent {
    Lanes<B> far = all<B>(0), wide = far, moved = far, turned = far, finite = far;
};

template <int W, int B = batch<W>>
LIVENS_INLINE void move_body(const Body& body, const double* y, double* place, Extent<B>& extent)
{
    for (int i = 0; i < 3; ++i) {
        const Lanes<B> u = body.inverse_root_mass * load<B>(y + i * W),
                       all_of_it = load<B>(place + i * W) + u;
        raise_to_size(extent.far, u);
        raise_to_size(extent.moved, all_of_it);
        extent.finite += u - u;
        store(place + i * W, all_of_it);
    }
    if (body.dofs == 3) return;
    Three<B> t;
    for (int i = 0; i < 3; ++i) {
        const double* s = body.spin + i;   // w = L^-T y_2
        Lanes<B> w = s[3 * i] * load<B>(y + (3 + i) * W);
        if (!body.principal)
            w = s[0] * load<B>(y + 3 * W) + s[3] * load<B>(y + 4 * W) + s[6] * load<B>(y + 5 * W);
        raise_to_size(extent.wide, w);
        extent.finite += w - w;
        t.x[i] = 0.5 * w;
    }
    turn<W, B>(place + 3 * W, t);
    for (int i = 4; i < 7; ++i) raise_to_size(extent.turned, load<B>(place + i * W));
}

template <int W>
void move(const Pattern& p, const Values& v, const Rule& rule, Sizes& sizes)
{
    Extent<batch<W>> extent;
    for (int b = 0; b < p.n_bodies; ++b)
        for (int l = 0; l < W; l += batch<W>)
            move_body<W>(p.bodies[b], v.step + p.bodies[b].first * W + l, v.place + 7 * b * W + l, extent);
    const double a = largest(extent.far) / rule.length, c = largest(extent.wide),
                 d = largest(extent.moved) / rule.length, e = 2 * largest(extent.turned);
    sizes.step = a < c ? c : a;
    sizes.motion = d < e ? e : d;
    sizes.finite = sum(extent.finite);
}

}   // namespace
}   // namespace livens::lanes
