// SPDX-License-Identifier: BSD-3-Clause
// Loads that read reactions: friction of bearings against equations solved without livens, and what is
// refused.
#include <array>
#include <cmath>

#include "livens/spacetime/solve.h"
#include "unit/io/swinging_rod.h"

namespace livens {

namespace {

using test::read;
using test::scenario_of;

/// A pendulum from 1.2 rad whose bearing of 5 cm rubs, 0.3 of its force.
std::string pendulum(const std::string& time,
                     const std::string& torque = "-0.3*0.05*pin.force*tanh(pin.angle_rate/0.1)",
                     const std::string& more = "")
{
    return test::hanging_arm(R"([[load]]
name = "bearing"
type = "actuator"
joint = "pin"
expression = ")" + torque + "\"\n" +
                             more +
                             "\n[start]\ncoordinates = [{ joint = \"pin\", value = 1.2 }]\n\n[time]\n" +
                             time);
}

/// Angle and rate at 2 s by Dormand and Prince's 8(5,3), with the force of the pin by its own equations.
constexpr std::array<double, 2> at_2_s{-0.74441363005759, -1.6060686854068};

double error_of(const std::string& text)
{
    const Scenario scenario = scenario_of(text);
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    EXPECT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    const JointCoordinate& q = scenario.model.joints()[0].coordinates[0].coordinate;
    return std::max(std::abs(coordinate_value(q, last.X) - at_2_s[0]),
                    std::abs(coordinate_rate(q, last.X, last.V) - at_2_s[1]));
}

TEST(ReactionLaws, RubAsTheirEquationsSay)
{
    EXPECT_LT(error_of(pendulum("end = 2\naccuracy = 1e-9")), 1e-8);
}

/// Order 2p, which multipliers of nodes would not give.
TEST(ReactionLaws, HaveTheOrderOfTheMotion)
{
    // A law that bends less fast: errors of the first elements are not those of a steep tanh.
    const auto error = [&](int n) {
        return error_of(pendulum("end = 2\nelements = " + std::to_string(n) +
                                 "\n[method]\nfamily = \"lobatto\"\ndegree = 3"));
    };
    const double rough = error(160), fine = error(320);
    EXPECT_GT(std::log2(rough / fine), 5.5) << rough << " " << fine;
}

TEST(ReactionLaws, AreRefusedByName)
{
    const auto code = [](const std::string& text) {
        const ScenarioResult result = read(text);
        return result.diagnostics.empty() ? std::string("none") : result.diagnostics[0].code;
    };
    const std::string twice = R"([[joint]]
name = "other"
type = "revolute"
between = ["world", "arm"]
at = [0, 1, 0]
axis = [0, 1, 0]
)";
    EXPECT_EQ(code(pendulum("end = 1")), "none");
    EXPECT_EQ(code(pendulum("end = 1", "-0.3*pin.force", twice)), "event-reaction");
    EXPECT_EQ(code(pendulum("end = 1", "-0.3*axle.force")), "input-unknown");
    EXPECT_EQ(code(pendulum("end = 1", "-0.3*pin.force", "until = \"pin.angle < 0\"\n")), "event-method");
    const std::string latch = R"([[joint]]
name = "latch"
type = "spherical"
between = ["world", "arm"]
at = [0, 0, 0]
from = 0.5
)";
    EXPECT_EQ(code(pendulum("end = 1", "-0.3*pin.force", latch)), "event-method");
}

}   // namespace

}   // namespace livens
