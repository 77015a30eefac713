// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/detail/joint_frame.h"
#include "livens/multibody/detail/wording.h"

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

Joint start_joint(const std::string& name, const char* type, int first, int second, JointFrame& frame,
                  double scale)
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

void normalise_axes(const Joint& joint, JointFrame& frame)
{
    frame.axis_first = unit_axis(frame.axis_first, "joint[" + joint.name + "]");
    frame.axis_second = unit_axis(frame.axis_second, "joint[" + joint.name + "]");
}

AxisPair perpendicular_axes(const Vector3& axis)
{
    int smallest = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
    Vector3 u{};
    u[smallest] = 1;
    u -= axis[smallest] * axis;
    u = unit_axis(u, "");
    return {u, cross(axis, u)};
}

void hold_point(Joint& joint, double scale)
{
    for (ConstraintRow& row : coincidence_rows(joint.first, point(joint.point_first), joint.second,
                                               point(joint.point_second), scale))
        joint.rows.push_back(std::move(row));
}

void hold_perpendicular(Joint& joint, const Vector3& a, const Vector3& b, const char* label)
{
    joint.rows.push_back(inner_product_row(joint.first, direction(a), joint.second, direction(b), 0, 1));
    joint.rows.back().label = label;
}

}   // namespace livens
