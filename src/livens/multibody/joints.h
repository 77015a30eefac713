// SPDX-License-Identifier: BSD-3-Clause
// Joints: named sets of constraint rows.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/constraint.h"
#include "livens/multibody/joint_coordinates.h"

namespace [[gnu::visibility("default")]] livens {

/// A joint between `first` (a body or the world) and `second` (a body). A new joint type is a new function
/// that fills in rows; no other code depends on the type.
///
/// Reactions are the force and torque that the joint exerts on `second`, at `point_second`, in world axes.
struct Joint {
    std::string name;
    std::string type;   ///< "revolute", ...; for messages and files
    int first = world;
    int second = 0;
    Vector3 point_first{};    ///< joint point in body coordinates of `first` (world coordinates if it is the
                              ///< world)
    Vector3 point_second{};   ///< joint point in body coordinates of `second`
    std::vector<ConstraintRow> rows;
    /// Directions fixed in each body that must point the same way at assembly, since rows a . b = 0 alone
    /// would also admit opposite directions; zero if there are none.
    Vector3 axis_first{};
    Vector3 axis_second{};
    /// Functions that must be positive at assembly, since the rows alone would admit another branch.
    std::vector<ConstraintRow> branches{};
    std::vector<NamedCoordinate> coordinates{};
    /// Times (s) at which the joint engages and is released; both are events of the motion.
    double from = -std::numeric_limits<double>::infinity();
    double until = std::numeric_limits<double>::infinity();
    /// For a slot: points along its curve, in coordinates of `first`, for drawing.
    std::vector<Vector3> path{};

    bool acts_at(double t) const { return from <= t && t < until; }
};

/// Points and axes of a joint, in coordinates of each body (world coordinates for the world).
struct JointFrame {
    Vector3 point_first{};
    Vector3 point_second{};
    Vector3 axis_first{0, 0, 1};   ///< normalised by the makers; not zero
    Vector3 axis_second{0, 0, 1};
    /// Directions perpendicular to the axes, aligned at zero joint angle. If either is zero, the maker
    /// chooses both, from the given configurations if it takes them.
    Vector3 across_first{};
    Vector3 across_second{};
};

/// The frame of a joint at one world point and axis, for given configurations of the two bodies.
JointFrame joint_frame(const Matrix34& X_first, const Matrix34& X_second, const Vector3& at,
                       const Vector3& axis = {0, 0, 1});

// Each throws InputError (path `joint[name]`) if both bodies are the same and for a zero axis. If `second` is
// the world, the bodies are exchanged: Joint::second is always a body, and reactions act on it. X_first and
// X_second are the configurations at assembly; constraint violations are relative to the length `scale`.

/// Rigid connection: coincident points, and the present relative orientation, or the one in which axes and
/// across directions of both frames are aligned. 6 rows.
Joint weld(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
           const Matrix34& X_second, double scale = 1);
/// Hinge: rotation about one common axis. 5 rows. Coordinate: angle.
Joint revolute(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Slider: translation along one common axis, without rotation. 5 rows. Coordinate: displacement.
Joint prismatic(const std::string& name, int first, int second, const JointFrame& frame,
                const Matrix34& X_first, const Matrix34& X_second, double scale = 1);
/// Translation along and rotation about one common axis. 4 rows. Coordinates: angle, displacement.
Joint cylindrical(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Rotation about one common axis with translation along it by `pitch` (m, not zero) per turn, positive for
/// a right-handed thread. 5 rows. Coordinates: angle, displacement. Throws InputError `joint-pitch`.
Joint screw(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second, double pitch, double scale = 1);
/// Translation in a plane and rotation about its normal, the axis. 3 rows. Coordinate: angle.
Joint planar(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Cardan joint: two perpendicular axes, one fixed in each body, and a common point. 4 rows.
Joint universal(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Two shafts along the axes that meet in a point and turn by equal angles, at any angle between them. In
/// the present configuration their angles are defined as equal. 4 rows. Throws InputError `joint-bend` if the
/// shafts are bent by half a turn.
Joint constant_velocity(const std::string& name, int first, int second, const JointFrame& frame,
                        const Matrix34& X_first, const Matrix34& X_second, double scale = 1);
/// Ball joint: a common point. 3 rows.
Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// A point of the second body stays on a line of the first, along its axis. 2 rows. Coordinate:
/// displacement.
Joint point_on_line(const std::string& name, int first, int second, const JointFrame& frame,
                    double scale = 1);
/// A point of the second body stays in a plane of the first, whose normal is its axis. 1 row.
Joint point_in_plane(const std::string& name, int first, int second, const JointFrame& frame,
                     double scale = 1);
/// An axis of each body; the two stay parallel. 2 rows. Coordinate: angle.
Joint parallel_axes(const std::string& name, int first, int second, const JointFrame& frame,
                    double scale = 1);
/// An axis of each body; the two stay perpendicular. 1 row.
Joint perpendicular_axes(const std::string& name, int first, int second, const JointFrame& frame,
                         double scale = 1);
/// An axis of each body, at a constant angle (rad) to each other. 1 row. Throws InputError `joint-angle`
/// unless 0 < angle < pi.
Joint constant_angle(const std::string& name, int first, int second, const JointFrame& frame, double angle,
                     double scale = 1);
/// A massless rod of the given length between the two points. 1 row. Throws InputError if length <= 0.
Joint rod(const std::string& name, int first, int second, const JointFrame& frame, double length);

/// A point of the second body stays on a curve given in coordinates of the first. 2 rows. Throws InputError
/// like curve_rows().
Joint slot(const std::string& name, int first, int second, const Curve& curve, const Vector3& point_second,
           const Matrix34& X_first, const Matrix34& X_second, double scale = 1);

/// The coordinate with this name, or null.
const NamedCoordinate* find_coordinate(const Joint& joint, std::string_view name);

// Couplings of the coordinates of two joints, satisfied in the configuration X of all bodies. 1 row; the
// reaction acts on the second body of the second joint. Throw InputError: `joint-coordinate` if a joint lacks
// the coordinate, `joint-factor` for a factor of zero, `joint-self` for two joints of the same bodies, and
// the errors of coupling_row().

/// The angle of the second changes by `ratio` times that of the first; negative for external gears.
Joint gear(const std::string& name, const Joint& first, const Joint& second, double ratio,
           const Configurations& X);
/// The displacement of the rack changes by `radius` (m, either sign) times the angle of the pinion.
Joint rack_and_pinion(const std::string& name, const Joint& pinion, const Joint& rack, double radius,
                      const Configurations& X, double scale = 1);

}   // namespace gnu::visibility("default")]]livens
