// SPDX-License-Identifier: BSD-3-Clause
// [start.known] and [end.known]: conditions by component as files give them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "livens/spacetime/solve.h"
#include "unit/io/scenario_text.h"

namespace livens {
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

TEST(KnownComponents, StandAlone)
{
    const ScenarioResult result =
        read(with("\n[start]\ngiven = \"positions\"\n\n[end.known]\n\"pivot.angle\" = \"swing\"\n"));
    ASSERT_EQ(result.diagnostics.size(), 1u) << shown(result);
    EXPECT_EQ(result.diagnostics[0].code, "boundary-conditions");
}

}   // namespace
}   // namespace livens
