// SPDX-License-Identifier: BSD-3-Clause
// Where loads act, read from the forces that they exert.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline io_internal {

/// A load that is a force f at one point of a body, F = f (1, theta)^T, at all instants looked at: theta in
/// coordinates of each of its two bodies (the world's are world coordinates).
struct LineOfAction {
    std::array<std::optional<Vector3>, 2> points;
    /// Where force and torque on the first body are told else, in its coordinates: where the torques are
    /// least, and along what does not matter to them the point of a joint between the bodies, or the centre
    /// of mass.
    std::optional<Vector3> place{};
};
/// One a load. Loads that exert nothing have neither points nor a place.
std::vector<LineOfAction> lines_of_action(const Model& model, const Motion& motion);

/// Of each load on its first body, world axes: the force (N), and the torque about its place (N m; 0 where it
/// has none).
std::vector<Reaction> load_reactions(const Model& model, const std::vector<LineOfAction>& lines,
                                     const State& state, std::span<const double> angles, Side side);

}   // namespace livens::inline io_internal
