// SPDX-License-Identifier: BSD-3-Clause
// Values, gradients, Hessians and time derivatives of constraint rows as quadratic forms with drives and
// functions of coordinates: theory.md, "Joints are quadratic forms", "Drives" and "Coordinates of joints".
// What a joint means is nowhere asked.
#include "livens/multibody/constraint.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "livens/base/error.h"

namespace livens {

namespace {

/// act(a, b, C_ab) of the entries that are not zero: forms know few columns.
template <typename Act>
void for_entries(const Matrix4& C, const Act& act)
{
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
            if (C(a, b) != 0) act(a, b, C(a, b));
}

/// Column b of `to` += factor times column a of X.
void add_column(double factor, const Matrix34& X, int a, Matrix34& to, int b)
{
    for (int i = 0; i < 3; ++i) to(i, b) += factor * X(i, a);
}

double product(const Matrix34& X, int a, const Matrix34& Y, int b)
{
    return X(0, a) * Y(0, b) + X(1, a) * Y(1, b) + X(2, a) * Y(2, b);
}

/// tr(X C Y^T)
double product(const Matrix34& X, const Matrix4& C, const Matrix34& Y)
{
    double sum = 0;
    for_entries(C, [&](int a, int b, double c) { sum += c * product(X, a, Y, b); });
    return sum;
}

}   // namespace

FormGradient form_gradient(const QuadraticForm& f, int i, int j, const Configurations& X)
{
    const Matrix34 X_j = X[j];
    FormGradient g{{}, f.b_j};
    for_entries(f.c_jj, [&](int a, int b, double c) { add_column(c, X_j, a, g.j, b); });
    // Terms of the world were folded into B_j and c when the row was made.
    if (i == world) return g;
    const Matrix34 X_i = X[i];
    g.i = f.b_i;
    for_entries(f.c_ii, [&](int a, int b, double c) { add_column(c, X_i, a, g.i, b); });
    for_entries(f.c_ij, [&](int a, int b, double c) {
        add_column(c, X_i, a, g.j, b);
        add_column(c, X_j, b, g.i, a);
    });
    return g;
}

namespace {

// Forms of the bodies i and j. Without body i, which is the world then, there are no terms in it.

/// <gradient, V>.
double form_rate(const QuadraticForm& f, int i, int j, const Configurations& X, const Configurations& V)
{
    const FormGradient g = form_gradient(f, i, j, X);
    return dot(g.j, V[j]) + (i == world ? 0 : dot(g.i, V[i]));
}

double form_curvature(const QuadraticForm& f, int i, int j, const Configurations& V)
{
    const Matrix34 V_j = V[j];
    const double curvature = product(V_j, f.c_jj, V_j);
    if (i == world) return curvature;
    const Matrix34 V_i = V[i];
    return curvature + product(V_i, f.c_ii, V_i) + 2 * product(V_i, f.c_ij, V_j);
}

/// 1/2 <gradient + gradient_from, step>, which is the form less its value at X_from: it is quadratic.
double form_change(const QuadraticForm& f, int i, int j, const Configurations& X_from,
                   const Configurations& X, const Configurations& step)
{
    return 0.5 * (form_rate(f, i, j, X_from, step) + form_rate(f, i, j, X, step));
}

/// act(q, body_i, body_j) of the coordinates of one function.
template <typename Act>
SmoothFunction::Point of_coordinates(const ConstraintRow& row, const SmoothFunction& F, std::size_t first,
                                     const Act& act)
{
    SmoothFunction::Point q{};
    for (std::size_t k = 0; k < F.n; ++k) {
        const PairForm& form = row.coordinates[first + k];
        q[k] = act(form, form.body_i, form.body_j);
    }
    return q;
}

bool touches(const PairForm& form, int body) { return form.body_i == body || form.body_j == body; }

void refuse_drives(const ConstraintRow& row)
{
    if (!row.drives.empty()) throw std::logic_error("a row with drives is asked without an instant");
}

}   // namespace

SmoothFunction::Point function_point(const ConstraintRow& row, const SmoothFunction& F, std::size_t first,
                                     const Configurations& X)
{
    return of_coordinates(row, F, first,
                          [&](const auto& form, int i, int j) { return form_value(form, i, j, X); });
}

double form_value(const QuadraticForm& f, int i, int j, const Configurations& X)
{
    const Matrix34 X_j = X[j];
    double phi = 0.5 * product(X_j, f.c_jj, X_j) + dot(f.b_j, X_j);
    if (i != world) {
        const Matrix34 X_i = X[i];
        phi += 0.5 * product(X_i, f.c_ii, X_i) + product(X_i, f.c_ij, X_j) + dot(f.b_i, X_i);
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

/// X tells rows that count turns up to a period, of which the value nearest to zero is the one (theory.md,
/// "Coordinates of joints", Angles).
double constraint_value(const ConstraintRow& row, Instant at, const Configurations& X)
{
    double phi = form_value(row, row.body_i, row.body_j, X);
    for (const Drive& drive : row.drives)
        phi += drive.factor(at).value * form_value(drive.form, row.body_i, row.body_j, X);
    for_each_function(row, [&](const SmoothFunction& F, std::size_t first) {
        phi += F.at(function_point(row, F, first, X)).value;
    });
    return row.period > 0 ? std::remainder(phi, row.period) : phi;
}

RowGradient constraint_gradient(const ConstraintRow& row, Instant at, const Configurations& X)
{
    RowGradient gradient(row);
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
    // Gradients are X K as rows of columns, so the block of d/dX_j of the gradient by X_i is the transpose.
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
    const auto by = [&](const PairForm& q, int wanted) {
        const FormGradient g = form_gradient(q, q.body_i, q.body_j, X);
        Matrix<12, 1> column{};
        std::copy_n(wanted == q.body_j ? g.j.a : g.i.a, 12, column.a);
        return column;
    };
    for_each_function(row, [&](const SmoothFunction& function, std::size_t first) {
        const PairForm* const q = row.coordinates.data() + first;
        const auto knows = [&](int wanted) {
            return std::any_of(q, q + function.n,
                               [&](const PairForm& form) { return touches(form, wanted); });
        };
        if (!knows(body) || !knows(other)) return;
        const SmoothFunction::Value F = function.at(function_point(row, function, first, X));
        for (std::size_t k = 0; k < function.n; ++k)
            for (std::size_t l = 0; l < function.n; ++l)
                if (F.hessian[k][l] != 0 && touches(q[k], body) && touches(q[l], other))
                    H += F.hessian[k][l] * outer(by(q[k], body), by(q[l], other));
    });
    return H;
}

/// Nothing is taken off by periods here: inside of elements rows are followed from node to node.
double constraint_change(const ConstraintRow& row, Instant from, const Configurations& X_from, Instant to,
                         const Configurations& X, const Configurations& step)
{
    const auto change_of = [&](const QuadraticForm& form, int i, int j) {
        return form_change(form, i, j, X_from, X, step);
    };
    double change = change_of(row, row.body_i, row.body_j);
    for (const Drive& drive : row.drives) {
        const double before = drive.factor(from).value, after = drive.factor(to).value;
        // The form moves with the factor as it is at the end; the factor changes with the form as it was at
        // the start. Both are differences, so small elements lose no digits (theory.md, "Drives").
        change += after * change_of(drive.form, row.body_i, row.body_j) +
                  (after - before) * form_value(drive.form, row.body_i, row.body_j, X_from);
    }
    for_each_function(row, [&](const SmoothFunction& F, std::size_t first) {
        change +=
            F.after(function_point(row, F, first, X_from), of_coordinates(row, F, first, change_of)).value;
    });
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
        // d2(f Phi)/dt2 = f Phi'' + 2 f' Phi' + f'' Phi; the part G X'' is not in here, it is the unknown
        // one.
        curvature += 2 * f.first * form_rate(drive.form, row.body_i, row.body_j, X, V) +
                     f.second * form_value(drive.form, row.body_i, row.body_j, X);
    }
    for_each_function(row, [&](const SmoothFunction& function, std::size_t first) {
        const SmoothFunction::Value F = function.at(function_point(row, function, first, X));
        const SmoothFunction::Point rates =
            of_coordinates(row, function, first,
                           [&](const auto& form, int i, int j) { return form_rate(form, i, j, X, V); });
        for (std::size_t k = 0; k < function.n; ++k)
            for (std::size_t l = 0; l < function.n; ++l) curvature += rates[k] * F.hessian[k][l] * rates[l];
    });
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

}   // namespace livens
