// SPDX-License-Identifier: BSD-3-Clause
// What a force along a coordinate of a joint has to move.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// kg or kg m^2: Q / q'' of each coordinate q under a force Q along it alone, where the bodies of the model
/// stand, at rest and without loads, while joints and couplings hold and drives let go. Very large where q is
/// held; zero for all where something that can move has no inertia.
std::vector<double> inertias_along(const Model& model, std::span<const JointCoordinate> coordinates);

}   // namespace gnu::visibility("default")]]livens
