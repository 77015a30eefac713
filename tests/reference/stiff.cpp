// SPDX-License-Identifier: BSD-3-Clause
// Stiff and damped bushings and torsion springs, and a car's wheel on a strut, against closed forms and
// Lagrange's equations.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::stiff_test {
namespace {

// Displacements of the chassis and turns of the lower arm, with rates, by Lagrange's equations in these two
// and the loop's closed form, integrated by DOP853 to 3e-14.
struct WheelRow {
    double t, z, turn, z_rate, turn_rate;
};
constexpr WheelRow wheel_rows[] = {
    {0.25, 0.050537221298483, -0.11057416291381, 0.2427170869932, -1.0226318431311},
    {0.5, 0.0081982942319132, -0.14742272972058, -0.45615006652366, 1.0073144201378},
    {1, 0.080114470396186, -0.23402438201172, -0.092257947754936, -0.55520787661703},
    {2, -0.044793845985094, 0.041993109074887, 0.066621050737115, 0.58015618527065}};

TEST(Suspension, AsShippedMeetsLagrangesEquations)
{
    const Shipped s = solve_example("wheel_suspension");
    const JointCoordinates all(s.model, s.solution.motion);
    for (const WheelRow& row : wheel_rows) {
        const std::vector<CoordinateValue> q = all.at(row.t);
        EXPECT_NEAR(q[0].value, row.z, 1e-9) << row.t;
        EXPECT_NEAR(q[0].rate, row.z_rate, 1e-8) << row.t;
        EXPECT_NEAR(q[1].value, row.turn, 1e-9) << row.t;
        EXPECT_NEAR(q[1].rate, row.turn_rate, 1e-8) << row.t;
    }
}

constexpr double k = 1e8, c = 2e4, w = 3, size = 1000;

/// m x'' + c x' + k x = size sin(w t) after its transients, which are gone in 10 ms.
double led(double m, double t)
{
    const double a = k - m * w * w, b = c * w, n = a * a + b * b;
    return size / n * (a * std::sin(w * t) - b * std::cos(w * t));
}

std::string held_by_bushing(const std::string& time)
{
    return R"toml(
[[body]]
name = "b"
mass = 2
inertia = [1, 1, 1]
[[load]]
name = "bushing"
type = "bushing"
between = ["world", "b"]
at = [0, 0, 0]
stiffness = [1e8, 1e8, 1e8, 1e8, 1e8, 1e8]
damping = [2e4, 2e4, 2e4, 2e4, 2e4, 2e4]
[[load]]
type = "force"
body = "b"
expression = ["0", "1000*sin(3*t)", "0"]
[[sensor]]
name = "b"
type = "point"
body = "b"
[[sensor]]
name = "bushing"
type = "load"
load = "bushing"
[time]
end = 2
)toml" + time;
}

std::string held_by_spring(const std::string& time)
{
    return R"toml(
[[body]]
name = "b"
mass = 2
inertia = [2, 2, 2]
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "b"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[load]]
name = "shaft"
type = "spring"
joint = "axle"
stiffness = 1e8
damping = 2e4
[[load]]
type = "actuator"
joint = "axle"
expression = "1000*sin(3*t)"
[time]
end = 2
)toml" + time;
}

/// Elements a thousand times as long as the vibration: the reaction follows the force, and does not ring.
TEST(Stiff, BushingsUnderRadauDoNotRing)
{
    const Solved s = solved(held_by_bushing("elements = 40\n[method]\nfamily = \"radau\"\ndegree = 4\n"));
    double before = 0;
    int turns = 0;
    for (const double t : s.solution.motion.mesh.ends) {
        if (t < 0.1) continue;
        const std::vector<double> read = s.sensed(t);
        const double off = read[1] - led(2, t);
        EXPECT_NEAR(off, 0, 1e-9 * size / k * 1e3) << t;
        if (off * before < 0 && std::abs(off) > 1e-12) ++turns;
        before = off;
        const double x_rate = (led(2, t + 1e-5) - led(2, t - 1e-5)) / 2e-5;
        const double force = k * led(2, t) + c * x_rate;
        EXPECT_TRUE(std::any_of(read.begin() + 6, read.end(), [&](double f) {
            return std::abs(std::abs(f) - std::abs(force)) < 1e-3;
        })) << t;
    }
    EXPECT_LT(turns, 5) << "ringing";
}

TEST(Stiff, TorsionSpringsUnderRadauFollowTheirTorque)
{
    const Solved s = solved(held_by_spring("elements = 40\n[method]\nfamily = \"radau\"\ndegree = 4\n"));
    for (const double t : {0.5, 1.0, 2.0})
        EXPECT_NEAR(s.coordinate("axle", "angle", t).value, led(2, t), 1e-12) << t;
}

/// To an accuracy the family is chosen, and what is said of the error holds.
TEST(Stiff, ToAnAccuracyTheyAreRight)
{
    const Solved bushing = solved(held_by_bushing("accuracy = 1e-9\noutput = [0.5, 1]\n")),
                 spring = solved(held_by_spring("accuracy = 1e-9\noutput = [0.5, 1]\n"));
    for (const double t : {0.5, 1.0, 2.0}) {
        EXPECT_NEAR(bushing.sensed(t)[1], led(2, t), 1e-9) << t;
        EXPECT_NEAR(spring.coordinate("axle", "angle", t).value, led(2, t), 1e-9) << t;
    }
}

}   // namespace
}   // namespace livens::tests::stiff_test
