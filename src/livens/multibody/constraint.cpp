#include "livens/multibody/constraint.h"

#include <algorithm>
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

// Forms of the bodies i and j. Without body i, which is the world then, there are no terms in it.

struct FormGradient {
    Matrix34 i{}, j{};
};

FormGradient form_gradient(const QuadraticForm& f, int i, int j, const Configurations& X)
{
    const Matrix34 X_j = X[j];
    FormGradient g{{}, X_j * f.c_jj + f.b_j};
    if (i == world) return g;
    const Matrix34 X_i = X[i];
    g.j += X_i * f.c_ij;
    g.i = X_i * f.c_ii + X_j * transpose(f.c_ij) + f.b_i;
    return g;
}

/// <gradient, V>.
double form_rate(const QuadraticForm& f, int i, int j, const Configurations& X, const Configurations& V)
{
    const FormGradient g = form_gradient(f, i, j, X);
    return dot(g.j, V[j]) + (i == world ? 0 : dot(g.i, V[i]));
}

double form_curvature(const QuadraticForm& f, int i, int j, const Configurations& V)
{
    const Matrix34 V_j = V[j];
    double curvature = dot(V_j * f.c_jj, V_j);
    if (i == world) return curvature;
    const Matrix34 V_i = V[i];
    return curvature + dot(V_i * f.c_ii, V_i) + 2 * dot(V_i * f.c_ij, V_j);
}

/// 1/2 <gradient + gradient_from, step>, which is the form less its value at X_from: it is quadratic.
double form_change(const QuadraticForm& f, int i, int j, const Configurations& X_from,
                   const Configurations& X, const Configurations& step)
{
    return 0.5 * (form_rate(f, i, j, X_from, step) + form_rate(f, i, j, X, step));
}

/// act(q_k, body_i, body_j, k) of all coordinates.
template <typename Act>
SmoothFunction::Point of_coordinates(const ConstraintRow& row, const Act& act)
{
    SmoothFunction::Point q{};
    for (std::size_t k = 0; k < row.coordinates.size(); ++k)
        q[k] = act(row.coordinates[k], row.coordinates[k].body_i, row.coordinates[k].body_j);
    return q;
}

SmoothFunction::Point coordinates(const ConstraintRow& row, const Configurations& X)
{
    return of_coordinates(row, [&](const auto& form, int i, int j) { return form_value(form, i, j, X); });
}

void refuse_drives(const ConstraintRow& row)
{
    if (!row.drives.empty()) throw std::logic_error("a row with drives is asked without an instant");
}

}   // namespace

double form_value(const QuadraticForm& f, int i, int j, const Configurations& X)
{
    const Matrix34 X_j = X[j];
    double phi = 0.5 * dot(X_j * f.c_jj, X_j) + dot(f.b_j, X_j);
    if (i != world) {
        const Matrix34 X_i = X[i];
        phi += dot(0.5 * (X_i * f.c_ii) + X_j * transpose(f.c_ij) + f.b_i, X_i);
    }
    return phi + f.c;
}

RowBodies row_bodies(const ConstraintRow& row)
{
    RowBodies found;
    const auto add = [&](int body) {
        if (body == world || found.find(body) < found.size) return;
        if (found.size == RowBodies::most)
            throw InputError({"joint-row", "", "a constraint row touches too many bodies", "",
                              "at most " + std::to_string(RowBodies::most), "", ""});
        found.bodies[static_cast<std::size_t>(found.size++)] = body;
    };
    add(row.body_i);
    add(row.body_j);
    for (const PairForm& q : row.coordinates) {
        add(q.body_i);
        add(q.body_j);
    }
    return found;
}

double constraint_value(const ConstraintRow& row, Instant at, const Configurations& X)
{
    double phi = form_value(row, row.body_i, row.body_j, X);
    for (const Drive& drive : row.drives)
        phi += drive.factor(at).value * form_value(drive.form, row.body_i, row.body_j, X);
    if (row.function) phi += row.function->at(coordinates(row, X)).value;
    return phi;
}

RowGradient constraint_gradient(const ConstraintRow& row, Instant at, const Configurations& X)
{
    RowGradient gradient{row_bodies(row)};
    for_each_form(row, at, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        const FormGradient g = form_gradient(form, i, j, X);
        gradient.by[gradient.bodies.find(j)] += weight * g.j;
        if (i != world) gradient.by[gradient.bodies.find(i)] += weight * g.i;
    });
    return gradient;
}

namespace {

/// K of a form as d2 form / dX dX of two bodies, entry by entry of X.
void add_form_hessian(const QuadraticForm& f, int i, int j, double weight, int body, int other,
                      Matrix<12, 12>& H)
{
    Matrix4 K{};
    if (body == i && other == i && i != world) K += f.c_ii;
    if (body == i && other == j) K += transpose(f.c_ij);
    if (body == j && other == i) K += f.c_ij;
    if (body == j && other == j) K += f.c_jj;
    for (int to = 0; to < 4; ++to)
        for (int from = 0; from < 4; ++from)
            for (int d = 0; d < 3; ++d) H(3 * to + d, 3 * from + d) += weight * K(from, to);
}

}   // namespace

Matrix<12, 12> constraint_hessian(const ConstraintRow& row, Instant at, const Configurations& X, int body,
                                  int other)
{
    Matrix<12, 12> H{};
    for_each_form(row, at, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        add_form_hessian(form, i, j, weight, body, other, H);
    });
    if (!row.function) return H;
    const auto by = [&](const PairForm& q, int wanted) {
        const FormGradient g = form_gradient(q, q.body_i, q.body_j, X);
        Matrix<12, 1> column{};
        const Matrix34 of = wanted == q.body_j ? g.j : wanted == q.body_i ? g.i : Matrix34{};
        std::copy_n(of.a, 12, column.a);
        return column;
    };
    const SmoothFunction::Value F = row.function->at(coordinates(row, X));
    for (std::size_t k = 0; k < row.coordinates.size(); ++k)
        for (std::size_t l = 0; l < row.coordinates.size(); ++l)
            if (F.hessian[k][l] != 0)
                H += F.hessian[k][l] * outer(by(row.coordinates[k], body), by(row.coordinates[l], other));
    return H;
}

double constraint_change(const ConstraintRow& row, Instant from, const Configurations& X_from, Instant to,
                         const Configurations& X, const Configurations& step)
{
    const auto change_of = [&](const QuadraticForm& form, int i, int j) {
        return form_change(form, i, j, X_from, X, step);
    };
    double change = change_of(row, row.body_i, row.body_j);
    for (const Drive& drive : row.drives) {
        const double before = drive.factor(from).value, after = drive.factor(to).value;
        change += after * change_of(drive.form, row.body_i, row.body_j) +
                  (after - before) * form_value(drive.form, row.body_i, row.body_j, X_from);
    }
    if (row.function)
        change += row.function->change(coordinates(row, X_from), of_coordinates(row, change_of));
    return change;
}

double constraint_rate(const ConstraintRow& row, Instant at, const Configurations& X)
{
    double rate = 0;
    for (const Drive& drive : row.drives)
        rate += drive.factor(at).first * form_value(drive.form, row.body_i, row.body_j, X);
    return rate;
}

double constraint_curvature(const ConstraintRow& row, Instant at, const Configurations& X,
                            const Configurations& V)
{
    double curvature = 0;
    for_each_form(row, at, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        curvature += weight * form_curvature(form, i, j, V);
    });
    for (const Drive& drive : row.drives) {
        const TimeValue f = drive.factor(at);
        curvature += 2 * f.first * form_rate(drive.form, row.body_i, row.body_j, X, V) +
                     f.second * form_value(drive.form, row.body_i, row.body_j, X);
    }
    if (!row.function) return curvature;
    const SmoothFunction::Value F = row.function->at(coordinates(row, X));
    const auto rates =
        of_coordinates(row, [&](const auto& form, int i, int j) { return form_rate(form, i, j, X, V); });
    for (std::size_t k = 0; k < rates.size(); ++k)
        for (std::size_t l = 0; l < rates.size(); ++l) curvature += rates[k] * F.hessian[k][l] * rates[l];
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

double constraint_value(const ConstraintRow& row, const Configurations& X)
{
    refuse_drives(row);
    return constraint_value(row, {}, X);
}

RowGradient constraint_gradient(const ConstraintRow& row, const Configurations& X)
{
    refuse_drives(row);
    return constraint_gradient(row, {}, X);
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
