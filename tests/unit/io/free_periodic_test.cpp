// SPDX-License-Identifier: BSD-3-Clause
// Periodic motions of what nothing drives: periods and turns against elliptic integrals and figures of other
// programs.
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "livens/dynamics/start/prepared.h"
#include "livens/io/solve_scenario.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::free_periodic_test {
namespace {

using test::read;
using test::replaced;
using test::shown;

constexpr double g = 9.81;

const std::string in_plane = R"(format = 1
gravity = [0, 0, -9.81]

[time]
end = { unknown = 2.6 }
elements = 16
periodic = true

[method]
family = "lobatto"
degree = 8

[[body]]
name = "bob"
shape = { point = true }
mass = 1
position = [1, 0, 0]

[[joint]]
name = "rod"
type = "rod"
between = ["world", "bob"]

[[joint]]
name = "plane"
type = "point_in_plane"
between = ["world", "bob"]
points = [[0, 0, 0], [0, 0, 0]]
axis = [0, 1, 0]

[start.known]
"bob.z" = 0
"bob.vz" = 0
)";

/// An arm that is long enough for a second bob.
const std::string second = R"(
[[body]]
name = "end"
shape = { point = true }
mass = 1
position = [AT]

[[joint]]
name = "second rod"
type = "rod"
between = ["bob", "end"]

[[joint]]
name = "second plane"
type = "point_in_plane"
between = ["world", "end"]
points = [[0, 0, 0], [0, 0, 0]]
axis = [0, 1, 0]
)";

const std::string in_space = R"(format = 1
gravity = [0, 0, -9.81]

[time]
end = { unknown = 1.18 }
elements = 16
periodic = { turn = { unknown = 3.3 } }

[method]
family = "lobatto"
degree = 8

[[body]]
name = "ball"
shape = { point = true }
mass = 1
position = [0.8660254037844386, 0, -0.5]
velocity = [0, 1.2, 0]

[[joint]]
name = "string"
type = "rod"
between = ["world", "ball"]

[start.known]
"ball.z" = -0.5
"ball.y" = 0
"ball.vz" = 0
"ball.vy" = 1.2
)";

/// Van der Pol's oscillator with mu = 1, about x = 0.
const std::string self_excited = R"toml(format = 1

[time]
end = { unknown = 6.2 }
elements = 40
periodic = true

[method]
family = "lobatto"
degree = 8

[[body]]
name = "cart"
shape = { box = [0.1, 0.1, 0.1] }
mass = 1
position = [0, 0, 0]
velocity = [2, 0, 0]

[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "cart"]
at = [0, 0, 0]
axis = [1, 0, 0]

[[load]]
name = "supply"
type = "actuator"
joint = "rail"
inputs = { x = "rail.displacement", v = "rail.displacement_rate" }
expression = "(1 - x^2)*v - x"

[start.known]
"cart.x" = 0
)toml";

std::string digits(double x)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

Solution solved(const std::string& text)
{
    const ScenarioResult result = read(text);
    if (!result.scenario) {
        ADD_FAILURE() << shown(result);
        Solution none;
        none.report.status = SolveStatus::not_converged;
        return none;
    }
    return solve_scenario(*result.scenario, result.scenario->options, std::make_shared<Prepared>()).solution;
}

std::string code_of(const std::string& text)
{
    const ScenarioResult refused = read(text);
    return refused.diagnostics.size() == 1 ? refused.diagnostics[0].code : shown(refused);
}

/// The end is the start, to rounding, and what is conserved was so.
void expect_closed(const Solution& s)
{
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const State first = s.motion.at_end(0), last = s.motion.at_end(s.motion.n_elements());
    for (std::size_t b = 0; b < first.X.size(); ++b) {
        EXPECT_LE(norm(last.X[b] - first.X[b]), 1e-11);
        EXPECT_LE(norm(last.V[b] - first.V[b]), 1e-10);
    }
    for (const double unfolded : s.numbers.unfolded) EXPECT_LE(std::abs(unfolded), 1e-11);
}

TEST(FreePeriodic, PendulumsHaveTheirPeriods)
{
    const double exact = 2.36784194757623745;   // 4 K(1/2) / sqrt(g)
    for (const double wrong : {0.9, 1.1}) {
        const Solution s = solved(replaced(in_plane, "unknown = 2.6", "unknown = " + digits(wrong * exact)));
        ASSERT_NO_FATAL_FAILURE(expect_closed(s));
        EXPECT_NEAR(s.numbers.values.at(0), exact, 1e-12) << wrong;
        EXPECT_LE(s.report.iterations.at(0), 9) << wrong;
        EXPECT_EQ(s.numbers.unfolded.size(), 1u);
    }
}

/// The energy stands for the amplitude, or the period, whose motion is sought.
TEST(FreePeriodic, AnyConditionTellsWhichMotionItIs)
{
    const Solution s =
        solved(replaced(replaced(in_plane, "\"bob.z\" = 0", "energy = -1"), "[1, 0, 0]", "[0.96, 0, -0.28]"));
    ASSERT_NO_FATAL_FAILURE(expect_closed(s));
    const double k2 = (g - 1) / (2 * g);   // sin^2 of half the amplitude: E = -g cos(amplitude)
    EXPECT_NEAR(s.numbers.values.at(0), 4 * std::comp_ellint_1(std::sqrt(k2)) / std::sqrt(g), 1e-11);
}

/// A spring of a joint counts its turns, and stores energy as others do.
TEST(FreePeriodic, SpringsOfJointsKeepEnergy)
{
    std::string text = self_excited;
    const std::size_t load = text.find("[[load]]");
    text.erase(load, text.find("[start.known]") - load);
    text = replaced(text, "axis = [1, 0, 0]\n", "axis = [1, 0, 0]\nstiffness = 4\n") + "\"cart.vx\" = 2\n";
    const Solution s = solved(replaced(text, "unknown = 6.2", "unknown = 3"));
    ASSERT_NO_FATAL_FAILURE(expect_closed(s));
    EXPECT_NEAR(s.numbers.values.at(0), std::numbers::pi, 1e-12);
    std::string wheel = replaced(text, "\"prismatic\"", "\"revolute\"");
    wheel = replaced(replaced(wheel, "\"cart.vx\" = 2", "\"rail.angle_rate\" = 0.1"), "\"cart.x\"",
                     "\"rail.angle\"");
    wheel = replaced(wheel, "velocity = [2, 0, 0]", "angular_velocity = [0.1, 0, 0]");
    const double inertia = 0.01 / 6;
    wheel = replaced(wheel, "unknown = 6.2",
                     "unknown = " + digits(2.2 * std::numbers::pi * std::sqrt(inertia / 4)));
    const Solution turning = solved(wheel);
    ASSERT_NO_FATAL_FAILURE(expect_closed(turning));
    EXPECT_NEAR(turning.numbers.values.at(0), std::numbers::pi * std::sqrt(inertia), 1e-12);
}

/// Modes in which both swing alike, 10 J and 20 J above hanging: periods of another program on two meshes.
TEST(FreePeriodic, ModesOfADoublePendulumHaveTheirPeriods)
{
    for (const auto& [energy, period] : {std::pair{10.0, 2.7323285454287}, std::pair{20.0, 2.84674933640}}) {
        // the linear mode: the second rod by sqrt 2 of the first; potential energy 2 g a^2
        const double a = std::sqrt(energy / (2 * g)), b = std::sqrt(2.0) * a;
        std::string text =
            replaced(in_plane, "[1, 0, 0]", "[" + digits(std::sin(a)) + ", 0, " + digits(-std::cos(a)) + "]");
        text = replaced(text, "\"bob.z\" = 0\n", "energy = " + digits(energy - 3 * g) + "\n");
        text = replaced(text, "elements = 16", "elements = 32");
        text = replaced(text, "\"bob.vz\"", "\"bob.vx\"");
        text += replaced(second, "AT",
                         digits(std::sin(a) + std::sin(b)) + ", 0, " + digits(-std::cos(a) - std::cos(b)));
        const Solution s = solved(text);
        ASSERT_NO_FATAL_FAILURE(expect_closed(s));
        EXPECT_NEAR(s.numbers.values.at(0), period, 2e-11) << energy;
    }
}

TEST(FreePeriodic, SphericalPendulumsComeBackTurned)
{
    const Solution s = solved(in_space);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.numbers.values.at(0), 1.078197607767349, 1e-12);
    EXPECT_NEAR(s.numbers.values.at(1), 3.615084340317049, 1e-12);
    const State first = s.motion.at_end(0), last = s.motion.at_end(16);
    const AxisTurn turn{s.numbers.values.at(1)};
    EXPECT_LE(norm(turned(turn, first.X[0]) - last.X[0]), 1e-11);
    EXPECT_LE(norm(turned_rate(turn, first.V[0]) - last.V[0]), 1e-10);
    EXPECT_GT(norm(first.X[0] - last.X[0]), 0.1);   // not without the turn
}

TEST(FreePeriodic, LimitCyclesNeedOneConditionAlone)
{
    const Solution s = solved(self_excited);
    ASSERT_NO_FATAL_FAILURE(expect_closed(s));
    EXPECT_NEAR(s.numbers.values.at(0), 6.66328685932313, 1e-12);
    EXPECT_TRUE(s.numbers.unfolded.empty());
    EXPECT_EQ(code_of(self_excited + "\"cart.vx\" = 2\n"), "conditions-too-many");
}

/// Everything that holds of a motion at rest holds for any period.
TEST(FreePeriodic, BodiesAtRestAreNone)
{
    std::string text = replaced(in_plane, "{ unknown = 2.6 }", "2.2");
    text = replaced(replaced(text, "\"bob.z\" = 0\n", ""), "\"bob.vz\" = 0", "\"bob.vx\" = 0");
    const Solution s = solved(replaced(text, "[1, 0, 0]", "[0, 0, -1]"));
    EXPECT_EQ(s.report.status, SolveStatus::suspect) << s.report.message;
    EXPECT_NE(s.report.message.find("at rest"), std::string::npos) << s.report.message;
    // near the motion of this period it is found
    const Solution moving = solved(replaced(text, "[1, 0, 0]", "[0.96, 0, -0.28]"));
    ASSERT_NO_FATAL_FAILURE(expect_closed(moving));
    EXPECT_GT(moving.motion.at_end(0).X[0](0, 0), 0.5);
}

/// Half a period later the energy is the same at the other end of the swing: that solves what is unfolded,
/// and is no period.
TEST(FreePeriodic, OtherPlacesOfTheSameEnergyAreNoPeriods)
{
    if (is_sanitized) GTEST_SKIP() << study;
    std::string text = self_excited;
    const std::size_t load = text.find("[[load]]");
    text.erase(load, text.find("[start.known]") - load);
    text = replaced(text, "axis = [1, 0, 0]\n", "axis = [1, 0, 0]\nstiffness = 4\n");
    text = replaced(replaced(text, "velocity = [2, 0, 0]", "velocity = [0, 0, 0]"), "\"cart.x\" = 0",
                    "\"cart.x\" = 1");
    text += "\"cart.vx\" = 0\n";
    for (const double share : {0.5, 1.45, 1.55, 2.4}) {
        const Solution s =
            solved(replaced(text, "unknown = 6.2", "unknown = " + digits(share * std::numbers::pi)));
        if (!s.report.converged()) {
            EXPECT_EQ(s.report.status, SolveStatus::suspect) << share << ": " << s.report.message;
            continue;
        }
        ASSERT_NO_FATAL_FAILURE(expect_closed(s));
        const double periods = s.numbers.values.at(0) / std::numbers::pi;
        EXPECT_NEAR(periods, std::round(periods), 1e-11) << share;
    }
}

TEST(FreePeriodic, WhatDoesNotDetermineThemIsRefused)
{
    EXPECT_EQ(code_of(replaced(in_plane, "\"bob.vz\" = 0\n", "")), "conditions-too-few");
    EXPECT_EQ(code_of(replaced(in_plane, "\"bob.vz\" = 0\n", "\"bob.vz\" = 0\nenergy = 1\n")),
              "conditions-dependent");
    const ScenarioResult few = read(replaced(in_space, "\"ball.y\" = 0\n", ""));
    EXPECT_NE(shown(few).find("no motion changes its energy"), std::string::npos) << shown(few);
    EXPECT_NE(shown(few).find("no motion changes its angular momentum"), std::string::npos) << shown(few);
    const std::string brake = "\n[[load]]\nname = \"air\"\ntype = \"drag\"\nbody = \"bob\"\nlinear = 0.3\n";
    const std::string braked = replaced(replaced(in_plane, "{ unknown = 2.6 }", "2.6"),
                                        "[start.known]\n\"bob.z\" = 0\n\"bob.vz\" = 0\n", "");
    EXPECT_EQ(code_of(braked), "conditions-too-few");
    EXPECT_EQ(code_of(replaced(in_plane, "type = \"rod\"\n", "type = \"rod\"\nuntil = 1\n")),
              "joint-time-method");
    const auto turned = [&](const std::string& how) {
        return code_of(replaced(in_space, "{ turn = { unknown = 3.3 } }", how));
    };
    EXPECT_EQ(turned("{ turn = { unknown = 3.3 }, axis = [1, 0, 0] }"), "periodic-turn");
    EXPECT_EQ(turned("{ turn = { unknown = 3.3 }, at = [1, 0, 0] }"), "periodic-turn");
    EXPECT_EQ(turned("{ turn = { unknown = 3.3 }, axis = [0, 0, 0] }"), "axis-zero");
    EXPECT_EQ(turned("{ axis = [0, 0, 1] }"), "missing-key");
    EXPECT_EQ(turned("3"), "wrong-type");
}

/// Of bodies that no weight turns: of four numbers of a state on a sphere three are kept.
TEST(FreePeriodic, MomentaAreKeptToo)
{
    std::string free = replaced(in_space, "gravity = [0, 0, -9.81]\n", "");
    free = replaced(free, "{ turn = { unknown = 3.3 } }", "true");
    const std::string said = shown(read(replaced(free, "\"ball.vy\" = 1.2\n", "")));
    for (const char* kept : {"its energy", "its angular momentum x", "its angular momentum y"})
        EXPECT_NE(said.find(kept), std::string::npos) << kept << ": " << said;
    EXPECT_EQ(said.find("its angular momentum z"), std::string::npos) << said;   // follows from the others
    EXPECT_EQ(said.find("its momentum"), std::string::npos) << said;
    const Solution s = solved(replaced(free, "unknown = 1.18", "unknown = 5"));
    ASSERT_NO_FATAL_FAILURE(expect_closed(s));
    EXPECT_NEAR(s.numbers.values.at(0), 2 * std::numbers::pi / 1.2, 1e-12);
}

}   // namespace
}   // namespace livens::free_periodic_test
