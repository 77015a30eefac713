// SPDX-License-Identifier: BSD-3-Clause
// What the makers of joints share.
#pragma once

#include <string>

#include "livens/multibody/joints.h"

namespace livens::inline multibody_internal {

/// A joint without rows, its bodies, points and scale checked. If `second` is the world the roles of the two
/// are exchanged, in `frame` too: reactions are those on the body. Its axes are turned round then, so that
/// coordinates about and along them stay those that were asked for.
Joint start_joint(const std::string& name, const char* type, int first, int second, JointFrame& frame,
                  double scale);

/// Both axes of the frame to length one, and unit directions across each; throws InputError `axis-zero`.
void normalise_axes(const Joint& joint, JointFrame& frame);

/// Directions across as the bodies stand, unless the frame has them: the same direction in space where the
/// axes are parallel, else the second's after the shortest turn of the first axis to the second. Before
/// start_joint(). Throws InputError `joint-bend` for axes that point in opposite directions.
void fix_across(JointFrame& frame, int first, int second, const Matrix34& X_first, const Matrix34& X_second,
                const std::string& name);

/// Two unit axes perpendicular to a unit axis and to each other; exact coordinate axes for a coordinate axis.
struct AxisPair {
    Vector3 u{}, v{};
};
AxisPair across_axis(const Vector3& axis);

/// Adds X_second point_second - X_first point_first = 0.
void hold_point(Joint& joint, double scale);

/// Adds the row (X_first a) . (X_second b) = 0.
void hold_perpendicular(Joint& joint, const Vector3& a, const Vector3& b, const char* label);

// Of frames with normalised axes:

/// Adds two rows: the second's axis stays parallel to the first's, which consistent_start() does not take the
/// wrong way round.
void hold_axis(Joint& joint, const JointFrame& frame);
/// Adds the row of the turn about an axis that is held already.
void hold_spin(Joint& joint, const JointFrame& frame);

/// What a point slides along: a line or a plane of one body.
struct Slide {
    int body;
    Vector3 point, axis;   ///< of the line, or the plane's normal
    int other;
    Vector3 other_point;   ///< what slides
};
/// The first's axis, in the order of bodies that the maker was told; `exchanged` says that it is not that of
/// the joint.
Slide slide_of(const Joint& joint, const JointFrame& frame, bool exchanged = false);

/// Adds the row that keeps the point in the plane with the normal n.
void hold_in_plane(Joint& joint, const Slide& slide, const Vector3& n, const char* label, double scale);
/// Adds two of these across the axis.
void hold_on_line(Joint& joint, const Slide& slide, double scale);

NamedCoordinate angle_coordinate(const Joint& joint, const JointFrame& frame);
NamedCoordinate displacement_coordinate(const Slide& slide);

}   // namespace livens::inline multibody_internal
