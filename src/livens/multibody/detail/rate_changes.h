// SPDX-License-Identifier: BSD-3-Clause
// What a projection of velocities did, for people.
#pragma once

#include <span>
#include <string>

#include "livens/multibody/model.h"

namespace livens {

/// "slider.displacement 0 -> 0.218 m/s, turning at 'ball' 0 -> 7.06 rad/s": the three rates of joints that
/// changed most, those of two bodies without a coordinate by how fast they turn against each other. Empty:
/// none did.
std::string rate_changes(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> before,
                         std::span<const Matrix34> after);

}   // namespace livens
