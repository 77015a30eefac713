// SPDX-License-Identifier: BSD-3-Clause
// Frames of joints on both bodies and the rows that joints are made of: held points, axes, lines and planes
// (theory.md, "Joints are quadratic forms"). Axes are unit vectors of the bodies, so rows have scale 1 or the
// model's length.
#include <algorithm>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"

namespace livens {

namespace {

Vector3 unit_axis(const Vector3& axis, const std::string& path)
{
    require_finite(axis, path, "an axis");
    const double largest = std::max({std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])});
    if (largest == 0)
        throw InputError(
            {"axis-zero", path, "the axis of a joint must not be zero", to_text(axis), "", "", ""});
    Vector3 unit{};
    for (int i = 0; i < 3; ++i) unit[i] = axis[i] / largest;   // squares neither overflow nor vanish
    const double length = norm(unit);
    for (int i = 0; i < 3; ++i) unit[i] /= length;
    return unit;
}

}   // namespace

JointFrame joint_frame(const Matrix34& X_first, const Matrix34& X_second, const Vector3& at,
                       const Vector3& axis)
{
    const Matrix3 to_first = transpose(directors(X_first)), to_second = transpose(directors(X_second));
    return {to_first * (at - X_first.column(0)), to_second * (at - X_second.column(0)), to_first * axis,
            to_second * axis};
}

Joint multibody_internal::start_joint(const std::string& name, const char* type, int first, int second,
                                      JointFrame& frame, double scale)
{
    const std::string path = "joint[" + name + "]";
    if (first == second)
        throw InputError({"joint-self", path, "a joint needs two different bodies", "", "", "",
                          first == world ? "one of them must be a body"
                                         : "join the body to the world or to another body"});
    if (!(scale > 0) || !std::isfinite(scale))
        throw InputError({"joint-scale", path, "the length that violations are measured by must be positive",
                          to_text(scale), "> 0", "", ""});
    require_finite(frame.point_first, path, "the point on the first body");
    require_finite(frame.point_second, path, "the point on the second body");
    if (second == world) {
        std::swap(first, second);
        std::swap(frame.point_first, frame.point_second);
        std::swap(frame.axis_first, frame.axis_second);
        std::swap(frame.across_first, frame.across_second);
        // Exchanged bodies see angles and displacements with the other sign; reversed axes give back the
        // stated one.
        frame.axis_first *= -1;
        frame.axis_second *= -1;
    }
    Joint joint;
    joint.name = name;
    joint.type = type;
    joint.first = first;
    joint.second = second;
    joint.point_first = frame.point_first;
    joint.point_second = frame.point_second;
    return joint;
}

void multibody_internal::normalise_axes(const Joint& joint, JointFrame& frame)
{
    frame.axis_first = unit_axis(frame.axis_first, "joint[" + joint.name + "]");
    frame.axis_second = unit_axis(frame.axis_second, "joint[" + joint.name + "]");
    const bool is_given =
        dot(frame.across_first, frame.across_first) > 0 && dot(frame.across_second, frame.across_second) > 0;
    // A stated direction is made perpendicular to the axis; without one any will do, the same each time.
    const auto across = [&](const Vector3& given, const Vector3& axis) {
        return is_given ? unit_axis(given - dot(given, axis) * axis, "joint[" + joint.name + "]")
                        : across_axis(axis).u;
    };
    frame.across_first = across(frame.across_first, frame.axis_first);
    frame.across_second = across(frame.across_second, frame.axis_second);
}

void multibody_internal::fix_across(JointFrame& frame, int first, int second, const Matrix34& X_first,
                                    const Matrix34& X_second, const std::string& name)
{
    if (dot(frame.across_first, frame.across_first) > 0 && dot(frame.across_second, frame.across_second) > 0)
        return;
    const std::string path = "joint[" + name + "]";
    const Vector3 axis_first = unit_axis(frame.axis_first, path),
                  axis_second = unit_axis(frame.axis_second, path);
    const Matrix34 &X = first == world ? world_configuration : X_first,
                   &Y = second == world ? world_configuration : X_second;
    const Vector3 a = X * direction(axis_first), b = Y * direction(axis_second);
    // The turn below divides by 1 + a . b, which vanishes where the axes are opposite.
    constexpr double opposite = 1e-6;
    if (1 + dot(a, b) < opposite)
        throw InputError({"joint-bend", path + ".axes",
                          "the axes of joint '" + name + "' point in opposite directions", "", "",
                          "there is no shortest turn from one to the other",
                          "reverse one of the two axes, or turn one of the bodies"});
    frame.across_first = across_axis(axis_first).u;
    // The turn about a x b that takes a to b, of the direction across a.
    const Vector3 u = X * direction(frame.across_first), sum = a + b;
    const Vector3 turned = u - (dot(sum, u) / (1 + dot(a, b))) * sum + 2 * dot(a, u) * b;
    frame.across_second = transpose(directors(Y)) * turned;
}

AxisPair multibody_internal::across_axis(const Vector3& axis)
{
    int smallest = 0;
    // The unit vector of the smallest component is the farthest from the axis, so no digits are lost in
    // taking the axis off.
    for (int i = 1; i < 3; ++i)
        if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
    Vector3 u{};
    u[smallest] = 1;
    u -= axis[smallest] * axis;
    u = unit_axis(u, "");
    return {u, cross(axis, u)};
}

void multibody_internal::hold_point(Joint& joint, double scale)
{
    for (ConstraintRow& row : coincidence_rows(joint.first, point(joint.point_first), joint.second,
                                               point(joint.point_second), scale))
        joint.rows.push_back(std::move(row));
}

void multibody_internal::hold_perpendicular(Joint& joint, const Vector3& a, const Vector3& b,
                                            const char* label)
{
    joint.rows.push_back(inner_product_row(joint.first, direction(a), joint.second, direction(b), 0, 1));
    joint.rows.back().label = label;
}

void multibody_internal::hold_axis(Joint& joint, const JointFrame& frame)
{
    joint.axis_first = frame.axis_first;
    joint.axis_second = frame.axis_second;
    // Two inner products hold an axis; the third direction, along it, would add nothing but a dependent row.
    const AxisPair across = across_axis(frame.axis_first);
    hold_perpendicular(joint, across.u, frame.axis_second, "axis 1");
    hold_perpendicular(joint, across.v, frame.axis_second, "axis 2");
}

void multibody_internal::hold_spin(Joint& joint, const JointFrame& frame)
{
    const Vector3 v = cross(frame.axis_second, frame.across_second);
    hold_perpendicular(joint, frame.across_first, v, "turn");
    // The row of the turn holds at half a turn as well: the branch has to be positive.
    joint.branches.push_back(inner_product_row(joint.first, direction(frame.across_first), joint.second,
                                               direction(frame.across_second), 0, 1));
    joint.branches.back().label = "turn";
}

/// The line belongs to the body that was given first. Where start_joint() has exchanged bodies that is the
/// second one, and the axis has been reversed.
Slide multibody_internal::slide_of(const Joint& joint, const JointFrame& frame, bool exchanged)
{
    if (exchanged)
        return {joint.second, joint.point_second, -frame.axis_second, joint.first, joint.point_first};
    return {joint.first, joint.point_first, frame.axis_first, joint.second, joint.point_second};
}

void multibody_internal::hold_in_plane(Joint& joint, const Slide& slide, const Vector3& n, const char* label,
                                       double scale)
{
    joint.rows.push_back(plane_row(slide.body, direction(n), point(slide.point), slide.other,
                                   point(slide.other_point), 0, scale));
    joint.rows.back().label = label;
}

void multibody_internal::hold_on_line(Joint& joint, const Slide& slide, double scale)
{
    const AxisPair across = across_axis(slide.axis);
    hold_in_plane(joint, slide, across.u, "across 1", scale);
    hold_in_plane(joint, slide, across.v, "across 2", scale);
}

NamedCoordinate multibody_internal::angle_coordinate(const Joint& joint, const JointFrame& frame)
{
    const Vector3 u = frame.across_first, v = cross(frame.axis_first, u), w = frame.across_second;
    NamedCoordinate angle{"angle",
                          angle_between(joint.first, direction(u), direction(v), joint.second, direction(w))};
    angle.apart = turn_between(joint.first, direction(u), direction(v), joint.second, direction(w),
                               direction(cross(frame.axis_second, w)));
    return angle;
}

NamedCoordinate multibody_internal::displacement_coordinate(const Slide& slide)
{
    return {"displacement", displacement_along(slide.body, direction(slide.axis), point(slide.point),
                                               slide.other, point(slide.other_point))};
}

}   // namespace livens
