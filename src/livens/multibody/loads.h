// SPDX-License-Identifier: BSD-3-Clause
// Loads: generalised forces as functions of time, configuration and velocity.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/joints.h"
#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

/// What a load may look at: the instant, and X and dX/dt of its one or two bodies (the world's where there is
/// none).
struct LoadArguments {
    Instant at;
    std::array<Matrix34, 2> X{world_configuration, world_configuration};
    std::array<Matrix34, 2> V{};
};

/// F_b for each body b, by virtual work tr(F_b^T dX_b); N in the first column, N m in the others.
using LoadForces = std::array<Matrix34, 2>;

/// Derivatives of the stacked columns of F_b by the stacked columns of X_c and of V_c: X[b][c] is 12 x 12.
struct LoadTangent {
    std::array<std::array<Matrix<12, 12>, 2>, 2> X{};
    std::array<std::array<Matrix<12, 12>, 2>, 2> V{};
};

/// A load is data and functions; a new one is a new maker.
struct Load {
    std::string name;
    std::string type;
    std::array<int, 2> bodies{world, world};   ///< the second is the world for a load on one body
    bool depends_on_X = false;                 ///< dF/dX may differ from zero
    bool depends_on_V = false;                 ///< dF/dV may differ from zero
    std::array<bool, 2>
        needs_directors{};        ///< F is not zero outside the first column: refused on a point mass
    std::vector<double> breaks;   ///< instants where F jumps or bends; they become element ends
    std::string domain;           ///< where F is a number, for the message if it is not; empty: everywhere
    /// An angle whose turns F does not see: a motion on which it passes half a turn has another F than it
    /// should have from there on. No forms: there is none.
    JointCoordinate bounded_angle{};

    /// F; required. Forces arrive as zero.
    std::function<void(const LoadArguments&, LoadForces&)> forces;
    /// dF/dX and dF/dV; required if one of the flags is set. The tangent arrives as zero.
    std::function<void(const LoadArguments&, LoadTangent&)> tangent;
    /// Potential energy in J of the conservative part; empty if the load has none.
    std::function<double(const LoadArguments&)> potential;
    /// Power in W of the part without potential. If empty: tr(F^T V) for a load without potential, else 0.
    std::function<double(const LoadArguments&)> power;
};

enum class Frame { inertial, body_fixed };

/// Three functions of time, the components of a load.
using TimeVector = std::array<TimeFunction, 3>;
TimeVector window(const TimeVector& value, double from, double until);

/// Force (N) at a material point of a body, in world axes or turning with the body:
/// F = f (1, theta)^T with f or f = sum_i f_i d_i.
Load point_force(const std::string& name, int body, const Vector3& point, const TimeVector& value,
                 Frame frame);

/// Torque (N m) on a body, F_i = 1/2 mu x d^i with contravariant directors  (P21); the metric is inverted.
Load torque(const std::string& name, int body, const TimeVector& value, Frame frame);

struct SpringDamper {
    double stiffness = 0;     ///< N/m
    double damping = 0;       ///< N s/m
    double free_length = 0;   ///< m
};

/// Spring and damper between a point of one body and a point of another or of the world; the force acts along
/// the line between the points. Throws InputError for negative stiffness, damping or free length. Points that
/// coincide: the force is zero for free_length 0 and along no direction (zero) otherwise.
Load spring_damper(const std::string& name, int first, const Vector3& point_first, int second,
                   const Vector3& point_second, const SpringDamper& spring);

struct JointSpring {
    double stiffness = 0;   ///< N/m or N m/rad
    double damping = 0;     ///< N s/m or N m s/rad
    double rest = 0;        ///< m or rad: the coordinate without force but the preload
    double preload = 0;     ///< N or N m, against the coordinate, wherever it is
};

// Loads along a coordinate of a joint: a force that does the work Q dq, between its two bodies. X is the
// configuration of all bodies at the start.

/// Q = -stiffness (q - rest) - damping dq/dt - preload. An angle is known up to 3.05 rad from where it is in
/// X: beyond that a spring is not a number, and the motion ends there by name.
Load joint_spring(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
                  const JointSpring& spring, const Configurations& X);
/// Q = value(t), N or N m.
Load actuator(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
              const TimeFunction& value, const Configurations& X);

/// What is told of a load whose force is not finite.
std::string not_finite(const Load& load);

/// What a load is asked with, from X and V of all bodies.
LoadArguments load_arguments(const Load& load, Instant at, std::span<const Matrix34> X,
                             std::span<const Matrix34> V);

/// tr(F^T V) over both bodies.
double load_power(const Load& load, const LoadArguments& arguments);
/// What changes the mechanism's energy: `power` by the rule stated there.
double power_without_potential(const Load& load, const LoadArguments& arguments);

}   // namespace livens
