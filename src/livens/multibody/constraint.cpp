#include "livens/multibody/constraint.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "livens/base/error.h"

namespace livens {

namespace {

/// A row without terms, on two bodies that differ.
ConstraintRow empty_row(int body_i, int body_j, double scale, const char* label)
{
    if (body_i == body_j)
        throw InputError({"joint-self", "", "a constraint row needs two different bodies",
                          std::to_string(body_i), "", "",
                          "a point or an axis of the world belongs to body -1"});
    ConstraintRow row;
    row.body_i = body_i;
    row.body_j = body_j;
    row.scale = scale;
    row.label = label;
    return row;
}

/// The same function of the same bodies, stored so that body_j is a body and the world's terms are in B_j, c.
ConstraintRow with_world_folded(ConstraintRow row)
{
    if (row.body_j == world) {
        std::swap(row.body_i, row.body_j);
        std::swap(row.c_ii, row.c_jj);
        std::swap(row.b_i, row.b_j);
        row.c_ij = transpose(row.c_ij);
    }
    if (row.body_i != world) return row;
    const Matrix34& X_world = world_configuration;
    row.b_j += X_world * row.c_ij;
    row.c += 0.5 * dot(X_world * row.c_ii, X_world) + dot(row.b_i, X_world);
    row.c_ii = {};
    row.c_ij = {};
    row.b_i = {};
    return row;
}

// Forms. Without body i there are no terms in it, and X_i is not looked at.

double form_value(const QuadraticForm& f, bool has_i, const Matrix34& X_i, const Matrix34& X_j)
{
    double phi = 0.5 * dot(X_j * f.c_jj, X_j) + dot(f.b_j, X_j);
    if (has_i) phi += dot(0.5 * (X_i * f.c_ii) + X_j * transpose(f.c_ij) + f.b_i, X_i);
    return phi + f.c;
}

void form_gradient(const QuadraticForm& f, bool has_i, const Matrix34& X_i, const Matrix34& X_j,
                   Matrix34& g_i, Matrix34& g_j)
{
    g_j = X_j * f.c_jj + f.b_j;
    g_i = {};
    if (!has_i) return;
    g_j += X_i * f.c_ij;
    g_i = X_i * f.c_ii + X_j * transpose(f.c_ij) + f.b_i;
}

double form_curvature(const QuadraticForm& f, bool has_i, const Matrix34& V_i, const Matrix34& V_j)
{
    double curvature = dot(V_j * f.c_jj, V_j);
    if (has_i) curvature += dot(V_i * f.c_ii, V_i) + 2 * dot(V_i * f.c_ij, V_j);
    return curvature;
}

bool has_i(const ConstraintRow& row) { return row.body_i != world; }

void refuse_drives(const ConstraintRow& row)
{
    if (!row.drives.empty()) throw std::logic_error("a row with drives is asked without an instant");
}

}   // namespace

double constraint_value(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j)
{
    double phi = form_value(row, has_i(row), X_i, X_j);
    for (const Drive& drive : row.drives)
        phi += drive.factor(at).value * form_value(drive.form, has_i(row), X_i, X_j);
    return phi;
}

void constraint_gradient(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j,
                         Matrix34& g_i, Matrix34& g_j)
{
    form_gradient(row, has_i(row), X_i, X_j, g_i, g_j);
    add_drive_gradient(row, at, X_i, X_j, g_i, g_j);
}

void add_drive_gradient(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j,
                        Matrix34& g_i, Matrix34& g_j)
{
    for (const Drive& drive : row.drives) {
        Matrix34 d_i{}, d_j{};
        form_gradient(drive.form, has_i(row), X_i, X_j, d_i, d_j);
        const double f = drive.factor(at).value;
        g_i += f * d_i;
        g_j += f * d_j;
    }
}

double constraint_change(const ConstraintRow& row, Instant from, Instant to, const Matrix34& X_i,
                         const Matrix34& X_j)
{
    double change = 0;
    for (const Drive& drive : row.drives)
        change += (drive.factor(to).value - drive.factor(from).value) *
                  form_value(drive.form, has_i(row), X_i, X_j);
    return change;
}

double constraint_rate(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j)
{
    double rate = 0;
    for (const Drive& drive : row.drives)
        rate += drive.factor(at).first * form_value(drive.form, has_i(row), X_i, X_j);
    return rate;
}

double constraint_curvature(const ConstraintRow& row, Instant at, const std::array<Matrix34, 2>& X,
                            const std::array<Matrix34, 2>& V)
{
    double curvature = form_curvature(row, has_i(row), V[0], V[1]);
    for (const Drive& drive : row.drives) {
        const TimeValue f = drive.factor(at);
        Matrix34 g_i{}, g_j{};
        form_gradient(drive.form, has_i(row), X[0], X[1], g_i, g_j);
        curvature += f.value * form_curvature(drive.form, has_i(row), V[0], V[1]) +
                     2 * f.first * (dot(g_i, V[0]) + dot(g_j, V[1])) +
                     f.second * form_value(drive.form, has_i(row), X[0], X[1]);
    }
    return curvature;
}

ConstraintRow frozen(const ConstraintRow& row, Instant at)
{
    ConstraintRow now = row;
    now.drives.clear();
    for (const Drive& drive : row.drives) {
        const double f = drive.factor(at).value;
        now.c_ii += f * drive.form.c_ii;
        now.c_ij += f * drive.form.c_ij;
        now.c_jj += f * drive.form.c_jj;
        now.b_i += f * drive.form.b_i;
        now.b_j += f * drive.form.b_j;
        now.c += f * drive.form.c;
    }
    return now;
}

double constraint_value(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j)
{
    refuse_drives(row);
    return form_value(row, has_i(row), X_i, X_j);
}

void constraint_gradient(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j, Matrix34& g_i,
                         Matrix34& g_j)
{
    refuse_drives(row);
    form_gradient(row, has_i(row), X_i, X_j, g_i, g_j);
}

double constraint_curvature(const ConstraintRow& row, const Matrix34& V_i, const Matrix34& V_j)
{
    refuse_drives(row);
    return form_curvature(row, has_i(row), V_i, V_j);
}

ConstraintRow inner_product_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double value,
                                double scale)
{
    ConstraintRow row = empty_row(body_i, body_j, scale, "axis");
    row.c_ij = outer(a, b);
    row.c = -value;
    return with_world_folded(row);
}

std::vector<ConstraintRow> coincidence_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                            double scale)
{
    static constexpr const char* labels[3] = {"x", "y", "z"};
    std::vector<ConstraintRow> rows;
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        ConstraintRow row = empty_row(body_i, body_j, scale, labels[k]);
        row.b_i = -outer(e, a);
        row.b_j = outer(e, b);
        rows.push_back(with_world_folded(row));
    }
    return rows;
}

ConstraintRow distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double length)
{
    ConstraintRow row = empty_row(body_i, body_j, length * length, "distance");
    row.c_ii = outer(a, a);
    row.c_ij = -outer(a, b);
    row.c_jj = outer(b, b);
    row.c = -0.5 * length * length;
    return with_world_folded(row);
}

ConstraintRow plane_row(int body_i, const Vector4& n, const Vector4& a, int body_j, const Vector4& b,
                        double distance, double scale)
{
    ConstraintRow row = empty_row(body_i, body_j, scale, "plane");
    row.c_ii = -(outer(n, a) + outer(a, n));
    row.c_ij = outer(n, b);
    row.c = -distance;
    return with_world_folded(row);
}

namespace {

/// y and its two derivatives by t, from f(t) and dy/df, d2y/df2.
TimeValue chain(const TimeValue& f, double y, double by_f, double by_ff)
{
    return {y, by_f * f.first, by_ff * f.first * f.first + by_f * f.second};
}

/// outer(f) of a function of time; `outer` takes its TimeValue.
template <typename Outer>
TimeFunction composed(const TimeFunction& inner, Outer outer)
{
    return {[inner, outer](Instant at) { return outer(inner(at)); }, inner.breaks()};
}

TimeValue cosine(const TimeValue& angle)
{
    const double c = std::cos(angle.value), s = std::sin(angle.value);
    return chain(angle, c, -s, -c);
}

TimeValue sine(const TimeValue& angle)
{
    const double c = std::cos(angle.value), s = std::sin(angle.value);
    return chain(angle, s, c, -s);
}

}   // namespace

std::vector<ConstraintRow> driven_point_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                             const std::array<TimeFunction, 3>& path, double scale)
{
    static constexpr const char* labels[3] = {"driven x", "driven y", "driven z"};
    std::vector<ConstraintRow> rows;
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        ConstraintRow row = plane_row(body_i, direction(e), a, body_j, b, 0, scale);
        row.label = labels[k];
        QuadraticForm one;
        one.c = -1;
        row.drives.push_back({path[static_cast<std::size_t>(k)], one});
        rows.push_back(std::move(row));
    }
    return rows;
}

ConstraintRow driven_distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                  const TimeFunction& length, double typical)
{
    ConstraintRow row = distance_row(body_i, a, body_j, b, typical);
    row.label = "driven distance";
    row.c += 0.5 * typical * typical;
    QuadraticForm one;
    one.c = -0.5;
    const auto square = [](const TimeValue& l) { return chain(l, l.value * l.value, 2 * l.value, 2); };
    row.drives.push_back({composed(length, square), one});
    return row;
}

ConstraintRow driven_angle_row(int body_i, const Vector4& a, int body_j, const Vector4& b1, const Vector4& b2,
                               const TimeFunction& angle)
{
    ConstraintRow row = inner_product_row(body_i, a, body_j, Vector4{}, 0, 1);
    row.label = "driven angle";
    row.drives.push_back({composed(angle, cosine), inner_product_row(body_i, a, body_j, b2, 0, 1)});
    row.drives.push_back({composed(angle, sine), inner_product_row(body_i, a, body_j, -b1, 0, 1)});
    return row;
}

ConstraintRow driven_angle_branch(int body_i, const Vector4& a, int body_j, const Vector4& b1,
                                  const Vector4& b2, const TimeFunction& angle)
{
    ConstraintRow row = inner_product_row(body_i, a, body_j, Vector4{}, 0, 1);
    row.label = "driven angle";
    row.drives.push_back({composed(angle, cosine), inner_product_row(body_i, a, body_j, b1, 0, 1)});
    row.drives.push_back({composed(angle, sine), inner_product_row(body_i, a, body_j, b2, 0, 1)});
    return row;
}

std::vector<ConstraintRow> rigidity_rows(int body)
{
    struct Pair {
        int a, b;
        const char* label;
    };
    static constexpr Pair pairs[6] = {{1, 1, "rigidity 11"}, {2, 2, "rigidity 22"}, {3, 3, "rigidity 33"},
                                      {1, 2, "rigidity 12"}, {1, 3, "rigidity 13"}, {2, 3, "rigidity 23"}};
    std::vector<ConstraintRow> rows;
    for (const Pair& pair : pairs) {
        ConstraintRow row = empty_row(world, body, 1, pair.label);
        row.c_jj(pair.a, pair.b) += 0.5;
        row.c_jj(pair.b, pair.a) += 0.5;
        row.c = pair.a == pair.b ? -0.5 : 0.0;
        rows.push_back(row);
    }
    return rows;
}

}   // namespace livens
