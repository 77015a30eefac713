// Every ideal joint is a few quadratic forms in X; one row is data.
#pragma once

#include <string>
#include <vector>

#include "livens/base/linear.h"

namespace livens {

/// The place of the fixed world among the bodies.
inline constexpr int world = -1;

/// One scalar constraint on the bodies i and j:
///
///     Phi = 1/2 tr(X_i C_ii X_i^T) + tr(X_i C_ij X_j^T) + 1/2 tr(X_j C_jj X_j^T)
///         + tr(B_i^T X_i) + tr(B_j^T X_j) + c
///
/// C_ii and C_jj are symmetric. Terms of the world are folded into B and c by the makers below, so a row with
/// body_i == world has no terms in i. Rows do not depend on time (prescribed motion is not part of this
/// version).
struct ConstraintRow {
    int body_i = world;
    int body_j = world;
    Matrix4 c_ii{}, c_ij{}, c_jj{};
    Matrix34 b_i{}, b_j{};
    double c = 0;
    double scale = 1;    ///< a violation |Phi| is reported as |Phi| / scale: a length, its square, or 1
    std::string label;   ///< what the row holds: "x", "axis 1", "distance"
};

/// X of the world: origin and axes.
inline constexpr Matrix34 world_configuration{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

/// Phi of a row; X_i is ignored where body_i is the world.
double constraint_value(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j);
/// g_i = X_i C_ii + X_j C_ij^T + B_i and g_j = X_j C_jj + X_i C_ij + B_j.
void constraint_gradient(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j, Matrix34& g_i,
                         Matrix34& g_j);
/// The part of d2 Phi/dt2 that is quadratic in the velocities: tr(V K V^T).
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

/// The six rows of rigidity, 1/2 (d_a . d_b - delta_ab) = 0, in the order 11, 22, 33, 12, 13, 23  (P4).
std::vector<ConstraintRow> rigidity_rows(int body);

}   // namespace livens
