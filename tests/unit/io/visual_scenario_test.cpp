// SPDX-License-Identifier: BSD-3-Clause
// How bodies look, apart from what they weigh: `visual`, `color`, `opacity`, [world].
#include <filesystem>
#include <fstream>

#include "livens/io/exports/formats.h"
#include "livens/io/scenario/bodies/colors.h"
#include "unit/io/scenario_text.h"

namespace livens::visual_scenario_test {

namespace {

using test::find;
using test::shown;

const std::string arm = R"(format = 1
[[body]]
name = "arm"
mass = 3
inertia = [0.001, 0.3, 0.3]
center_of_mass = [0.1, 0, 0]
color = "SteelBlue"
opacity = 0.5
visual = [
  { box = [1, 0.2, 0.1], position = [0.5, 0, 0] },
{ cylinder = { radius = 0.1, length = 0.4 }, color = "#F80", opacity = 1, rotation_vector = ["90 deg",0,0] },
]
[world]
visual = { box = [4, 2, 0.1], position = [0, 0, -0.05] }
[time]
end = 1
)";

struct Reach {
    Vector3 least, most;
};
Reach reach_of(const Surface& surface)
{
    Reach reach{surface.points.front(), surface.points.front()};
    for (const Vector3& p : surface.points)
        for (int i = 0; i < 3; ++i) {
            reach.least[i] = std::min(reach.least[i], p[i]);
            reach.most[i] = std::max(reach.most[i], p[i]);
        }
    return reach;
}

TEST(Visual, StandsWhereItIsSaidWhateverTheMass)
{
    const ScenarioResult result = parse_scenario(arm, "test.toml");
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    const auto drawn = drawn_of(*result.scenario);
    ASSERT_EQ(drawn.size(), 2u);
    ASSERT_EQ(drawn[0].size(), 2u);
    // From the reference point on, not from the centre of mass.
    const Reach box = reach_of(united({drawn[0][0]}));
    EXPECT_LE(norm(box.least - Vector3{0, -0.1, -0.05}), 1e-15);
    EXPECT_LE(norm(box.most - Vector3{1, 0.1, 0.05}), 1e-15);
    const Reach cylinder = reach_of(united({drawn[0][1]}));
    EXPECT_NEAR(cylinder.most[1], 0.2, 1e-15) << "its axis lies along y";
    EXPECT_LE(cylinder.most[2], 0.1);
    ASSERT_EQ(drawn[1].size(), 1u);
    EXPECT_NEAR(reach_of(united(drawn[1])).most[2], 0, 1e-15);
    // Mass and inertia are those that were stated.
    EXPECT_EQ(result.scenario->model.bodies()[0].mass(0, 0), 3);
}

TEST(Visual, HasTheColourOfItsBodyUnlessItHasItsOwn)
{
    const auto drawn = drawn_of(*parse_scenario(arm, "test.toml").scenario);
    EXPECT_EQ(drawn[0][0].color->a[2], 0xb4 / 255.0);
    EXPECT_EQ(drawn[0][0].opacity, 0.5);
    EXPECT_LE(norm(*drawn[0][1].color - Vector3{1, 0x88 / 255.0, 0}), 1e-15);
    EXPECT_EQ(drawn[0][1].opacity, 1);
    EXPECT_FALSE(drawn[1][0].color.has_value());
}

TEST(Visual, IsDrawnInsteadOfTheShapeAndColourAloneKeepsIt)
{
    const std::string shaped = test::replaced(arm, "inertia = [0.001, 0.3, 0.3]", "shape = { sphere = 2 }");
    EXPECT_LE(reach_of(united(drawn_of(*parse_scenario(shaped, "test.toml").scenario)[0])).most[0], 1.0);
    const std::size_t from = shaped.find("visual = ["), to = shaped.find("[world]");
    const auto drawn =
        drawn_of(*parse_scenario(shaped.substr(0, from) + shaped.substr(to), "t.toml").scenario);
    ASSERT_EQ(drawn[0].size(), 1u);
    EXPECT_NEAR(reach_of(united(drawn[0])).most[2], 2, 1e-12);
    EXPECT_EQ(drawn[0][0].color->a[2], 0xb4 / 255.0);
}

TEST(Visual, IsRefusedWithWhatToWriteInstead)
{
    const auto expect = [](const std::string& from, const std::string& to, std::string_view code,
                           const std::string& help) {
        const ScenarioResult result = parse_scenario(test::replaced(arm, from, to), "test.toml");
        EXPECT_FALSE(result.scenario.has_value()) << to;
        const Diagnostic* d = find(result, code);
        ASSERT_NE(d, nullptr) << to << shown(result);
        EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
        EXPECT_NE(d->help.find(help), std::string::npos) << shown(result);
    };
    const std::string color = "\"SteelBlue\"";
    expect(color, "\"stelblue\"", "unknown-choice", "did you mean 'steelblue'?");
    expect(color, "\"#12345678\"", "unknown-choice", "\"#123456\"");
    expect(color, "\"c33\"", "unknown-choice", "write \"#c33\"");
    expect(color, "\"#12\"", "unknown-choice", "#rrggbb");
    expect(color, "\"Größe\"", "unknown-choice", "#rrggbb");
    expect(color, "[255, 0, 0]", "out-of-range", "");
    expect(color, "[1, 0, 0, 1]", "wrong-type", "");
    expect("opacity = 0.5", "opacity = 0", "out-of-range", "");
    expect("box = [4, 2, 0.1]", "box = [4, 2, 0]", "out-of-range", "");
    expect("{ box = [4, 2, 0.1], position = [0, 0, -0.05] }", "[]", "shape", "leave it out");
    expect("{ box = [4, 2, 0.1], position = [0, 0, -0.05] }", "{}", "shape", "give one of box");
    expect("{ box = [4, 2, 0.1], position = [0, 0, -0.05] }", "[1]", "wrong-type", "visual = [{ box");
    expect("{ box = [4, 2, 0.1]", "{ box = [4, 2, 0.1], sphere = 1", "shape", "keep one");
    expect("{ box = [4, 2, 0.1]", "{ mesh = \"a.stl\"", "mesh-unit", "add unit");
    expect("{ box = [4, 2, 0.1]", "{ mesh = \"a.stl\", unit = \"m\"", "mesh-file", "");
    expect("{ box = [4, 2, 0.1]", "{ mesh = \"a.dae\", unit = \"mm\"", "mesh-unit", "unit = \"m\"");
    expect("{ box = [4, 2, 0.1]", "{ mesh = \"a.DAE\", unit = \"m\"", "mesh-file", "");
}

/// A shape beside `inertia` is drawn and does nothing else: a primitive about the centre of mass, and what
/// has coordinates of its own stays in them.
TEST(Visual, AShapeBesideAnInertiaIsOneToo)
{
    const std::size_t from = arm.find("visual = ["), to = arm.find("[world]");
    const std::string bare = arm.substr(0, from) + arm.substr(to);
    const auto with = [&](const std::string& shape) {
        return parse_scenario(test::replaced(bare, "opacity", "shape = " + shape + "\nopacity"), "t.toml");
    };
    const Matrix4 mass = parse_scenario(bare, "t.toml").scenario->model.bodies()[0].mass;
    const auto expect = [&](const std::string& shape, double least, double most) {
        const ScenarioResult result = with(shape);
        ASSERT_TRUE(result.scenario.has_value()) << shown(result);
        EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
        EXPECT_EQ(result.scenario->model.bodies()[0].mass, mass);
        const Reach reach = reach_of(united(drawn_of(*result.scenario)[0]));
        EXPECT_NEAR(reach.least[0], least, 1e-15) << shape;
        EXPECT_NEAR(reach.most[0], most, 1e-15) << shape;
    };
    expect("{ box = [1, 0.2, 0.1] }", -0.4, 0.6);
    expect("{ parts = [{ box = [1, 1, 1], position = [2, 0, 0] }, { box = [2, 2, 2] }] }", -1, 2.5);
    EXPECT_EQ(with("{ box = [1, 0.2, 0.1] }").scenario->model.bodies()[0].volume, 1 * 0.2 * 0.1);
}

TEST(Visual, AShapeBesideAnInertiaWeighsNothing)
{
    const std::string
        box = "shape = { box = [1, 1, 1] }\n",
        two = "shape = { parts = [{ box = [1, 1, 1] }, { box = [1, 1, 1], position = [2,0,0] }] }\n";
    const std::string moments = "mass = 3\ninertia = [0.001, 0.3, 0.3]\ncenter_of_mass = [0.1, 0, 0]\n";
    const auto expect = [&](const std::string& keys, std::string_view code, const std::string& place) {
        const ScenarioResult result = parse_scenario(test::replaced(arm, moments, keys), "test.toml");
        const Diagnostic* d = find(result, code);
        ASSERT_NE(d, nullptr) << keys << shown(result);
        EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
        EXPECT_NE(d->message.find(place), std::string::npos) << shown(result);
    };
    expect(box + moments + "density = 2\n", "mass-conflict", "density");
    expect(box + "inertia = [0.001, 0.3, 0.3]\n", "mass-missing", "'mass'");
    expect(two + "mass = 3\ninertia = [0.001, 0.3, 0.3]\n", "mass-missing", "'center_of_mass'");
    expect("shape = { box = [1, 1, 1], density_field = \"2\" }\n" + moments, "mass-conflict",
           "density of its own");
}

TEST(Visual, OfAMeshNeedNotBeClosedAndIsKeptByTheRun)
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "livens_visual_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "sheet.obj") << "v 0 0 0\nv 1000 0 0\nv 0 2000 0\nf 1 2 3\n";
    const std::string text =
        test::replaced(arm, "{ box = [4, 2, 0.1]", "{ mesh = \"sheet.obj\", unit = \"mm\"");
    const ScenarioResult first = parse_scenario(text, "test.toml", {folder});
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(first.scenario.has_value()) << shown(first);
    const ScenarioResult again = parse_scenario(text, "test.toml", {folder, first.scenario->meshes});
    ASSERT_TRUE(again.scenario.has_value()) << shown(again);
    for (const ScenarioResult* result : {&first, &again}) {
        const Surface world = united(drawn_of(*result->scenario).back());
        EXPECT_EQ(world.triangles.size(), 1u);
        EXPECT_NEAR(reach_of(world).most[1], 2, 1e-15);
    }
    EXPECT_FALSE(parse_scenario(text, "test.toml", {folder}).scenario.has_value()) << "control: it is gone";
    EXPECT_FALSE(
        parse_scenario(text, "test.toml", {folder, "picture sheet.obj\nface 0 1 2\n"}).scenario.has_value())
        << "a damaged run";
}

TEST(Colors, AreNamesAndNumbersInLettersOfAnyCase)
{
    EXPECT_LE(norm(*parse_color("rebeccapurple") - Vector3{0x66 / 255.0, 0x33 / 255.0, 0x99 / 255.0}), 1e-15);
    EXPECT_LE(norm(*parse_color("#aBc") - *parse_color("#AABBCC")), 0);
    EXPECT_LE(norm(*parse_color("aliceblue") - Vector3{0xf0 / 255.0, 0xf8 / 255.0, 1}), 1e-15);
    EXPECT_LE(norm(*parse_color("YellowGreen") - *parse_color("#9acd32")), 0) << "the last of the list";
    for (const char* text : {"", "#", "#12", "#12345", "#gggggg", "steel blue", "#1234567", "red "})
        EXPECT_FALSE(parse_color(text).has_value()) << text;
}

}   // namespace

}   // namespace livens::visual_scenario_test
