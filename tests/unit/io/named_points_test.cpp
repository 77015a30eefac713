// SPDX-License-Identifier: BSD-3-Clause
// [[point]]: what a name says is what its coordinates say, in every key that takes a point.
#include <functional>

#include "livens/io/scenario.h"
#include "unit/io/model_numbers.h"
#include "unit/io/scenario_text.h"

namespace livens::named_points_test {
namespace {

using test::expect_error;
using test::numbers_of;
using test::read;
using test::replaced;
using test::shown;

const std::string two_bodies = R"(format = 1
[[body]]
name = "arm"
shape = { box = [1, 0.2, 0.1] }
mass = 2
position = [0.5, 0, 0]
rotation_vector = [0, 0.3, 0.1]

[[body]]
name = "hand"
shape = { box = [0.3, 0.2, 0.1] }
mass = 1
position = [1.4, 0.1, -0.2]

[[point]]
name = "tip"
body = "arm"
position = [0.5, "5 cm", 0]

[[point]]
name = "grip"
body = "hand"
position = [0.1, 0, 0.02]

[[point]]
name = "hook"
body = "world"
position = [0, 0, 1]

[time]
end = 1
)";

void expect_same(const std::string& named, const std::string& written)
{
    const ScenarioResult a = read(two_bodies + named), b = read(two_bodies + written);
    ASSERT_TRUE(a.scenario) << named << shown(a);
    ASSERT_TRUE(b.scenario) << written << shown(b);
    EXPECT_EQ(numbers_of(a.scenario->model), numbers_of(b.scenario->model)) << named;
}

TEST(NamedPoints, AreTheirCoordinatesWhereverOneIsTaken)
{
    const std::string bodies = "between = [\"arm\", \"hand\"]\n",
                      places = bodies + "points = [[0.5, 0.05, 0], [0.1, 0, 0.02]]\n",
                      on_world = "between = [\"world\", \"hand\"]\npoints = [[0, 0, 1], [0.1, 0, 0.02]]\n";
    const auto joint = [](const std::string& keys) {
        return "[[joint]]\nname = \"j\"\n" + keys + "[start]\ninitial = \"project\"\n";
    };
    expect_same(joint("type = \"rod\"\npoints = [\"tip\", \"grip\"]\n"), joint("type = \"rod\"\n" + places));
    expect_same(joint("type = \"rod\"\npoints = [\"hook\", \"grip\"]\n"),
                joint("type = \"rod\"\n" + on_world));
    expect_same(joint("type = \"spherical\"\n" + bodies + "points = [\"tip\", \"grip\"]\n"),
                joint("type = \"spherical\"\n" + places));
    expect_same(joint("type = \"revolute\"\npoints = [\"tip\", \"grip\"]\naxes = [[0, 1, 0], [0, 1, 0]]\n"),
                joint("type = \"revolute\"\n" + places + "axes = [[0, 1, 0], [0, 1, 0]]\n"));
    expect_same("[[joint]]\nname = \"j\"\ntype = \"weld\"\n" + bodies + "at = \"hook\"\n",
                "[[joint]]\nname = \"j\"\ntype = \"weld\"\n" + bodies + "at = [0, 0, 1]\n");
    expect_same(
        joint("type = \"cylindrical\"\n" + bodies + "frames = [{ point = \"tip\" }, { point = \"grip\" }]\n"),
        joint("type = \"cylindrical\"\n" + bodies +
              "frames = [{ point = [0.5, 0.05, 0] }, { point = [0.1, 0, 0.02] }]\n"));
    const std::string curve = "curve = { points = [[0, 0, 0], [1, 0, 0], [2, 1, 0]] }\n";
    expect_same(joint("type = \"slot\"\n" + bodies + curve + "point = \"grip\"\n"),
                joint("type = \"slot\"\n" + bodies + curve + "point = [0.1, 0, 0.02]\n"));

    const std::string drive = "[[drive]]\nname = \"d\"\n",
                      law = "value = 0.5\n[start]\ninitial = \"project\"\n";
    expect_same(drive + "type = \"distance\"\npoints = [\"tip\", \"grip\"]\n" + law,
                drive + "type = \"distance\"\n" + places + law);
    const std::string path = "value = [0, 0, 0]\n";
    for (const std::string type : {"point", "body"})
        expect_same(drive + "type = \"" + type + "\"\npoint = \"grip\"\n" + path,
                    drive + "type = \"" + type + "\"\nbody = \"hand\"\npoint = [0.1, 0, 0.02]\n" + path);

    const std::string load = "[[load]]\nname = \"l\"\n", spring = "stiffness = 5\nfree_length = 0.2\n";
    expect_same(load + "type = \"spring\"\npoints = [\"hook\", \"grip\"]\n" + spring,
                load + "type = \"spring\"\n" + on_world + spring);
    expect_same(load + "type = \"force\"\npoint = \"tip\"\nvalue = [0, 1, 2]\n",
                load + "type = \"force\"\nbody = \"arm\"\npoint = [0.5, 0.05, 0]\nvalue = [0, 1, 2]\n");
    expect_same(
        load + "type = \"drag\"\npoint = \"tip\"\nlinear = 1\nmedium = [1, 0, 0]\n",
        load + "type = \"drag\"\nbody = \"arm\"\npoint = [0.5, 0.05, 0]\nlinear = 1\nmedium = [1, 0, 0]\n");
    expect_same(load + "type = \"attraction\"\nbody = \"arm\"\npoint = \"hook\"\nmu = 2\n",
                load + "type = \"attraction\"\nbody = \"arm\"\npoint = [0, 0, 1]\nmu = 2\n");
    const std::string stiff = "stiffness = [1, 2, 3, 4, 5, 6]\n";
    expect_same(load + "type = \"bushing\"\n" + bodies + "at = \"hook\"\n" + stiff,
                load + "type = \"bushing\"\n" + bodies + "at = [0, 0, 1]\n" + stiff);

    const std::string sensor = "[[sensor]]\nname = \"s\"\n";
    expect_same(sensor + "type = \"point\"\npoint = \"tip\"\n",
                sensor + "type = \"point\"\nbody = \"arm\"\npoint = [0.5, 0.05, 0]\n");
    expect_same(sensor + "type = \"relative\"\npoints = [\"tip\", \"grip\"]\n",
                sensor + "type = \"relative\"\n" + places);
}

TEST(NamedPoints, AreReadByExpressionsAsSensorsAre)
{
    const std::string load =
        "[[load]]\nname = \"l\"\ntype = \"force\"\nbody = \"hand\"\nexpression = [\"0\", "
        "\"-3*tip.z + tip.vx\", \"0\"]\n";
    const std::string sensor =
        "[[sensor]]\nname = \"s\"\ntype = \"point\"\nbody = \"arm\"\npoint = [0.5, 0.05, 0]\n";
    expect_same(load + sensor, replaced(replaced(load, "tip.z", "s.z"), "tip.vx", "s.vx") + sensor);
    expect_error(two_bodies + replaced(load, "tip.vx", "tip.ax"), "input-algebraic", "[\"0\", \"-3");
    expect_error(two_bodies + replaced(load, "tip.vx", "hook.x"), "input-unknown", "[\"0\", \"-3");
}

TEST(NamedPoints, WithoutANameOfItsOwnAPartIsCalledByThem)
{
    const ScenarioResult r =
        read(two_bodies + "[[joint]]\ntype = \"rod\"\npoints = [\"tip\", \"grip\"]\n[[load]]\ntype = "
                          "\"force\"\npoint = \"tip\"\nvalue = [1, 0, 0]\n");
    ASSERT_TRUE(r.scenario) << shown(r);
    EXPECT_EQ(r.scenario->model.joints()[0].name, "rod tip-grip");
    EXPECT_EQ(r.scenario->model.loads()[0].name, "force on tip");
    EXPECT_EQ(r.scenario->model.find_point("grip"), 1);
    EXPECT_EQ(r.scenario->model.points()[2].body, world);
}

TEST(NamedPoints, OneMistakeIsOneError)
{
    const auto expect_one = [](const std::string& text, std::string_view code, std::string_view where,
                               const std::string& help = "") {
        const ScenarioResult r = read(text);
        EXPECT_EQ(r.diagnostics.size(), 1u) << shown(r);
        expect_error(text, code, where);
        if (!help.empty() && !r.diagnostics.empty()) {
            EXPECT_NE(r.diagnostics[0].help.find(help), std::string::npos) << shown(r);
        }
    };
    const std::string rod = "[[joint]]\ntype = \"rod\"\n";
    expect_one(two_bodies + rod + "points = [\"tp\", \"grip\"]\n", "point-unknown", "\"tp\"", "'tip'");
    expect_one(two_bodies + rod + "points = [\"tip\", \"hand\"]\n", "point-unknown", "\"hand\"]\n");
    expect_one(two_bodies + rod + "between = [\"arm\", \"world\"]\npoints = [\"tip\", \"grip\"]\n",
               "point-body", "\"grip\"]\n");
    expect_one(two_bodies + rod + "points = [\"tip\", \"tip\"]\n", "joint-self", "\"tip\"]\n");
    expect_one(two_bodies + rod + "points = [\"tip\", [0, 0, 0]]\n", "wrong-type", "[0, 0, 0]]\n");
    expect_one(two_bodies + rod + "between = [\"arm\", \"grip\"]\n", "body-unknown", "\"grip\"]\n");
    expect_one(two_bodies +
                   "[[load]]\ntype = \"force\"\nbody = \"hand\"\npoint = \"tip\"\nvalue = [1, 0, 0]\n",
               "point-body", "\"tip\"\nvalue");
    expect_one(two_bodies + "[[load]]\ntype = \"force\"\npoint = \"tap\"\nvalue = [1, 0, 0]\n",
               "point-unknown", "\"tap\"", "'tip'");
    expect_one(two_bodies + "[[load]]\ntype = \"force\"\npoint = [0, 0, 0]\nvalue = [1, 0, 0]\n",
               "missing-key", "[[load]]");
    expect_one(two_bodies + "[[load]]\ntype = \"force\"\npoint = \"hook\"\nvalue = [1, 0, 0]\n", "load-self",
               "\"hook\"\nvalue");
    expect_one(two_bodies + "[[point]]\nname = \"tip\"\nbody = \"hand\"\n", "name-duplicate",
               "\"tip\"\nbody = \"hand\"");
    expect_one(two_bodies + "[[point]]\nname = \"hand\"\nbody = \"arm\"\n", "name-duplicate",
               "\"hand\"\nbody = \"arm\"");
    expect_one(two_bodies + "[[sensor]]\nname = \"grip\"\ntype = \"point\"\nbody = \"arm\"\n",
               "name-duplicate", "\"grip\"\nbody = \"hand\"");
    expect_one(two_bodies + "[[point]]\nname = \"a\"\nbody = \"amr\"\n", "body-unknown", "\"amr\"", "'arm'");
    expect_one(replaced(two_bodies, "shape = { box = [0.3, 0.2, 0.1] }", "shape = { point = true }"),
               "point-mass", "[0.1, 0, 0.02]");
}

}   // namespace
}   // namespace livens::named_points_test
