#include "livens/multibody/tables.h"

#include <algorithm>
#include <cmath>

#include "livens/multibody/twist.h"

namespace livens {

namespace {

/// The entries of K between two sides of a row.
void collect(const Matrix4& C, int from, int to, bool transposed,
             std::vector<Tables::RowTable::Entry>& form)
{
    for (int b = 0; b < 4; ++b) {
        for (int a = 0; a < 4; ++a) {
            if (C(a, b) == 0) continue;
            const int row = transposed ? b : a, column = transposed ? a : b;
            form.push_back({from, 3 * row, to, 3 * column, C(a, b)});
        }
    }
}

Tables::RowTable row_table(const ConstraintRow& row)
{
    Tables::RowTable table;
    table.row = &row;
    table.has_i = row.body_i != world;
    collect(row.c_jj, 1, 1, false, table.form);
    if (table.has_i) {
        collect(row.c_ii, 0, 0, false, table.form);
        collect(row.c_ij, 0, 1, false, table.form);
        collect(row.c_ij, 1, 0, true, table.form);
    }
    for (int side = 0; side < 2; ++side) {
        const double* b = side == 0 ? row.b_i.a : row.b_j.a;
        for (int a = 0; a < 12; a += 3) {
            bool touched = b[a] != 0 || b[a + 1] != 0 || b[a + 2] != 0;
            for (const auto& entry : table.form)
                touched = touched || (entry.to_side == side && entry.to == a);
            if (touched) table.columns[side].push_back(a);
        }
    }
    auto used = [](double x) { return x != 0; };
    table.has_b =
        std::any_of(row.b_i.a, row.b_i.a + 12, used) || std::any_of(row.b_j.a, row.b_j.a + 12, used);
    return table;
}

Matrix34 at(const double* X, int body)
{
    Matrix34 m{};
    std::copy(X + 12 * body, X + 12 * body + 12, m.a);
    return m;
}

/// The constants of the scaled twists. A singular inertia is enlarged for the coordinates alone: the
/// equations keep m.
bool scale_body(const Body& body, double length, Tables::BodyTable& table)
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

Tables::Tables(const Model& the_model, int the_rank) : model(&the_model), rank(the_rank)
{
    length = the_model.length();
    for (const Body& body : the_model.bodies()) {
        BodyTable table;
        table.first = n_twists;
        table.dofs = body.is_point ? 3 : 6;
        for (int to = 0; to < 4; ++to)
            for (int from = 0; from < 4; ++from)
                if (from != to && body.mass(from, to) != 0)
                    table.mass.push_back({from, to, body.mass(from, to)});
        for (int a = 0; a < 4; ++a) table.diagonal[a] = body.mass(a, a);
        const Matrix34 w = livens::weight(body, the_model.gravity());
        std::copy(w.a, w.a + 12, table.weight);
        regular = scale_body(body, length, table) && regular;
        bodies.push_back(table);
        n_twists += table.dofs;
    }
    for (int r = 0; r < the_model.n_rows(); ++r) rows.push_back(row_table(the_model.row(r)));
    for (int l = 0; l < static_cast<int>(the_model.loads().size()); ++l) {
        const Load& load = the_model.loads()[l];
        if (load.depends_on_X || load.depends_on_V) loads_with_tangent.push_back(l);
    }
}

void Tables::gradient(int r, const double* X, double* g) const
{
    const RowTable& t = rows[r];
    const double* sides[2] = {t.has_i ? X + 12 * t.row->body_i : X, X + 12 * t.row->body_j};
    for (int side = t.first_side(); side < 2; ++side) {
        const double* b = side == 0 ? t.row->b_i.a : t.row->b_j.a;
        for (const int a : t.columns[side])
            for (int i = a; i < a + 3; ++i) g[12 * side + i] = b[i];
    }
    for (const auto& entry : t.form) {
        const double* x = sides[entry.from_side] + entry.from;
        double* out = g + 12 * entry.to_side + entry.to;
        for (int i = 0; i < 3; ++i) out[i] += entry.value * x[i];
    }
}

void Tables::map_twists(const double* X, double* maps) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        if (bodies[b].dofs == 3) continue;
        const double* R = X + 12 * b + 3;
        const double *c = bodies[b].center, *l = bodies[b].spin;
        double* f = maps + 12 * b;
        if (bodies[b].principal)
            for (int a = 0; a < 3; ++a)
                for (int i = 0; i < 3; ++i) f[3 * a + i] = l[4 * a] * R[3 * a + i];
        else
            multiply(R, l, f);
        if (!bodies[b].offset) continue;   // the maps start as zero
        for (int i = 0; i < 3; ++i) f[9 + i] = R[i] * c[0] + R[3 + i] * c[1] + R[6 + i] * c[2];
    }
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

/// Rows about the reference point to rows about the centre of mass, of one body.
void centre(const double* f, double* q)
{
    const double* c = f + 9;
    q[3] -= c[1] * q[2] - c[2] * q[1];
    q[4] -= c[2] * q[0] - c[0] * q[2];
    q[5] -= c[0] * q[1] - c[1] * q[0];
}

void scale_row(const Tables::BodyTable& body, const double* f, const double* q, double* y)
{
    const double r = body.inverse_root_mass;
    for (int i = 0; i < 3; ++i) y[i] = r * q[i];
    if (body.dofs == 3) return;
    for (int i = 0; i < 3; ++i) y[3 + i] = f[3 * i] * q[3] + f[3 * i + 1] * q[4] + f[3 * i + 2] * q[5];
}

}   // namespace

void Tables::to_scaled_rows(const double* maps, const double* q, double* y) const
{
    for (int b = 0; b < n_bodies(); ++b)
        scale_row(bodies[b], maps + 12 * b, q + bodies[b].first, y + bodies[b].first);
}

/// The rows of twist::rows, of the columns that are touched.
void Tables::wrench(int r, int side, const double* X, const double* maps, const double* g,
                       double* q) const
{
    const RowTable& t = rows[r];
    const int body = t.body(side);
    const double *x = X + 12 * body, *load = g + 12 * side;
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
    if (bodies[body].offset) centre(maps + 12 * body, q);
}

void Tables::scaled_gradient(int r, const double* X, const double* maps, const double* g,
                                double* out) const
{
    std::fill(out, out + n_twists, 0.0);
    for (int side = rows[r].first_side(); side < 2; ++side) {
        const int body = rows[r].body(side);
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

double Tables::value(int r, const double* X, const double* g) const
{
    const RowTable& t = rows[r];
    double sum = 0;
    for (int side = t.first_side(); side < 2; ++side) {
        const double* x = X + 12 * t.body(side);
        const double* b = side == 0 ? t.row->b_i.a : t.row->b_j.a;
        for (const int a : t.columns[side])
            for (int i = a; i < a + 3; ++i) sum += (g[12 * side + i] + b[i]) * x[i];
    }
    return 0.5 * sum + t.row->c;
}

double Tables::value(int r, const double* X) const
{
    double g[24];
    gradient(r, X, g);
    return value(r, X, g);
}

double Tables::curvature(int r, const double* V) const
{
    const RowTable& t = rows[r];
    double sum = 0;
    for (const auto& entry : t.form) {
        const double* from = V + 12 * t.body(entry.from_side) + entry.from;
        const double* to = V + 12 * t.body(entry.to_side) + entry.to;
        sum += entry.value * (from[0] * to[0] + from[1] * to[1] + from[2] * to[2]);
    }
    return sum;
}

void Tables::add_weight(double factor, double* raw) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        // without an offset the weight has no part on the directors
        const int n = bodies[b].offset ? 12 : 3;
        for (int i = 0; i < n; ++i) raw[12 * b + i] += factor * bodies[b].weight[i];
    }
}

void Tables::add_loads(Instant instant, const double* X, const double* V, double factor, double* raw) const
{
    for (const Load& load : model->loads()) {
        LoadArguments arguments;
        arguments.at = instant;
        for (int side = 0; side < 2; ++side) {
            const int body = load.bodies[side];
            if (body == world) continue;
            arguments.X[side] = at(X, body);
            arguments.V[side] = at(V, body);
        }
        LoadForces forces{};
        load.forces(arguments, forces);
        for (int side = 0; side < 2; ++side) {
            if (load.bodies[side] == world) continue;
            double* f = raw + 12 * load.bodies[side];
            for (int i = 0; i < 12; ++i) f[i] += factor * forces[side].a[i];
        }
    }
}

void Tables::twist_rows(const double* X, const double* maps, const double* raw, double* q) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        double* o = q + bodies[b].first;
        if (bodies[b].dofs == 6) {
            twist::rows(X + 12 * b, raw + 12 * b, o);
            if (bodies[b].offset) centre(maps + 12 * b, o);
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

void Tables::times_mass(const double* __restrict Y, double factor, double* __restrict out) const
{
    for (const BodyTable& body : bodies) {
        for (int a = 0; a < 4; ++a) {
            const double s = factor * body.diagonal[a];
            out[3 * a] = s * Y[3 * a];
            out[3 * a + 1] = s * Y[3 * a + 1];
            out[3 * a + 2] = s * Y[3 * a + 2];
        }
        for (const auto& entry : body.mass) {
            const double s = factor * entry.value;
            for (int i = 0; i < 3; ++i) out[3 * entry.to + i] += s * Y[3 * entry.from + i];
        }
        Y += 12;
        out += 12;
    }
}

}   // namespace livens
