// SPDX-License-Identifier: BSD-3-Clause
// What the tables say in twists, plain and mass-orthonormal.
#include <algorithm>

#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"

namespace livens {

namespace {

/// out <- l r for 3 x 3 matrices, column by column.
void multiply(const double* l, const double* r, double* out)
{
    for (int j = 0; j < 9; j += 3)
        for (int i = 0; i < 3; ++i) out[j + i] = l[i] * r[j] + l[3 + i] * r[j + 1] + l[6 + i] * r[j + 2];
}

/// out <- l^T r.
void multiply_transposed(const double* l, const double* r, double* out)
{
    for (int j = 0; j < 9; j += 3)
        for (int i = 0; i < 3; ++i)
            out[j + i] = l[3 * i] * r[j] + l[3 * i + 1] * r[j + 1] + l[3 * i + 2] * r[j + 2];
}

}   // namespace

inline void Tables::map_twist(int b, const double* X, double* f) const
{
    if (bodies[b].dofs == 3) return;
    const double* R = X + 12 * b + 3;
    const double *c = bodies[b].center, *l = bodies[b].spin;
    if (bodies[b].principal)
        for (int a = 0; a < 3; ++a)
            for (int i = 0; i < 3; ++i) f[3 * a + i] = l[4 * a] * R[3 * a + i];
    else
        multiply(R, l, f);
    if (!bodies[b].offset) return;   // the maps start as zero
    for (int i = 0; i < 3; ++i) f[9 + i] = R[i] * c[0] + R[3 + i] * c[1] + R[6 + i] * c[2];
}

void Tables::map_twists(const double* X, double* maps) const
{
    for (int b = 0; b < n_bodies(); ++b) map_twist(b, X, maps + 12 * b);
}

void Tables::to_twist(const double* maps, const double* y, double* xi) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        const BodyTable& body = bodies[b];
        const double* f = maps + 12 * b;
        const double* in = y + body.first;
        double* out = xi + body.first;
        const double r = body.inverse_root_mass;
        if (body.dofs == 3) {
            for (int i = 0; i < 3; ++i) out[i] = r * in[i];
            continue;
        }
        const double y0 = in[3], y1 = in[4], y2 = in[5];
        const double* c = f + 9;
        double w[3];
        for (int i = 0; i < 3; ++i) w[i] = f[i] * y0 + f[3 + i] * y1 + f[6 + i] * y2;
        out[0] = r * in[0] + (c[1] * w[2] - c[2] * w[1]);
        out[1] = r * in[1] + (c[2] * w[0] - c[0] * w[2]);
        out[2] = r * in[2] + (c[0] * w[1] - c[1] * w[0]);
        for (int i = 0; i < 3; ++i) out[3 + i] = w[i];
    }
}

namespace {

void scale_row(const Tables::BodyTable& body, const double* f, const double* q, double* y)
{
    const double r = body.inverse_root_mass;
    for (int i = 0; i < 3; ++i) y[i] = r * q[i];
    if (body.dofs == 3) return;
    for (int i = 0; i < 3; ++i) y[3 + i] = f[3 * i] * q[3] + f[3 * i + 1] * q[4] + f[3 * i + 2] * q[5];
}

}   // namespace

void Tables::to_centre(const double* f, double* q)
{
    const double* c = f + 9;
    q[3] -= c[1] * q[2] - c[2] * q[1];
    q[4] -= c[2] * q[0] - c[0] * q[2];
    q[5] -= c[0] * q[1] - c[1] * q[0];
}

void Tables::to_scaled_rows(const double* maps, const double* q, double* y) const
{
    for (int b = 0; b < n_bodies(); ++b)
        scale_row(bodies[b], maps + 12 * b, q + bodies[b].first, y + bodies[b].first);
}

/// The rows of twist::rows, of the columns that are touched: about the reference point.
inline void Tables::plain_wrench(int r, int side, const double* X, const double* g, double* q) const
{
    const RowTable& t = rows[r];
    const double *x = X + 12 * t.bodies[side], *load = g + 12 * side;
    std::fill(q, q + 6, 0.0);
    for (const int a : t.columns[side]) {
        if (a == 0) {
            for (int i = 0; i < 3; ++i) q[i] = load[i];
            continue;
        }
        q[3] += x[a + 1] * load[a + 2] - x[a + 2] * load[a + 1];
        q[4] += x[a + 2] * load[a] - x[a] * load[a + 2];
        q[5] += x[a] * load[a + 1] - x[a + 1] * load[a];
    }
}

void Tables::wrench(int r, int side, const double* X, const double* maps, const double* g, double* q) const
{
    const int body = rows[r].bodies[side];
    plain_wrench(r, side, X, g, q);
    if (bodies[body].offset) to_centre(maps + 12 * body, q);
}

void Tables::scaled_wrench(int r, int side, const double* X, const double* g, double* y) const
{
    const int body = rows[r].bodies[side];
    double map[12] = {}, q[6];
    map_twist(body, X, map);
    plain_wrench(r, side, X, g, q);
    if (bodies[body].offset) to_centre(map, q);
    std::fill(y, y + 6, 0.0);
    scale_row(bodies[body], map, q, y);
}

void Tables::add_wrenches(int r, const double* X, const double* maps, const double* g, double factor,
                          double* q) const
{
    for (int side = 0; side < rows[r].n_sides; ++side) {
        const BodyTable& body = bodies[rows[r].bodies[side]];
        double of_side[6];
        wrench(r, side, X, maps, g, of_side);
        for (int i = 0; i < body.dofs; ++i) q[body.first + i] += factor * of_side[i];
    }
}

void Tables::scaled_gradient(int r, const double* X, const double* maps, const double* g, double* out) const
{
    std::fill(out, out + n_twists, 0.0);
    for (int side = 0; side < rows[r].n_sides; ++side) {
        const int body = rows[r].bodies[side];
        double q[6];
        wrench(r, side, X, maps, g, q);
        scale_row(bodies[body], maps + 12 * body, q, out + bodies[body].first);
    }
}

/// With Q = R_A^T R_B it is L^-1 Q (tr(E Q) 1 - E Q) L^-T.
void Tables::spin_mass(int body, const double* X_A, const double* X_B, double* H) const
{
    const BodyTable& b = bodies[body];
    double Q[9], EQ[9], T[9];
    multiply_transposed(X_A + 12 * body + 3, X_B + 12 * body + 3, Q);
    if (b.principal) {
        const double *e = b.euler, *l = b.spin;
        const double t = e[0] * Q[0] + e[4] * Q[4] + e[8] * Q[8];
        for (int j = 0; j < 3; ++j) {
            for (int i = 0; i < 3; ++i) EQ[3 * j + i] = -e[4 * i] * Q[3 * j + i];
            EQ[4 * j] += t;
        }
        multiply(Q, EQ, T);
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) H[3 * j + i] = l[4 * i] * T[3 * j + i] * l[4 * j];
        return;
    }
    multiply(b.euler, Q, EQ);
    const double tr = EQ[0] + EQ[4] + EQ[8];
    for (int i = 0; i < 9; ++i) EQ[i] = (i % 4 == 0 ? tr : 0.0) - EQ[i];
    multiply(Q, EQ, T);
    multiply(T, b.spin, EQ);
    multiply_transposed(b.spin, EQ, H);
}

void Tables::twist_rows(const double* X, const double* maps, const double* raw, double* q) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        double* o = q + bodies[b].first;
        if (bodies[b].dofs == 6) {
            twist::rows(X + 12 * b, raw + 12 * b, o);
            if (bodies[b].offset) to_centre(maps + 12 * b, o);
        } else {
            std::copy(raw + 12 * b, raw + 12 * b + 3, o);
        }
    }
}

void Tables::rates_of(const double* X, const double* xi, double* dX) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        const double* w = xi + bodies[b].first;
        if (bodies[b].dofs == 6) {
            twist::columns(X + 12 * b, w, dX + 12 * b);
        } else {
            std::fill(dX + 12 * b, dX + 12 * b + 12, 0.0);
            std::copy(w, w + 3, dX + 12 * b);
        }
    }
}

}   // namespace livens
