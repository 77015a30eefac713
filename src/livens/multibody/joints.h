// SPDX-License-Identifier: BSD-3-Clause
// Joints: names for sets of constraint rows.
#pragma once

#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/constraint.h"

namespace [[gnu::visibility("default")]] livens {

/// A joint between `first` (a body or the world) and `second` (a body). A new kind of joint is a new function
/// that fills in rows; nothing else in livens asks for the kind.
///
/// Reactions are what the joint exerts on `second`, at `point_second`, in world axes.
struct Joint {
    std::string name;
    std::string type;   ///< "revolute", ...; for messages and files
    int first = world;
    int second = 0;
    Vector3 point_first{};    ///< joint point in body coordinates of `first` (world coordinates if it is the
                              ///< world)
    Vector3 point_second{};   ///< joint point in body coordinates of `second`
    std::vector<ConstraintRow> rows;
    /// Directions fixed in each body that must point the same way at assembly, where rows a . b = 0 alone
    /// would admit the opposite; zero where there are none.
    Vector3 axis_first{};
    Vector3 axis_second{};
    /// Functions that must be positive at assembly, where rows alone would admit another branch.
    std::vector<ConstraintRow> branches{};
};

/// Where a joint sits, in coordinates of each body. For the world they are world coordinates.
struct JointFrame {
    Vector3 point_first{};
    Vector3 point_second{};
    Vector3 axis_first{0, 0, 1};   ///< normalised by the makers; not zero
    Vector3 axis_second{0, 0, 1};
};

/// The frame of a joint at one world point and axis in the given configuration of the two bodies.
JointFrame joint_frame(const Matrix34& X_first, const Matrix34& X_second, const Vector3& at,
                       const Vector3& axis = {0, 0, 1});

// Each throws InputError (path `joint[name]`) for a body joined to itself and for a zero axis. If `second` is
// the world, the roles are exchanged: Joint::second is always a body, and reactions are those on it. X_first
// and X_second are the configurations at assembly; `scale` is a length that violations are measured by.

/// Everything held: coincident points and three pairs of axes that are perpendicular now. 6 rows.
Joint weld(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
           const Matrix34& X_second, double scale = 1);
/// Rotation about one common axis. 5 rows.
Joint revolute(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Two perpendicular axes, one fixed in each body, and a common point. 4 rows.
Joint universal(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// A common point. 3 rows.
Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// A massless rod of the given length between the two points. 1 row. Throws InputError if length <= 0.
Joint rod(const std::string& name, int first, int second, const JointFrame& frame, double length);

}   // namespace livens
