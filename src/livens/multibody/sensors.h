// SPDX-License-Identifier: BSD-3-Clause
// Sensors: named quantities to record.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/joint_coordinates.h"

namespace [[gnu::visibility("default")]] livens {

struct Joint;
struct Load;

/// One reading of a sensor: a coordinate or its time derivative, or a value computed otherwise.
struct SensorComponent {
    std::string name;               ///< "x", "angle_rate"
    std::string unit;               ///< "m", "rad s-1", as in result files
    NamedCoordinate coordinate{};   ///< without forms: none
    int derivative = 0;             ///< order of the time derivative: 1 rate, 2 acceleration

    bool is_rate() const { return derivative == 1; }
    bool is_acceleration() const { return derivative == 2; }
};

/// Components are coordinates, or for a load Load::readings and its power, or for an energy sensor the
/// kinetic energy of a body and the potential energy of its weight.
struct Sensor {
    std::string name;
    std::string type;   ///< "point", "joint", "relative", "load", "energy"
    std::vector<SensorComponent> components;
    int load = -1;   ///< index of the load, or -1
    int body = -1;   ///< index of the body of an energy sensor, or -1
};

// X is the initial configuration of all bodies.

/// Position, velocity and acceleration of a point of a body: x .. z, vx .. vz, ax .. az in world axes.
Sensor point_sensor(const std::string& name, int body, const Vector3& point, const Configurations& X);
/// Position of a point of the second body relative to a point of the first, in axes of the first: x, y, z,
/// with first and second time derivatives vx .. vz, ax .. az. Either body may be the world.
Sensor relative_sensor(const std::string& name, int first, const Vector3& point_first, int second,
                       const Vector3& point_second, const Configurations& X);
/// All coordinates of a joint with rates and accelerations. Throws InputError (`joint-coordinate`) if the
/// joint has none.
Sensor joint_sensor(const std::string& name, const Joint& joint);
/// Readings of a load, and the power that it supplies to the bodies.
Sensor load_sensor(const std::string& name, int index, const Load& load);
/// Kinetic energy, and potential energy of the weight (zero at the world origin), J.
Sensor energy_sensor(const std::string& name, int body);

}   // namespace gnu::visibility("default")]]livens
