// SPDX-License-Identifier: BSD-3-Clause
// The kinds of joints that a scenario knows: one table, from which schema, reader and documentation follow.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "livens/io/scenario/schema/section.h"
#include "livens/multibody/joints.h"

namespace livens::inline io_internal {

/// What says where a joint is.
enum class Location : std::uint8_t {
    at_points,        ///< a point of each body
    on_curve,         ///< a curve of the first body
    at_point,         ///< one point
    on_axis,          ///< one point and one axis
    on_two_axes,      ///< one point and an axis of each body
    on_line,          ///< one point, which is on the first body and slides, and an axis of the first body
    along_axis,       ///< an axis
    along_two_axes,   ///< an axis of each body
    of_joints         ///< where other joints are
};

/// All that a joint can be made of.
struct JointParts {
    const Section& section;
    std::string name;
    int first, second;
    JointFrame frame;
    const Matrix34 &X_first, &X_second;   ///< at the start
    double scale;
    bool has_point_mass = false;
    std::vector<CoupledJoint> coupled = {};   ///< of a coupling: by `joints` two, else the terms
    CoupledJoint leader = {};                 ///< of a coupling by a law; null: there is none
    std::vector<Matrix34> X = {};             ///< of all bodies, for a coupling
    /// From coordinates of the bodies as stated to their axes.
    Matrix3 stretch_first = identity<3>(), stretch_second = identity<3>();

    double distance() const
    {
        return norm(X_second * point(frame.point_second) - X_first * point(frame.point_first));
    }
    double angle() const
    {
        const Vector3 a = X_first * direction(frame.axis_first), b = X_second * direction(frame.axis_second);
        return std::atan2(norm(cross(a, b)), dot(a, b));
    }
};

struct JointKind : Kind {
    Location location;
    Joint (*make)(const JointParts&);
};

const std::vector<JointKind>& joint_kinds();

/// `law` of a coupling.
Key law_key();
/// By terms, and by a law where there is one.
Joint make_coupling(const JointParts& p);
// Keys of loads along the only coordinate, or in tables for each of two.
std::vector<Key> and_along_angle(std::vector<Key> keys);
std::vector<Key> and_along_displacement(std::vector<Key> keys);
std::vector<Key> and_along_both(std::vector<Key> keys);
/// A table for one of several angles.
Key table_along_angle(std::string_view word, const std::string& of);
/// Of a ball joint, against all turns together and along its angles.
std::vector<Key> and_against_turns(std::vector<Key> keys);

}   // namespace livens::inline io_internal
