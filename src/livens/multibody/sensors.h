// SPDX-License-Identifier: BSD-3-Clause
// Sensors: what is read of a motion, by name.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/joint_coordinates.h"

namespace [[gnu::visibility("default")]] livens {

struct Joint;
struct Load;

/// A number that a sensor reads: of a coordinate, or else by a function.
struct SensorComponent {
    std::string name;               ///< "x", "angle_rate"
    std::string unit;               ///< "m", "rad s-1", as files of results have it
    NamedCoordinate coordinate{};   ///< no forms: none
    int derivative = 0;             ///< by time, of the coordinate: 1 is its rate, 2 its acceleration

    bool is_rate() const { return derivative == 1; }
    bool is_acceleration() const { return derivative == 2; }
};

/// Components are those of coordinates; a sensor of a load reads Load::readings and its power, one of a
/// body's energy that of motion and that of height.
struct Sensor {
    std::string name;
    std::string type;   ///< "point", "joint", "relative", "load", "energy", "controller"
    std::vector<SensorComponent> components;
    int load = -1;   ///< which one is read, or -1
    int body = -1;   ///< whose energy is read, or -1
};

// X is the configuration of all bodies at the start.

/// A point of a body: x, y, z, vx, vy, vz and ax, ay, az in world axes.
Sensor point_sensor(const std::string& name, int body, const Vector3& point, const Configurations& X);
/// A point of the second body from one of the first, in axes of the first: x, y, z, their rates vx, vy, vz
/// and the rates of these, ax, ay, az. Either may be the world.
Sensor relative_sensor(const std::string& name, int first, const Vector3& point_first, int second,
                       const Vector3& point_second, const Configurations& X);
/// All coordinates and readings of a joint, their rates and accelerations. Throws InputError
/// (`joint-coordinate`) if it has none.
Sensor joint_sensor(const std::string& name, const Joint& joint);
/// What a load reports, and its power on the bodies.
Sensor load_sensor(const std::string& name, int index, const Load& load);
/// kinetic and potential (of weight, zero where the world's origin is), J.
Sensor energy_sensor(const std::string& name, int body);

}   // namespace gnu::visibility("default")]]livens
