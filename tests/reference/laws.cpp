// SPDX-License-Identifier: BSD-3-Clause
// Loads by laws and expressions, and what sensors read, against closed forms, as scenarios say them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/nodal/window.h"
#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::laws_test {
namespace {

using std::numbers::pi;

/// A body on a slide along x.
const std::string slide = R"(
[[body]]
name = "b"
mass = 2
inertia = [1, 1, 1]
position = [0, 0, 0]
[[joint]]
name = "slide"
type = "prismatic"
between = ["world", "b"]
at = [0, 0, 0]
axis = [1, 0, 0]
)";

std::string moving(const std::string& body, const std::string& velocity)
{
    const std::string place = "position = [0, 0, 0]\n";
    std::string text = body;
    return text.insert(text.find(place) + place.size(), "velocity = " + velocity + "\n");
}

TEST(Laws, AnOscillatorByAnExpressionIsThatOfASpring)
{
    const Solved s = solved(moving(slide, "[1, 0, 0]") + R"(
[[load]]
type = "actuator"
joint = "slide"
inputs = { x = "slide.displacement", v = "slide.displacement_rate" }
expression = "2*sin(3*t) - 32*x - 0.8*v"
[time]
end = 3
accuracy = 1e-11
)");
    // m x'' + c x' + k x = F sin(w t), from rest position with 1 m/s.
    const double m = 2, c = 0.8, k = 32, F = 2, w = 3, t = 3;
    const double d = c / (2 * m), wd = std::sqrt(k / m - d * d);
    const double a = k - m * w * w, b = c * w, n = a * a + b * b;
    const double P = F * a / n, Q = -F * b / n;   // P sin + Q cos
    const double A = -Q, B = (1 - P * w + d * A) / wd;
    const double x = P * std::sin(w * t) + Q * std::cos(w * t) +
                     std::exp(-d * t) * (A * std::cos(wd * t) + B * std::sin(wd * t));
    EXPECT_NEAR(s.coordinate("slide", "displacement", 3).value, x, 1e-10);
}

TEST(Laws, FallThroughAirFollowsTheHyperbolicTangent)
{
    const Solved s = solved(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "ball"
shape = { point = true }
mass = 0.5
[[load]]
name = "air"
type = "drag"
body = "ball"
quadratic = 0.02
[[load]]
name = "calm"
type = "drag"
body = "ball"
linear = 0
[[sensor]]
name = "fall"
type = "point"
body = "ball"
[[sensor]]
name = "brake"
type = "load"
load = "air"
[[sensor]]
name = "height"
type = "energy"
body = "ball"
[time]
end = 2
accuracy = 1e-11
)");
    const double g = 9.81, m = 0.5, c = 0.02, end = std::sqrt(m * g / c), t = 2;
    const double v = end * std::tanh(g * t / end), z = -end * end / g * std::log(std::cosh(g * t / end));
    const std::vector<double> read = s.sensed(2);
    ASSERT_EQ(read.size(), 15u);
    EXPECT_NEAR(read[2], z, 1e-9);
    EXPECT_NEAR(read[5], -v, 1e-9);
    EXPECT_NEAR(read[8], c / m * v * v - g, 1e-8);
    EXPECT_NEAR(read[9], 0.5 * m * v * v, 1e-8);   // those of loads come last
    EXPECT_NEAR(read[10], m * g * z, 1e-8);
    EXPECT_NEAR(read[13], c * v * v, 1e-9);
    EXPECT_NEAR(read[14], -c * v * v * v, 1e-8);
}

TEST(Laws, APlanetCloses)
{
    // Half an ellipse, from the far end to the near one: the vis-viva equation.
    const double mu = 4, far = 2, near = 0.5, a = 0.5 * (far + near),
                 period = 2 * pi * std::sqrt(a * a * a / mu);
    const double v = std::sqrt(mu * (2 / far - 1 / a)), w = std::sqrt(mu * (2 / near - 1 / a));
    const std::string text =
        "[[body]]\nname = \"b\"\nshape = { point = true }\nmass = 7\nposition = [2, 0, 0]\nvelocity = [0, " +
        to_text(v) + ", 0]\n[[load]]\ntype = \"attraction\"\nbody = \"b\"\nmu = 4\n" +
        "[time]\nend = " + to_text(period / 2) + "\naccuracy = 1e-11\n";
    const Solved s = solved(text);
    const BodySample end = sample_bodies(s.model, s.solution.motion, period / 2)[0];
    EXPECT_LT(norm(end.position - Vector3{-near, 0, 0}), 1e-9);
    EXPECT_LT(norm(end.velocity - Vector3{0, -w, 0}), 1e-8);
}

TEST(Laws, GravityOverABodyMakesItLibrate)
{
    // A slender satellite held at its centre: J phi'' = -3 mu / (2 r^3) (J - J_axis) sin 2 phi, small here.
    const double mu = 3, r = 2, J = 1.2, along = 0.2, w = std::sqrt(3 * mu / (r * r * r) * (J - along) / J);
    const double phi = 1e-4, t = 1.5;
    const auto held = [&](const std::string& gradient) {
        return solved(R"(
[[body]]
name = "b"
mass = 5
inertia = [0.2, 1.2, 1.2]
position = [2, 0, 0]
rotation_vector = [0, 0, 1e-4]
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "b"]
at = [2, 0, 0]
axis = [0, 0, 1]
coordinate = 1e-4
[[load]]
type = "attraction"
body = "b"
mu = 3
gradient = )" + gradient +
                      "\n[time]\nend = 1.5\naccuracy = 1e-11\n");
    };
    EXPECT_NEAR(held("true").coordinate("axle", "angle", t).value, phi * std::cos(w * t), 1e-11);
    EXPECT_NEAR(held("false").coordinate("axle", "angle", t).value, phi, 1e-15);
}

/// A satellite on a circle librates about the way to the centre: phi = 2 theta has phi'' = -3 n^2 s sin(phi),
/// s = (J_y - J_x) / J_z, so that from rest theta is zero after K(sin(theta_0)) / (n sqrt(3 s)), when the
/// body has turned as far as its orbit. In true units: mu of the Earth, where mu m / r is 1e10 times the
/// couple.
TEST(Laws, ASatelliteLibratesInTrueUnitsToTheAccuracyAsked)
{
    const double mu = 3.986004418e14, tilt = pi / 9, ratio = (1250.0 - 100) / 1300;
    for (const double r : {1e5, 1e6, 7e6, 4.2e7, 1e8}) {
        for (const double accuracy : {1e-6, 1e-10}) {
            const double n = std::sqrt(mu / (r * r * r)),
                         end = std::comp_ellint_1(std::sin(tilt)) / n / std::sqrt(3 * ratio);
            const auto run = [&](const std::string& gradient) {
                return solved(
                    "[[body]]\nname = \"b\"\nmass = 500\ninertia = [100, 1250, 1300]\nposition = [" +
                    to_text(r) + ", 0, 0]\nvelocity = [0, " + to_text(n * r) +
                    ", 0]\nrotation_vector = [0, 0, " + to_text(tilt) + "]\nangular_velocity = [0, 0, " +
                    to_text(n) + "]\n[[load]]\ntype = \"attraction\"\nbody = \"b\"\nmu = " + to_text(mu) +
                    "\ngradient = " + gradient + "\n[time]\nend = " + to_text(end) +
                    "\naccuracy = " + to_text(accuracy) + "\n");
            };
            const auto turned = [&](const Solved& s) {
                const BodySample b = sample_bodies(s.model, s.solution.motion, end)[0];
                return std::remainder(std::atan2(b.directors(1, 0), b.directors(0, 0)) - n * end, 2 * pi);
            };
            const Solved s = run("true");
            EXPECT_LT(std::abs(turned(s)), accuracy) << r;
            EXPECT_LT(s.solution.motion.n_elements(), 40) << r;
            EXPECT_TRUE(s.solution.report.notes.empty()) << s.solution.report.notes.front();
            EXPECT_NEAR(turned(run("false")), tilt, 1e-6) << r;
        }
    }
}

/// Beyond half a turn the rotation vector of a bushing changes its sign: the run says so, whatever it ends
/// with.
TEST(Laws, ABushingThatReachesHalfATurnIsNamed)
{
    const auto run = [](double spin, const std::string& time) {
        const ScenarioResult read = parse_scenario(
            "format = 1\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [0.01, 0.01, 0.01]\nangular_velocity = "
            "[0, 0, " +
                to_text(spin) +
                "]\n[[load]]\nname = \"bush\"\ntype = \"bushing\"\nbetween = [\"world\", \"b\"]\nat = [0, 0, "
                "0]\nstiffness = [10, 10, 10, 0.01, 0.01, 0.01]\n[time]\nend = 1\n" +
                time,
            "test.toml");
        const Scenario& s = read.scenario.value();
        return solve(s.model, {s.model.start()}, s.time, s.method, s.options).report;
    };
    // q = spin sin(t): half a turn is reached at asin(pi / spin), where the torque jumps.
    for (const std::string time : {"", "elements = 20\n", "elements = 40\n"}) {
        const SolveReport report = run(10, time);
        EXPECT_NE(report.status, SolveStatus::converged);
        EXPECT_NE(report.message.find("bushing 'bush' reaches half a turn at t = 0.3"), std::string::npos)
            << time << report.message;
    }
    EXPECT_EQ(run(3, "").status, SolveStatus::converged) << "by 3 sin(1) = 2.52 rad";
}

/// A bushing that does nothing along its rotation vector has no turn at which it ends.
TEST(Laws, ABushingThatDampsTheAngularVelocityAloneTurnsOn)
{
    const auto run = [](const std::string& rotational) {
        const ScenarioResult read = parse_scenario(
            "format = 1\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nangular_velocity = "
            "[0, 4, 0]\n[[load]]\nname = \"bush\"\ntype = \"bushing\"\nbetween = [\"world\", \"b\"]\nat = "
            "[0, 0, "
            "0]\ndamping = [0, 0, 0, 0.01, 0.01, 0.01]\n" +
                rotational + "damping_by = \"angular_velocity\"\n[time]\nend = 2\naccuracy = 1e-9\n",
            "test.toml");
        const Scenario& s = read.scenario.value();
        return solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    };
    const Solution free = run("stiffness = [10, 10, 10, 0, 0, 0]\n");
    EXPECT_EQ(free.report.status, SolveStatus::converged) << free.report.message;
    const State end = free.motion.at(2);
    EXPECT_NEAR(angular_velocity(end.X[0], end.V[0])[1], 4 * std::exp(-0.2), 1e-9);
    for (const std::string held : {"stiffness = [10, 10, 10, 0, 1e-5, 0]\n",
                                   "stiffness = [10, 10, 10, 0, 0, 0]\npreload = [0, 0, 0, 0, 1e-5, 0]\n"})
        EXPECT_NE(run(held).report.message.find("bushing 'bush' reaches half a turn"), std::string::npos)
            << held;
}

TEST(Laws, ABushingTurnsHarmonicallyHoweverFar)
{
    // About one axis the rotation vector is the angle itself, so that 2 rad are no more than 0.02.
    const double k = 6, J = 1.5, c = 0.3, t = 2, phi = 2;
    const Solved s = solved(R"(
[[body]]
name = "b"
mass = 2
inertia = [1, 1.2, 1.5]
rotation_vector = [0, 0, 2]
[[load]]
name = "mount"
type = "bushing"
between = ["world", "b"]
frames = [{}, {}]
stiffness = [800, 900, 700, 5, 4, 6]
damping = [0, 0, 0, 0, 0, 0.3]
preload = [0, 0, 70, 0, 0, 0]
[[sensor]]
name = "mount"
type = "load"
load = "mount"
[time]
end = 2
accuracy = 1e-11
)");
    const double d = c / (2 * J), w = std::sqrt(k / J - d * d);
    const double angle = phi * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
    const std::vector<double> u = s.sensed(t);
    ASSERT_EQ(u.size(), 13u);
    EXPECT_NEAR(u[11], angle, 1e-9);
    // The preload pulls it down, as a weight would.
    EXPECT_NEAR(u[5], -70.0 / 700 * (1 - std::cos(std::sqrt(700.0 / 2) * t)), 1e-9);
}

TEST(Laws, AHardeningSpringHasThePeriodOfItsIntegral)
{
    // From rest at x0: a quarter of the period is the integral of dx / v, here over x = x0 sin(s) by the
    // midpoint rule, which is exact to rounding for periodic functions.
    const double m = 2, k = 5, cubic = 40, x0 = 0.7;
    double quarter = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i) {
        const double s = (i + 0.5) * pi / 2 / n, sine = std::sin(s);
        quarter += pi / 2 / n / std::sqrt((k + 0.5 * cubic * x0 * x0 * (1 + sine * sine)) / m);
    }
    for (const std::string law : {"law = \"progressive\"\nstiffness = 5\ncubic = 40\n"}) {
        const Solved s = solved(R"(
[[body]]
name = "b"
shape = { point = true }
mass = 2
position = [1.7, 0, 0]
[[load]]
name = "spring"
type = "spring"
between = ["world", "b"]
free_length = 1
)" + law + "[[sensor]]\nname = \"spring\"\ntype = \"load\"\nload = \"spring\"\n[time]\nend = " +
                                to_text(quarter) + "\naccuracy = 1e-11\n");
        const std::vector<double> read = s.sensed(quarter);   // force, length, power
        EXPECT_NEAR(read[1], 1, 1e-9);
        EXPECT_NEAR(read[0], 0, 1e-7);
    }
}

TEST(Laws, ATableOfAStraightLineIsALinearSpring)
{
    const auto end = [](const std::string& law) {
        return solved(moving(slide, "[1, 0, 0]") +
                      "[[load]]\ntype = \"spring\"\njoint = \"slide\"\nrest = 0.1\npreload = 0.3\n" + law +
                      "[time]\nend = 2\naccuracy = 1e-10\n")
            .coordinate("slide", "displacement", 2)
            .value;
    };
    const double linear = end("stiffness = 18\n");
    const double w = 3, x0 = 0.1 - 0.3 / 18, x = x0 + -x0 * std::cos(w * 2) + std::sin(w * 2) / w;
    EXPECT_NEAR(linear, x, 1e-9);
    for (const std::string between : {"linear", "spline"})
        EXPECT_NEAR(end("law = \"table\"\ntable = { elongations = [-0.1, 0, 0.2], forces = [-1.8, 0, 3.6], "
                        "interpolation = \"" +
                        between + "\" }\n"),
                    x, 1e-9);
}

/// A damper has neither a length nor a stiffness: v = exp(-c t / m), between points and along a joint.
TEST(Laws, ADamperAloneTakesAnExponential)
{
    for (const std::string where :
         {"between = [\"world\", \"b\"]\npoints = [[-3, 0, 0], [0, 0, 0]]\n", "joint = \"slide\"\n"}) {
        const Solved s = solved(moving(slide, "[1, 0, 0]") + "[[load]]\ntype = \"spring\"\ndamping = 1.5\n" +
                                where + "[time]\nend = 2\naccuracy = 1e-10\n");
        EXPECT_NEAR(s.coordinate("slide", "displacement", 2).value, 2 / 1.5 * (1 - std::exp(-1.5)), 1e-10)
            << where;
    }
}

/// A wheel under an expression of time.
double wheel_after(const std::string& expression, const std::string& more = "")
{
    return solved(R"(
[[body]]
name = "w"
mass = 1
inertia = [0.4, 0.4, 0.5]
angular_velocity = [0, 0, 1]
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "w"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[load]]
type = "actuator"
joint = "pivot"
expression = ")" + expression +
                  "\"\n" + more + "[time]\nend = 4\n")
        .coordinate("pivot", "angle", 4)
        .value;
}

TEST(Laws, JumpsAndPulsesOfExpressionsAreSeen)
{
    for (int i = 0; i < 20; ++i) {
        const double c = 1.348 + 0.0731 * i;
        const double jumped = c - 3 * c * c + (1 - 6 * c) * (4 - c) + 3 * (4 - c) * (4 - c);
        const std::string from_c = "(t-" + to_text(c) + ")";
        EXPECT_NEAR(wheel_after("3*max(-1,min(1," + from_c + "*1e9))"), jumped, 1e-5) << c;
        EXPECT_NEAR(wheel_after("3*abs" + from_c + "/" + from_c), jumped, 1e-5) << c;
        EXPECT_NEAR(wheel_after("3*abs" + from_c + "/" + from_c, "breaks = [" + to_text(c) + "]\n"), jumped,
                    1e-5);
        // theta'' = 6 |t - c|
        const double bent = 4 + std::pow(c, 2) * 3 * 4 + std::pow(4 - c, 3) - std::pow(c, 3);
        EXPECT_NEAR(wheel_after("3*abs" + from_c), bent, 1e-5) << c;
    }
    // 100 rad/s^2 for 30 ms, with ramps of 1 ms at both ends.
    const double push = 100 * 0.029, middle = 1.215;
    EXPECT_NEAR(wheel_after("min(1,max(0,(t-1.2)*1000))*min(1,max(0,(1.23-t)*1000))*50"),
                4 + push * (4 - middle), 1e-5);
    const double bell = 100 * std::sqrt(pi) / 2000;
    EXPECT_NEAR(wheel_after("50*exp(-((t-1.237)*2000)^2)"), 4 + bell * (4 - 1.237), 1e-5);
}

/// A bell on what is at rest: elements have grown long in the calm before it, and neither solution sees more
/// than its foot if one of them ends there.
TEST(Laws, PulsesOnWhatIsAtRestAreSeen)
{
    for (const double accuracy : {1e-3, 1e-6, 1e-8})
        for (const double width : {0.01, 0.03, 0.063, 0.2})
            for (const double at : {3.1, 5.136, 6.796}) {
                const Solved s = solved(slide +
                                        "[[load]]\ntype = \"actuator\"\njoint = \"slide\"\nexpression = "
                                        "\"200*exp(-((t-" +
                                        to_text(at) + ")/" + to_text(width) +
                                        ")^2)\"\n[time]\nend = 10\naccuracy = " + to_text(accuracy) + "\n");
                const double x = 200 * width * std::sqrt(pi) / 2 * (10 - at);
                EXPECT_NEAR(s.coordinate("slide", "displacement", 10).value, x, 3 * accuracy)
                    << accuracy << ' ' << width << ' ' << at;
            }
}

// Angles of motor and pivot and their rates, from Lagrange's equations in these two angles by DOP853 to
// 3e-14.
struct FurutaRow {
    double t, psi, phi, psi_rate, phi_rate;
};
constexpr FurutaRow furuta_rows[] = {
    {0.1, 0.06732285551307156, -0.011147356894534399, 0.5503390990079466, 0.36393541198453316},
    {0.25, 0.11894062046020006, 0.013153543775718543, 0.18681005153386918, 0.037346332693112966},
    {0.5, 0.13206462209863207, 0.009279449936945355, -0.03567270701297123, -0.03196858165619212},
    {1, 0.0901744505992873, -0.00013580101719795767, -0.09515053199057426, -0.0069910379281657555},
    {5, 0.00040438938409300844, -1.6767645885038196e-05, -0.0005652206020826593, 2.3409023743296817e-05}};

TEST(Laws, TheFurutaPendulumAsShippedMeetsLagrangesEquations)
{
    const Shipped shipped = solve_example("furuta_pendulum");
    const JointCoordinates angles(shipped.model, shipped.solution.motion);
    for (const FurutaRow& row : furuta_rows) {
        const std::vector<CoordinateValue> q = angles.at(row.t);
        EXPECT_NEAR(q[0].value, row.psi, 1e-9) << row.t;
        EXPECT_NEAR(q[1].value, row.phi, 1e-9) << row.t;
        EXPECT_NEAR(q[0].rate, row.psi_rate, 1e-8) << row.t;
        EXPECT_NEAR(q[1].rate, row.phi_rate, 1e-8) << row.t;
    }
}

TEST(Laws, AFurutaPendulumFallsWithoutItsController)
{
    const std::string furuta = R"(
gravity = [0, 0, -9.81]
[[body]]
name = "arm"
mass = 0.2
inertia = [1e-3, 1e-3, 1e-3]
position = [0.1, 0, 0]
[[body]]
name = "pendulum"
mass = 0.1
inertia = [8e-4, 8e-4, 1e-5]
position = [0.2, 0.01, 0.15]
rotation_vector = [-0.06656816377582381, 0, 0]
[[joint]]
name = "motor"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "pivot"
type = "revolute"
between = ["arm", "pendulum"]
at = [0.2, 0, 0]
axis = [1, 0, 0]
coordinate = -0.06656816377582381
[[sensor]]
name = "tip"
type = "point"
body = "pendulum"
point = [0, 0, 0.15]
)";
    const std::string control = R"([[load]]
type = "actuator"
joint = "motor"
inputs = { phi = "pivot.angle", w = "pivot.angle_rate", psi = "motor.angle", v = "motor.angle_rate" }
expression = "-6*phi - 0.8*w + 0.3*psi + 0.35*v"
)";
    const std::string time = "[time]\nend = 5\naccuracy = 1e-7\n";
    const Solved held = solved(furuta + control + time);
    EXPECT_LT(std::abs(held.coordinate("pivot", "angle", 5).value), 1e-4);
    EXPECT_NEAR(held.sensed(5)[2], 0.15 + std::hypot(0.01, 0.15), 1e-6);
    EXPECT_LT(solved(furuta + "[time]\nend = 0.6\naccuracy = 1e-7\n").sensed(0.6)[2], 0.2);   // it falls
}

/// Likewise where the motion decides the rest of the formula: here it is damped.
TEST(Laws, PulsesBesideTheMotionAreSeen)
{
    for (const double accuracy : {1e-4, 1e-7})
        for (const double width : {0.005, 0.01, 0.03})
            for (const double at : {5.136, 6.796}) {
                const Solved s =
                    solved(slide +
                           "[[load]]\ntype = \"actuator\"\njoint = \"slide\"\ninputs = { v = "
                           "\"slide.displacement_rate\" }\nexpression = \"200*exp(-((t-" +
                           to_text(at) + ")/" + to_text(width) +
                           ")^2) - 0.2*v\"\n[time]\nend = 10\naccuracy = " + to_text(accuracy) + "\n");
                // m x'' + c x' = f, m = 2, c = 0.2: x(T) = int f (1 - exp(-(T - s) c / m)) / c ds
                const double impulse = 200 * width * std::sqrt(pi), rate = 0.1;
                const double left = std::exp(-rate * (10 - at) + rate * rate * width * width / 4);
                EXPECT_NEAR(s.coordinate("slide", "displacement", 10).value, impulse * (1 - left) / 0.2,
                            3 * accuracy)
                    << accuracy << ' ' << width << ' ' << at;
            }
}

/// Those who look at a march on its way find the angles of loads at the ends that there are: the motion's
/// arrays may be longer.
TEST(Laws, AnglesAreCountedWhileMarching)
{
    const ScenarioResult read = read_scenario(root / "examples/furuta_pendulum.toml");
    ASSERT_TRUE(read.scenario.has_value());
    const Model& model = read.scenario->model;
    Conditions conditions;
    conditions.start = model.start();
    const Ends ends = close_ends(model, {conditions}, 0, 5, {});
    const ModelTables tables(model, ends.independent);
    TimeMesh mesh{{0}};
    NodalWindow window(tables, mesh, ends, element_rule(Points::lobatto, 4));
    StepSizeController controller(Points::lobatto, 4, 1e-6, 0.01, {0, 5});
    std::vector<std::pair<double, std::vector<double>>> seen;
    WindowOptions options;
    options.length_of_model = model.length();
    options.controller = &controller;
    options.goes_on = [&] {
        const Motion& so_far = *window.monitor().so_far();
        for (const int end : {so_far.n_elements() / 2, so_far.n_elements()})
            seen.emplace_back(so_far.mesh.ends[end], so_far.at(so_far.mesh.ends[end]).angles);
        return true;
    };
    SolveReport report;
    solve_windows(window, mesh, options, report);
    ASSERT_TRUE(report.converged()) << report.message;
    const Motion motion = window.take_motion();
    ASSERT_GT(seen.size(), 20u);
    for (const auto& [t, angles] : seen) {
        EXPECT_EQ(angles.size(), 2u) << t;   // of the pivot and of the motor
        EXPECT_EQ(angles, motion.at(t).angles) << t;
    }
    EXPECT_GT(std::abs(seen.back().second[0]), 1e-6);
}

}   // namespace
}   // namespace livens::tests::laws_test
