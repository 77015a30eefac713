// SPDX-License-Identifier: BSD-3-Clause
// One rigid body or point mass: its mass matrix and its state at the start.
#pragma once

#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/mass_properties.h"

namespace [[gnu::visibility("default")]] livens {

/// A state of a controller that a body holds, as a component of its velocity.
struct HeldState {
    std::string name;   ///< "pid.i"
    double unit = 1;    ///< m/s of a state that is one
    Vector3 along{};    ///< a unit vector, perpendicular to those of other states of the body
};

/// A rigid body is a reference point and three directors, X = [phi d1 d2 d3] (P3).
/// A point mass has no directors: its X, V and m are zero outside the first column (and row), and it has
/// three unknowns a node instead of six.
struct Body {
    std::string name;
    bool is_point = false;
    bool is_rotor = false;   ///< a point mass that stands for inertias along coordinates, see WithRotors
    /// Of a point mass that holds states of controllers (controllers.h): the speed of one of its size, m/s.
    /// 0: it is none.
    double state_speed = 0;
    std::vector<HeldState> states{};   ///< three at most
    Matrix4 mass{};                    ///< m (P7)
    Matrix34 X{};                      ///< configuration at the start
    Matrix34 V{};                      ///< dX/dt at the start
    Matrix3 upright = identity<3>();   ///< directors from which rotations of the body are counted
    /// The directors as the user counts them are [d1 d2 d3] stretch: symmetric, the identity unless they are
    /// skew (P4). X, m and all places on the body are in the orthonormal triad.
    Matrix3 stretch = identity<3>();
    double volume = 0;   ///< m^3; 0: nobody said

    bool holds_states() const { return state_speed > 0; }
    /// It has weight, energy and a place; else it stands for something that has none.
    bool is_matter() const { return !is_rotor && !holds_states(); }
};

/// What a state is usually given by; all in world axes.
struct Placement {
    Vector3 position{};                  ///< of the reference point, m
    Matrix3 directors = identity<3>();   ///< columns d1, d2, d3, orthonormal and right-handed
    Vector3 velocity{};                  ///< of the reference point, m/s
    Vector3 angular_velocity{};          ///< rad/s, world axes
};

/// Throws InputError (path `body[name]`) for impossible mass properties and for directors that are not
/// orthonormal and right-handed within 1e-10; within that they are orthonormalised.
Body rigid_body(const std::string& name, const MassProperties& properties, const Placement& placement = {});
/// A body by its m (P7) in the coordinates of directors that may be skew and of any length (P4); those of
/// the body are the nearest orthonormal triad, and `stretch` tells how to get back: [Eugster et al. 2014].
/// Throws InputError too for directors that are left-handed or (nearly) in one plane.
Body skew_body(const std::string& name, const Matrix4& mass, const Placement& placement);
/// |D^T D - I|, its largest entry.
double skewness(const Matrix3& directors);
bool is_skew(const Body& body);
Body point_mass(const std::string& name, double mass, const Vector3& position, const Vector3& velocity = {});

/// Orientations. Quaternions are (w, x, y, z), body to world.
Matrix3 directors_from_quaternion(const Vector4& quaternion);   ///< normalised first; InputError if zero
Matrix3 directors_from_rotation_vector(const Vector3& rotation_vector);   ///< rad, world axes
Vector4 quaternion_from_directors(const Matrix3& directors);              ///< of an orthonormal triad, w >= 0
/// The orthonormal triad nearest to the given one (polar factor).
Matrix3 project_directors(const Matrix3& directors);

/// dX/dt = [velocity, w x d1, w x d2, w x d3], and the angular velocity that fits directors' rates best.
Matrix34 rate(const Matrix34& X, const Vector3& velocity, const Vector3& angular_velocity);
Vector3 angular_velocity(const Matrix34& X, const Matrix34& V);

}   // namespace gnu::visibility("default")]]livens
