// SPDX-License-Identifier: BSD-3-Clause
// What a joint lets a body do, y = T y_parent + z theta: with G_c y_c + G_p y_p = 0 and G_c^T = Q R,
// T = - Q R^-T G_p, and z spans what is across Q; nodes side by side.
#pragma once

#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::lanes {
namespace {

/// Of registers that hold eight, half: blocks are small.
constexpr int part = LIVENS_REGISTER < 4 ? LIVENS_REGISTER : 4;

template <int W>
LIVENS_INLINE Lanes<W> load_anywhere(const double* x)
{
    Lanes<W> v;
    __builtin_memcpy(&v, x, sizeof v);
    return v;
}

template <int W>
LIVENS_INLINE void store_anywhere(double* x, const Lanes<W>& v)
{
    __builtin_memcpy(x, &v, sizeof v);
}

/// Of a twist, squared, across all before it: less is left to nodes one by one.
constexpr double least_of_twist = 0.02;

template <int W>
LIVENS_INLINE double least_of(const Lanes<W>& v)
{
    double x[W], least;
    store_anywhere<W>(x, v);
    least = x[0];
    for (int i = 1; i < W; ++i) least = x[i] < least ? x[i] : least;   // false: also no number
    return least;
}

/// At W nodes of those in `of`; see BlockFunctions::move_joint.
template <int W>
struct JointAtNodes {
    JointSize of;
    Lanes<W> q[36], R[36];

    /// The part of q_n across those before it; what is taken off goes to R. Its square before and size.
    LIVENS_INLINE void orthogonalise(int n, Lanes<W>& before, Lanes<W>& size)
    {
        Lanes<W>* v = q + n * of.d;
        before = size = all<W>(0);
        for (int i = 0; i < of.d; ++i) before += v[i] * v[i];
        for (int k = 0; k < n; ++k) R[6 * k + n] = all<W>(0);
        for (int twice = 0; twice < 2; ++twice)
            for (int k = 0; k < n; ++k) {
                Lanes<W> along = all<W>(0);
                for (int i = 0; i < of.d; ++i) along += q[k * of.d + i] * v[i];
                for (int i = 0; i < of.d; ++i) v[i] -= along * q[k * of.d + i];
                R[6 * k + n] += along;
            }
        for (int i = 0; i < of.d; ++i) size += v[i] * v[i];
        size = root(size);
    }
    LIVENS_INLINE void divide(int n, const Lanes<W>& by)
    {
        const Lanes<W> inverse = all<W>(1) / by;
        for (int i = 0; i < of.d; ++i) q[n * of.d + i] = inverse * q[n * of.d + i];
    }
    LIVENS_INLINE bool take_rows(const double* own, double least)
    {
        for (int r = 0; r < of.m; ++r) {
            for (int i = 0; i < of.d; ++i) q[r * of.d + i] = load_anywhere<W>(own + (r * of.d + i) * of.p);
            Lanes<W> before, size;
            orthogonalise(r, before, size);
            if (!(least_of<W>(size - least * root(before)) > 0)) return false;
            R[7 * r] = size;
            divide(r, size);
        }
        return true;
    }
    LIVENS_INLINE void find_T(const double* above, double* T)
    {
        for (int j = 0; j < of.n; ++j) {
            Lanes<W> x[6];
            for (int r = 0; r < of.m; ++r) {
                x[r] = load_anywhere<W>(above + (r * of.n + j) * of.p);
                for (int k = 0; k < r; ++k) x[r] -= R[6 * k + r] * x[k];
                x[r] = x[r] / R[7 * r];
            }
            for (int i = 0; i < of.d; ++i) {
                Lanes<W> sum = all<W>(0);
                for (int r = 0; r < of.m; ++r) sum -= q[r * of.d + i] * x[r];
                store_anywhere<W>(T + (i * of.n + j) * of.p, sum);
            }
        }
    }
    /// Unit vectors of which most is left at the node where least is.
    LIVENS_INLINE bool find_z(double* z)
    {
        Lanes<W> left[6];
        for (int e = 0; e < of.d; ++e) {
            left[e] = all<W>(1);
            for (int k = 0; k < of.m; ++k) left[e] -= q[k * of.d + e] * q[k * of.d + e];
        }
        const int f = of.d - of.m;
        for (int n = of.m; n < of.d; ++n) {
            int best = 0;
            double most = 0;
            for (int e = 0; e < of.d; ++e) {
                const double least = least_of<W>(left[e]);
                if (least > most) {
                    most = least;
                    best = e;
                }
            }
            if (!(most > least_of_twist)) return false;
            for (int i = 0; i < of.d; ++i) q[n * of.d + i] = all<W>(i == best ? 1 : 0);
            Lanes<W> before, size;
            orthogonalise(n, before, size);
            divide(n, size);
            for (int i = 0; i < of.d; ++i) {
                store_anywhere<W>(z + (i * f + n - of.m) * of.p, q[n * of.d + i]);
                left[i] -= q[n * of.d + i] * q[n * of.d + i];
            }
        }
        return true;
    }
};

/// The last of these lanes may go over some that others have had.
[[maybe_unused]] bool move_joint(const double* own, const double* above, const JointSize& of, double least,
                                 double* z, double* T)
{
    constexpr int W = part;
    if (of.p < W) return false;
    JointAtNodes<W> nodes;
    nodes.of = of;
    for (int A = 0; A < of.p; A += W) {
        const int first = A + W <= of.p ? A : of.p - W;
        if (!nodes.take_rows(own + first, least)) return false;
        nodes.find_T(above + first, T + first);
        if (!nodes.find_z(z + first)) return false;
    }
    return true;
}

}   // namespace
}   // namespace livens::lanes
