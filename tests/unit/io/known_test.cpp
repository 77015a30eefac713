// SPDX-License-Identifier: BSD-3-Clause
// [start.known] and [end.known]: conditions by component as files give them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "livens/spacetime/solve.h"
#include "unit/io/scenario_text.h"

namespace livens::known_test {
namespace {

using test::find;
using test::read;
using test::shown;

constexpr std::string_view links = R"(format = 1
gravity = [0, 0, -9.81]

[parameters]
swing = "60 deg"

[time]
end = 1
elements = 12

[[body]]
name = "rod"
shape = { box = [1, 0.1, 0.1] }
mass = 2
position = [0.5, 0, 0]

[[body]]
name = "ball"
mass = 1
inertia = [1, 1, 1]

[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]

[[sensor]]
name = "tip"
type = "point"
body = "rod"
point = [0.5, 0, 0]
)";

std::string with(const std::string& conditions) { return std::string(links) + conditions; }

const std::string all = R"(
[start.known]
"pivot.angle" = "swing / 2"
"ball.position" = [0, 0, "20 cm"]
"ball.rotation" = [0, 0, 0]

[end.known]
"tip.vz" = 1.5
"ball.velocity" = ["3.6 km/h", 0, 0]
"ball.angular_velocity" = [0, "180 deg/s", 0]
)";

TEST(KnownComponents, AreReadInTheirUnits)
{
    const ScenarioResult result = read(with(all));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    const Conditions& c = result.scenario->conditions;
    EXPECT_EQ(c.at_start, Known::nothing);
    EXPECT_EQ(c.at_end, Known::nothing);
    ASSERT_EQ(c.components.size(), 14u);
    EXPECT_EQ(c.components[0].quantity.name, "pivot.angle");
    EXPECT_DOUBLE_EQ(c.components[0].value, std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(c.components[3].value, 0.2);
    EXPECT_EQ(c.components[7].quantity.name, "tip.vz");
    EXPECT_EQ(c.components[7].at, Condition::At::end);
    EXPECT_DOUBLE_EQ(c.components[8].value, 1);
    EXPECT_DOUBLE_EQ(c.components[12].value, std::numbers::pi);
    EXPECT_NE(result.scenario->resolved.find("\"tip.vz\""), std::string::npos) << result.scenario->resolved;
}

TEST(KnownComponents, AreMetByTheMotion)
{
    const ScenarioResult result = read(with(all));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Scenario& scenario = *result.scenario;
    const Solution s = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const State start = s.motion.at_end(0), end = s.motion.at_end(12);
    EXPECT_NEAR(start.X[0](2, 0), -0.5 * std::sin(std::numbers::pi / 6), 1e-12);
    EXPECT_NEAR(2 * end.V[0](2, 0), 1.5, 1e-12);   // of the tip, twice as far out
    EXPECT_NEAR(end.V[1](0, 0), 1, 1e-12);
}

// [body.start] is a guess, and changes nothing of what is asked for; nor does a displaced part.
TEST(KnownComponents, OfRotationsCountFromWhereBodiesArePlaced)
{
    const std::string free = R"(format = 1
gravity = [0, 0, -9.81]
time = { end = 1, elements = 12 }
[[body]]
name = "ball"
mass = 1
inertia = [1, 2, 3]
rotation_vector = [0, 0, 0.4]
)",
                      known = R"(
[start.known]
"ball.position" = [0, 0, 0]
"ball.rotation" = [0, 0, 0.3]
[end.known]
"ball.position" = [1, 0, 0]
"ball.rotation" = [0, 0, 1.1]
)";
    for (const char* start : {"", "[body.start]\nrotation_vector = [0, 0, 0.9]\n",
                              "[body.start]\nrotation_vector = [0.2, 0.1, 0.9]\n"}) {
        const ScenarioResult result = read(free + start + known);
        ASSERT_TRUE(result.scenario.has_value()) << shown(result);
        const Scenario& scenario = *result.scenario;
        const Solution s = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        const State first = s.motion.at_end(0), last = s.motion.at_end(12);
        EXPECT_NEAR(std::atan2(first.X[0](1, 1), first.X[0](0, 1)), 0.4 + 0.3, 1e-12) << start;
        EXPECT_NEAR(std::atan2(last.X[0](1, 1), last.X[0](0, 1)), 0.4 + 1.1, 1e-12) << start;
    }
}

TEST(KnownComponents, HaveOneMessageForAMistakeAtItsPlace)
{
    const std::string text = with(all);
    const auto line_of = [](const std::string& in, std::size_t at) {
        return 1 +
               static_cast<int>(std::count(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    };
    const std::vector<std::array<std::string, 3>> mistakes{
        {"\"tip.vz\" = 1.5", "\"tip.vz\" = \"1.5 m\"", "unit"},
        {"\"tip.vz\" = 1.5", "\"tip.az\" = 1.5", "conditions-not-smooth"},
        {"\"tip.vz\" = 1.5", "\"top.vz\" = 1.5", "conditions-unknown"},
        {"\"tip.vz\" = 1.5", "\"tip.vz\" = [1, 2, 3]", "wrong-type"},
        {"\"tip.vz\" = 1.5", "\"tip.vz\" = { number = 1 }", "wrong-type"},
        {"\"tip.vz\" = 1.5", "\"rod.y\" = 0.1", "conditions-joints"},
        {"\"tip.vz\" = 1.5", "\"ball.vx\" = 1.5", "conditions-twice"},
        {"\"ball.velocity\" = [", "\"ball.velocity\" = [0, ", "wrong-type"},
        {"\"tip.vz\" = 1.5\n", "\"tip.vz\" = 1.5\n\"rod.vx\" = 1\n\"rod.x\" = 0.4\n", "conditions-dependent"},
        {"\"tip.vz\" = 1.5", "\"rod.speed\" = 0", "conditions-value"},
        {"\"tip.vz\" = 1.5", "\"rod.energy\" = \"3 N\"", "unit"},
        {"[0, \"180 deg/s\", 0]\n", "[0, 0, 0]\n\"pivot.angle\" = 1\n", "conditions-too-many"},
    };
    for (const auto& [from, to, code] : mistakes) {
        std::string wrong = text;
        const std::size_t at = wrong.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        wrong.replace(at, from.size(), to);
        const ScenarioResult result = read(wrong);
        EXPECT_FALSE(result.scenario.has_value()) << to;
        ASSERT_EQ(result.diagnostics.size(), 1u) << to << "\n" << shown(result);
        EXPECT_EQ(result.diagnostics[0].code, code) << to << "\n" << shown(result);
        EXPECT_GE(result.diagnostics[0].line, line_of(wrong, wrong.find("[end.known]"))) << shown(result);
    }
    const std::string few = with("\n[start.known]\n\"pivot.angle\" = \"swing\"\n");
    const ScenarioResult result = read(few);
    ASSERT_EQ(result.diagnostics.size(), 1u) << shown(result);
    EXPECT_EQ(result.diagnostics[0].code, "conditions-too-few");
    EXPECT_EQ(result.diagnostics[0].line, line_of(few, few.find("[start.known]"))) << shown(result);
}

TEST(KnownComponents, StandBesideWhatIsGivenAtTheOtherEnd)
{
    const std::string given = "\n[start]\ngiven = \"positions\"\n",
                      at_end = all.substr(all.find("[end.known]"));
    const ScenarioResult result = read(with(given + at_end));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Scenario& scenario = *result.scenario;
    EXPECT_EQ(scenario.conditions.at_start, Known::positions);
    const Solution s = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.motion.at_end(0).X[0](0, 0), 0.5);
    EXPECT_NEAR(s.motion.at_end(12).V[1](0, 0), 1, 1e-12);
    // at one end it is one or the other
    for (const std::string known : {"positions", "momenta"}) {
        const std::string wrong =
            "\n[start]\ngiven = \"" + known + "\"\n[start.known]\n\"pivot.angle\" = 0\n\n";
        const ScenarioResult refused = read(with(wrong + at_end));
        EXPECT_FALSE(refused.scenario.has_value());
        EXPECT_NE(find(refused, "boundary-conditions"), nullptr) << shown(refused);
    }
}

/// Momenta of all bodies at the end, of the motion that components alone make.
TEST(KnownComponents, StandBesideMomentaOfAllBodies)
{
    const std::string text = R"(format = 1
gravity = [0, 0, -9.81]
[time]
end = 0.3
elements = 10
[method]
family = "lobatto"
degree = 8
[[body]]
name = "bob"
shape = { point = true }
mass = 2
position = [1, 0, 0]
[body.end]
position = [1, 0, -0.44145]
velocity = [3, 0, 1.057]
[start.known]
"bob.position" = [0, 0, 0]
[end]
given = "momenta"
)";
    const ScenarioResult result = read(text);
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Scenario& scenario = *result.scenario;
    EXPECT_EQ(scenario.conditions.at_end, Known::momenta);
    const Solution s = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.motion.at_end(0).V[0](0, 0), 3, 1e-12);
    EXPECT_NEAR(s.motion.at_end(0).V[0](2, 0), 4, 1e-12);
    EXPECT_NEAR(s.motion.at_end(10).X[0](0, 0), 0.9, 1e-12);
    EXPECT_NEAR(s.motion.at_end(10).X[0](2, 0), 0.75855, 1e-12);
}

TEST(KnownComponents, AreSpeedsAndEnergies)
{
    std::string text = with(all);
    text.replace(text.find("\"tip.vz\" = 1.5"), 14, "\"rod.kinetic_energy\" = \"300 mJ\"");
    const ScenarioResult result = read(text);
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Scenario& scenario = *result.scenario;
    Problem problem{scenario.conditions};
    problem.conditions.start.V[0] = rate(problem.conditions.start.X[0], {0, 0, -0.5}, {0, 1, 0});
    const Solution s = solve(scenario.model, problem, scenario.time, scenario.method);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const Matrix34 V = s.motion.at_end(12).V[0];
    EXPECT_NEAR(0.5 * dot(V, V * scenario.model.bodies()[0].mass), 0.3, 1e-12);
}

const std::string driven = R"(
[[load]]
name = "motor"
type = "actuator"
joint = "pivot"
inputs = { w = "pivot.angle_rate" }
expression = "2*sin(2*pi*t) - 2*w"
)";

/// A rod alone, with what stands in [time] more.
std::string periodic(const std::string& time, const std::string& rest)
{
    std::string text(links);
    const std::size_t at = text.find("[[body]]\nname = \"ball\"");
    text.erase(at, text.find("[[joint]]") - at);
    const std::size_t parameters = text.find("[parameters]");
    text.erase(parameters, text.find("[time]") - parameters);
    text.replace(text.find("elements = 12"), 13, "elements = 24\n" + time);
    return text + rest;
}

TEST(KnownComponents, AreThoseOfPeriodicMotions)
{
    const ScenarioResult result = read(periodic("periodic = true", driven));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Scenario& scenario = *result.scenario;
    EXPECT_TRUE(scenario.conditions.is_periodic);
    EXPECT_NE(scenario.resolved.find("\"periodic\""), std::string::npos);
    const Solution s = solve(scenario.model, {scenario.conditions}, scenario.time, scenario.method);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_NEAR(s.motion.at_end(0).X[0](2, 0), s.motion.at_end(24).X[0](2, 0), 1e-12);
    EXPECT_FALSE(read(periodic("periodic = false", driven)).scenario->conditions.is_periodic);
    const auto code = [](const std::string& text) {
        const ScenarioResult refused = read(text);
        return refused.diagnostics.size() == 1 ? refused.diagnostics[0].code : shown(refused);
    };
    EXPECT_EQ(code(periodic("periodic = true", "")), "conditions-too-few");
    EXPECT_EQ(code(periodic("periodic = true", driven + "\n[start.known]\n\"pivot.angle\" = 0\n")),
              "conditions-too-many");
    EXPECT_EQ(code(periodic("periodic = true", driven + "\n[method]\nfamily = \"radau\"\n")),
              "conditions-method");
    EXPECT_EQ(code(periodic("periodic = 3", driven)), "wrong-type");
    EXPECT_EQ(code(periodic("", driven + "\n[method]\nroots = 3\n")), "roots-unused");
}

}   // namespace
}   // namespace livens::known_test
