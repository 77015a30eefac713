// SPDX-License-Identifier: BSD-3-Clause
// Unknown numbers in files: { unknown = guess, low = .., high = .. } in place of a number.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "livens/dynamics/start/prepared.h"
#include "livens/io/solve_scenario.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::unknowns_test {
namespace {

using test::find;
using test::read;
using test::replaced;
using test::shown;

const std::string pendulum = R"(format = 1
gravity = [0, 0, -9.81]

[parameters]
L = "100 cm"

[time]
end = 2
elements = 20

[method]
family = "lobatto"
degree = 8

[[body]]
name = "bob"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = ["L", 0, 0]

[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "bob"]
at = [0, 0, 0]
axis = [0, 1, 0]

[[load]]
name = "friction"
type = "spring"
joint = "pivot"
stiffness = 0
damping = { unknown = 0.3, low = 0 }

[start.known]
"pivot.angle" = 0
"pivot.angle_rate" = 0

[end.known]
"pivot.angle" = "60 deg"
)";

SolvedScenario solved(const Scenario& scenario)
{
    return solve_scenario(scenario, scenario.options, std::make_shared<Prepared>());
}

/// What arrives at the end of a march from the start that was found, in the model that was found.
void expect_march_arrives(const SolvedScenario& s)
{
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    ASSERT_NE(s.found, nullptr);
    SolveOptions options;
    options.tolerance = 1e-13;
    const Motion& motion = s.solution.motion;
    const Motion march = solve(s.found->model, {{motion.at_end(0)}}, motion.mesh, Lobatto{8}, options).motion;
    const Matrix34 off = march.at_end(march.n_elements()).X[0] - motion.at_end(motion.n_elements()).X[0];
    EXPECT_LE(norm(off), 1e-9);
}

TEST(UnknownsOfFiles, AreFoundAndStandInTheScenarioOfTheResult)
{
    const ScenarioResult result = read(pendulum);
    ASSERT_TRUE(result.scenario) << shown(result);
    ASSERT_EQ(result.scenario->unknowns.numbers.size(), 1u);
    EXPECT_EQ(result.scenario->unknowns.numbers[0].name, "friction.damping");
    EXPECT_EQ(result.scenario->unknowns.numbers[0].low, 0);
    SolvedScenario s = solved(*result.scenario);
    expect_march_arrives(s);
    const double damping = s.solution.numbers.values[0];
    EXPECT_EQ(s.found->unknowns.numbers[0].guess, damping);
    EXPECT_GT(std::abs(damping - 0.3), 0.1);
    const livens::Run run = judged_run(*result.scenario, std::move(s), {});
    EXPECT_TRUE(run.report.converged()) << run.report.message;
    EXPECT_NE(run.resolved.find("\"friction.damping\""), std::string::npos);
    const ScenarioResult again = read(run.scenario_text);
    ASSERT_TRUE(again.scenario) << shown(again);
    const SolvedScenario same = solved(*again.scenario);
    EXPECT_NEAR(same.solution.numbers.values[0], damping, 1e-12);
}

TEST(UnknownsOfFiles, MayBeParametersThatMuchIsComputedFrom)
{
    std::string text = replaced(pendulum, "L = \"100 cm\"", "L = { unknown = \"100 cm\", high = \"3 m\" }");
    text = replaced(text, "{ unknown = 0.3, low = 0 }", "0.3");
    const ScenarioResult result = read(text);
    ASSERT_TRUE(result.scenario) << shown(result);
    EXPECT_EQ(result.scenario->unknowns.numbers[0].name, "L");
    EXPECT_EQ(result.scenario->unknowns.numbers[0].guess, 1);
    EXPECT_EQ(result.scenario->unknowns.numbers[0].high, 3);
    const SolvedScenario s = solved(*result.scenario);
    expect_march_arrives(s);
    const double L = s.solution.numbers.values[0];
    EXPECT_EQ(s.found->model.bodies()[0].X(0, 0), L);
    EXPECT_NE(s.found->text.find(" m\", high"), std::string::npos) << s.found->text;
}

TEST(UnknownsOfFiles, MayBeTheEndOfTimeAndAPlace)
{
    std::string text = replaced(pendulum, "end = 2", "end = { unknown = 1.9 }");
    text = replaced(text, "{ unknown = 0.3, low = 0 }", "0.3");
    const ScenarioResult result = read(text);
    ASSERT_TRUE(result.scenario) << shown(result);
    const SolvedScenario s = solved(*result.scenario);
    expect_march_arrives(s);
    EXPECT_EQ(end_of(s.found->time), s.solution.motion.end());
    EXPECT_EQ(result.scenario->unknowns.numbers[0].name, "time.end");

    // the pivot goes with an unknown height, as does what is known of the bob
    text = replaced(pendulum, "at = [0, 0, 0]", "at = [{ unknown = 0.1, low = -0.5 }, 0, 0]");
    text = replaced(text, "{ unknown = 0.3, low = 0 }", "0.3");
    const ScenarioResult place = read(text);
    ASSERT_TRUE(place.scenario) << shown(place);
    EXPECT_EQ(place.scenario->unknowns.numbers[0].name, "pivot.at.x");
    expect_march_arrives(solved(*place.scenario));
}

/// The foot of the rocker is not known.
const std::string four_bar = R"(format = 1
gravity = [0, 0, -9.81]
[parameters]
base = 2
[time]
end = 0.3
elements = 10
[method]
family = "lobatto"
degree = 6
[[body]]
name = "crank"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = [0, 0, 0.5]
[[body]]
name = "coupler"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = ["base/2", 0, 1]
[[body]]
name = "rocker"
mass = 1
inertia = [0.1, 0.1, 0.1]
position = ["base", 0, 0.5]
[[joint]]
name = "A"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[joint]]
name = "B"
type = "revolute"
between = ["crank", "coupler"]
at = [0, 0, 1]
axis = [0, 1, 0]
[[joint]]
name = "C"
type = "revolute"
between = ["coupler", "rocker"]
at = ["base", 0, 1]
axis = [0, 1, 0]
[[joint]]
name = "D"
type = "revolute"
between = ["world", "rocker"]
at = ["base", 0, { unknown = 0, low = -0.5, high = 0.5 }]
axis = [0, 1, 0]
[start.known]
"A.angle" = "20 deg"
"A.angle_rate" = 1
"D.angle" = "22 deg"
)";

/// Two angles of a four-bar say where a joint is: they follow from each other while it is known.
TEST(UnknownsOfFiles, MayBeThePlaceOfAJointOfAClosedLoop)
{
    const ScenarioResult result = read(four_bar);
    ASSERT_TRUE(result.scenario) << shown(result);
    const SolvedScenario s = solved(*result.scenario);
    expect_march_arrives(s);
    const double z = s.solution.numbers.values[0];
    EXPECT_GT(std::abs(z), 1e-3);
    // by the closure of the loop alone: crank 1 from (0, 0), rocker 1 - z from (2, z), coupler 2
    const double a = 20 * M_PI / 180, d = 22 * M_PI / 180;
    const double bx = std::sin(a), bz = std::cos(a), r = 1 - z, cx = 2 + r * std::sin(d),
                 cz = z + r * std::cos(d);
    EXPECT_NEAR(std::hypot(cx - bx, cz - bz), 2, 1e-10);
}

/// Elements that are too long for their degree: whatever comes of it, it is judged at its own nodes.
TEST(UnknownsOfFiles, OneElementOrTwoAreEnough)
{
    for (const char* elements : {"elements = 1", "elements = 2", "elements = 3"}) {
        const ScenarioResult result = read(replaced(pendulum, "elements = 20", elements));
        ASSERT_TRUE(result.scenario.has_value()) << shown(result);
        const SolvedScenario s = solved(*result.scenario);
        ASSERT_TRUE(s.solution.report.converged()) << elements << ": " << s.solution.report.message;
        EXPECT_NEAR(s.solution.numbers.values.at(0), 0.4376, 0.07) << elements;
        EXPECT_LT(s.solution.report.moved_by_rounding, 1e-10) << elements;
    }
}

/// A relay drives an oscillator against its damping: each half of the cycle is one of a damped oscillator,
/// so the period is 2 pi / sqrt(1 - 0.1^2) s. Forces jump where the rate turns, at both ends of time and in
/// the middle, or elsewhere.
TEST(UnknownsOfFiles, AreFoundWhereForcesJump)
{
    const auto text = [](const std::string& known, const std::string& time) {
        return R"file(format = 1
[[body]]
name = "b"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "s"
type = "prismatic"
between = ["world", "b"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[load]]
type = "actuator"
joint = "s"
expression = "-s.displacement - 0.2*s.displacement_rate + 0.5*sign(s.displacement_rate)"
[start]
coordinates = [{ joint = "s", value = 3, rate = 0.001 }]
known = )file" + known +
               "\n[time]\nend = { unknown = 6.2 }\nperiodic = true\n" + time;
    };
    const double period = 2 * 3.141592653589793 / std::sqrt(0.99);
    for (const char* known : {R"({ "s.displacement_rate" = 0 })", R"({ "s.displacement" = 2 })"})
        for (const char* time : {"elements = 40", "accuracy = 1e-9", "accuracy = 1e-11"}) {
            const SolvedScenario s = solved(*read(text(known, time)).scenario);
            ASSERT_TRUE(s.solution.report.converged()) << known << time << s.solution.report.message;
            const double off = std::abs(s.solution.numbers.values[0] - period);
            EXPECT_LT(off, 2 * s.solution.numbers.errors[0]) << known << time;
            EXPECT_LT(off, 1e-7) << known << time;
        }
}

/// Gravity, and a motion scaled with the mass: of a point mass and its friction only the ratio shows.
TEST(UnknownsOfFiles, ThatActAlikeAreNotDetermined)
{
    if (is_sanitized) GTEST_SKIP() << study;
    const std::string light = replaced(pendulum, "inertia = [0.1, 0.1, 0.1]", "inertia = [1e-9, 1e-9, 1e-9]");
    const ScenarioResult one = read(light);
    ASSERT_TRUE(one.scenario.has_value()) << shown(one);
    const SolvedScenario s = solved(*one.scenario);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const State end = s.solution.motion.at_end(20);
    char rate[40];
    std::snprintf(rate, sizeof rate, "%.17g", angular_velocity(end.X[0], end.V[0])[1]);
    std::string both = replaced(light, "mass = 1\n", "mass = { unknown = 1.1, low = 0.2, high = 5 }\n");
    both += std::string("\"pivot.angle_rate\" = ") + rate + "\n";
    const ScenarioResult two = read(both);
    ASSERT_TRUE(two.scenario.has_value()) << shown(two);
    const SolvedScenario alike = solved(*two.scenario);
    EXPECT_FALSE(alike.solution.report.converged());   // free along a valley, or at a bound
}

TEST(UnknownsOfFiles, ThatAreWrongAreRefusedWhereTheyStand)
{
    struct Wrong {
        std::string from, to, code;
    };
    const Wrong cases[] = {
        {"low = 0 }", "low = 1 }", "unknown-guess"},
        {"low = 0 }", "low = 2, high = 1 }", "unknown-bounds"},
        {"low = 0 }", "most = 1 }", "unknown-key"},
        {"unknown = 0.3", "unknown = true", "wrong-type"},
        {"unknown = 0.3", "unknown = \"3 m\"", "unit"},
        {"unknown = 0.3", "unknown = \"3*M\"", "expression-name"},
        {"low = 0 }", "low = \"1 m\" }", "unit"},
        {"elements = 20", "elements = { unknown = 20 }", "unknown-place"},
        {"type = \"spring\"", "type = { unknown = 3 }", "unknown-place"},
        {"family = \"lobatto\"", "family = \"radau\"", "conditions-method"},
        {"end = 2", "end = { unknown = 2 }", "conditions-too-few"},
        {"unknown = 0.3, low = 0 }", "unknown = 0, low = -1 }", "out-of-range"},
    };
    for (const Wrong& wrong : cases) {
        const std::string text = replaced(pendulum, wrong.from, wrong.to);
        const ScenarioResult result = read(text);
        EXPECT_FALSE(result.scenario) << wrong.to;
        const Diagnostic* told = find(result, wrong.code);
        ASSERT_NE(told, nullptr) << wrong.to << '\n' << shown(result);
        EXPECT_GT(told->line, 0) << wrong.to;
    }
    // beside a guess there may be no model: the number is named, and where it stands
    const ScenarioResult beside =
        read(replaced(pendulum, "unknown = 0.3, low = 0 }", "unknown = 0, low = -1 }"));
    const Diagnostic* told = find(beside, "out-of-range");
    ASSERT_NE(told, nullptr);
    EXPECT_EQ(told->line, 33) << shown(beside);
    EXPECT_NE(told->message.find("the unknown 'friction.damping' is -0"), std::string::npos) << told->message;
    const std::string parameter = replaced(pendulum, "L = \"100 cm\"", "L = { unknown = \"100 cx\" }");
    const ScenarioResult computed = read(parameter);
    ASSERT_EQ(computed.diagnostics.size(), 1u) << shown(computed);
    EXPECT_EQ(computed.diagnostics[0].line, 5) << shown(computed);
    const ScenarioResult march = read(pendulum.substr(0, pendulum.find("[start.known]")));
    ASSERT_NE(find(march, "unknown-march"), nullptr) << shown(march);
}

/// Without friction no pendulum depends on its mass, which only solving can tell.
TEST(UnknownsOfFiles, ThatNothingShowsAreToldWhereTheyStand)
{
    std::string text = replaced(pendulum, "mass = 1", "mass = { unknown = 1, low = 0.1 }");
    text = replaced(text, "damping = { unknown = 0.3, low = 0 }", "damping = 0");
    const std::string light = replaced(text, "inertia = [0.1, 0.1, 0.1]", "inertia = [1e-14, 1e-14, 1e-14]");
    // nor does a body of its own inertia where nothing pulls it: it turns as it was made to
    const std::string still = replaced(text, "gravity = [0, 0, -9.81]", "gravity = [0, 0, 0]");
    for (const std::string& wrong : {light, still}) {
        const ScenarioResult result = read(wrong);
        ASSERT_TRUE(result.scenario) << shown(result);
        try {
            solved(*result.scenario);
            FAIL() << "solved";
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "unknown-unseen");
            const Diagnostic told = diagnostic_of(*result.scenario, error.complaint());
            EXPECT_EQ(told.severity, Severity::error);
            EXPECT_EQ(told.code, "unknown-unseen");
            EXPECT_EQ(told.file, "test.toml");
            EXPECT_EQ(told.line, 17);
            EXPECT_EQ(told.column, 8);
        }
    }
}

}   // namespace
}   // namespace livens::unknowns_test
