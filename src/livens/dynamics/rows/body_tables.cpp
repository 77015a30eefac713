// SPDX-License-Identifier: BSD-3-Clause
// Scaled twists, with shortcuts that most bodies allow: principal axes, and a reference point at the centre
// of mass.
#include "livens/dynamics/rows/body_tables.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/model.h"

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

/// The constants of the scaled twists. A singular inertia is enlarged for the coordinates alone: the
/// equations keep m.
/// A pivot below 1e-7 tr J becomes 1e-3 tr J, or that of the mass at a thousandth of the model's length if
/// that is more.
bool scale_body(const Body& body, double length, BodyTable& table)
{
    const MassProperties p = mass_properties(body.mass);
    table.inverse_root_mass = 1 / std::sqrt(p.mass);
    if (body.is_point) return true;
    const Vector3 c = p.center_of_mass;
    std::copy(c.a, c.a + 3, table.center);
    table.offset = dot(c, c) > 0;
    table.reach = std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]);
    Matrix3 J = p.inertia;
    const Matrix3 E = 0.5 * trace(J) * identity<3>() - J;
    std::copy(E.a, E.a + 9, table.euler);
    bool regular = true;
    Matrix3 L{};
    const double floor = 1e-7 * trace(J);
    for (int j = 0; j < 3; ++j) {
        double d = J(j, j);
        for (int k = 0; k < j; ++k) d -= L(j, k) * L(j, k);
        if (!(d > floor)) {
            regular = false;
            d = std::max(1e-3 * trace(J), 1e-6 * p.mass * length * length);
        }
        L(j, j) = std::sqrt(d);
        for (int i = j + 1; i < 3; ++i) {
            double s = J(i, j);
            for (int k = 0; k < j; ++k) s -= L(i, k) * L(j, k);
            L(i, j) = s / L(j, j);
        }
    }
    const Matrix3 spin = transpose(inverse(L));
    std::copy(spin.a, spin.a + 9, table.spin);
    table.root_inertia = std::max({L(0, 0), L(1, 1), L(2, 2)});
    table.principal = true;
    for (int i = 0; i < 9; ++i)
        table.principal = table.principal && (i % 4 == 0 || (spin.a[i] == 0 && E.a[i] == 0));
    return regular;
}

}   // namespace

BodyTables::BodyTables(const Model& model) : n_(model.n_bodies())
{
    int n_twists = 0;
    for (const Body& body : model.bodies()) {
        BodyTable table;
        table.first = n_twists;
        table.dofs = body.is_point ? 3 : 6;
        for (int to = 0; to < 4; ++to)
            for (int from = 0; from < 4; ++from)
                if (from != to && body.mass(from, to) != 0)
                    table.mass.others.push_back({from, to, body.mass(from, to)});
        for (int a = 0; a < 4; ++a) table.mass.diagonal[a] = body.mass(a, a);
        const Matrix34 w = livens::weight(body, model.gravity());
        std::copy(w.a, w.a + 12, table.weight);
        are_regular_ = scale_body(body, model.length(), table) && are_regular_;
        tables_.push_back(table);
        n_twists += table.dofs;
    }
}

void BodyTables::add_weight(double factor, double* raw) const
{
    for (int b = 0; b < n_; ++b) {
        for (int i = 0; i < 3; ++i) raw[12 * b + i] += factor * tables_[b].weight[i];
        // without an offset the weight has no part on the directors
        for (int i = 3; tables_[b].offset && i < 12; ++i) raw[12 * b + i] += factor * tables_[b].weight[i];
    }
}

/// m acts between columns of Y, so that the 12 x 12 matrix m (x) 1 is never formed.
void MassTable::times(const double* __restrict Y, double factor, double* __restrict out) const
{
    for (int a = 0; a < 4; ++a) {
        const double s = factor * diagonal[a];
        out[3 * a] = s * Y[3 * a];
        out[3 * a + 1] = s * Y[3 * a + 1];
        out[3 * a + 2] = s * Y[3 * a + 2];
    }
    for (const Entry& entry : others) {
        const double s = factor * entry.value;
        for (int i = 0; i < 3; ++i) out[3 * entry.to + i] += s * Y[3 * entry.from + i];
    }
}

void BodyTables::times_mass(const double* Y, double factor, double* out) const
{
    for (int b = 0; b < n_; ++b) tables_[b].mass.times(Y + 12 * b, factor, out + 12 * b);
}

/// In principal axes L is diagonal, and K = R L^-T has the columns of R, scaled.
void BodyTables::map_twist(int b, const double* X, double* f) const
{
    if (tables_[b].dofs == 3) return;
    const double* R = X + 12 * b + 3;
    const double *c = tables_[b].center, *l = tables_[b].spin;
    if (tables_[b].principal)
        for (int a = 0; a < 3; ++a)
            for (int i = 0; i < 3; ++i) f[3 * a + i] = l[4 * a] * R[3 * a + i];
    else
        multiply(R, l, f);
    if (!tables_[b].offset) return;   // the maps start as zero
    for (int i = 0; i < 3; ++i) f[9 + i] = R[i] * c[0] + R[3 + i] * c[1] + R[6 + i] * c[2];
}

void BodyTables::map_twists(const double* X, double* maps) const
{
    for (int b = 0; b < n_; ++b) map_twist(b, X, maps + 12 * b);
}

void BodyTables::to_twist(const double* maps, const double* y, double* xi) const
{
    for (int b = 0; b < n_; ++b) {
        const BodyTable& body = tables_[b];
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

void BodyTables::to_scaled_rows(const double* maps, const double* q, double* y) const
{
    for (int b = 0; b < n_; ++b)
        scale_row(tables_[b], maps + 12 * b, q + tables_[b].first, y + tables_[b].first);
}

void BodyTables::scaled_row(int body, const double* X, const double* map, const double* g, double* y) const
{
    double q[6];
    twist::rows(X, g, q);
    if (tables_[body].offset) to_centre(map, q);
    std::fill_n(y, 6, 0.0);
    scale_row(tables_[body], map, q, y);
}

/// With Q = R_A^T R_B it is L^-1 Q (tr(E Q) 1 - E Q) L^-T.
void BodyTables::spin_mass(int body, const double* X_A, const double* X_B, double* H) const
{
    const BodyTable& b = tables_[body];
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

void BodyTables::twist_rows(const double* X, const double* maps, const double* raw, double* q) const
{
    for (int b = 0; b < n_; ++b) {
        double* o = q + tables_[b].first;
        if (tables_[b].dofs == 6) {
            twist::rows(X + 12 * b, raw + 12 * b, o);
            if (tables_[b].offset) to_centre(maps + 12 * b, o);
        } else {
            std::copy(raw + 12 * b, raw + 12 * b + 3, o);
        }
    }
}

void BodyTables::rates_of(const double* X, const double* xi, double* dX) const
{
    for (int b = 0; b < n_; ++b) {
        const double* w = xi + tables_[b].first;
        if (tables_[b].dofs == 6) {
            twist::columns(X + 12 * b, w, dX + 12 * b);
        } else {
            std::fill(dX + 12 * b, dX + 12 * b + 12, 0.0);
            std::copy(w, w + 3, dX + 12 * b);
        }
    }
}

}   // namespace livens
