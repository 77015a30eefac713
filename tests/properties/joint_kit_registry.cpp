// SPDX-License-Identifier: BSD-3-Clause
// Every joint of the library, one entry a joint: the kit runs over this list.
#include <cmath>

#include "livens/multibody/joints/spline_curve.h"
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

/// Bent at random, at a common point.
JointFrame with_two_axes(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    JointFrame frame = joint_frame(X_first, X_second, random.vector());
    frame.axis_first = random.unit();
    frame.axis_second = random.unit();
    return frame;
}

/// The second point beyond the first along the axis, or across it.
template <bool is_across>
JointFrame slid(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    const Vector3 at = random.vector(), axis = random.unit();
    JointFrame frame = joint_frame(X_first, X_second, at, axis);
    const Vector3 there = at + (is_across ? cross(axis, random.vector()) : random.number() * axis);
    frame.point_second = joint_frame(X_first, X_second, there).point_second;
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
        {"prismatic", 5, slid<false>,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) { return prismatic("j", first, second, frame, X_first, X_second); }},
        {"cylindrical", 4, slid<false>,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return cylindrical("j", first, second, frame);
         }},
        {"screw", 5, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) { return screw("j", first, second, frame, X_first, X_second, 2); }},
        {"planar", 3, slid<true>,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return planar("j", first, second, frame);
         }},
        {"constant_velocity", 4, with_two_axes,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) {
             return constant_velocity("j", first, second, frame, X_first, X_second);
         }},
        {"point_on_line", 2, slid<false>,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return point_on_line("j", first, second, frame);
         },
         false},
        {"slot", 2, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) {
             const Vector3 here = frame.point_first;   // on the curve, beyond its third point
             std::vector<Vector3> points{
                 {-1, 0.2, 0.3}, {-0.5, -0.2, 0}, {0, 0, 0}, {0.6, 0.5, -0.3}, {1.2, 0.1, 0.4}};
             const Curve curve = spline_curve(points, false);
             const Vector3 shift = here - curve.at(1.4).x;
             for (Vector3& p : points) p += shift;
             return slot("j", first, second, spline_curve(points, false), frame.point_second, X_first,
                         X_second);
         },
         false},
        {"point_in_plane", 1, slid<true>,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return point_in_plane("j", first, second, frame);
         },
         false},
        {"parallel_axes", 2, anywhere,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return parallel_axes("j", first, second, frame);
         }},
        {"perpendicular_axes", 1, with_perpendicular_axes,
         [](int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&) {
             return perpendicular_axes("j", first, second, frame);
         }},
        {"constant_angle", 1, with_two_axes,
         [](int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second) {
             const double cosine =
                 dot(X_first * direction(frame.axis_first), X_second * direction(frame.axis_second));
             return constant_angle("j", first, second, frame, std::acos(cosine));
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
