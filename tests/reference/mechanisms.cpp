// SPDX-License-Identifier: BSD-3-Clause
// Slides, screws, gears, shafts and drives against closed forms, as scenarios say them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "livens/base/text.h"
#include "livens/diagnostics/diagnostics.h"
#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::mechanisms_test {
namespace {

using std::numbers::pi;

/// A number with two derivatives by time.
struct Jet {
    double x, v, a;
};
Jet operator+(Jet l, Jet r) { return {l.x + r.x, l.v + r.v, l.a + r.a}; }
Jet operator*(double f, Jet r) { return {f * r.x, f * r.v, f * r.a}; }
Jet chain(Jet u, double f, double df, double ddf) { return {f, df * u.v, ddf * u.v * u.v + df * u.a}; }
Jet sine(Jet u) { return chain(u, std::sin(u.x), std::cos(u.x), -std::sin(u.x)); }
Jet cosine(Jet u) { return chain(u, std::cos(u.x), -std::sin(u.x), -std::cos(u.x)); }
Jet arc_sine(Jet u)
{
    const double r = std::sqrt(1 - u.x * u.x);
    return chain(u, std::asin(u.x), 1 / r, u.x / (r * r * r));
}

const std::string slider_crank = R"(
[[body]]
name = "crank"
mass = 1
inertia = [0.01, 0.1, 0.1]
position = [0.5, 0, 0]
[[body]]
name = "rod"
mass = 2
inertia = [0.02, 1.5, 1.5]
position = [2.5, 0, 0]
[[body]]
name = "slider"
mass = 3
inertia = [1, 1, 1]
position = [4, 0, 0]
[[joint]]
name = "main"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "pin"
type = "revolute"
between = ["crank", "rod"]
at = [1, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "wrist"
type = "revolute"
between = ["rod", "slider"]
at = [4, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "guide"
type = "prismatic"
between = ["world", "slider"]
at = [4, 0, 0]
axis = [1, 0, 0]
[[drive]]
name = "motor"
type = "joint"
joint = "main"
rate = 10
[[load]]
type = "force"
body = "slider"
table = { times = [0, 0.5, 1, 2], values = [[0, 0, 0], [-300, 0, 0], [100, 0, 0], [50, 0, 0]] }
[start]
initial = "project"
)";

TEST(Mechanisms, ACrankAtConstantRateTakesTheTorqueOfVirtualWork)
{
    const Solved run = solved(slider_crank + "[time]\nend = 2\naccuracy = 1e-11\noutput = 0.1\n");
    const auto force = [](double t) {
        if (t < 0.5) return -600 * t;
        return t < 1 ? -300 + 800 * (t - 0.5) : 100 - 50 * (t - 1);
    };
    for (const double t : {0.1, 0.3, 0.7, 1.3, 1.9, 2.0}) {
        const Jet crank{10 * t, 10, 0}, rod = -1.0 * arc_sine((1.0 / 3) * sine(crank));
        const Jet tip = cosine(crank) + 3 * cosine(rod);
        const Jet x = cosine(crank) + 1.5 * cosine(rod), y = sine(crank) + 1.5 * sine(rod);
        const double power = 2 * (x.v * x.a + y.v * y.a) + 1.5 * rod.v * rod.a + 3 * tip.v * tip.a;
        const double torque = (power - force(t) * tip.v) / 10;
        EXPECT_NEAR(run.reaction("motor", t).torque[2], torque, 1e-9 * 1000) << t;
        EXPECT_NEAR(run.coordinate("guide", "displacement", t).value, tip.x - 4, 1e-13) << t;
        EXPECT_NEAR(run.coordinate("guide", "displacement", t).rate, tip.v, 1e-11) << t;
        EXPECT_NEAR(run.coordinate("main", "angle", t).value, 10 * t, 1e-13) << t;
        EXPECT_NEAR(run.coordinate("wrist", "angle", t).value, -rod.x, 1e-13) << t;
    }
    EXPECT_LT(run.solution.verdict.energy_drift, 1e-11) << "with the power of the drive";
    for (const double error : run.solution.estimate.reaction)
        EXPECT_LT(error, 1e-6) << "of redundant joints, too";
}

TEST(Mechanisms, TheSliderCrankAsShippedMeetsVirtualWork)
{
    const Shipped shipped = solve_example("slider_crank");
    EXPECT_TRUE(shipped.solution.verdict.reasons.empty());
    EXPECT_TRUE(shipped.solution.motion.redundant_rows.empty());
    const Solved run{shipped.model, shipped.solution};
    const Load& gas = run.model.loads()[0];
    for (int i = 1; i <= 60; ++i) {
        const double t = 0.001 * i, length = 0.15, spin = 0.3 * (0.15 * 0.15 + 0.02 * 0.02) / 12;
        const Jet crank{200 * t, 200, 0}, rod = -1.0 * arc_sine((0.05 / length) * sine(crank));
        const Jet pin = 0.05 * cosine(crank) + length * cosine(rod);
        const Jet x = 0.05 * cosine(crank) + 0.5 * length * cosine(rod),
                  y = 0.05 * sine(crank) + 0.5 * length * sine(rod);
        LoadForces F{};
        LoadArguments at;
        at.at.t = t;
        gas.forces(at, F);
        const double power = 0.3 * (x.v * x.a + y.v * y.a) + spin * rod.v * rod.a + 0.5 * pin.v * pin.a;
        EXPECT_NEAR(run.reaction("speed", t).torque[2], (power - F[0](0, 0) * pin.v) / 200, 1e-9 * 100) << t;
        EXPECT_NEAR(run.coordinate("bore", "displacement", t).value, pin.x - 0.2, 1e-14) << t;
        // The bore carries what the rod pushes aside, and all weights but those on shaft and pins.
        const double along = 0.5 * pin.a - F[0](0, 0);
        const double turning = spin * rod.a, side = 0.3 * y.a;   // of the rod, about its centre
        const double c = std::cos(rod.x), s = std::sin(rod.x), half = 0.5 * length;
        const double at_crank_x = -along - 0.3 * x.a;   // rod: forces of the crank pin and piston pin on it
        // turning = r1 x f1 + r2 x f2 with r = -+half (c, s), f2 = (-along, f2y), f1 = -at_crank_x.., f1y =
        // side - f2y
        const double f1x = -at_crank_x, f2x = -along;
        const double f2y = (turning + half * (c * side - s * f1x) + half * s * f2x) / (2 * half * c);
        EXPECT_NEAR(run.reaction("bore", t).force[1], f2y, 1e-9 * 1000) << t;
    }
}

TEST(Mechanisms, ANutOnAScrewFallsAndTurnsForAHundredTurns)
{
    const Solved run = solved(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "nut"
mass = 2
inertia = [0.03, 0.04, 0.05]
[[joint]]
name = "thread"
type = "screw"
between = ["world", "nut"]
at = [0, 0, 0]
axis = [0, 0, 1]
pitch = 0.5
[time]
end = 10
accuracy = 1e-10
output = 0.25
)");
    const double k = 2 * pi / 0.5, fall = 9.81 / (1 + 0.05 * k * k / 2);
    for (const double t : {0.25, 5.0, 10.0}) {
        const CoordinateValue z = run.coordinate("thread", "displacement", t);
        EXPECT_NEAR(z.value, -0.5 * fall * t * t, 1e-9) << t;
        EXPECT_NEAR(z.rate, -fall * t, 1e-9) << t;
        const CoordinateValue turn = run.coordinate("thread", "angle", t);
        EXPECT_NEAR(turn.value, -0.5 * k * fall * t * t, 1e-8) << t;
        EXPECT_NEAR(turn.rate, -k * fall * t, 1e-8) << t;
    }
    EXPECT_GT(std::abs(run.coordinate("thread", "angle", 10).value), 100 * 2 * pi);
}

TEST(Mechanisms, AGearPairIsOneInertiaForAHundredTurns)
{
    const Solved run = solved(R"(
[[body]]
name = "pinion"
mass = 1
inertia = [0.1, 0.1, 0.02]
[[body]]
name = "wheel"
mass = 4
inertia = [0.5, 0.5, 0.9]
position = [0.3, 0, 0]
[[body]]
name = "rack"
mass = 5
inertia = [1, 1, 1]
position = [0, 0.1, 0]
[[joint]]
name = "mesh"
type = "gear"
joints = ["of pinion", "of wheel"]
ratio = -0.5
[[joint]]
name = "of pinion"
type = "revolute"
between = ["world", "pinion"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "of wheel"
type = "revolute"
between = ["wheel", "world"]
at = [0.3, 0, 0]
axis = [0, 0, -1]
coordinate = "90 deg"
[[joint]]
name = "slide"
type = "prismatic"
between = ["world", "rack"]
at = [0, 0.1, 0]
axis = [1, 0, 0]
[[joint]]
type = "rack_and_pinion"
joints = ["of pinion", "slide"]
radius = -0.1
[[load]]
type = "torque"
body = "wheel"
value = [0, 0, -8]
[time]
end = 10
accuracy = 1e-10
output = 0.25
)");
    // Coordinates of the wheel are of the world against it about -z: again its own about z.
    const double inertia = 0.02 + 0.9 / 4 + 5 * 0.01, rate = 4 / inertia;
    for (const double t : {0.25, 5.0, 10.0}) {
        const double turned = 0.5 * rate * t * t;
        EXPECT_NEAR(run.coordinate("of pinion", "angle", t).value, turned, 1e-8) << t;
        EXPECT_NEAR(run.coordinate("of wheel", "angle", t).value, pi / 2 - 0.5 * turned, 1e-8) << t;
        EXPECT_NEAR(run.coordinate("slide", "displacement", t).value, -0.1 * turned, 1e-9) << t;
        EXPECT_NEAR(run.coordinate("of pinion", "angle", t).rate, rate * t, 1e-8) << t;
        // what the teeth hand to the wheel: its own acceleration less the load
        EXPECT_NEAR(run.reaction("mesh", t).torque[2], -0.9 * 0.5 * rate + 8, 1e-8) << t;
    }
    EXPECT_GT(run.coordinate("of pinion", "angle", 10).value, 100 * 2 * pi);
}

/// Two shafts in bearings that meet at an angle, the first of which is driven.
std::string shafts(const std::string& joint, double bend)
{
    const std::string c = to_text(std::cos(bend)), s = to_text(std::sin(bend));
    const std::string direction = "[" + c + ", " + s + ", 0]";
    return R"(
[[body]]
name = "in"
mass = 1
inertia = [0.1, 0.2, 0.2]
position = [-1, 0, 0]
[[body]]
name = "out"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = )" +
           direction + R"(
[[joint]]
name = "bearing in"
type = "revolute"
between = ["world", "in"]
at = [-1, 0, 0]
axis = [1, 0, 0]
[[joint]]
name = "bearing out"
type = "revolute"
between = ["world", "out"]
at = )" + direction +
           "\naxis = " + direction + R"(
[[joint]]
name = "joint"
between = ["in", "out"]
at = [0, 0, 0]
)" + joint +
           R"(
[[drive]]
type = "joint"
joint = "bearing in"
rate = 5
[start]
initial = "project"
[time]
end = 3
accuracy = 1e-11
output = 0.1
)";
}

TEST(Mechanisms, AUniversalJointTurnsByHookesFormula)
{
    // The axis of the cross in the input is across the plane of the shafts at the start, z turned by `in`;
    // that in the output lies in the plane, turned by `out`. Perpendicular: tan(out) = cos(bend) tan(in).
    const double bend = 0.5;
    const std::string s = to_text(-std::sin(bend)), c = to_text(std::cos(bend));
    const Solved run =
        solved(shafts("type = \"universal\"\naxes = [[0, 0, 1], [" + s + ", " + c + ", 0]]", bend));
    for (const double t : {0.1, 0.2, 1.0, 2.0, 3.0}) {
        const double in = 5 * t, cosine = std::stod(c);
        const double out = std::atan2(std::sin(in) * cosine, std::cos(in));
        const CoordinateValue angle = run.coordinate("bearing out", "angle", t);
        EXPECT_NEAR(std::remainder(angle.value - out, 2 * pi), 0, 1e-10) << t;
        EXPECT_NEAR(angle.value, in, 0.2) << "turns are counted";
        EXPECT_NEAR(angle.rate, 5 * cosine / (1 - std::pow(std::sin(bend) * std::sin(in), 2)), 1e-9) << t;
    }
}

TEST(Mechanisms, AConstantVelocityJointTurnsBothShaftsEqually)
{
    const double bend = 0.5;
    const std::string out = "[" + to_text(std::cos(bend)) + ", " + to_text(std::sin(bend)) + ", 0]";
    const Solved run = solved(shafts("type = \"constant_velocity\"\naxes = [[1, 0, 0], " + out + "]", bend));
    for (const double t : {0.1, 0.7, 1.3, 3.0}) {
        EXPECT_NEAR(run.coordinate("bearing out", "angle", t).value, 5 * t, 1e-13) << t;
        EXPECT_NEAR(run.coordinate("bearing out", "angle", t).rate, 5, 1e-12) << t;
    }
}

TEST(Mechanisms, ATorsionSpringSwingsAndAMotorLifts)
{
    const std::string fan = R"(
[[body]]
name = "fan"
mass = 1
inertia = [0.1, 0.1, 0.02]
[[joint]]
name = "hub"
type = "revolute"
between = ["fan", "world"]
at = [0, 0, 0]
axis = [0, 0, -1]
coordinate = "30 deg"
[[load]]
type = "spring"
joint = "hub"
)";
    const std::string time = "[time]\nend = 3\naccuracy = 1e-11\noutput = 0.25\n";
    const Solved swings =
        solved(fan + "stiffness = \"3 N m/rad\"\ndamping = 0.01\nrest = \"-30 deg\"\n" + time);
    const double decay = 0.25, w = std::sqrt(3 / 0.02 - decay * decay);   // c / (2 J) = 0.25 1/s
    for (const double t : {0.25, 1.0, 3.0}) {
        const double wave = std::cos(w * t) + decay / w * std::sin(w * t);
        EXPECT_NEAR(swings.coordinate("hub", "angle", t).value,
                    -pi / 6 + pi / 3 * std::exp(-decay * t) * wave, 1e-10);
    }
    // Preload and motor at odds: a constant torque, over many turns, since nothing asks for the angle.
    const Solved turns = solved(fan +
                                "stiffness = 0\npreload = 1\n[[load]]\ntype = \"actuator\"\njoint = \"hub\"\n"
                                "value = 1.5\n" +
                                time);
    EXPECT_NEAR(turns.coordinate("hub", "angle", 3).value, pi / 6 + 0.5 * (0.5 / 0.02) * 9, 1e-9);
    EXPECT_LT(turns.solution.verdict.energy_drift, 1e-12);
}

/// A fan on a torsion spring, thrown through eleven turns.
std::string fan(const std::string& time, const std::string& method)
{
    return R"(
[[body]]
name = "fan"
mass = 1
inertia = [0.1, 0.1, 0.02]
angular_velocity = [0, 0, 50]
[[joint]]
name = "hub"
type = "revolute"
between = ["world", "fan"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[load]]
name = "coil"
type = "spring"
joint = "hub"
stiffness = 0.01
)" + time + method;
}

TEST(Mechanisms, ATorsionSpringCountsItsTurns)
{
    const double w = std::sqrt(0.5), t = 6, angle = 50 / w * std::sin(w * t);
    const std::string to_accuracy = "[time]\nend = 6\naccuracy = 1e-9\n",
                      in_elements = "[time]\nend = 6\nelements = 300\n";
    for (const auto& [time, method, bound] :
         {std::tuple{to_accuracy, "", 1e-8}, std::tuple{to_accuracy, "[method]\nfamily = \"radau\"\n", 1e-8},
          std::tuple{in_elements, "[method]\ndegree = 8\n", 1e-10},
          std::tuple{in_elements, "[method]\ndegree = 8\nwindow = 7\n", 1e-10}}) {
        const Solved s = solved(fan(time, method));
        EXPECT_NEAR(s.coordinate("hub", "angle", t).value, angle, bound) << method;
        // The spring's potential counts them, too.
        const Balance energies = balance(s.model, s.solution.motion);
        EXPECT_NEAR(energies.potential.back(), 0.005 * angle * angle, 1e-8) << method;
        EXPECT_LT(energies.energy_drift.back(), 1e-9 * 25) << method;
    }
    // Shortened elements begin with the turns of the whole motion, also of one that a file holds.
    Solved s = solved(fan("[time]\nend = 6\nelements = 300\n", "[method]\ndegree = 8\n"));
    s.solution.motion.load_angles.clear();
    const ExactSample exact = sample_exactly(s.model, s.solution.motion, Lobatto{8}, 5.301, {});
    ASSERT_TRUE(exact.report.converged());
    EXPECT_NEAR(exact.state.X[0](0, 1), std::cos(50 / w * std::sin(w * 5.301)), 1e-9);
    EXPECT_NEAR(angular_velocity(exact.state.X[0], exact.state.V[0])[2], 50 * std::cos(w * 5.301), 1e-9);
}

TEST(Mechanisms, AMotorTurnsToItsPlaceManyTurnsAway)
{
    const Solved s = solved(R"(
[[body]]
name = "rotor"
mass = 1
inertia = [0.1, 0.1, 0.02]
[[joint]]
name = "hub"
type = "revolute"
between = ["world", "rotor"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[load]]
type = "actuator"
joint = "hub"
inputs = { phi = "hub.angle", w = "hub.angle_rate" }
expression = "2*(30 - phi) - 0.3*w"
[time]
end = 1
accuracy = 1e-9
)");
    const double d = 0.3 / (2 * 0.02), w = std::sqrt(2 / 0.02 - d * d), t = 1;
    const double left = 30 * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
    EXPECT_NEAR(s.coordinate("hub", "angle", t).value, 30 - left, 1e-8);
}

/// What a family that does not count says.
Solution stepped(const std::string& time)
{
    const ScenarioResult read = parse_scenario(
        "format = 1\n" + fan(time, "[method]\nfamily = \"midpoint\"\nestimate = \"none\"\n"), "test.toml");
    EXPECT_TRUE(read.scenario.has_value());
    const Scenario& s = *read.scenario;
    return solve(s.model, {s.model.start()}, s.time, s.method, s.options);
}

TEST(Mechanisms, TurnsThatNobodyCountsAreToldByName)
{
    const Solution ended = stepped("[time]\nend = 1\nelements = 1000\n");
    EXPECT_FALSE(ended.report.converged());
    EXPECT_NE(ended.report.message.find("'coil'"), std::string::npos) << ended.report.message;
    EXPECT_NE(ended.report.message.find("175 degrees"), std::string::npos) << ended.report.message;
    EXPECT_LT(ended.motion.end(), 3.05 / 49) << "it ends before the angle is lost";
    // Long steps, none of which sees the place where the angle is lost.
    const Solution over = stepped("[time]\nend = 1\nelements = 40\n");
    bool is_told = !over.report.converged();
    for (const std::string& reason : over.verdict.reasons)
        is_told = is_told || reason.find("'coil' has lost count of its turns") != std::string::npos;
    EXPECT_TRUE(is_told);
    EXPECT_EQ(stepped("[time]\nend = 0.05\nelements = 100\n").verdict.reasons.size(), 0u)
        << "2.5 rad are known";
}

TEST(Mechanisms, ProjectedStartsCountFromWhereBodiesAreStated)
{
    const std::string arm = R"(
[[body]]
name = "arm"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "hub"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[drive]]
type = "joint"
joint = "hub"
)";
    const std::string rest = "[start]\ninitial = \"project\"\n";
    const Solved led = solved(arm + "polynomial = [0.5, 1]\n" + rest + "[time]\nend = 1\noutput = 0.5\n");
    EXPECT_NEAR(led.coordinate("hub", "angle", 0).value, 0.5, 1e-14);
    EXPECT_NEAR(led.coordinate("hub", "angle", 1).value, 1.5, 1e-13);
    EXPECT_NEAR(led.solution.motion.at_end(0).X[0](1, 1), std::sin(0.5), 1e-14) << "there it stands";
    // A step that began before the motion is where the coordinate is at the start, whatever is left of it.
    const Solved late = solved(arm + "step = { from = 0, until = 2, rise = 1 }\n" + rest +
                               "[time]\nstart = 1\nend = 2\noutput = 0.5\n");
    EXPECT_NEAR(late.coordinate("hub", "angle", 1).value, 0, 1e-14);
    EXPECT_NEAR(late.coordinate("hub", "angle", 2).value, 0.5, 1e-13);
}

TEST(Mechanisms, APointOnALineOfABodyOrOfTheWorld)
{
    // The same wire, once carried by a body that is held, once with the bodies named the other way round.
    const auto text = [](const std::string& between) {
        return R"(
gravity = [0, 0, -9.81]
[[body]]
name = "bead"
shape = { point = true }
mass = 1
position = [1, 0, 0]
[[body]]
name = "wire"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "fixed"
type = "weld"
between = ["world", "wire"]
at = [0, 0, 0]
[[joint]]
name = "on"
type = "point_on_line"
at = [1, 0, 0]
axis = [3, 0, -4]
between = )" + between +
               "\n[time]\nend = 1\naccuracy = 1e-10\noutput = 0.5\n";
    };
    for (const char* between : {R"(["wire", "bead"])", R"(["world", "bead"])"}) {
        const Solved run = solved(text(between));
        for (const double t : {0.5, 1.0}) {
            EXPECT_NEAR(run.coordinate("on", "displacement", t).value, 0.5 * 9.81 * 0.8 * t * t, 1e-12);
            EXPECT_NEAR(run.reaction("on", t).force[2], 9.81 * 0.36, 1e-10);
        }
    }
}

}   // namespace
}   // namespace livens::tests::mechanisms_test
