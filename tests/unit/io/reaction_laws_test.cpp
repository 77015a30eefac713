// SPDX-License-Identifier: BSD-3-Clause
// Loads that read reactions: friction of bearings against equations solved without livens, and what is
// refused.
#include <array>
#include <cmath>

#include "livens/multibody/controllers.h"
#include "livens/spacetime/solve.h"
#include "livens/statics/frequencies.h"
#include "unit/io/swinging_rod.h"

namespace livens::reaction_laws_test {

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

/// A pendulum swings up against its weight and stands still for an instant at the start, where friction
/// jumps: the jump is no damper that radau would be taken for. Rounding says on which side of it a state is.
TEST(ReactionLaws, ThatJumpWhereTheMotionBeginsAreNoDampers)
{
    const std::string jumps = "-0.3*0.05*pin.force*sign(pin.angle_rate)";
    const Scenario scenario = scenario_of(pendulum("end = 2\naccuracy = 1e-8", jumps));
    const HighestFrequencies found = highest_frequencies(scenario.model, scenario.model.start());
    EXPECT_LT(found.dampers.rate, 1) << "1/s";
    const SolvedScenario s = solve_scenario(scenario, scenario.options, scenario.prepared);
    EXPECT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    EXPECT_TRUE(std::holds_alternative<Lobatto>(s.solution.method));
    const Scenario steep =
        scenario_of(pendulum("end = 2", "-0.3*0.05*pin.force*tanh(pin.angle_rate/1e-4)"));
    EXPECT_GT(highest_frequencies(steep.model, steep.model.start()).dampers.rate, 100) << "negative control";
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

/// A block of 2 kg on a rail along x, at 2 m/s, and 1 kg that is welded below it `until` then.
std::string block(const std::string& until, const std::string& more)
{
    return R"(format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "block"
shape = { box = [0.2, 0.2, 0.2] }
mass = 2
[[body]]
name = "below"
shape = { sphere = 0.1 }
mass = 1
position = [0, 0, -1]
[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "block"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[joint]]
name = "hook"
type = "weld"
between = ["block", "below"]
at = [0, 0, -1]
until = )" +
           until + R"(
[start]
coordinates = [{ joint = "rail", value = 0, rate = 2 }]
[time]
end = 1
accuracy = 1e-10
)" + more;
}

const std::string friction = R"([[load]]
name = "friction"
type = "actuator"
joint = "rail"
expression = "10 - 0.2*rail.force"
)";

/// Of the first body.
std::array<double, 2> place_and_speed(const SolvedScenario& s)
{
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    return {last.X[0](0, 0), last.V[0](0, 0)};
}

SolvedScenario solved_well(const std::string& text)
{
    SolvedScenario s = test::solved(text);
    EXPECT_TRUE(s.solution.report.converged()) << text << s.solution.report.message;
    return s;
}

/// A rail bears 3 kg until the one below is let go, and 2 kg then: known beforehand, or by the motion.
TEST(ReactionLaws, ReadTheJointsThatAct)
{
    constexpr double g = 9.81, t = 0.5, a1 = 10 / 3.0 - 0.2 * g, a2 = 10 / 2.0 - 0.2 * g, v1 = 2 + a1 * t;
    for (const char* until : {"0.5", "\"t > 0.5\""}) {
        const std::array<double, 2> found = place_and_speed(solved_well(block(until, friction)));
        EXPECT_NEAR(found[0], 2 * t + a1 * t * t / 2 + v1 * t + a2 * t * t / 2, 1e-10) << until;
        EXPECT_NEAR(found[1], v1 + a2 * t, 1e-10) << until;
    }
}

/// They begin and end as other loads do.
TEST(ReactionLaws, ActWhenTheMotionSays)
{
    constexpr double g = 9.81, a = 10 / 3.0 - 0.2 * g;
    const std::array<double, 2> found =
        place_and_speed(solved_well(block("5", friction + "from = \"t > 0.25\"\nuntil = \"t > 0.75\"\n")));
    EXPECT_NEAR(found[1], 2 + 0.5 * a, 1e-10);
    EXPECT_NEAR(found[0], 0.25 * 2 + 0.5 * 2 + a / 8 + 0.25 * (2 + 0.5 * a), 1e-10);
}

const std::string wall = R"([[stop]]
name = "wall"
joint = "rail"
limits = ["-inf", 0.1]
restitution = 0
)";

/// What a stop bears drives another body: nothing until it is met.
TEST(ReactionLaws, ReadStops)
{
    const std::string text = R"([[body]]
name = "other"
shape = { sphere = 0.1 }
mass = 4
position = [0, 1, 0]
[[joint]]
name = "track"
type = "prismatic"
between = ["world", "other"]
at = [0, 1, 0]
axis = [1, 0, 0]
[[load]]
name = "push"
type = "force"
body = "block"
value = [3, 0, 0]
[[load]]
name = "copied"
type = "actuator"
joint = "track"
expression = "wall.force"
)";
    const SolvedScenario s = solved_well(block("5", wall + text));
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    const double met = 0.1 * 2 / (2 + std::sqrt(4 + 2 * 0.1));   // 2 t + t^2 / 2 = 0.1
    EXPECT_NEAR(last.X[0](0, 0), 0.1, 1e-12);
    EXPECT_NEAR(last.V[2](0, 0), 3 * (1 - met) / 4, 1e-9);
}

double state_of(const SolvedScenario& s, const std::string& text, double t, std::size_t k = 0)
{
    return states_in(scenario_of(text).model, s.solution.motion.at(t).V)[k].value;
}

/// A filter, samples, what an event sets, and a load that reads an output that reads a reaction.
TEST(ReactionLaws, AreReadByControllers)
{
    constexpr double g = 9.81, before = 3 * g, after = 2 * g;
    const std::string filter = R"([[controller]]
name = "filter"
states = { r = "(rail.force - r)/0.1" }
outputs = { o = "10 - 0.2*rail.force" }
)",
                      load = R"([[load]]
name = "friction"
type = "actuator"
joint = "rail"
expression = "filter.o"
)";
    const std::string text = block("0.5", filter + load);
    const SolvedScenario s = solved_well(text);
    const double half = before * (1 - std::exp(-5)), whole = after + (half - after) * std::exp(-5);
    EXPECT_NEAR(state_of(s, text, 1), whole, 1e-8);
    EXPECT_NEAR(place_and_speed(s)[1], 2 + 0.5 * (10 / 3.0 + 10 / 2.0) - 0.2 * g, 1e-10);

    const std::string sampled = block(
        "\"t > 0.5\"", "[[controller]]\nname = \"scale\"\nstates = { r = \"rail.force\" }\nevery = 0.2\n");
    const SolvedScenario of_samples = solved_well(sampled);
    EXPECT_NEAR(state_of(of_samples, sampled, 0.55), before, 1e-9);
    EXPECT_NEAR(state_of(of_samples, sampled, 0.65), after, 1e-9);

    const std::string set = block("\"t > 0.5\"", R"([[controller]]
name = "scale"
states = { r = "0" }
[[event]]
when = "t > 0.7"
set = { "scale.r" = "2*rail.force" }
)");
    EXPECT_NEAR(state_of(solved_well(set), set, 0.9), 2 * after, 1e-9);
}

/// A controller of the force on a wall: i' = 5 - f, where f = i.
TEST(ReactionLaws, ControlForces)
{
    const std::string text = R"(format = 1
body = [{ name = "block", shape = { box = [0.2, 0.2, 0.2] }, mass = 2 }]
[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "block"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[stop]]
name = "wall"
joint = "rail"
limits = ["-inf", 0]
[[controller]]
name = "hand"
states = { i = "5 - wall.force" }
start = { i = 1 }
[[load]]
name = "push"
type = "actuator"
joint = "rail"
expression = "hand.i"
[time]
end = 1
accuracy = 1e-10
)";
    EXPECT_NEAR(state_of(solved_well(text), text, 1), 5 - 4 * std::exp(-1), 1e-9);
}

/// With joints that come to share what they bear the load is no number, and the motion ends by name.
TEST(ReactionLaws, EndWhereJointsShareWhatTheyBear)
{
    const std::string second = R"([[joint]]
name = "second"
type = "prismatic"
between = ["world", "block"]
at = [0, 0, 0]
axis = [1, 0, 0]
from = 0.5
)";
    const SolvedScenario s = test::solved(block("5", friction + second));
    EXPECT_FALSE(s.solution.report.converged());
    EXPECT_NE(s.solution.report.message.find("share what they bear"), std::string::npos)
        << s.solution.report.message;
}

/// In a model that is added, displaced and turned, all is as it was.
TEST(ReactionLaws, MoveWithTheirModels)
{
    const std::string law = "-0.02*pin.force - 0.05*pin.force_x + 0.1*pin.torque_x";
    const Model alone = scenario_of(pendulum("end = 1", law)).model;
    Model whole(Vector3{0, 0, -9.81});
    const Displacement by{{1, 2, 3}, directors_from_rotation_vector({0, 0, 0.7})};
    whole.add(alone, "first ", by);
    whole.add(alone, "second ", {});
    const State at = alone.start(), there = whole.start();
    const auto torque = [](const Model& model, std::size_t k, const State& state) {
        const Load& load = model.loads()[k];
        return load.readings[0].value(load_arguments(load, {0, Side::right}, state.X, state.V));
    };
    const double own = torque(alone, 0, at);
    EXPECT_GT(std::abs(own), 0.1);
    for (const std::size_t k : {0, 1}) EXPECT_NEAR(torque(whole, k, there), own, 1e-12) << k;
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
    const std::string both = "from = \"pin.angle < 0\"\nuntil = \"pin.angle<0\"\n";
    EXPECT_EQ(code(pendulum("end = 1", "-0.3*pin.force", both)), "event-condition");
}

}   // namespace

}   // namespace livens::reaction_laws_test
