// SPDX-License-Identifier: BSD-3-Clause
// [[include]]: a file that is included is what it is alone, displaced and renamed, and its faults are told
// with their file and line.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "livens/io/scenario.h"
#include "livens/multibody/controllers.h"
#include "sanitized.h"
#include "unit/io/model_numbers.h"
#include "unit/io/scenario_text.h"
#include "unit/io/swinging_rod.h"

namespace livens::include_test {
namespace {

using test::find;
using test::numbers_of;
using test::shown;

const std::filesystem::path corpus = std::filesystem::path(LIVENS_SOURCE_DIR) / "tests/fuzz/corpus";

double largest_difference(const std::vector<double>& a, const std::vector<double>& b)
{
    if (a.size() != b.size()) return INFINITY;
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(a[i] - b[i]) / (1 + std::abs(a[i])));
    return most;
}

std::string text_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder of files that goes away again.
class Folder {
public:
    Folder()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "livens-include-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(path_ / "parts");
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    void write(const std::string& name, const std::string& text) const
    {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    ScenarioResult read(const std::string& text) const
    {
        write("main.toml", text);
        return read_scenario(path_ / "main.toml");
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

const std::string leg = R"(format = 1
gravity = [0, 0, -9.81]

[[body]]
name = "thigh"
shape = { box = [0.05, 0.05, 0.4] }
mass = 2
position = [0, 0, -0.2]

[[body]]
name = "shin"
shape = { box = [0.04, 0.04, 0.4] }
mass = 1
position = [0, 0, -0.6]

[[point]]
name = "foot"
body = "shin"
position = [0, 0, -0.2]

[[joint]]
name = "hip"
type = "revolute"
between = ["world", "thigh"]
at = [0, 0, 0]
axis = [0, 1, 0]
rate = 0.5

[[joint]]
name = "knee"
type = "revolute"
between = ["thigh", "shin"]
at = [0, 0, -0.4]
axis = [0, 1, 0]

[[load]]
name = "muscle"
type = "actuator"
joint = "knee"
expression = "-3*knee.angle - 0.2*knee.angle_rate"

[time]
end = 1
)";

const std::string two_legs = R"(format = 1
gravity = [0, 0, -9.81]

[[include]]
file = "parts/leg.toml"
prefix = "left."
position = [0, 0.1, 0]

[[include]]
file = "parts/leg.toml"
prefix = "right."
position = [0, -0.1, 0]
rotation_vector = [0, 0, "180 deg"]

[[load]]
name = "band"
type = "spring"
points = ["left.foot", "right.foot"]
stiffness = 10
free_length = 0.2

[[load]]
name = "pull"
type = "force"
point = "left.foot"
expression = ["right.knee.angle", "'right.foot'.x", "0"]

[time]
end = 0.5
)";

TEST(Include, IsTheSameMechanismDisplacedForEveryKindOfJointLoadDriveAndSensor)
{
    const Displacement by{{1, -2, 0.5}, directors_from_rotation_vector({0.3, -0.5, 0.8})};
    for (const std::string name : {"joints_and_loads", "mechanisms", "laws"}) {
        SCOPED_TRACE(name);
        const std::string file = "every_key_of_" + name + ".toml", text = text_of(corpus / file);
        const ScenarioResult alone = parse_scenario(text, file, {corpus});
        ASSERT_TRUE(alone.scenario) << shown(alone);
        std::string whole = "format = 1\n[[include]]\nfile = \"" + file +
                            "\"\nprefix = \"p.\"\nposition = [1, -2, 0.5]\nrotation_vector = [0.3, -0.5, "
                            "0.8]\n" +
                            text.substr(text.find("[time]"));
        if (const std::size_t at = whole.find("joint = \"table\""); at != std::string::npos)
            whole.insert(at + 9, "p.");
        const ScenarioResult included = parse_scenario(whole, "main.toml", {corpus});
        ASSERT_TRUE(included.scenario) << shown(included);
        Model added;
        added.add(alone.scenario->model, "p.", by);
        const Model& model = included.scenario->model;
        ASSERT_EQ(model.bodies().size(), added.bodies().size());
        for (std::size_t b = 0; b < added.bodies().size(); ++b)
            EXPECT_EQ(model.bodies()[b].name, added.bodies()[b].name);
        ASSERT_EQ(model.joints().size(), added.joints().size());
        for (std::size_t j = 0; j < added.joints().size(); ++j)
            EXPECT_EQ(model.joints()[j].name, added.joints()[j].name);
        EXPECT_LT(largest_difference(numbers_of(added), numbers_of(model)), 1e-9);
        Model shifted;
        shifted.add(alone.scenario->model, "p.", {by.position, identity<3>()});
        EXPECT_GT(largest_difference(numbers_of(shifted), numbers_of(model)), 0.1) << "it sees the rotation";
    }
}

TEST(Include, NamesArePrefixedAndFoundFromOutside)
{
    const Folder folder;
    folder.write("parts/leg.toml", leg);
    const ScenarioResult r = folder.read(two_legs);
    ASSERT_TRUE(r.scenario) << shown(r);
    EXPECT_TRUE(r.diagnostics.empty()) << shown(r);
    const Model& m = r.scenario->model;
    EXPECT_EQ(m.bodies()[2].name, "right.thigh");
    EXPECT_EQ(m.joints()[1].name, "left.knee");
    EXPECT_EQ(m.loads()[0].name, "left.muscle");
    EXPECT_EQ(m.find_point("right.foot"), 1);
    // half a turn about the vertical: the rates of both hips swing the legs to opposite sides
    EXPECT_NEAR(m.bodies()[0].V(0, 0), -m.bodies()[2].V(0, 0), 1e-15);
    EXPECT_NE(m.bodies()[0].V(0, 0), 0);
    EXPECT_EQ(r.scenario->mesh_files.size(), 1u);
}

/// Friction of bearings by reactions, in parts of which one is turned: each is that of one pendulum alone
/// (ReactionLaws.RubAsTheirEquationsSay), also by components along axes of the part.
TEST(Include, LoadsReadReactionsOfTheirParts)
{
    if (is_sanitized) GTEST_SKIP() << study;
    const Folder folder;
    folder.write("arm.toml", test::hanging_arm(R"toml([[load]]
name = "bearing"
type = "actuator"
joint = "pin"
expression = "-0.3*0.05*sqrt(pin.force_x^2 + pin.force_z^2)*tanh(pin.angle_rate/0.1)"
[[controller]]
name = "scale"
states = { f = "(pin.force_x - f)/0.05" }
)toml"));
    const ScenarioResult r = folder.read(R"(format = 1
gravity = [0, 0, -9.81]
include = [{ file = "arm.toml", prefix = "a " },
           { file = "arm.toml", prefix = "b ", position = [0, 3, 0], rotation_vector = [0, 0, "90 deg"] }]
[start]
coordinates = [{ joint = "a pin", value = 1.2 }, { joint = "b pin", value = 1.2 }]
[time]
end = 2
accuracy = 1e-9
)");
    ASSERT_TRUE(r.scenario) << shown(r);
    const SolvedScenario s = solve_scenario(*r.scenario, r.scenario->options, r.scenario->prepared);
    ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
    const State last = s.solution.motion.at_end(s.solution.motion.n_elements());
    for (const std::size_t k : {0, 1}) {
        const Joint& pin = r.scenario->model.joints()[k];
        EXPECT_NEAR(coordinate_value(pin.coordinates[0].coordinate, last.X), -0.74441363005759, 1e-8) << k;
    }
    const std::vector<NamedState> states = states_in(r.scenario->model, last.V);
    EXPECT_GT(std::abs(states[0].value), 0.1);
    EXPECT_NEAR(states[0].value, states[1].value, 1e-7);
}

TEST(Include, PartsBeginWhereTheStartHasLedThem)
{
    const Folder folder;
    folder.write("parts/leg.toml", leg + "[[drive]]\ntype = \"joint\"\njoint = \"knee\"\nrate = 0\n");
    const ScenarioResult r =
        folder.read(two_legs + "[start]\ncoordinates = [{ joint = \"right.knee\", value = 0.3 }]\n");
    ASSERT_TRUE(r.scenario) << shown(r);
    const Model& m = r.scenario->model;
    const int knee = m.find_joint("right.knee"), drive = m.find_joint("right.drive of knee");
    ASSERT_GE(drive, 0);
    EXPECT_NEAR(m.joints()[static_cast<std::size_t>(knee)].coordinates[0].at_stated, 0.3, 1e-12);
    // it holds what was there: its row is closed
    const ConstraintRow& row = m.joints()[static_cast<std::size_t>(drive)].rows[0];
    EXPECT_LT(std::abs(constraint_value(row, {0}, m.start().X)), 1e-12);
}

TEST(Include, ARunNeedsNoFileBesideItsOwn)
{
    const Folder folder;
    folder.write("parts/leg.toml", leg + "# a line with \\n and \\\\ in it\n");
    const ScenarioResult r = folder.read(two_legs);
    ASSERT_TRUE(r.scenario) << shown(r);
    const ScenarioResult again = parse_scenario(r.text, "scenario in run.nc", {{}, r.scenario->meshes});
    ASSERT_TRUE(again.scenario) << shown(again);
    EXPECT_EQ(numbers_of(again.scenario->model), numbers_of(r.scenario->model));
    EXPECT_EQ(again.scenario->meshes, r.scenario->meshes);
}

TEST(Include, AModelInsideIsWhatAFileWouldBe)
{
    const std::string ball =
        "body = [{ name = \"ball\", shape = { sphere = 0.1 }, mass = 1, velocity = [1, 0, 0] }]";
    const ScenarioResult r =
        test::read("format = 1\n[[include]]\nprefix = \"a \"\nposition = [1, 0, 0]\nrotation_vector = "
                   "[0, 0, \"90 deg\"]\nmodel = { " +
                   ball + ", include = [{ prefix = \"b \", position = [2, 0, 0], model = { " + ball +
                   " } }] }\n[time]\nend = 1\n");
    ASSERT_TRUE(r.scenario) << shown(r);
    const Model& m = r.scenario->model;
    ASSERT_EQ(m.n_bodies(), 2);
    EXPECT_EQ(m.bodies()[1].name, "a b ball");
    EXPECT_NEAR(norm(m.bodies()[1].X.column(0) - Vector3{1, 2, 0}), 0, 1e-15);
    EXPECT_NEAR(norm(m.bodies()[1].V.column(0) - Vector3{0, 1, 0}), 0, 1e-15);
}

/// The only finding, with its file and line.
void expect_one(const ScenarioResult& r, const std::string& code, const std::string& file, int line,
                const std::string& words = "")
{
    EXPECT_FALSE(r.scenario) << code;
    ASSERT_EQ(r.diagnostics.size(), 1u) << code << "\n" << shown(r);
    const Diagnostic& d = r.diagnostics[0];
    EXPECT_EQ(d.code, code) << shown(r);
    EXPECT_TRUE(d.file.ends_with(file)) << d.file;
    EXPECT_EQ(d.line, line) << shown(r);
    EXPECT_NE((d.message + d.help).find(words), std::string::npos) << shown(r);
}

int line_of(const std::string& text, const std::string& where) { return test::spot(text, where).line; }

TEST(Include, FaultsOfAFileAreToldOnceWithItsLine)
{
    const auto expect_fault = [](const std::string& from, const std::string& to, const std::string& code,
                                 const std::string& where) {
        const Folder folder;
        const std::string changed = test::replaced(leg, from, to);
        folder.write("parts/leg.toml", changed);
        expect_one(folder.read(two_legs), code, "parts/leg.toml", line_of(changed, where));
    };
    expect_fault("mass = 2", "mass = -2", "out-of-range", "mass = -2");
    expect_fault("\"thigh\", \"shin\"", "\"thigh\", \"shn\"", "body-unknown", "\"shn\"");
    expect_fault("joint = \"knee\"", "joint = \"hipp\"", "joint-unknown", "joint = \"hipp\"");
    expect_fault("axis = [0, 1, 0]\nrate", "axs = [0, 1, 0]\nrate", "unknown-key", "axs");
    expect_fault("format = 1\n", "format = 1\nx = = 2\n", "toml-syntax", "x = =");
    expect_fault("gravity = [0, 0, -9.81]", "gravity = [0, 0, -1.62]", "gravity-differs", "gravity");
    expect_fault("knee.angle -", "kne.angle -", "input-unknown", "expression");
    const Folder folder;
    folder.write("parts/leg.toml", test::replaced(leg, "mass = 2", "mass = -2"));
    const ScenarioResult r = folder.read(two_legs);
    EXPECT_NE(shown(r).find("mass = -2"), std::string::npos) << "the line of the other file is shown";
}

TEST(Include, WhatCannotBeIncludedIsOneErrorAtTheKey)
{
    const auto expect_fault = [](const std::string& from, const std::string& to, const std::string& code,
                                 const std::string& where, const std::string& words) {
        const Folder folder;
        folder.write("parts/leg.toml", leg);
        folder.write("outside.toml", leg);
        const std::string text = test::replaced(two_legs, from, to);
        expect_one(folder.read(text), code, "main.toml", line_of(text, where), words);
    };
    const std::string first = "file = \"parts/leg.toml\"\nprefix = \"left.\"";
    expect_fault(first, "file = \"parts/lg.toml\"\nprefix = \"left.\"", "include-file", "parts/lg.toml",
                 "does not exist");
    expect_fault(first, "file = \"parts\"\nprefix = \"left.\"", "include-file", "\"parts\"", "is no file");
    expect_fault(first, "file = \"../outside.toml\"\nprefix = \"left.\"", "include-path", "../outside",
                 "leaves");
    expect_fault(first, "file = \"parts/../parts/leg.toml\"\nprefix = \"left.\"", "include-path", "/../",
                 "leaves");
    expect_fault(first, "file = \"/etc/passwd\"\nprefix = \"left.\"", "include-path", "/etc", "folder");
    expect_fault(first, "prefix = \"left.\"", "include-source", "[[include]]\nprefix", "file");
    expect_fault("prefix = \"right.\"", "prefix = \"left.\"", "name-duplicate",
                 "prefix = \"left.\"\nposition = [0, -0.1", "left.shin");
    expect_fault("rotation_vector = [0, 0, \"180 deg\"]", "directors = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]",
                 "joint-frames", "directors", "perpendicular");
    expect_fault("points = [\"left.foot\"", "points = [\"left.fot\"", "point-unknown", "left.fot",
                 "left.foot");
}

TEST(Include, RingsAndDepthsEnd)
{
    const Folder folder;
    const std::string include = "format = 1\n[[include]]\nprefix = \"a.\"\nfile = ",
                      time = "\n[time]\nend = 1\n";
    expect_one(folder.read(include + "\"main.toml\"" + time), "include-ring", "main.toml", 4, "main.toml");
    folder.write("one.toml", include + "\"two.toml\"\n");
    folder.write("two.toml", include + "\"one.toml\"\n");
    expect_one(folder.read(include + "\"one.toml\"" + time), "include-ring", "two.toml", 4, "one.toml");
    for (int i = 0; i < 12; ++i)
        folder.write("f" + std::to_string(i) + ".toml",
                     include + "\"f" + std::to_string(i + 1) + ".toml\"\n");
    expect_one(folder.read(include + "\"f0.toml\"" + time), "include-limit", "f7.toml", 2, "deep");
    std::string doubled = "format = 1\n";
    for (int i = 0; i < 8; ++i)
        doubled += "[[include]]\nprefix = \"" + std::to_string(i) + "\"\nfile = \"g0.toml\"\n";
    for (int i = 0; i < 6; ++i) {
        std::string text = doubled;
        for (std::size_t at; (at = text.find("g0")) != std::string::npos;)
            text.replace(at, 2, "h" + std::to_string(i + 1));
        folder.write((i == 0 ? "g0" : "h" + std::to_string(i)) + ".toml", text);
    }
    const ScenarioResult r = folder.read(doubled + time);
    EXPECT_NE(find(r, "include-limit"), nullptr) << shown(r);
}

TEST(Include, AFileThatIsACompleteScenarioIsTakenAndItsEndsAreNot)
{
    const Folder folder;
    folder.write("parts/leg.toml", leg + "[method]\ndegree = 3\n[start]\ninitial = \"project\"\n");
    const ScenarioResult r = folder.read(two_legs);
    ASSERT_TRUE(r.scenario) << shown(r);
    ASSERT_EQ(r.diagnostics.size(), 1u) << "told once of both: " << shown(r);
    EXPECT_EQ(r.diagnostics[0].code, "include-ignored");
    EXPECT_EQ(r.scenario->options.initial, StartPolicy::check);
}

TEST(Include, ParametersOfAFileAreSetByTheOneThatIncludesIt)
{
    const Folder folder;
    folder.write(
        "parts/part.toml",
        "format = 1\nparameters = { r = \"50 mm\", weight = \"2*n\", n = 3 }\n[[body]]\nname = "
        "\"ball\"\nshape = "
        "{ "
        "sphere = \"r\" }\nmass = \"weight\"\n[[point]]\nname = \"top\"\nbody = \"ball\"\nposition = [0, 0, "
        "\"r\"]\n");
    const std::string whole =
        "format = 1\nparameters = { R = \"1 m\" }\n[[include]]\nfile = \"parts/part.toml\"\nprefix = \"a.\"\n"
        "parameters = { r = \"R/4\" }\n[[include]]\nfile = \"parts/part.toml\"\nprefix = \"b.\"\nposition = "
        "[\"2*R\", "
        "0, 0]\nparameters = { n = 5, r = 0.1 }\n[time]\nend = 1\n";
    const ScenarioResult r = folder.read(whole);
    ASSERT_TRUE(r.scenario) << shown(r);
    EXPECT_TRUE(r.diagnostics.empty()) << shown(r);
    const Model& m = r.scenario->model;
    EXPECT_DOUBLE_EQ(m.points()[0].position[2], 0.25);
    EXPECT_DOUBLE_EQ(m.points()[1].position[2], 0.1) << "a plain number is in SI units";
    EXPECT_DOUBLE_EQ(m.bodies()[0].mass(0, 0), 6);
    EXPECT_DOUBLE_EQ(m.bodies()[1].mass(0, 0), 10);
    EXPECT_EQ(m.bodies()[1].X(0, 0), 2);
    const std::string unknown = test::replaced(whole, "n = 5", "q = 5");
    expect_one(folder.read(unknown), "parameter-set", "main.toml", line_of(unknown, "q = 5"), "'q'");
    const std::string wrong = test::replaced(whole, "R/4", "R/4 + 1 s");
    expect_one(folder.read(wrong), "unit", "main.toml", line_of(wrong, "R/4"));
}

TEST(Include, CopiesOfPartsAndPointsAreMade)
{
    const ScenarioResult r = test::read("format = 1\n[[repeat]]\ncount = 3\npoint = [{ name = \"p{i}\", body "
                                        "= \"ball {i}\", position = [0, 0, \"i\"] "
                                        "}]\nbody = [{ name = \"ball {i}\", shape = { sphere = 0.1 }, mass = "
                                        "1, position = [\"i\", 0, 0] }]\njoint = [{ "
                                        "type = \"rod\", points = [\"p{i}\", \"hook\"] }]\nload = [{ name = "
                                        "\"l{i}\", type = \"force\", point = "
                                        "\"p{i}\", value = [0, 0, \"i\"] }]\ninclude = [{ prefix = \"x{i} "
                                        "\", position = [0, \"i\", 0], model = { body = [{ "
                                        "name = \"b\", shape = { point = true }, mass = 1 }] } "
                                        "}]\n[[point]]\nname = \"hook\"\nbody = \"world\"\n[time]\nend "
                                        "= 1\n");
    ASSERT_TRUE(r.scenario) << shown(r);
    const Model& m = r.scenario->model;
    EXPECT_EQ(m.bodies().back().name, "x3 b");
    EXPECT_EQ(m.bodies().back().X(1, 0), 3);
    EXPECT_EQ(m.joints()[1].name, "rod p2-hook");
    EXPECT_EQ(m.points()[static_cast<std::size_t>(m.find_point("p3"))].position[2], 3);
}

TEST(Include, MeshesOfAFileLieBesideIt)
{
    const Folder folder;
    std::filesystem::copy_file(corpus / "wedge.obj", folder.path() / "parts/wedge.obj");
    folder.write(
        "parts/part.toml",
        "format = 1\n[[body]]\nname = \"wedge\"\nshape = { mesh = \"wedge.obj\", unit = \"mm\", turn = true "
        "}\ndensity = 1000\n[time]\nend = 1\n");
    const std::string whole = "format = 1\n[[include]]\nfile = \"parts/part.toml\"\n[time]\nend = 1\n";
    const ScenarioResult r = folder.read(whole);
    ASSERT_TRUE(r.scenario) << shown(r);
    EXPECT_EQ(r.scenario->outlines.size(), 2u);
    const ScenarioResult again = parse_scenario(whole, "x", {{}, r.scenario->meshes});
    EXPECT_TRUE(again.scenario) << shown(again);
}

}   // namespace
}   // namespace livens::include_test
