// SPDX-License-Identifier: BSD-3-Clause
// What the joint rows of a model say in one configuration: values, rates, rounding levels, and wrenches.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

std::vector<int> all_rows(const Model& model);

// What is asked of positions alone wants a model without drives, or one that is frozen() at an instant.

/// Phi of the model's rows, and G V.
std::vector<double> joint_values(const Model& model, std::span<const Matrix34> X);
/// The same, of rows with a period those that are reached on the straight way from where they are `phi`.
std::vector<double> joint_values_from(const Model& model, std::span<const double> phi,
                                      std::span<const Matrix34> X_from, std::span<const Matrix34> X);
std::vector<double> joint_rates(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V);
/// What drives add to dPhi/dt: zeros without drives.
std::vector<double> drive_rates(const Model& model, Instant at, std::span<const Matrix34> X);

/// How far some rows are from being fulfilled.
struct Gap {
    int row = -1;           ///< with the largest |Phi| / scale
    double violation = 0;   ///< that
    double level = 0;       ///< largest |Phi| in units of its rounding, 4 eps max(sum of its |terms|, scale)
    bool near = true;       ///< every row is at its rounding level or below 1e-9 of its scale
};
Gap widest_gap(const Model& model, std::span<const Matrix34> X, std::span<const int> rows);
Gap widest_gap(const Model& model, std::span<const Matrix34> X, std::span<const int> rows,
               std::span<const double> phi);

/// What a multiplier of one does to a body: the gradient g of its row by X as a force and a moment.
///
/// The moment sum_i d_i x (g_i - theta_i g_0) is taken about the joint point theta, where only axes have one,
/// however remote the reference point is. It is zero where it is not above 8 eps times its absolute terms.
struct Wrench {
    int body = 0;
    Vector3 at{};       ///< the joint point, body coordinates
    Vector3 force{};    ///< world axes
    Vector3 moment{};   ///< about the joint point, world axes
    double doubt = 0;   ///< rounding error of the force, relative to it
};

/// On the bodies of every row of the model.
using RowWrenches = std::vector<std::vector<Wrench>>;
RowWrenches row_wrenches(const Model& model, std::span<const Matrix34> X);

/// Moment about another point of the body, moment + D (at - theta) x force.
Vector3 moment_about(const Wrench& wrench, const Matrix34& X, const Vector3& theta);

}   // namespace livens::inline dynamics_internal
