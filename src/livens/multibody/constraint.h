// SPDX-License-Identifier: BSD-3-Clause
// Every ideal joint is a few rows, nearly all of them quadratic forms in X; one row is data. Drives make it
// depend on time, and smooth functions of forms couple joint coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/time/guard.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

/// The place of the fixed world among the bodies.
inline constexpr int world = -1;

/// A function of two bodies i and j:
///
///     1/2 tr(X_i C_ii X_i^T) + tr(X_i C_ij X_j^T) + 1/2 tr(X_j C_jj X_j^T)
///         + tr(B_i^T X_i) + tr(B_j^T X_j) + c
///
/// C_ii and C_jj are symmetric. Terms of the world are folded into B_j and c by the makers below, so a form
/// whose body i is the world has no terms in i.
struct QuadraticForm {
    Matrix4 c_ii{}, c_ij{}, c_jj{};
    Matrix34 b_i{}, b_j{};
    double c = 0;
};

/// A form and its bodies; body_j is never the world.
struct PairForm : QuadraticForm {
    int body_i = world;
    int body_j = world;
};

/// What a row follows: f(t) times a form. The factor must have a continuous rate.
struct Drive {
    TimeFunction factor;
    QuadraticForm form;
};

/// A smooth function of a few numbers q, which are forms; see joint_coordinates.h.
struct SmoothFunction {
    static constexpr std::size_t most = 4;
    using Point = std::array<double, most>;
    struct Value {
        double value = 0;
        Point gradient{};
        std::array<Point, most> hessian{};
    };
    std::function<Value(const Point& q)> at;
    /// Of each step derivatives at from + step, and for the value F(from + step) - F(from) along the straight
    /// way: angles turn on, also where their value at a point begins again.
    std::function<void(const Point& from, std::span<const Point> steps, std::span<Value> out)> moved;
    std::size_t n = 1;   ///< numbers that it is of

    Value after(const Point& from, const Point& step) const
    {
        Value value;
        moved(from, {&step, 1}, {&value, 1});
        return value;
    }
};

/// Where a smooth function of q is smooth piece by piece only, as a spline is.
struct FunctionGuard {
    Guard guard;
    std::function<double(const SmoothFunction::Point& q)> value;
};

/// Where a function ends, for messages: the margin is positive where it has values.
struct FunctionEdge {
    std::function<double(const SmoothFunction::Point& q)> margin;
    double size;        ///< of what a margin is measured by
    std::string what;   ///< happens where it is zero: "the law of 'cam' ends"
};

/// One scalar constraint, Phi(t, X) = form + sum_k f_k(t) form_k + sum_m F_m(q_1, ..): a quadratic form,
/// whose C, B and c may depend on time, and smooth functions of forms q, which may have bodies of their own.
/// Each function is of few forms, so that a row of many coordinates costs as much as its terms.
struct ConstraintRow : PairForm {
    double scale = 1;    ///< a violation |Phi| is reported as |Phi| / scale: a length, its square, or 1
    std::string label;   ///< what the row holds: "x", "axis 1", "distance"
    std::vector<Drive> drives{};               ///< on the bodies of the form
    std::vector<PairForm> coordinates{};       ///< q of F_1, then those of F_2, ..
    std::vector<SmoothFunction> functions{};   ///< F_m
    std::vector<FunctionEdge> edges{};         ///< of as many of the functions, the first ones
    double period =
        0;   ///< Phi is known up to whole multiples of it, and is the one nearest to 0; 0: it is known
    std::optional<FunctionGuard> guard{};   ///< of F_1; one row of a joint has it for all

    /// Whether the row is a quadratic form alone.
    bool is_quadratic() const { return drives.empty() && functions.empty(); }
};

/// X of the world: origin and axes.
inline constexpr Matrix34 world_configuration{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

/// A view of the configurations of all bodies, 12 numbers each.
class Configurations {
public:
    explicit Configurations(const double* X) : X_(X) {}
    Configurations(std::span<const Matrix34> X) : X_(X.empty() ? nullptr : X.data()->data()) {}
    Configurations(const std::vector<Matrix34>& X) : Configurations(std::span(X)) {}

    Matrix34 operator[](int body) const
    {
        if (body == world) return world_configuration;
        Matrix34 X;
        std::copy_n(X_ + 12 * body, 12, X.a);
        return X;
    }

    /// 12 numbers a body.
    const double* data() const { return X_; }

private:
    const double* X_;
};

/// The bodies that a row touches, each once and without the world.
struct RowBodies {
    static constexpr int most = 64;
    int size = 0;
    std::array<int, most> bodies;   ///< so many of them

    RowBodies() {}   // most rows touch two: the others are not written

    const int* begin() const { return bodies.data(); }
    const int* end() const { return bodies.data() + size; }
    int find(int body) const { return static_cast<int>(std::find(begin(), end(), body) - begin()); }
};
/// Throws InputError for a row that touches more than RowBodies::most.
RowBodies row_bodies(const ConstraintRow& row);

/// The gradient of a row by X of each of its bodies.
struct RowGradient {
    RowBodies bodies;
    std::array<Matrix34, RowBodies::most> by;   ///< as many as bodies

    /// Zero.
    explicit RowGradient(const ConstraintRow& row) : bodies(row_bodies(row))
    {
        std::fill_n(by.begin(), bodies.size, Matrix34{});
    }

    /// Zero for a body that the row does not touch.
    Matrix34 of(int body) const
    {
        const int side = bodies.find(body);
        return side < bodies.size ? by[static_cast<std::size_t>(side)] : Matrix34{};
    }
};

/// Calls act(form, body_i, body_j, weight) for all forms of a row: to first order Phi is the sum of weight
/// times form.
template <typename Act>
void for_each_form(const ConstraintRow& row, Instant at, const Configurations& X, const Act& act);

double constraint_value(const ConstraintRow& row, Instant at, const Configurations& X);
RowGradient constraint_gradient(const ConstraintRow& row, Instant at, const Configurations& X);
/// d2 Phi by X of one of the row's bodies and X of another.
Matrix<12, 12> constraint_hessian(const ConstraintRow& row, Instant at, const Configurations& X, int body,
                                  int other);
/// Phi at another instant and place less Phi; `step` is the difference of the places, which may have digits
/// that they have lost.
double constraint_change(const ConstraintRow& row, Instant from, const Configurations& X_from, Instant to,
                         const Configurations& X_to, const Configurations& step);
/// The part of dPhi/dt that stays where X does not move; 0 without drives.
double constraint_rate(const ConstraintRow& row, Instant at, const Configurations& X);
/// d2 Phi/dt2 less what accelerations do to it: V K V of all forms by their weights, what drives add,
/// sum_k (2 f_k' <gradient of form_k, V> + f_k'' form_k), and q'^T F'' q'.
double constraint_curvature(const ConstraintRow& row, Instant at, const Configurations& X,
                            const Configurations& V);
/// The row as it is at an instant, without drives.
ConstraintRow frozen(const ConstraintRow& row, Instant at);

/// The same of rows without drives. Throw std::logic_error for others: they need an instant.
double constraint_value(const ConstraintRow& row, const Configurations& X);
RowGradient constraint_gradient(const ConstraintRow& row, const Configurations& X);

/// The numbers q of one function of a row, the first of which is coordinate `first`.
SmoothFunction::Point function_point(const ConstraintRow& row, const SmoothFunction& F, std::size_t first,
                                     const Configurations& X);
/// act(F, first) of all functions of a row.
template <typename Act>
void for_each_function(const ConstraintRow& row, const Act& act);
/// The gradient of a form by X of its bodies, zero by that of the world.
struct FormGradient {
    Matrix34 i{}, j{};
};
FormGradient form_gradient(const QuadraticForm& form, int body_i, int body_j, const Configurations& X);
/// The value of a form.
double form_value(const QuadraticForm& form, int body_i, int body_j, const Configurations& X);

// Makers of rows. A point is (1, theta), a direction (0, a), see base/linear.h; either body may be the world,
// and then a point or a direction is one of the world. The bodies must differ.

/// (X_i a) . (X_j b) = value; the row of two axes has value 0.
ConstraintRow inner_product_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double value,
                                double scale);
/// X_j b - X_i a = 0: three rows x, y, z in world axes.
std::vector<ConstraintRow> coincidence_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                            double scale);
/// 1/2 (|X_j b - X_i a|^2 - length^2) = 0  (P27).
ConstraintRow distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double length);
/// (X_i n) . (X_j b - X_i a) = distance: the point b of body j in a plane of body i with normal n.
ConstraintRow plane_row(int body_i, const Vector4& n, const Vector4& a, int body_j, const Vector4& b,
                        double distance, double scale);

// Makers of rows with drives.

/// X_j b = X_i (a + path(t)): a point is led along a path in axes of body i. Three rows x, y, z.
std::vector<ConstraintRow> driven_point_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                             const std::array<TimeFunction, 3>& path, double scale);
/// 1/2 (|X_j b - X_i a|^2 - length(t)^2) = 0; the length is positive and about `typical`.
ConstraintRow driven_distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                  const TimeFunction& length, double typical);
/// (X_i a) . (cos(angle) X_j b2 - sin(angle) X_j b1) = 0: the direction a of body i is turned by angle(t)
/// from b1 towards b2, which are perpendicular unit vectors of body j; or by half a turn more.
ConstraintRow driven_angle_row(int body_i, const Vector4& a, int body_j, const Vector4& b1, const Vector4& b2,
                               const TimeFunction& angle);
/// What is positive where the angle is not half a turn more, for Joint::branches.
ConstraintRow driven_angle_branch(int body_i, const Vector4& a, int body_j, const Vector4& b1,
                                  const Vector4& b2, const TimeFunction& angle);

/// The six rows of rigidity, 1/2 (d_a . d_b - delta_ab) = 0, in the order 11, 22, 33, 12, 13, 23  (P4).
std::vector<ConstraintRow> rigidity_rows(int body);

template <typename Act>
void for_each_function(const ConstraintRow& row, const Act& act)
{
    std::size_t first = 0;
    for (const SmoothFunction& F : row.functions) {
        act(F, first);
        first += F.n;
    }
}

template <typename Act>
void for_each_form(const ConstraintRow& row, Instant at, const Configurations& X, const Act& act)
{
    act(row, row.body_i, row.body_j, 1.0);
    for (const Drive& drive : row.drives) act(drive.form, row.body_i, row.body_j, drive.factor(at).value);
    for_each_function(row, [&](const SmoothFunction& function, std::size_t first) {
        const SmoothFunction::Value F = function.at(function_point(row, function, first, X));
        for (std::size_t k = 0; k < function.n; ++k) {
            const PairForm& q = row.coordinates[first + k];
            act(q, q.body_i, q.body_j, F.gradient[k]);
        }
    });
}

}   // namespace gnu::visibility("default")]]livens
