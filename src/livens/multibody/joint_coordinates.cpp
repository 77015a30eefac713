// SPDX-License-Identifier: BSD-3-Clause
// Angles and displacements as coordinates of joints. theory.md, "Coordinates of joints", has the derivatives
// and how turns are counted.
#include "livens/multibody/joint_coordinates.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/rotation_vector.h"

namespace livens {

namespace {

using Point = SmoothFunction::Point;
using Value = SmoothFunction::Value;

double form_at(const PairForm& form, const Configurations& X)
{
    return form_value(form, form.body_i, form.body_j, X);
}

Point point_of(const JointCoordinate& q, const Configurations& X)
{
    Point at{};
    for (std::size_t k = 0; k < q.forms.size(); ++k) at[k] = form_at(q.forms[k], X);
    return at;
}

double rate_of(const PairForm& form, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    ConstraintRow row;
    static_cast<PairForm&>(row) = form;
    const RowGradient gradient = constraint_gradient(row, X);
    double rate = 0;
    for (int side = 0; side < gradient.bodies.size; ++side)
        rate += dot(gradient.by[side], V[gradient.bodies.bodies[side]]);
    return rate;
}

Value angle_at(double factor, double c, double s)
{
    const double square = c * c + s * s, quartic = square * square;
    Value angle;
    angle.value = factor * arc_tangent(s, c);
    // Of atan2(s, c) off the unit circle as well: between the nodes of an element s^2 + c^2 is not one.
    angle.gradient[0] = factor * (-s / square);
    angle.gradient[1] = factor * (c / square);
    angle.hessian[0][0] = factor * (2 * c * s / quartic);
    angle.hessian[0][1] = angle.hessian[1][0] = factor * ((s * s - c * c) / quartic);
    angle.hessian[1][1] = factor * (-2 * c * s / quartic);
    return angle;
}

Value displacement_at(double factor, double q)
{
    Value value;
    value.value = factor * q;
    value.gradient[0] = factor;
    return value;
}

/// 1 - s^2 as a product, which keeps its digits near +-1.
Value arc_sine_at(double s)
{
    const double square = (1 - s) * (1 + s), c = std::sqrt(square);
    Value angle;
    angle.value = arc_sine(s);
    angle.gradient[0] = 1 / c;
    angle.hessian[0][0] = s / (square * c);
    return angle;
}

Value rotation_component_at(const Point& q)
{
    const Turn turn = turn_of(q.data());
    Value r;
    r.value = turn.r[0].value;
    for (std::size_t i = 0; i < 4; ++i) {
        r.gradient[i] = turn.J[0][i].value;
        for (std::size_t j = 0; j < 4; ++j) r.hessian[i][j] = turn.J[0][i].by[j];
    }
    return r;
}

/// atan2(S, c) with S = |s|; nothing has a direction where s is zero, and its derivatives are taken as zero.
Value rotation_angle_at(const Point& q)
{
    const double S = hypotenuse(q[0], q[1], q[2]), c = q[3], square = S * S + c * c,
                 quartic = square * square;
    Value angle;
    angle.value = arc_tangent(S, c);
    angle.gradient[3] = -S / square;
    angle.hessian[3][3] = 2 * c * S / quartic;
    if (S == 0) return angle;
    const double by_S = c / square, by_S_S = -2 * c * S / quartic, by_S_c = (S * S - c * c) / quartic;
    for (std::size_t k = 0; k < 3; ++k) {
        const double n = q[k] / S;
        angle.gradient[k] = by_S * n;
        angle.hessian[k][3] = angle.hessian[3][k] = by_S_c * n;
        for (std::size_t l = 0; l < 3; ++l)
            angle.hessian[k][l] = by_S_S * n * q[l] / S + by_S / S * ((k == l ? 1 : 0) - n * q[l] / S);
    }
    return angle;
}

/// factor (X a) . (Y b)
PairForm product_of(int first, const Vector3& a, int second, const Vector3& b, double factor)
{
    return inner_product_row(first, direction(factor * a), second, direction(b), 0, 1);
}

PairForm sum_of(PairForm form, const PairForm& more)
{
    form.c_ij += more.c_ij;   // products of two directions: of the world they are in b_j alone
    form.b_j += more.b_j;
    return form;
}

/// s1, s2, s3, the sine times the axis of the turn between two triads, and c, its cosine.
/// Of R = A^T B, R_lm = a_l . b_m: s_k = 1/2 (R_ml - R_lm) with k, l, m as x, y, z go round, and c = 1/2 (tr
/// R - 1).
std::array<PairForm, 4> sine_and_cosine(int first, int second, const TriadPair& triads)
{
    const auto product = [&](int k, int l, double factor) {
        return product_of(first, triads.first.column(k), second, triads.second.column(l), factor);
    };
    std::array<PairForm, 4> forms;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        forms[static_cast<std::size_t>(k)] = sum_of(product(m, l, 0.5), product(l, m, -0.5));
    }
    forms[3] = sum_of(sum_of(product(0, 0, 0.5), product(1, 1, 0.5)), product(2, 2, 0.5));
    forms[3].c -= 0.5;
    return forms;
}

}   // namespace

JointCoordinate displacement_along(int body_i, const Vector4& n, const Vector4& a, int body_j,
                                   const Vector4& b)
{
    return {{plane_row(body_i, n, a, body_j, b, 0, 1)}};
}

JointCoordinate angle_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b)
{
    return {{inner_product_row(body_i, a1, body_j, b, 0, 1), inner_product_row(body_i, a2, body_j, b, 0, 1)}};
}

/// a1 . b1 + a2 . b2 and a2 . b1 - a1 . b2, which are twice cosine and sine of a turn about a1 x a2; the
/// factor does not change their angle.
JointCoordinate turn_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b1,
                             const Vector4& b2)
{
    const JointCoordinate one = angle_between(body_i, a1, a2, body_j, b1),
                          two = angle_between(body_i, -a1, a2, body_j, b2);
    return {{sum_of(one.forms[0], two.forms[1]), sum_of(one.forms[1], two.forms[0])}};
}

/// With R = R_i(a) R_j(b) R_k(c) and e = 1 for i, j, k as x, y, z go round, else -1: R_ik = e sin b,
/// R_jk = -e sin a cos b, R_kk = cos a cos b, R_ij = -e cos b sin c, R_ii = cos b cos c.
std::array<JointCoordinate, 3> angles_of_turn(int first, int second, const TriadPair& triads,
                                              const std::array<int, 3>& sequence)
{
    const auto [i, j, k] = sequence;
    const double e = (i + 1) % 3 == j ? 1 : -1;
    const auto R = [&](int row, int column, double factor) {
        return product_of(first, triads.first.column(row), second, triads.second.column(column), factor);
    };
    return {JointCoordinate{{R(k, k, 1), R(j, k, -e)}, CoordinateKind::outer_angle},
            JointCoordinate{{R(i, k, e)}, CoordinateKind::arc_sine},
            JointCoordinate{{R(i, i, 1), R(i, j, -e)}, CoordinateKind::outer_angle}};
}

JointCoordinate rotation_component(int first, int second, const TriadPair& triads, int k)
{
    const std::array<PairForm, 4> forms = sine_and_cosine(first, second, triads);
    const auto at = [&](int i) { return forms[static_cast<std::size_t>(i % 3)]; };
    return {{at(k), at(k + 1), at(k + 2), forms[3]}, CoordinateKind::rotation_component};
}

JointCoordinate rotation_angle(int first, int second, const TriadPair& triads)
{
    const std::array<PairForm, 4> forms = sine_and_cosine(first, second, triads);
    return {{forms.begin(), forms.end()}, CoordinateKind::rotation_angle};
}

SmoothFunction::Value coordinate_at(CoordinateKind kind, const Point& q)
{
    switch (kind) {
    case CoordinateKind::displacement:
        return displacement_at(1, q[0]);
    case CoordinateKind::angle:
    case CoordinateKind::outer_angle:
        return angle_at(1, q[0], q[1]);
    case CoordinateKind::arc_sine:
        return arc_sine_at(q[0]);
    case CoordinateKind::rotation_component:
        return rotation_component_at(q);
    case CoordinateKind::rotation_angle:
        break;
    }
    return rotation_angle_at(q);
}

/// Wherever the bodies are.
static bool is_always_known(CoordinateKind kind)
{
    return kind == CoordinateKind::displacement || kind == CoordinateKind::angle;
}

bool is_known(CoordinateKind kind, const Point& q)
{
    constexpr double least_square = 1e-4;   // of a cosine: 0.6 degrees
    if (is_always_known(kind)) return true;
    if (kind == CoordinateKind::outer_angle) return q[0] * q[0] + q[1] * q[1] >= least_square;
    if (kind == CoordinateKind::arc_sine) return (1 - q[0]) * (1 + q[0]) >= least_square;
    return rotation_angle_at(q).value <= widest_rotation;
}

bool is_known(const JointCoordinate& q, const Configurations& X)
{
    return is_always_known(q.kind) || is_known(q.kind, point_of(q, X));
}

double coordinate_value(const JointCoordinate& q, const Configurations& X)
{
    return coordinate_at(q.kind, point_of(q, X)).value;
}

double coordinate_rate(const JointCoordinate& q, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    const Value at = coordinate_at(q.kind, point_of(q, X));
    double rate = 0;
    for (std::size_t k = 0; k < q.forms.size(); ++k) rate += at.gradient[k] * rate_of(q.forms[k], X, V);
    return rate;
}

/// Of an angle by sine and cosine of the change itself, (-pi, pi]: no jump of either angle comes in.
double coordinate_change(const JointCoordinate& q, std::span<const Matrix34> from,
                         std::span<const Matrix34> to)
{
    if (!q.counts_turns()) return coordinate_value(q, to) - coordinate_value(q, from);
    const double c0 = form_at(q.forms[0], from), s0 = form_at(q.forms[1], from);
    const double c = form_at(q.forms[0], to), s = form_at(q.forms[1], to);
    return arc_tangent(c0 * s - s0 * c, c0 * c + s0 * s);
}

double turned_to(double angle, double near)
{
    constexpr double turn = 2 * std::numbers::pi;
    return angle + turn * std::round((near - angle) / turn);
}

}   // namespace livens
