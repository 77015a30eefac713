// SPDX-License-Identifier: BSD-3-Clause
// Every joint bears what it holds: forces and moments by hand, in axes of the world and of the joint.
#include <gtest/gtest.h>

#include <numbers>

#include "livens/base/text.h"
#include "reference/solved.h"

namespace livens::tests::statics_test {
namespace {

const Vector3 at{0.3, -0.2, 0.4}, center{0.9, 0.5, -0.1};
const Vector3 a{0.48, 0.6, 0.64}, b{0.8, 0, -0.6}, n = cross(a, b);
const Vector3 some{3, -1, 2}, other{-0.5, 2, 1.5};

std::string text_of(const Vector3& v)
{
    return "[" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]";
}

Vector3 across(const Vector3& v, const Vector3& axis) { return v - dot(v, axis) * axis; }

struct Held {
    const char* type;
    std::string keys;        ///< of the joint between the world and the body
    Vector3 force, moment;   ///< about the joint's point, world axes: what it holds, by hand
};

std::vector<Held> all_joints()
{
    const std::string here = "at = " + text_of(at) + "\n", on_a = here + "axis = " + text_of(a) + "\n";
    const std::string axes = "axes = [" + text_of(a) + ", " + text_of(b) + "]\n";
    constexpr double pitch = 0.5, thrust = 7;
    const Vector3 from = at - 2.0 * n;
    return {
        {"weld", here, some, other},
        {"revolute", on_a, some, across(other, a)},
        {"prismatic", on_a, across(some, a), other},
        {"cylindrical", on_a, across(some, a), across(other, a)},
        {"screw", on_a + "pitch = 0.5\n", across(some, a) + thrust * a,
         across(other, a) - thrust * pitch / (2 * std::numbers::pi) * a},
        {"planar", on_a, thrust * a, across(other, a)},
        {"universal", here + axes, some, thrust * n},
        {"constant_velocity", here + "axes = [" + text_of(a) + ", " + text_of(a) + "]\n", some, thrust * a},
        {"spherical", here, some, {}},
        {"point_on_line", on_a, across(some, a), {}},
        {"point_in_plane", on_a, thrust * a, {}},
        {"parallel_axes", "axis = " + text_of(a) + "\n", {}, across(other, a)},
        {"perpendicular_axes", axes, {}, thrust * n},
        {"constant_angle", axes, {}, thrust * n},
        {"slot",
         "curve = { points = [" + text_of(at - a) + ", " + text_of(at + a) + "] }\npoint = POINT\n",
         across(some, a),
         {}},
        {"rod", "points = [" + text_of(from) + ", POINT]\n", thrust * n, {}}};
}

TEST(Statics, EveryJointBearsWhatItHolds)
{
    const Vector3 turn{0.4, -0.7, 0.3};
    const Matrix3 D = directors_from_rotation_vector(turn);
    for (Held held : all_joints()) {
        SCOPED_TRACE(held.type);
        const std::size_t point = held.keys.find("POINT");   // the joint's, in body coordinates
        if (point != std::string::npos) held.keys.replace(point, 5, text_of(transpose(D) * (at - center)));
        const bool is_free = norm(held.force) == 0;   // then the joint has no point that matters
        const Vector3 torque = held.moment - (is_free ? Vector3{} : cross(center - at, held.force));
        const std::string type = held.type;
        const bool placed = type == "perpendicular_axes" || type == "constant_angle";
        const Solved s = solved(R"(
[[body]]
name = "body"
mass = 2
inertia = [0.4, 0.5, 0.6]
position = )" + text_of(center) +
                                "\nrotation_vector = " + text_of(turn) + R"(
[[joint]]
name = "joint"
between = ["world", "body"]
type = ")" + type + "\"\n" + (placed ? "at = " + text_of(at) + "\n" : "") +
                                held.keys + R"(
[[load]]
type = "force"
body = "body"
value = )" + text_of(held.force) +
                                R"(
[[load]]
type = "torque"
body = "body"
value = )" + text_of(torque) + R"(
[time]
end = 0.5
elements = 2
)");
        for (const double t : {0.0, 0.5}) {
            const Reaction r = s.reaction("joint", t);
            EXPECT_LT(norm(r.force + held.force), 1e-12 * (1 + norm(held.force)));
            EXPECT_LT(norm(r.torque + held.moment), 1e-12 * (1 + norm(held.moment) + norm(held.force)));
            // in axes of the joint: along a, b and n
            for (const Vector3& axis : {a, b, n})
                EXPECT_NEAR(dot(r.force, axis), -dot(held.force, axis), 1e-11);
        }
        const State state = s.solution.motion.at(0.5);
        EXPECT_LT(norm(state.X[0].column(0) - center), 1e-12) << "nothing moves";
        EXPECT_LT(norm(state.V[0]), 1e-12);
    }
}

}   // namespace
}   // namespace livens::tests::statics_test
