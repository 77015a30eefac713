// SPDX-License-Identifier: BSD-3-Clause
// Stops: rows that hold one way alone, closed by an impact and opened where they would have to pull.
#pragma once

#include <string>

#include "livens/multibody/events.h"
#include "livens/multibody/joints.h"

namespace [[gnu::visibility("default")]] livens {

class Model;

struct StopLaw {
    double limit = 0;         ///< m or rad
    bool is_lowest = true;    ///< the coordinate goes no lower; else no higher
    double restitution = 0;   ///< see ImpactLaw
    bool goes_together = false;
};

// X is the configuration of all bodies where the model has them. Throw InputError `stop-restitution` beside 0
// to 1.

/// A stop of a joint's coordinate, as NamedCoordinate counts it: "hinge stop", and what goes through it is
/// torn out of its turn: angles count their turns. Adds the joint and the events that close and open it,
/// of its name and of its name with " opens". Returns its index among the joints.
int add_coordinate_stop(Model& model, const std::string& name, const Joint& joint,
                        const NamedCoordinate& coordinate, const StopLaw& law, const Configurations& X);
/// Of the distance of two points (m): ropes that only pull, points that stay apart.
int add_distance_stop(Model& model, const std::string& name, const BodyPoint& first, const BodyPoint& second,
                      const StopLaw& law, const Configurations& X);

}   // namespace gnu::visibility("default")]]livens
