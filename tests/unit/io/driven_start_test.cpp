// SPDX-License-Identifier: BSD-3-Clause
// A drive that moves at the start, and bodies of which no velocity is said: they start as it wants.
#include <cmath>

#include "livens/io/scenario.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/spacetime/solve.h"
#include "unit/io/scenario_text.h"

namespace livens::driven_start_test {
namespace {

using test::find;
using test::read;
using test::replaced;
using test::shown;

const std::string linkage = R"(format = 1
gravity = [0, 0, -9.81]

[[body]]
name = "crank"
mass = 1
inertia = [0.01, 0.02, 0.02]
position = [0.1, 0, 0]

[[body]]
name = "rod"
mass = 2
inertia = [0.01, 0.1, 0.1]
position = [0.45, 0, 0]

[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "crank"]
at = [0, 0, 0]
axis = [0, 1, 0]

[[joint]]
name = "pin"
type = "revolute"
between = ["crank", "rod"]
at = [0.2, 0, 0]
axis = [0, 1, 0]

[[drive]]
name = "motor"
type = "joint"
joint = "pivot"
rate = "60 rpm"

[time]
end = 0.1
elements = 4
)";

std::string with(const std::string& before, const std::string& more)
{
    return replaced(linkage, before, before + "\n" + more);
}

TEST(DrivenStart, IsProjectedWhereNoVelocityIsSaid)
{
    const ScenarioResult result = read(linkage);
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Diagnostic* d = find(result, "start-driven");
    ASSERT_NE(d, nullptr) << shown(result);
    EXPECT_EQ(d->severity, Severity::warning);
    EXPECT_NE(d->message.find("'motor'"), std::string::npos) << d->message;
    EXPECT_EQ(d->line, 31) << "at the drive";
    EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
    EXPECT_EQ(result.scenario->options.initial, StartPolicy::project);
    EXPECT_NE(result.scenario->resolved.find(R"("initial": "project")"), std::string::npos);
}

/// As if [start] had asked for it, and with the rates of least energy: those of the joint alone.
TEST(DrivenStart, MovesAsWithAProjectionThatWasAskedFor)
{
    const ScenarioResult bare = read(linkage), asked = read(linkage + "[start]\ninitial = \"project\"\n");
    ASSERT_TRUE(bare.scenario && asked.scenario) << shown(bare) << shown(asked);
    EXPECT_TRUE(asked.diagnostics.empty()) << shown(asked);
    EXPECT_EQ(bare.scenario->resolved, asked.scenario->resolved);
    const auto end_of = [](const Scenario& s) {
        return solve(s.model, {s.conditions}, s.time, s.method, s.options).motion.at_end(4);
    };
    const State one = end_of(*bare.scenario), other = end_of(*asked.scenario);
    EXPECT_TRUE(one.X == other.X && one.V == other.V);
    const NamedCoordinate& angle = bare.scenario->model.joints()[0].coordinates[0];
    EXPECT_NEAR(coordinate_rate(angle.coordinate, one.X, one.V), 2 * M_PI, 1e-12);
}

/// One word on velocities, zero or not, and nothing is guessed.
TEST(DrivenStart, IsRefusedBesideVelocitiesThatDoNotFit)
{
    for (const std::string& text :
         {with("name = \"rod\"", "velocity = [0, 0, 0]"), with("name = \"rod\"", "velocity = [0, 0, 1]"),
          with("name = \"crank\"", "angular_velocity = [0, 0, 0]"),
          with("name = \"crank\"", "angular_velocity_body = [0, 1, 0]"),
          with("name = \"crank\"", "director_rates = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]"),
          with("name = \"crank\"", "start.velocity = [0, 0, 0]"), with("name = \"pin\"", "rate = 0"),
          linkage + "[start]\ncoordinates = [{ joint = \"pin\", rate = 0 }]\n",
          linkage + "[start]\ncoordinates = [{ joint = \"pivot\", rate = \"59 rpm\" }]\n",
          linkage + "[start]\ninitial = \"check\"\n",
          linkage +
              "[[include]]\nprefix = \"far \"\nmodel = { body = [{ name = \"ball\", "
              "shape = { sphere = 0.1 }, mass = 1, position = [9, 0, 0], velocity = [0, 0, 0] }] }\n"}) {
        const ScenarioResult result = read(text);
        EXPECT_NE(find(result, "start-velocity"), nullptr) << text << shown(result);
        EXPECT_EQ(find(result, "start-driven"), nullptr) << text << shown(result);
    }
}

TEST(DrivenStart, TakesOtherWordsOnTheStart)
{
    for (const std::string& text :
         {linkage + "[start]\ngiven = \"state\"\n",
          linkage + "[start]\ncoordinates = [{ joint = \"pin\", value = \"30 deg\" }]\n",
          linkage + "[[include]]\nmodel = { body = [{ name = \"ball\", shape = { sphere = 0.1 }, mass = 1, "
                    "position = [9, 0, 0] }] }\n"}) {
        const ScenarioResult result = read(text);
        EXPECT_TRUE(result.scenario && find(result, "start-driven") != nullptr) << text << shown(result);
    }
}

TEST(DrivenStart, IsNoneOfADriveThatBeginsAtRest)
{
    for (const char* law :
         {"step = { rise = 1, from = 0, until = 0.05 }", "polynomial = [0, 0, 1]", "rate = 0", "value = 0"}) {
        const ScenarioResult result = read(replaced(linkage, "rate = \"60 rpm\"", law));
        ASSERT_TRUE(result.scenario.has_value()) << law << shown(result);
        EXPECT_TRUE(result.diagnostics.empty()) << law << shown(result);
        EXPECT_EQ(result.scenario->options.initial, StartPolicy::check) << law;
    }
}

TEST(DrivenStart, DoesNotMoveBodiesOntoTheirJoints)
{
    const ScenarioResult result =
        read(replaced(linkage, "at = [0.2, 0, 0]\naxis = [0, 1, 0]",
                      "points = [[0.11, 0, 0], [-0.25, 0, 0]]\naxes = [[0, 1, 0], [0, 1, 0]]"));
    EXPECT_NE(find(result, "start-position"), nullptr) << shown(result);
    EXPECT_EQ(find(result, "start-driven"), nullptr) << shown(result);
}

TEST(DrivenStart, HasNoVelocitiesForDrivesThatContradict)
{
    const std::string two = replaced(
        linkage, "[time]",
        "[[drive]]\nname = \"other\"\ntype = \"joint\"\njoint = \"pivot\"\nrate = \"30 rpm\"\n\n[time]");
    for (const std::string& text : {two, two + "[start]\ninitial = \"project\"\n"}) {
        const ScenarioResult result = read(text);
        const Diagnostic* d = find(result, "joint-contradiction");
        ASSERT_NE(d, nullptr) << shown(result);
        EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
    }
    EXPECT_TRUE(read(replaced(two, "\"30 rpm\"", "\"60 rpm\"")).scenario.has_value());
}

// A base that floats, and a leg on a hinge whose rate is given.
const std::string floating = R"(format = 1

[[body]]
name = "base"
mass = 10
inertia = [0.1, 0.2, 0.2]

[[body]]
name = "leg"
mass = 1
inertia = [0.01, 0.01, 0.01]
position = [0.2, 0, -0.15]

[[joint]]
name = "hip"
type = "revolute"
between = ["base", "leg"]
at = [0.2, 0, 0]
axis = [0, 1, 0]
rate = 1

[time]
end = 0.1
)";

TEST(StatedVelocities, AreKeptWhereARateMovesTheStart)
{
    const std::string at_rest =
        replaced(floating, "mass = 10\n", "mass = 10\nvelocity = [0, 0, 0]\nangular_velocity = [0, 0, 0]\n");
    const ScenarioResult kept = read(at_rest);
    ASSERT_TRUE(kept.scenario.has_value()) << shown(kept);
    EXPECT_TRUE(kept.diagnostics.empty()) << shown(kept);
    EXPECT_LT(norm(kept.scenario->model.bodies()[0].V), 1e-15);
    const Body& leg = kept.scenario->model.bodies()[1];
    EXPECT_LT(norm(angular_velocity(leg.X, leg.V) - Vector3{0, 1, 0}), 1e-14);
    // Negative control: nobody says that it is at rest.
    const ScenarioResult free = read(floating);
    EXPECT_TRUE(free.diagnostics.empty()) << shown(free);
    EXPECT_GT(norm(free.scenario->model.bodies()[0].V), 0.1);
    // [body.start] says it as well.
    const ScenarioResult later = read(replaced(floating, "mass = 10\ninertia = [0.1, 0.2, 0.2]\n",
                                               "mass = 10\ninertia = [0.1, 0.2, 0.2]\n[body.start]\nvelocity "
                                               "= [1, 0, 0]\nangular_velocity = [0, 0, 0]\n"));
    ASSERT_TRUE(later.scenario.has_value()) << shown(later);
    EXPECT_LT(norm(later.scenario->model.bodies()[0].V.column(0) - Vector3{1, 0, 0}), 1e-14);
}

TEST(StatedVelocities, ThatDoNotFitAreToldAlsoWhereTheyAreZero)
{
    const std::string both = replaced(
        replaced(floating, "mass = 10\n", "mass = 10\nvelocity = [0, 0, 0]\nangular_velocity = [0, 0, 0]\n"),
        "mass = 1\n", "mass = 1\nvelocity = [0, 0, 0]\nangular_velocity = [0, 0, 0]\n");
    const ScenarioResult result = read(both);
    EXPECT_EQ(result.diagnostics.size(), 2u) << shown(result);
    const Diagnostic* d = find(result, "start-changed");
    ASSERT_NE(d, nullptr) << shown(result);
    EXPECT_NE(d->message.find("'base'"), std::string::npos);
}

}   // namespace
}   // namespace livens::driven_start_test
