// SPDX-License-Identifier: BSD-3-Clause
// How fast a start is, to tell velocities that break a joint from rounding.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

std::vector<Vector3> centers_of_mass(const Model& model);

/// Of centres of mass, and of directors times the model's length.
double largest_speed(const Model& model, const State& state, std::span<const Vector3> centers);

/// Largest |dPhi/dt| of a row that these speeds can make.
double rate_bound(const State& state, std::span<const Wrench> row, std::span<const Vector3> centers,
                  double speed, double length);

/// A thousandth of what weight makes along a length of the model: below, a fault of 1e-9 may be rounding.
double speed_by_weight(const Model& model);

/// The same of whatever moves the mechanism: loads, and drives by how their laws bend. A millionth of a
/// length in a second at least: 1e-9 of that is the rounding of lengths a second. Rates that are zero but for
/// rounding were computed from such speeds, which nobody states.
double speed_of_rounding(const Model& model, const State& state, const RowWrenches& wrenches,
                         std::span<const Vector3> centers);

}   // namespace livens::inline dynamics_internal
