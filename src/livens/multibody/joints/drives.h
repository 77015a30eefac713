// SPDX-License-Identifier: BSD-3-Clause
// Drives: joints whose rows follow functions of time. What holds their bodies is their reaction.
#pragma once

#include <array>
#include <string>

#include "livens/multibody/joints.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

// X is the configuration of all bodies at the start of the motion, where coordinates are what their joints
// say.

/// A coordinate of a joint follows law(t), whose values are those that NamedCoordinate counts. 1 row;
/// reactions are those on the joint's second body.
Joint driven_coordinate(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
                        const TimeFunction& law, const Configurations& X);
/// The distance of two points follows length(t); where that is not positive the row is no number. 1 row.
Joint driven_distance(const std::string& name, int first, const Vector3& point_first, int second,
                      const Vector3& point_second, const TimeFunction& length, const Configurations& X);
/// A point of a body is led along a path in world axes, from where it stands by path(t). 3 rows.
Joint driven_point(const std::string& name, int body, const Vector3& point,
                   const std::array<TimeFunction, 3>& path, const Configurations& X, double scale = 1);
/// Likewise, and the body does not turn. 6 rows.
Joint driven_body(const std::string& name, int body, const Vector3& point,
                  const std::array<TimeFunction, 3>& path, const Configurations& X, double scale = 1);

}   // namespace livens
