// Every ideal joint is a few quadratic forms in X; one row is data. Drives make it depend on time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/time/time_function.h"

namespace livens {

/// The place of the fixed world among the bodies.
inline constexpr int world = -1;

/// A function of the bodies i and j of a row:
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

/// What a row follows: f(t) times a form. The factor must have a continuous rate.
struct Drive {
    TimeFunction factor;
    QuadraticForm form;
};

/// One scalar constraint, Phi(t, X) = form + sum_k f_k(t) form_k: C, B and c are functions of time.
struct ConstraintRow : QuadraticForm {
    int body_i = world;
    int body_j = world;
    double scale = 1;    ///< a violation |Phi| is reported as |Phi| / scale: a length, its square, or 1
    std::string label;   ///< what the row holds: "x", "axis 1", "distance"
    std::vector<Drive> drives;
};

/// X of the world: origin and axes.
inline constexpr Matrix34 world_configuration{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

/// Phi of a row; X_i is ignored where body_i is the world.
double constraint_value(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j);
/// g_i = X_i C_ii + X_j C_ij^T + B_i and g_j = X_j C_jj + X_i C_ij + B_j.
void constraint_gradient(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j,
                         Matrix34& g_i, Matrix34& g_j);
/// Adds what drives contribute to the gradient.
void add_drive_gradient(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j,
                        Matrix34& g_i, Matrix34& g_j);
/// Phi at another instant less Phi, at the same X.
double constraint_change(const ConstraintRow& row, Instant from, Instant to, const Matrix34& X_i,
                         const Matrix34& X_j);
/// The part of dPhi/dt that stays where X does not move; 0 without drives.
double constraint_rate(const ConstraintRow& row, Instant at, const Matrix34& X_i, const Matrix34& X_j);
/// d2 Phi/dt2 less what accelerations do to it:
/// tr(V K V^T) + sum_k (2 f_k' <gradient of form_k, V> + f_k'' form_k).
double constraint_curvature(const ConstraintRow& row, Instant at, const std::array<Matrix34, 2>& X,
                            const std::array<Matrix34, 2>& V);
/// The row as it is at an instant, without drives.
ConstraintRow frozen(const ConstraintRow& row, Instant at);

/// The same of rows without drives. Throws std::logic_error for others: they need an instant.
double constraint_value(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j);
void constraint_gradient(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j, Matrix34& g_i,
                         Matrix34& g_j);
double constraint_curvature(const ConstraintRow& row, const Matrix34& V_i, const Matrix34& V_j);

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
ConstraintRow driven_angle_row(int body_i, const Vector4& a, int body_j, const Vector4& b1,
                               const Vector4& b2, const TimeFunction& angle);
/// What is positive where the angle is not half a turn more, for Joint::branches.
ConstraintRow driven_angle_branch(int body_i, const Vector4& a, int body_j, const Vector4& b1,
                                  const Vector4& b2, const TimeFunction& angle);

/// The six rows of rigidity, 1/2 (d_a . d_b - delta_ab) = 0, in the order 11, 22, 33, 12, 13, 23  (P4).
std::vector<ConstraintRow> rigidity_rows(int body);

}   // namespace livens
