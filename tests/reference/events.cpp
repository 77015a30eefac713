// SPDX-License-Identifier: BSD-3-Clause
// Joints that let go and drives that begin and end, against motions that were integrated without livens.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/text.h"
#include "newton_euler.h"
#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::events_test {
namespace {

constexpr double g = 9.81;

/// A rod of 2 kg on a hinge at one end, which lets go at 0.7 s; in the plane y = 0, it starts along x.
std::string pendulum(const std::string& time, const std::string& until = "until = 0.7")
{
    return R"(
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
mass = 2
inertia = [0.01, 0.2, 0.2]
center_of_mass = [0.5, 0, 0]
[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
)" + until +
           "\n[time]\nend = 1.5\n" + time;
}

/// Angle about y from x, and its rate, of the hinged rod.
Numbers swung(double t)
{
    const double inertia = 0.2 + 2 * 0.25;
    return extrapolated(
        [=](double, const Numbers& y) {
            return Numbers{y[1], 2 * g * 0.5 * std::cos(y[0]) / inertia};
        },
        {0, 0}, 0, t, 40);
}

struct Flight {
    Vector3 center;
    double angle, rate;
};
Flight flown(double t)
{
    const double off = std::min(t, 0.7), s = std::max(t - 0.7, 0.0);
    const Numbers y = swung(off);
    const Vector3 along{std::cos(y[0]), 0, -std::sin(y[0])}, across{-std::sin(y[0]), 0, -std::cos(y[0])};
    return {0.5 * along + s * (0.5 * y[1]) * across + Vector3{0, 0, -0.5 * g * s * s}, y[0] + s * y[1], y[1]};
}

void expect_flight(const Solved& s, double t, double tolerance)
{
    SCOPED_TRACE(t);
    const Flight exact = flown(t);
    const State state = s.solution.motion.at(t);
    EXPECT_LT(norm(state.X[0] * point({0.5, 0, 0}) - exact.center), tolerance);
    const Vector3 along{std::cos(exact.angle), 0, -std::sin(exact.angle)};
    EXPECT_LT(norm(state.X[0].column(1) - along), tolerance);
    EXPECT_NEAR(s.coordinate("hinge", "angle", t).rate, exact.rate, 10 * tolerance);
}

TEST(Events, AHingeLetsGo)
{
    for (const std::string time : {"accuracy = 1e-10\noutput = [0.3, 0.7, 1.1]",
                                   "elements = 30\noutput = 0.1\n[method]\ndegree = 10"}) {
        const Solved s = solved(pendulum(time));
        for (const double t : {0.0, 0.3, 0.7, 1.1, 1.5}) expect_flight(s, t, 2e-10);
        const std::vector<JointSample> at = sample_joints(s.model, s.solution.motion, 0.7);
        // the centre's acceleration, by the pendulum's equation, times the mass
        const Numbers y = swung(0.7);
        const double turn = 2 * g * 0.5 * std::cos(y[0]) / 0.7;
        const Vector3 along{std::cos(y[0]), 0, -std::sin(y[0])}, across{-std::sin(y[0]), 0, -std::cos(y[0])};
        const Vector3 held = 2 * (0.5 * turn * across - 0.5 * y[1] * y[1] * along + Vector3{0, 0, g});
        EXPECT_LT(norm(at[0].left.force - held), 1e-7);
        EXPECT_EQ(norm(at[0].right.force), 0);
        EXPECT_EQ(norm(s.reaction("hinge", 1.1).force), 0);
        const ErrorEstimate& told = s.solution.estimate;
        ASSERT_FALSE(told.empty());
        EXPECT_LT(told.largest, 1e-10);
        for (const double error : told.reaction) EXPECT_LT(error, 1e-6) << "sides are not mixed";
        bool is_told = false;
        for (const std::string& note : s.solution.report.notes)
            is_told = is_told || note.find("'hinge' is released at 0.7 s") != std::string::npos;
        EXPECT_TRUE(is_told);
    }
    const Solved held = solved(pendulum("accuracy = 1e-10", ""));
    EXPECT_GT(norm(held.solution.motion.at(1.5).X[0] * point({0.5, 0, 0}) - flown(1.5).center), 0.1)
        << "negative control";
}

/// Order 2p at element ends through the event; the exact sample between.
/// Behind its time the angle of a hinge, which expressions and springs go on to read, is that of the turn
/// about its axis which is left when the shortest turn from axis to axis is taken off: nobody states
/// directions across an axis, and none matters. Nor does it while the hinge holds.
TEST(Events, AnAngleGoesOnBehindItsHingeWhateverLiesAcrossIt)
{
    const auto solved_with = [](double across, const std::string& acts) {
        const std::string frame = "{ point = [0, 0, 0], rotation_vector = [0, 0, " + to_text(across) + "] }";
        return solved(R"(
[[body]]
name = "rod"
mass = 2
inertia = [0.15, 0.2, 0.3]
[[joint]]
name = "hinge"
type = "revolute"
between = ["world", "rod"]
frames = [)" + frame + ", " +
                      frame + "]\n" + acts + R"(
[[load]]
type = "torque"
body = "rod"
inputs = { q = "hinge.angle", w = "hinge.angle_rate" }
expression = ["0.3 + q", "0.2 - w", "-3*q"]
[[load]]
type = "spring"
joint = "hinge"
stiffness = 2
damping = 0.1
rest = 1
[time]
end = 1.5
accuracy = 1e-10
)");
    };
    for (const std::string acts : {"until = 0.3", "until = 0.9", ""}) {
        const Solved one = solved_with(0, acts);
        const Matrix34 X = one.solution.motion.at(1.5).X[0];
        const auto turned = [](const Matrix34& D) {   // as quaternions have it
            return 2 * std::atan2(quaternion_from_directors(directors(D))[3],
                                  quaternion_from_directors(directors(D))[0]);
        };
        EXPECT_NEAR(one.coordinate("hinge", "angle", 1.5).value, turned(X), 1e-9) << acts;
        EXPECT_EQ(X(2, 3) < 0.9, !acts.empty()) << "the axes have left each other, or not";
        for (const double across : {0.4, 2.0}) {
            const Solved other = solved_with(across, acts);
            EXPECT_LT(norm(other.solution.motion.at(1.5).X[0] - X), 1e-9) << acts << across;
            EXPECT_NEAR(other.coordinate("hinge", "angle", 1.2).value,
                        one.coordinate("hinge", "angle", 1.2).value, 1e-9);
        }
    }
}

TEST(Events, KeepTheOrder)
{
    double before = 0;
    for (const int n : {15, 30}) {
        const Solved s = solved(pendulum("elements = " + std::to_string(n) +
                                         "\noutput = [0.7]\n[method]\ndegree = 2\nestimate = \"none\""));
        const double error = norm(s.solution.motion.at(1.5).X[0] * point({0.5, 0, 0}) - flown(1.5).center);
        if (before > 0) {
            EXPECT_NEAR(std::log2(before / error), 4, 0.5);
        }
        before = error;
        const ExactSample exact = sample_exactly(s.model, s.solution.motion, s.solution.method, 0.9321);
        EXPECT_LT(norm(exact.state.X[0] * point({0.5, 0, 0}) - flown(0.9321).center), 2 * error + 1e-12);
    }
}

/// A crank at constant rate that is let go turns on by itself.
TEST(Events, ADriveLetsGo)
{
    const Solved s = solved(R"(
[[body]]
name = "wheel"
mass = 2
inertia = [2, 2, 3]
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "wheel"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[drive]]
name = "motor"
type = "joint"
joint = "axle"
until = 1
step = { from = 0.25, until = 1.75, rise = 6 }
[[load]]
type = "spring"
joint = "axle"
stiffness = 0
damping = 1.5
[time]
end = 3
accuracy = 1e-11
output = [0.5, 1, 2]
)");
    const auto step = [](double t) {
        const double u = (t - 0.25) / 1.5;
        return std::array{6 * u * u * u * (10 + u * (6 * u - 15)), 6 * 30 * u * u * (u - 1) * (u - 1) / 1.5};
    };
    const auto [q, w] = step(1);
    for (const double t : {1.0, 2.0, 3.0}) {
        const double decay = std::exp(-0.5 * (t - 1));   // I w' = -1.5 w
        EXPECT_NEAR(s.coordinate("axle", "angle", t).value, q + w * (1 - decay) / 0.5, 1e-10);
        EXPECT_NEAR(s.coordinate("axle", "angle", t).rate, w * decay, 1e-9);
    }
    EXPECT_NEAR(s.coordinate("axle", "angle", 0.5).value, step(0.5)[0], 1e-12);
    EXPECT_EQ(norm(s.reaction("motor", 2).torque), 0);
    EXPECT_GT(norm(s.reaction("motor", 0.5).torque), 1);
}

std::string relay(const std::string& second)
{
    return R"(
[[body]]
name = "cart"
mass = 2
inertia = [2, 2, 3]
[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "cart"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[drive]]
name = "first"
type = "joint"
joint = "rail"
until = 1
polynomial = [0, 0, 1]
[[drive]]
name = "second"
type = "joint"
joint = "rail"
from = 1
)" + second +
           "\n[time]\nend = 2\nelements = 20\n[method]\ndegree = 4\n";
}

/// One drive hands over to another that meets it: 1 m and 2 m/s at 1 s.
TEST(Events, ADriveBeginsWhereItMeetsTheMotion)
{
    const Solved s = solved(relay("polynomial = [-1, 2]"));
    EXPECT_NEAR(s.coordinate("rail", "displacement", 2).value, 3, 1e-13);
    const std::vector<JointSample> at = sample_joints(s.model, s.solution.motion, 1);
    EXPECT_NEAR(at[1].left.force[0], 4, 1e-10);
    EXPECT_NEAR(at[1].right.force[0], 0, 1e-10);
    EXPECT_NEAR(at[2].left.force[0], 0, 1e-10);
}

TEST(Events, ADriveThatDoesNotMeetTheMotionIsNoImpactUnseen)
{
    for (const std::string law : {"polynomial = [-0.99, 2]", "polynomial = [-0.9, 1.9]", "value = 1"}) {
        SCOPED_TRACE(law);
        const Scenario s = parse_scenario("format = 1\n" + relay(law), "test.toml").scenario.value();
        const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
        EXPECT_EQ(solution.report.status, SolveStatus::not_converged);
        EXPECT_NE(solution.report.message.find("'second' begins to act at 1 s"), std::string::npos)
            << solution.report.message;
        EXPECT_NEAR(solution.motion.end(), 1, 1e-12) << "what was solved is kept";
    }
}

// Places of the stone and direction of the arm, by equations in three angles and then a parabola, integrated
// by DOP853 to 3e-14.
struct Throw {
    double t;
    Vector3 stone;
    double arm_x, arm_z;
};
const Throw throws[] = {{0.5, {3.689447207942, 0, 0.859593250351}, 0.9770739864812, 0.2129000350909},
                        {0.9, {1.159428125787, 0, 9.025582310327}, -0.2361004567208, 0.971728652627},
                        {2, {-32.03130203604, 0, 24.49790664548}, -0.3651561360213, 0.9309462907848},
                        {3, {-62.20469309224, 0, 28.26315604108}, 0.8782507776453, 0.4782003466807}};

TEST(Events, TheTrebuchetAsShippedThrowsAsFarAsItsEquationsSay)
{
    const Shipped s = solve_example("trebuchet");
    for (const Throw& one : throws) {
        SCOPED_TRACE(one.t);
        const State state = s.at(one.t);
        EXPECT_LT(norm(state.X[s.body("stone")].column(0) - one.stone), 2e-8);
        EXPECT_LT(norm(state.X[s.body("arm")].column(1) - Vector3{one.arm_x, 0, one.arm_z}), 1e-8);
    }
}

/// A phase has a share of the accuracy: what was asked for has to stand in the message.
TEST(Events, WhatAPhaseCannotReachIsToldOfWhatWasAskedFor)
{
    Scenario s = read_scenario(root / "examples" / "trebuchet.toml").scenario.value();
    std::get<Span>(s.time).accuracy = 1e-15;
    const SolveReport report = solve(s.model, {s.model.start()}, s.time, s.method, s.options).report;
    EXPECT_EQ(report.status, SolveStatus::inaccurate);
    EXPECT_NE(report.message.find("the accuracy 1e-15 that is asked for over events"), std::string::npos)
        << report.message;
}

/// What a drive misses by is part of the error that is told, since the second solution is moved as well.
TEST(Events, WhatADriveMissesByIsTold)
{
    const Scenario s =
        parse_scenario("format = 1\n" + relay("polynomial = [-0.9999995, 2]"), "test.toml").scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_GT(solution.estimate.largest * s.model.length(), 4.9e-7) << "off by 5e-7 m";
    EXPECT_LT(solution.estimate.largest * s.model.length(), 5e-6);
    EXPECT_LT(solved(relay("polynomial = [-1, 2]")).solution.estimate.largest, 1e-12) << "negative control";
}

/// Where no place near fits, the motion up to there is kept as well; and radau goes through events.
TEST(Events, AreTheSameForRadauAndFarMisses)
{
    const std::string radau = "family = \"radau\"\n";
    EXPECT_NEAR(solved(relay("polynomial = [-1, 2]") + radau).coordinate("rail", "displacement", 2).value, 3,
                1e-12);
    const std::string turned = R"(
[[body]]
name = "a"
mass = 2
inertia = [2, 2, 3]
[[joint]]
name = "p"
type = "revolute"
between = ["world", "a"]
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "held"
type = "weld"
between = ["world", "a"]
at = [0, 0, 0]
until = 0.5
[[drive]]
type = "joint"
joint = "p"
from = 0.5
value = 1.6
[time]
end = 1
elements = 4
)";
    const Scenario s = parse_scenario("format = 1\n" + turned, "test.toml").scenario.value();
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_EQ(solution.report.status, SolveStatus::not_converged) << solution.report.message;
    EXPECT_NEAR(solution.motion.end(), 0.5, 1e-12);
}

/// A triple pendulum on a stiff spring that long elements do not resolve: its phase, where a joint lets go,
/// becomes a velocity that goes on. Against elements that resolve it.
TEST(Events, AVibrationThatIsNotResolvedIsPartOfTheError)
{
    std::string text = "gravity = [0, 0, -9.81]\n";
    const double pitch[] = {0, 0.3, -0.4};
    Vector3 at{};
    for (int i = 0; i < 3; ++i) {
        const Vector3 along{std::cos(pitch[i]), 0, -std::sin(pitch[i])}, middle = at + 0.5 * along;
        const auto vector = [](const Vector3& v) {
            return "[" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]\n";
        };
        const std::string n = std::to_string(i), before = i == 0 ? "world" : "b" + std::to_string(i - 1);
        text += "[[body]]\nname = \"b" + n +
                "\"\nmass = 1\ninertia = [0.08, 0.08, 0.08]\nposition = " + vector(middle) +
                "rotation_vector = " + vector({0, pitch[i], 0});
        text += "[[joint]]\nname = \"j" + n + "\"\ntype = \"revolute\"\nbetween = [\"" + before + "\", \"b" +
                n + "\"]\nat = " + vector(at) + "axis = [0, 1, 0]\n" + (i == 2 ? "until = 0.437\n" : "");
        at += along;
    }
    text += "[[load]]\ntype = \"spring\"\njoint = \"j1\"\nstiffness = 1e5\n[time]\nend = 1\n";
    const Solved fine =
        solved(text + "elements = 600\noutput = [0.437]\n[method]\ndegree = 8\nestimate = \"none\"\n");
    for (const std::string how :
         {"elements = 40\n[method]\nfamily = \"radau\"\ndegree = 4\n", "accuracy = 1e-2\n"}) {
        SCOPED_TRACE(how);
        const Scenario s = parse_scenario("format = 1\n" + text + how, "test.toml").scenario.value();
        const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
        ASSERT_EQ(solution.motion.end(), 1) << solution.report.message;
        const State a = solution.motion.at(1), b = fine.solution.motion.at(1);
        double error = 0;
        for (int i = 0; i < 3; ++i)
            error = std::max(error, norm(a.X[i].column(0) - b.X[i].column(0)) / s.model.length());
        EXPECT_LT(error, 1.5 * solution.estimate.largest);
    }
}

/// A four-bar has three rows too many as long as it is closed; then its rocker is let go.
TEST(Events, ALoopOpens)
{
    const std::string text = R"(
gravity = [0, 0, -9.81]
[[body]]
name = "crank"
mass = 1
inertia = [0.001, 0.02, 0.02]
position = [0.25, 0, 0]
[[body]]
name = "coupler"
mass = 1
inertia = [0.001, 0.08, 0.08]
position = [0.5, 0, 0.5]
directors = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
[[joint]]
name = "shaft"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[joint]]
name = "pin"
type = "revolute"
between = ["crank", "coupler"]
at = [0.5, 0, 0]
axis = [0, 1, 0]
[[joint]]
name = "slide"
type = "point_on_line"
between = ["world", "coupler"]
at = [0.5, 0, 1]
axis = [1, 0, 0]
until = 0.4
[[joint]]
name = "plane"
type = "point_in_plane"
between = ["world", "coupler"]
at = [0.5, 0, 0.5]
axis = [0, 1, 0]
[time]
end = 0.8
accuracy = 1e-9
output = [0.4]
)";
    const Solved s = solved(text);
    const std::vector<JointSample> closed = sample_joints(s.model, s.solution.motion, 0.2),
                                   open = sample_joints(s.model, s.solution.motion, 0.6);
    EXPECT_FALSE(closed[2].is_unique) << "the slide's row y";
    EXPECT_TRUE(open[2].is_unique);
    EXPECT_EQ(norm(open[2].left.force), 0);
    EXPECT_GT(norm(closed[2].left.force), 0.1);
    EXPECT_LT(violations(s.model, s.solution.motion).joints_at_nodes, 1e-12);
    EXPECT_LT(s.solution.verdict.energy_drift, 1e-9);
}

}   // namespace
}   // namespace livens::tests::events_test
