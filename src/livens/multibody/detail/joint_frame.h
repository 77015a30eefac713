// SPDX-License-Identifier: BSD-3-Clause
// What the makers of joints share.
#pragma once

#include <string>

#include "livens/multibody/joints.h"

namespace livens {

/// A joint without rows, its bodies, points and scale checked. If `second` is the world the roles of the two
/// are exchanged, in `frame` too: reactions are those on the body.
Joint start_joint(const std::string& name, const char* type, int first, int second, JointFrame& frame,
                  double scale);

/// Both axes of the frame to length one; throws InputError `axis-zero`.
void normalise_axes(const Joint& joint, JointFrame& frame);

/// Two unit axes perpendicular to a unit axis and to each other; exact coordinate axes for a coordinate axis.
struct AxisPair {
    Vector3 u{}, v{};
};
AxisPair perpendicular_axes(const Vector3& axis);

/// Adds X_second point_second - X_first point_first = 0.
void hold_point(Joint& joint, double scale);

/// Adds the row (X_first a) . (X_second b) = 0.
void hold_perpendicular(Joint& joint, const Vector3& a, const Vector3& b, const char* label);

}   // namespace livens
