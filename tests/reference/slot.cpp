// SPDX-License-Identifier: BSD-3-Clause
// Points on curves through points, against SciPy: CubicSpline by chord lengths (not-a-knot, periodic), and
// the one equation of motion of a bead on it by DOP853 to 1e-13.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/joints/spline_curve.h"
#include "reference/solved.h"

namespace livens::tests::slot_test {
namespace {

using std::numbers::pi;

TEST(Slot, ABeadSlidesDownAnOpenWire)
{
    const Solved s = solved(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "bead"
shape = { point = true }
mass = 1.3
position = [0, 0, 1]
[[joint]]
name = "wire"
type = "slot"
between = ["world", "bead"]
curve = { points = [[0, 0, 1], [0.4, 0.1, 0.6], [0.7, 0.3, 0.4], [1, 0.2, 0.5], [1.4, 0, 0.2], [2, -0.2, 0]] }
[time]
end = 1
output = 0.5
accuracy = 1e-9
)");
    const BodySample half = sample_bodies(s.model, s.solution.motion, 0.5)[0],
                     end = sample_bodies(s.model, s.solution.motion, 1)[0];
    EXPECT_LT(norm(half.position - Vector3{0.20193151932141448, -0.06158287116198019, 0.8647625681613322}),
              1e-9);
    EXPECT_LT(norm(half.velocity - Vector3{1.0462810050571334, 0.3763942821804347, -1.1903704530410564}),
              1e-8);
    EXPECT_LT(norm(end.position - Vector3{1.246365788736722, 0.07325046554656095, 0.38076863314562825}),
              3e-9);
    EXPECT_LT(norm(end.velocity - Vector3{2.300259427044692, -1.1527400852365883, -2.3514498255037153}),
              3e-8);
}

TEST(Slot, ABodyGoesRoundAClosedTrackTwice)
{
    std::string points;
    for (int i = 0; i < 12; ++i) {
        const double a = i * pi / 6;
        points += (i == 0 ? "[" : ", [") + to_text(std::cos(a)) + ", " + to_text(std::sin(a)) + ", " +
                  to_text(0.3 * std::sin(2 * a)) + "]";
    }
    // The point is the body's centre of mass, about which it turns freely: that does not matter.
    const Solved s = solved(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "car"
mass = 2
inertia = [0.1, 0.2, 0.25]
center_of_mass = [0.1, 0, 0]
position = [0.9, 0, 0]
velocity = [0, 4.251741271649922, 2.6311017006092157]
[[joint]]
name = "track"
type = "slot"
between = ["world", "car"]
point = [0.1, 0, 0]
curve = { closed = true, points = [)" +
                            points + "] }\n[time]\nend = 3\naccuracy = 1e-8\n");
    const BodySample end = sample_bodies(s.model, s.solution.motion, 3)[0];
    EXPECT_LT(norm(end.center_of_mass - Vector3{0.4883569794807941, 0.8729837901884117, 0.2561138690333518}),
              1e-7);
    EXPECT_LT(balance(s.model, s.solution.motion).energy_drift.back(), 1e-6);
}

TEST(Slot, NormalsOfASpatialCurveDoNotTurnAboutIt)
{
    std::vector<Vector3> points;
    for (int i = 0; i < 8; ++i) points.push_back({std::cos(0.6 * i), std::sin(0.6 * i), 0.2 * i});
    const Curve curve = spline_curve(points, false);
    constexpr double h = 1e-4;
    for (double s = 0.1; s < curve.last - 0.1; s += 0.037) {
        const CurvePoint at = curve.at(s), ahead = curve.at(s + h), behind = curve.at(s - h);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(norm(at.normals[k]), 1, 1e-14);
            EXPECT_NEAR(dot(at.normals[k], at.first), 0, 1e-14);
            const Vector3 rate = 1 / (2 * h) * (ahead.normals[k] - behind.normals[k]);
            EXPECT_NEAR(dot(rate, at.normals[1 - k]), 0, 1e-6) << s;
        }
        EXPECT_NEAR(dot(at.normals[0], at.normals[1]), 0, 1e-14);
        EXPECT_LT(norm(1 / (2 * h) * (ahead.x - behind.x) - at.first), 1e-6);
    }
}

TEST(Slot, WrongCurvesAreTold)
{
    const auto code = [](const std::vector<Vector3>& points, bool is_closed) -> std::string {
        try {
            spline_curve(points, is_closed);
        } catch (const InputError& error) {
            return error.complaint().code;
        }
        return "";
    };
    EXPECT_EQ(code({{0, 0, 0}}, false), "curve-points");
    EXPECT_EQ(code({{0, 0, 0}, {1, 0, 0}}, true), "curve-points");
    EXPECT_EQ(code({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, false), "curve-points");
    EXPECT_EQ(code({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, false), "curve-straight-back");
    EXPECT_EQ(code({{0, 0, 0}, {1, 0, 0}}, false), "");
    EXPECT_EQ(code({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}}, true), "");
}

}   // namespace
}   // namespace livens::tests::slot_test
