// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/rows/tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens {

namespace {

/// Whether the gradient of a form by X_i, or X_j, may have a column other than zero.
bool touches(const QuadraticForm& form, bool is_i, int column)
{
    bool touched = norm((is_i ? form.b_i : form.b_j).column(column)) > 0;
    for (int k = 0; k < 4; ++k) {
        const double cross = is_i ? form.c_ij(column, k) : form.c_ij(k, column);
        touched = touched || cross != 0 || (is_i ? form.c_ii : form.c_jj)(k, column) != 0;
    }
    return touched;
}

void find_columns(const RowBodies& bodies, Tables::RowTable& table)
{
    std::array<std::array<bool, 4>, RowBodies::most> touched{};
    const auto look = [&](const QuadraticForm& form, int i, int j) {
        for (int column = 0; column < 4; ++column) {
            if (i != world && touches(form, true, column)) touched[bodies.find(i)][column] = true;
            if (touches(form, false, column)) touched[bodies.find(j)][column] = true;
        }
    };
    const ConstraintRow& row = *table.row;
    look(row, row.body_i, row.body_j);
    for (const Drive& drive : row.drives) look(drive.form, row.body_i, row.body_j);
    for (const PairForm& q : row.coordinates) look(q, q.body_i, q.body_j);
    for (int side = 0; side < bodies.size; ++side)
        for (int column = 0; column < 4; ++column)
            if (touched[side][column]) table.columns[side].push_back(3 * column);
}

Tables::RowTable row_table(const ConstraintRow& row)
{
    Tables::RowTable table;
    table.row = &row;
    const RowBodies bodies = row_bodies(row);
    table.n_sides = bodies.size;
    std::copy(bodies.begin(), bodies.end(), table.bodies);
    find_columns(bodies, table);
    table.is_quadratic = row.is_quadratic();
    if (!table.is_quadratic) return table;
    const int last = table.n_sides - 1;   // body_j; body_i is side 0 unless it is the world
    if (last == 1) {
        table.K[0][0] = row.c_ii;
        table.K[0][1] = row.c_ij;
        table.K[1][0] = transpose(row.c_ij);
        table.B[0] = row.b_i;
    }
    table.K[last][last] = row.c_jj;
    table.B[last] = row.b_j;
    for (int from = 0; from < table.n_sides; ++from)
        for (int to = 0; to < table.n_sides; ++to)
            for (int b = 0; b < 4; ++b)
                for (int a = 0; a < 4; ++a)
                    if (table.K[from][to](a, b) != 0)
                        table.form.push_back({from, 3 * a, to, 3 * b, table.K[from][to](a, b)});
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

}   // namespace

Tables::Tables(const Model& the_model, std::vector<int> rows_to_solve, bool with_rigidity,
               std::shared_ptr<KnownPattern> known)
    : model(&the_model), turns(the_model), independent(std::move(rows_to_solve)),
      rank(static_cast<int>(independent.size())),
      known_pattern(known != nullptr ? std::move(known) : std::make_shared<KnownPattern>()),
      n_bodies_(the_model.n_bodies())
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
    for (int b = 0; with_rigidity && b < n_bodies(); ++b) {
        if (bodies[b].dofs == 3) continue;
        rigidity.reserve(6 * bodies.size());   // rows point into it
        for (const ConstraintRow& row : rigidity_rows(b)) {
            rigidity.push_back(row);
            rows.push_back(row_table(rigidity.back()));
        }
    }
    for (int l = 0; l < static_cast<int>(the_model.loads().size()); ++l) {
        const Load& load = the_model.loads()[l];
        if (load.depends_on_X || load.depends_on_V) loads_with_tangent.push_back(l);
    }
}

void Tables::gradient(int r, Instant at, const double* X, double* g) const
{
    const RowTable& t = rows[r];
    if (!t.is_quadratic) {
        const RowGradient gradient = constraint_gradient(*t.row, at, Configurations(X));
        for (int side = 0; side < t.n_sides; ++side) std::copy_n(gradient.by[side].a, 12, g + 12 * side);
        return;
    }
    for (int side = 0; side < t.n_sides; ++side)
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i) g[12 * side + a + i] = t.B[side].a[a + i];
    for (const auto& entry : t.form) {
        const double* x = X + 12 * t.bodies[entry.from_side] + entry.from;
        double* out = g + 12 * entry.to_side + entry.to;
        for (int i = 0; i < 3; ++i) out[i] += entry.value * x[i];
    }
}

/// A quadratic polynomial has Phi(X) - Phi(X_0) = 1/2 <grad Phi(X_0) + grad Phi(X), X - X_0>, which does not
/// lose the digits of a small increment.
double Tables::change(int r, const double* g_from, const double* g_to, const double* step) const
{
    const RowTable& t = rows[r];
    double sum = 0;
    for (int side = 0; side < t.n_sides; ++side) {
        const double* d = step + 12 * t.bodies[side];
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i)
                sum += (g_from[12 * side + a + i] + g_to[12 * side + a + i]) * d[a + i];
    }
    return 0.5 * sum;
}

double Tables::rate(int r, Instant at, const double* X) const
{
    return rows[r].is_quadratic ? 0 : constraint_rate(*rows[r].row, at, Configurations(X));
}

double Tables::value(int r, Instant at, const double* X, const double* g) const
{
    const RowTable& t = rows[r];
    if (!t.is_quadratic) return constraint_value(*t.row, at, Configurations(X));
    double sum = 0;
    for (int side = 0; side < t.n_sides; ++side) {
        const double* x = X + 12 * t.bodies[side];
        for (const int a : t.columns[side])
            for (int i = 0; i < 3; ++i) sum += (g[12 * side + a + i] + t.B[side].a[a + i]) * x[a + i];
    }
    return 0.5 * sum + t.row->c;
}

double Tables::value(int r, Instant at, const double* X) const
{
    double g[gradient_size];
    gradient(r, at, X, g);
    return value(r, at, X, g);
}

double Tables::curvature(int r, Instant at, const double* X, const double* V) const
{
    const RowTable& t = rows[r];
    if (!t.is_quadratic) return constraint_curvature(*t.row, at, Configurations(X), Configurations(V));
    double sum = 0;
    for (const auto& entry : t.form) {
        const double* from = V + 12 * t.bodies[entry.from_side] + entry.from;
        const double* to = V + 12 * t.bodies[entry.to_side] + entry.to;
        sum += entry.value * (from[0] * to[0] + from[1] * to[1] + from[2] * to[2]);
    }
    return sum;
}

void Tables::add_weight(double factor, double* raw) const
{
    for (int b = 0; b < n_bodies(); ++b) {
        for (int i = 0; i < 3; ++i) raw[12 * b + i] += factor * bodies[b].weight[i];
        // without an offset the weight has no part on the directors
        for (int i = 3; bodies[b].offset && i < 12; ++i) raw[12 * b + i] += factor * bodies[b].weight[i];
    }
}

LoadArguments Tables::arguments(int index, Instant instant, const double* X, const double* V,
                                std::span<const double> angles) const
{
    const Load& load = model->loads()[index];
    LoadArguments arguments(load.bodies.size());
    arguments.at = instant;
    arguments.angles = turns.of(index, angles);
    for (std::size_t side = 0; side < load.bodies.size(); ++side) {
        const int body = load.bodies[side];
        if (body == world) continue;
        arguments.X[side] = at(X, body);
        arguments.V[side] = at(V, body);
    }
    return arguments;
}

void Tables::add_loads(Instant instant, const double* X, const double* V, double factor, double* raw,
                       std::span<const double> angles) const
{
    for (std::size_t l = 0; l < model->loads().size(); ++l) {
        const Load& load = model->loads()[l];
        LoadForces forces{};
        load.forces(arguments(static_cast<int>(l), instant, X, V, angles), forces);
        for (int side = 0; side < 2; ++side) {
            if (load.bodies[side] == world) continue;
            double* f = raw + 12 * load.bodies[side];
            for (int i = 0; i < 12; ++i) f[i] += factor * forces[side].a[i];
        }
    }
}

int Tables::bad_load(Instant instant, const double* X, const double* V, std::span<const double> angles) const
{
    for (std::size_t l = 0; l < model->loads().size(); ++l) {
        const Load& load = model->loads()[l];
        LoadForces forces{};
        load.forces(arguments(static_cast<int>(l), instant, X, V, angles), forces);
        double sum = 0;
        for (const Matrix34& F : forces)
            for (const double f : F.a) sum += std::abs(f);
        if (!std::isfinite(sum)) return static_cast<int>(l);
    }
    return -1;
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
