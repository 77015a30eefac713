// SPDX-License-Identifier: BSD-3-Clause
// Where loads act, read from the forces that they exert.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens {

/// A load that is a force f at one point of a body, F = f (1, theta)^T, at all instants looked at: theta in
/// coordinates of each of its two bodies (the world's are world coordinates).
struct LineOfAction {
    std::array<std::optional<Vector3>, 2> points;
};
/// One a load. Loads that exert nothing, torques and the like have no points.
std::vector<LineOfAction> lines_of_action(const Model& model, const Motion& motion);

/// F of all loads on their first bodies, N: the force, in world axes.
std::vector<Vector3> load_forces(const Model& model, const State& state, std::span<const double> angles,
                                 Side side);

}   // namespace livens
