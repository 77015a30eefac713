// SPDX-License-Identifier: BSD-3-Clause
// Every joint of the library, one entry a joint: the kit runs over this list.
#include "properties/joint_kit.h"

namespace livens {

namespace {

JointFrame anywhere(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    return joint_frame(X_first, X_second, random.vector(), random.unit());
}

JointFrame with_perpendicular_axes(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    const Vector3 at = random.vector(), axis = random.unit();
    Vector3 across = cross(axis, random.unit());
    across *= 1 / norm(across);
    JointFrame frame = joint_frame(X_first, X_second, at, axis);
    frame.axis_second = joint_frame(X_first, X_second, at, across).axis_second;
    return frame;
}

JointFrame with_points_apart(Random& random, const Matrix34&, const Matrix34&)
{
    return {random.vector(), random.vector(), random.unit(), random.unit()};
}

}   // namespace

const std::vector<JointCase>& joint_cases()
{
    static const std::vector<JointCase> cases{
        {"weld", 6, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) { return weld("j", first, second, frame, X_first, X_second); }},
        {"revolute", 5, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return revolute("j", first, second, frame);
         }},
        {"universal", 4, with_perpendicular_axes,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return universal("j", first, second, frame);
         }},
        {"spherical", 3, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return spherical("j", first, second, frame);
         }},
        {"rod", 1, with_points_apart,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) {
             const double length =
                 norm(X_second * point(frame.point_second) - X_first * point(frame.point_first));
             return rod("j", first, second, frame, length);
         }},
    };
    return cases;
}

}   // namespace livens
