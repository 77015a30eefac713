// SPDX-License-Identifier: BSD-3-Clause
// What a projection of velocities did, for people.
#pragma once

#include <span>
#include <string>

#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

/// "slider.displacement 0 -> 0.218 m/s, turning at 'ball' 0 -> 7.06 rad/s": the three that changed most of
/// rates of joints, of how fast two bodies turn against each other without a coordinate, and of angular
/// velocities that were stated of bodies. Empty: none did.
std::string rate_changes(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> before,
                         std::span<const Matrix34> after);

/// "0.3 m/s and 2 rad/s": by how much the velocities of a body changed.
std::string velocity_change(const Body& body, const Matrix34& X, const Matrix34& before,
                            const Matrix34& after);

}   // namespace livens::inline dynamics_internal
