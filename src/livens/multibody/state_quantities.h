// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a state by name: what conditions at the ends of time are stated of.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/sensors.h"

namespace [[gnu::visibility("default")]] livens {

class Model;

/// A turn about an axis of the world.
struct AxisTurn {
    double angle = 0;   ///< rad, right-handed
    Vector3 axis{0, 0, 1};
    Vector3 at{};   ///< a point on it, m

    AxisTurn back() const { return {-angle, axis, at}; }
};

/// X of a body after the turn, and V.
Matrix34 turned(const AxisTurn& by, const Matrix34& X);
Matrix34 turned_rate(const AxisTurn& by, const Matrix34& V);

/// A smooth function of X and V: a coordinate or its rate, or a component of a body's angular velocity.
struct StateQuantity {
    std::string name;               ///< "pivot.angle_rate"
    std::string unit;               ///< "rad s-1", as sensors have it
    NamedCoordinate coordinate{};   ///< no forms: none
    int derivative = 0;             ///< by time, of the coordinate: 0 or 1
    int body = -1;                  ///< whose angular velocity it is, or -1
    int axis = 0;                   ///< of the world, likewise
    /// Neither: a speed or an energy, which see X and V.
    std::function<double(std::span<const Matrix34> X, std::span<const Matrix34> V)> function{};
    double mass = 0;   ///< kg, of an energy; 0: a speed
    /// What it is once this turn of all bodies is taken back.
    std::optional<AxisTurn> before{};

    bool is_energy() const { return mass > 0; }
    bool is_rate() const { return derivative == 1 || body >= 0 || function; }
    bool is_angle() const { return body >= 0 || coordinate.coordinate.is_angle(); }
    bool counts_turns() const { return !is_rate() && coordinate.coordinate.counts_turns(); }
};

/// "object.component": the object is a joint, a sensor or a body. Joints have their coordinates and rates,
/// sensors what they read of coordinates, bodies x, y, z of their reference point and vx, vy, vz;
/// rotation_x, rotation_y, rotation_z, the rotation vector from where the body is upright;
/// angular_velocity_x and so on, all in world axes; its speed, its kinetic energy and its energy with that of
/// its weight. "energy" alone is that of all bodies with what loads store. "position", "velocity", "rotation"
/// and "angular_velocity" of a body are three at once. Throws InputError: `conditions-unknown`, and
/// `conditions-not-smooth` for what is no function of X and V.
std::vector<StateQuantity> state_quantities(const Model& model, const std::string& name);

/// In a state; `stated`: the bodies as the model has them, from which coordinates are counted. Angles are
/// within half a turn of what they are there.
double value_of(const StateQuantity& quantity, std::span<const Matrix34> stated, std::span<const Matrix34> X,
                std::span<const Matrix34> V);

}   // namespace gnu::visibility("default")]]livens
