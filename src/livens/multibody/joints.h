// SPDX-License-Identifier: BSD-3-Clause
// Joints: names for sets of constraint rows.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/acting_times.h"
#include "livens/multibody/constraint.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/multibody/rope.h"

namespace [[gnu::visibility("default")]] livens {

/// Lines that joints follow, to be drawn.
struct JointLine {
    /// Of a slot: points of its whole curve in coordinates of `first`, in order.
    std::vector<Vector3> path{};
    /// Of a rope: the points that it runs over.
    std::vector<BodyPoint> over{};
};

/// How a joint begins to act where bodies move otherwise than it lets them: with an impact, which changes
/// velocities at once (docs/theory.md, "Impacts").
struct ImpactLaw {
    double restitution = 0;   ///< speed apart behind it by speed together before it, 0 to 1
    /// The side on which its one row is open: the sign of the row's values there. The joint pushes to this
    /// side alone. 0: it holds both ways, all its rows, with restitution 0.
    int open_side = 0;
    bool goes_together = false;   ///< with others at the same instant, by Moreau's law
};

/// A joint between `first` (a body or the world) and `second` (a body). A new kind of joint is a new function
/// that fills in rows; nothing else in livens asks for the kind.
///
/// Reactions are what the joint exerts on `second`, at `point_second`, in world axes.
struct Joint : JointLine, ActingTimes {
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
    std::optional<ImpactLaw> impact{};   ///< none: it has to find bodies as it holds them
    std::vector<NamedCoordinate> coordinates{};
    /// Beside its coordinates, of a ball joint: the components of its rotation vector, which what is asked
    /// for them takes as coordinates, and its length, which is only read.
    std::vector<NamedCoordinate> readings{};
    /// Of a ball joint with readings, in coordinates of `first` and `second`.
    TriadPair triads{};
    /// One of its coordinates, or behind them of its readings.
    const NamedCoordinate& coordinate(std::size_t k) const
    {
        return k < coordinates.size() ? coordinates[k] : readings[k - coordinates.size()];
    }
};

/// Where a joint sits, in coordinates of each body. For the world they are world coordinates.
struct JointFrame {
    Vector3 point_first{};
    Vector3 point_second{};
    Vector3 axis_first{0, 0, 1};   ///< normalised by the makers; not zero
    Vector3 axis_second{0, 0, 1};
    /// Directions across the axes that point the same way where the joint's angle is zero. Where one is zero,
    /// the maker chooses both: as the bodies stand, if it is told how.
    Vector3 across_first{};
    Vector3 across_second{};
};

/// The frame of a joint at one world point and axis in the given configuration of the two bodies.
JointFrame joint_frame(const Matrix34& X_first, const Matrix34& X_second, const Vector3& at,
                       const Vector3& axis = {0, 0, 1});

// Each throws InputError (path `joint[name]`) for a body joined to itself and for a zero axis. If `second` is
// the world, the roles are exchanged: Joint::second is always a body, and reactions are those on it. X_first
// and X_second are the configurations at assembly; `scale` is a length that violations are measured by.

/// Everything held: coincident points, and three pairs of axes that are perpendicular now, or where the
/// across directions of the frame point the same way. 6 rows.
Joint weld(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
           const Matrix34& X_second, double scale = 1);
/// Rotation about one common axis. 5 rows. Coordinate: angle.
Joint revolute(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Slides along one common axis and turns as little as a weld. 5 rows. Coordinate: displacement.
Joint prismatic(const std::string& name, int first, int second, const JointFrame& frame,
                const Matrix34& X_first, const Matrix34& X_second, double scale = 1);
/// Slides along and turns about one common axis. 4 rows. Coordinates: angle, displacement.
Joint cylindrical(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Slides along and turns about one common axis by `pitch` (m, not zero) a turn, positive for a right-handed
/// thread, from where it stands. 5 rows. Coordinates: angle, displacement. Throws InputError `joint-pitch`.
Joint screw(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second, double pitch, double scale = 1);
/// Two planes that stay in one, their common normal the axis. 3 rows. Coordinate: angle.
Joint planar(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Two perpendicular axes, one fixed in each body, and a common point. 4 rows. Coordinates: angle_1, of the
/// cross about the axis on the first body against this body, and angle_2, of the second body about its axis
/// against the cross.
Joint universal(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);
/// Two shafts, along the axes, that meet in a point and turn equally, however they are bent. Where they
/// stand now, one bend of the second takes it there. 4 rows. Throws InputError `joint-bend` for shafts that
/// are bent by half a turn.
Joint constant_velocity(const std::string& name, int first, int second, const JointFrame& frame,
                        const Matrix34& X_first, const Matrix34& X_second, double scale = 1);
/// A common point. 3 rows.
Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, double scale = 1);

/// How a ball joint is turned: by two triads, and by angles about their axes.
struct BallTurn {
    TriadPair triads;
    std::string angles = {};   ///< "xyz", "zyx" and the like: three different axes; empty: it has no angles
};
/// The same with readings: the rotation vector from the first triad to the second and its length, and with
/// coordinates angle_1, angle_2, angle_3 if it has angles. Throws InputError `joint-angles`.
Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, const BallTurn& turn,
                const Matrix34& X_first, const Matrix34& X_second, double scale = 1);
/// A point of the second body on a line of the first, which the first's axis is. 2 rows. Coordinate:
/// displacement.
Joint point_on_line(const std::string& name, int first, int second, const JointFrame& frame,
                    double scale = 1);
/// A point of the second body in a plane of the first, whose axis is the normal. 1 row.
Joint point_in_plane(const std::string& name, int first, int second, const JointFrame& frame,
                     double scale = 1);
/// An axis of each body that stay parallel. 2 rows. Coordinate: angle.
Joint parallel_axes(const std::string& name, int first, int second, const JointFrame& frame,
                    double scale = 1);
/// An axis of each body that stay perpendicular. 1 row.
Joint perpendicular_axes(const std::string& name, int first, int second, const JointFrame& frame,
                         double scale = 1);
/// An axis of each body at a constant angle (rad). 1 row. Throws InputError `joint-angle` unless
/// 0 < angle < pi.
Joint constant_angle(const std::string& name, int first, int second, const JointFrame& frame, double angle,
                     double scale = 1);
/// A massless rod of the given length between the two points. 1 row. Throws InputError if length <= 0.
Joint rod(const std::string& name, int first, int second, const JointFrame& frame, double length);
/// A rope over two or more points, in this order, along which it runs freely: without mass and stretch, and
/// always taut. The sum of its spans is `length`. 1 row; the reaction is that on the last of its bodies, at
/// its last point there. X: of all bodies as they stand. Throws InputError `rod-length`, and what
/// check_rope() throws.
Joint rod(const std::string& name, const std::vector<BodyPoint>& over, double length,
          const Configurations& X);

/// A point of the second body slides along a curve in coordinates of the first. 2 rows. Throws InputError as
/// curve_rows() does.
Joint slot(const std::string& name, int first, int second, const Curve& curve, const Vector3& point_second,
           const Matrix34& X_first, const Matrix34& X_second, double scale = 1);

/// The coordinate of that name, or null; of a ball joint also a component of its rotation vector.
const NamedCoordinate* find_coordinate(const Joint& joint, std::string_view name);

// Joints between the coordinates of others, a sum of which stays as it is in the configuration X of all
// bodies. 1 row; the reaction is that on the last joint's second body. Throw InputError: `joint-coordinate`
// where a joint lacks the coordinate, `joint-factor` for zero, `joint-self` for two wheels that one joint
// joins, and what coupling_row() throws.

/// The angle of the second changes by `ratio` times that of the first: negative where wheels mesh outside.
Joint gear(const std::string& name, const Joint& first, const Joint& second, double ratio,
           const Configurations& X);
/// The displacement of the rack changes by `radius` (m, either sign) times the angle of the pinion.
Joint rack_and_pinion(const std::string& name, const Joint& pinion, const Joint& rack, double radius,
                      const Configurations& X, double scale = 1);

/// A coordinate of a joint, "angle" (rad) or "displacement" (m), and what it is multiplied by.
struct CoupledJoint {
    double factor = 0;
    const Joint* joint = nullptr;
    std::string coordinate = {};
};
/// sum_k factor_k coordinate_k stays as it is: joints that follow others, tendons, differentials, pulleys.
/// `length`: of the model, by which displacements are measured beside angles. Also throws InputError
/// `coupling-terms` for less than two coordinates, one of them twice, and more than RowBodies::most bodies.
Joint coupling(const std::string& name, const std::vector<CoupledJoint>& terms, const Configurations& X,
               double length = 1);
/// sum_k factor_k coordinate_k = law(coordinate of `of`), whose factor does not count: cams, levers, what no
/// sum says. One term is enough. Coordinates are what their joints call them, so that the start need not
/// fulfil it, and the law is judged where a motion begins: consistent_start(). Also throws InputError
/// `coupling-terms` for a coordinate on both sides, and `coupling-law` for a law that positions do not tell.
Joint coupling(const std::string& name, const std::vector<CoupledJoint>& terms, const CoupledJoint& of,
               const CoordinateLaw& law, const Configurations& X, double length = 1);

}   // namespace gnu::visibility("default")]]livens
