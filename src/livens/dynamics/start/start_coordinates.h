// SPDX-License-Identifier: BSD-3-Clause
// A start by coordinates of joints: where a crank stands and how fast it turns, and the rest follows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// What a coordinate of a joint is to be at the start.
struct StartCoordinate {
    int joint = 0;
    int coordinate = 0;                       ///< which of the joint's
    std::optional<double> value{};            ///< as the joint counts it, m or rad; empty: it stays
    std::optional<double> rate{};             ///< m/s or rad/s; empty: that of the stated velocities
    std::string path = "start.coordinates";   ///< of complaints
};

/// What somebody said of a body's velocity at the start, be it zero: it is kept where coordinates allow.
struct StatedVelocity {
    int body = 0;
    bool of_place = true;   ///< of the reference point
    bool of_turn = true;    ///< the angular velocity
};

struct MovedStart {
    Model model;                        ///< with its bodies there; at_stated of coordinates went along
    std::vector<std::string> kept;      ///< "elbow.angle": stated by nobody, independent, and left as it was
    int left_free = 0;                  ///< freedoms that no coordinate tells: moved by the least
    std::vector<std::string> changed;   ///< a sentence for each body whose stated velocities were not kept
};

/// Leads the wanted coordinates from where the bodies are stated to their values, in small steps along the
/// joints, so that the mechanism stays on its branch and turns are counted. Other coordinates that are
/// independent of them keep their values and rates; what no coordinate tells moves by the least in the metric
/// of the masses. Velocities of bodies that are `stated` stay if all of them fit; else those that move fit by
/// the least as well, and `changed` says which. The model has no drives, loads and sensors yet: these are
/// made where bodies stand.
///
/// Throws InputError: `start-coordinate` for a coordinate that is not there, wanted twice, held by joints or
/// by the other wanted ones, more than 1000 turns or lengths away, or not to be reached, with the value where
/// the mechanism stops; std::logic_error for drives, loads or sensors; and what consistent_start() throws.
MovedStart move_start(const Model& model, const std::vector<StartCoordinate>& wanted, StartPolicy policy,
                      double t = 0, const std::vector<StatedVelocity>& stated = {});

inline constexpr double same_angle = 1e-6;   ///< rad: two that are meant to be one
/// The model with its bodies in another state: joints remain where they are on the bodies, and coordinates
/// count on, angles by the shorter way unless one of `counted` has the same angle after more turns.
Model restated(const Model& model, const State& state, const std::vector<StartCoordinate>& counted = {});

/// Coordinates of joints that are independent of each other and of all rows in a state, in their order: they
/// tell the configuration, but for `left_free` freedoms.
struct IndependentCoordinates {
    std::vector<std::string> names;   ///< "crank shaft.angle"
    int left_free = 0;
};
IndependentCoordinates independent_coordinates(const Model& model, const State& state);

}   // namespace livens
