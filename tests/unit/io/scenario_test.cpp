// SPDX-License-Identifier: BSD-3-Clause
// What a scenario means: each key arrives in the model, and each contradiction is told at its place.
#include "livens/io/scenario.h"

#include <cmath>
#include <numbers>
#include <set>

#include "unit/io/codes_of_tests.h"
#include "unit/io/scenario_text.h"

namespace livens::scenario_test {

namespace {

using test::Case;
using test::expect_error;
using test::find;
using test::read;
using test::replaced;
using test::shown;
using test::valid_scenario;

Scenario good(const std::string& text)
{
    ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    return result.scenario ? std::move(*result.scenario) : Scenario();
}

/// A scenario of one body with these lines, and of nothing else.
std::string one_body(const std::string& lines, const std::string& rest = "")
{
    return "format = 1\n[[body]]\nname = \"b\"\n" + lines + "\n" + rest + "\n[time]\nend = 1\nelements = 4\n";
}
const std::string given_mass = "mass = 2\ninertia = [1, 2, 2]\n";

TEST(Scenario, ArrivesInTheModel)
{
    const Scenario s = good(replaced(valid_scenario, "gravity", "title = \"t\"\ngravity"));
    EXPECT_EQ(s.title, "t");
    EXPECT_EQ(s.model.gravity(), (Vector3{0, 0, -9.81}));
    ASSERT_EQ(s.model.n_bodies(), 2);
    EXPECT_NEAR(s.model.bodies()[0].mass(0, 0), 20, 1e-12);
    EXPECT_EQ(s.model.bodies()[0].X.column(0), (Vector3{0.5, 0, 0}));
    ASSERT_EQ(s.model.n_rows(), 8);
    EXPECT_EQ(s.model.joints()[0].first, world);
    EXPECT_EQ(s.model.joints()[1].point_first, (Vector3{0.5, 0, 0}));
    EXPECT_EQ(s.model.joints()[1].point_second, (Vector3{-0.5, 0, 0}));
    ASSERT_EQ(s.model.loads().size(), 1u);
    EXPECT_EQ(std::get<TimeMesh>(s.time).n_elements(), 10);
    EXPECT_EQ(s.output, std::get<TimeMesh>(s.time).ends) << "without output every element end is one";
    EXPECT_EQ(s.file, "test.toml");
}

TEST(Scenario, ShapesGiveTheInertiaOfTheLibrary)
{
    const auto expect_mass = [](const std::string& shape, const MassProperties& expected) {
        const Scenario s = good(one_body("shape = { " + shape + " }\ndensity = 3"));
        EXPECT_EQ(s.model.bodies()[0].mass, mass_matrix(expected)) << shape;
    };
    expect_mass("box = [1, 2, 3]", box(3, {1, 2, 3}));
    expect_mass("sphere = 2", sphere(3, 2));
    expect_mass("sphere = { radius = 2 }", sphere(3, 2));
    expect_mass("cylinder = { radius = 2, length = 3 }", cylinder(3, 2, 3));
    expect_mass("cylinder = { radius = 2, length = 3, inner_radius = 1 }", cylinder(3, 2, 3, 1));
    expect_mass("capsule = { radius = 2, length = 3 }", capsule(3, 2, 3));
    expect_mass("ellipsoid = [1, 2, 3]", ellipsoid(3, {1, 2, 3}));
    expect_mass("cone = { radius = 2, height = 3 }", cone(3, 2, 3));
}

TEST(Scenario, MassAndCentreMoveAShape)
{
    const Scenario s = good(one_body("shape = { box = [1, 2, 3] }\nmass = 5\ncenter_of_mass = [0, 1, 0]"));
    const MassProperties p = mass_properties(s.model.bodies()[0].mass);
    EXPECT_NEAR(p.mass, 5, 1e-14);
    EXPECT_NEAR(norm(p.center_of_mass - Vector3{0, 1, 0}), 0, 1e-15);
    EXPECT_NEAR(p.inertia(0, 0), 5.0 / 12 * 13, 1e-13);
}

TEST(Scenario, InertiaIsPrincipalOrFull)
{
    const Scenario principal = good(one_body("mass = 1\ninertia = [1, 2, 2.5]"));
    const Scenario full = good(one_body("mass = 1\ninertia = [[1, 0, 0], [0, 2, 0], [0, 0, 2.5]]"));
    EXPECT_EQ(principal.model.bodies()[0].mass, full.model.bodies()[0].mass);
    const Scenario turned = good(one_body("mass = 1\ninertia = [[2, 0.25, 0], [0.25, 2, 0], [0, 0, 3]]"));
    EXPECT_NEAR(mass_properties(turned.model.bodies()[0].mass).inertia(0, 1), 0.25, 1e-15);
}

TEST(Scenario, OrientationsAgree)
{
    const double c = std::cos(0.3), s = std::sin(0.3);
    char directors_text[200], quaternion_text[100];
    std::snprintf(directors_text, sizeof directors_text,
                  "directors = [[%.17g, %.17g, 0], [%.17g, %.17g, 0], [0, 0, 1]]", c, s, -s, c);
    std::snprintf(quaternion_text, sizeof quaternion_text, "quaternion = [%.17g, 0, 0, %.17g]",
                  std::cos(0.15), std::sin(0.15));
    const auto X = [](const std::string& line) {
        return good(one_body(given_mass + line)).model.bodies()[0].X;
    };
    const Matrix34 expected = configuration({}, {c, s, 0, -s, c, 0, 0, 0, 1});
    EXPECT_LT(norm(X(directors_text) - expected), 1e-15) << "rows of the text are d1, d2, d3";
    EXPECT_LT(norm(X(quaternion_text) - expected), 1e-15);
    EXPECT_LT(norm(X("rotation_vector = [0, 0, 0.3]") - expected), 1e-15);
    EXPECT_LT(norm(X("rotation_vector = [0, 0, \"17.188733853924695 deg\"]") - expected), 1e-15);
}

TEST(Scenario, SpinsAreInWorldOrBodyAxesOrRaw)
{
    const std::string quarter = given_mass + "rotation_vector = [0, 0, \"90 deg\"]\nvelocity = [1, 2, 3]\n";
    const auto V = [&](const std::string& line, const std::string& rest = "") {
        return good(one_body(quarter + line, rest)).model.bodies()[0].V;
    };
    const Matrix34 world_axes = V("angular_velocity = [0, 2, 0]");
    EXPECT_LT(norm(world_axes - V("angular_velocity_body = [2, 0, 0]")), 1e-15) << "d1 lies along y";
    EXPECT_EQ(world_axes.column(0), (Vector3{1, 2, 3}));
    const Matrix34 raw =
        V("director_rates = [[0, 0, 0], [0, 0, 0], [0, 1, 0]]", "[start]\ninitial = \"project\"");
    EXPECT_EQ(raw.column(3), (Vector3{0, 1, 0})) << "rates arrive as they are; assembly projects them";
    EXPECT_EQ(raw.column(2), (Vector3{0, 0, 0}));
}

TEST(Scenario, PointMassesHaveNoDirectors)
{
    const Scenario s = good(one_body("shape = { point = true }\nmass = 2\nposition = [1, 0, 0]"));
    EXPECT_TRUE(s.model.bodies()[0].is_point);
    EXPECT_EQ(s.model.bodies()[0].mass(0, 0), 2);
}

std::string two_bodies(const std::string& joint)
{
    return "format = 1\n[[body]]\nname = \"a\"\n" + given_mass + "[[body]]\nname = \"b\"\n" + given_mass +
           "position = [2, 0, 0]\nrotation_vector = [0, 0, \"90 deg\"]\n" + joint +
           "\n[time]\nend = 1\nelements = 4\n";
}

TEST(Scenario, JointsByWorldPointAndByBodyPointsAgree)
{
    const auto joint = [](const std::string& lines) {
        return good(two_bodies("[[joint]]\nname = \"j\"\nbetween = [\"a\", \"b\"]\n" + lines))
            .model.joints()[0];
    };
    const std::string by_world = "at = [1, 0, 0]\n", by_points = "points = [[1, 0, 0], [0, 1, 0]]\n";
    for (const auto& [type, world_axes, body_axes] :
         {std::tuple("spherical", "", ""),
          std::tuple("revolute", "axis = [0, 3, 0]\n", "axes = [[0, 1, 0], [1, 0, 0]]\n"),
          std::tuple("universal", "axes = [[0, 1, 0], [0, 0, 1]]\n", "axes = [[0, 1, 0], [0, 0, 1]]\n"),
          std::tuple("weld", "", "")}) {
        const std::string head = "type = \"" + std::string(type) + "\"\n";
        const Joint a = joint(head + by_world + world_axes), b = joint(head + by_points + body_axes);
        EXPECT_LT(norm(a.point_second - b.point_second), 1e-15) << type;
        ASSERT_EQ(a.rows.size(), b.rows.size()) << type;
        for (std::size_t i = 0; i < a.rows.size(); ++i) {
            EXPECT_LT(norm(a.rows[i].c_ij - b.rows[i].c_ij), 1e-15) << type << i;
            EXPECT_LT(norm(a.rows[i].b_j - b.rows[i].b_j), 1e-15) << type << i;
        }
    }
}

TEST(Scenario, RodsAreAsLongAsTheyStartUnlessSaid)
{
    const std::string rod = "[[joint]]\ntype = \"rod\"\nbetween = [\"a\", \"b\"]\n";
    const auto constant = [&](const std::string& lines) {
        return good(two_bodies(rod + lines)).model.joints()[0].rows[0];
    };
    const Matrix34 a = configuration({}, identity<3>()),
                   b = configuration({2, 0, 0}, {0, 1, 0, -1, 0, 0, 0, 0, 1});
    EXPECT_NEAR(constraint_value(constant(""), std::vector{a, b}), 0, 1e-15);
    EXPECT_NEAR(constraint_value(constant("points = [[0, 0, 0], [0, 1, 0]]"), std::vector{a, b}), 0, 1e-15);
    expect_error(two_bodies(rod + "length = 3"), "start-position", "[[joint]]");
    const Scenario to_world = good(two_bodies("[[joint]]\ntype = \"rod\"\nbetween = [\"world\", \"b\"]"));
    EXPECT_EQ(to_world.model.joints()[0].name, "rod world-b");
    EXPECT_EQ(to_world.model.joints()[0].rows[0].scale, 4) << "the square of its length";
}

TEST(Scenario, InconsistentStartsAreProjectedOnRequest)
{
    const std::string joint =
        "[[joint]]\ntype = \"spherical\"\nbetween = [\"a\", \"b\"]\npoints = [[1, 0, 0], [0, 1.01, 0]]\n";
    expect_error(two_bodies(joint), "start-position", "[[joint]]");
    const Scenario s = good(two_bodies(joint + "[start]\ninitial = \"project\""));
    EXPECT_EQ(s.options.initial, StartPolicy::project);
}

TEST(Scenario, WindowsAndTablesBreakTheMesh)
{
    const auto mesh = [](const std::string& lines) {
        const std::string load = "[[load]]\ntype = \"force\"\nbody = \"b\"\n" + lines;
        return std::get<TimeMesh>(good(one_body(given_mass, load)).time).ends;
    };
    EXPECT_EQ(mesh("value = [1, 0, 0]"), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
    EXPECT_EQ(mesh("value = [1, 0, 0]\nfrom = 0.3\nuntil = 7"),
              (std::vector<double>{0, 0.15, 0.3, 0.3 + 0.7 / 3, 0.3 + 1.4 / 3, 1}));
    EXPECT_EQ(mesh("table = { times = [0, 0.25, 0.6], values = [[0, 0, 0], [1, 0, 0], [0, 0, 0]] }").size(),
              6u);
}

TEST(Scenario, BreaksCanBeIgnored)
{
    const std::string load = "[[load]]\ntype = \"force\"\nbody = \"b\"\nvalue = [1, 0, 0]\nfrom = 0.3\n";
    const std::string text =
        replaced(one_body(given_mass, load), "elements = 4", "elements = 4\nbreaks = \"ignore\"");
    EXPECT_EQ(std::get<TimeMesh>(good(text).time).n_elements(), 4);
}

TEST(Scenario, LoadsActAsTheySay)
{
    const auto forces = [](const std::string& lines, double t) {
        const Scenario s = good(one_body(given_mass + "rotation_vector = [0, 0, \"90 deg\"]",
                                         "[[load]]\nbody = \"b\"\n" + lines));
        LoadArguments at;
        at.at = {t, Side::right};
        at.X[0] = s.model.bodies()[0].X;
        LoadForces F{};
        s.model.loads()[0].forces(at, F);
        return F[0];
    };
    EXPECT_EQ(forces("type = \"force\"\nvalue = [1, 2, 3]", 0).column(0), (Vector3{1, 2, 3}));
    EXPECT_EQ(forces("type = \"force\"\nvalue = [1, 2, 3]\npoint = [0, 2, 0]", 0).column(2),
              (Vector3{2, 4, 6}));
    EXPECT_LT(
        norm(forces("type = \"force\"\nframe = \"body\"\nvalue = [1, 0, 0]", 0).column(0) - Vector3{0, 1, 0}),
        1e-15);
    EXPECT_EQ(norm(forces("type = \"force\"\nvalue = [1, 2, 3]\nuntil = 0.5", 0.5)), 0);
    const std::string table = "table = { times = [0, \"1000 ms\"], values = [[0, 0, 0], [0, \"2 kN\", 0]] }";
    EXPECT_EQ(forces("type = \"force\"\n" + table, 0.25).column(0), (Vector3{0, 500, 0}));
    const Matrix34 moment = forces("type = \"torque\"\nvalue = [0, 0, 6]", 0);
    const Matrix34 X = configuration({}, {0, 1, 0, -1, 0, 0, 0, 0, 1});
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), moment.column(i));
    EXPECT_LT(norm(sum - Vector3{0, 0, 6}), 1e-14);
}

TEST(Scenario, SpringsTakeTheWorldOnEitherSide)
{
    for (const char* between : {"[\"world\", \"b\"]", "[\"b\", \"world\"]"}) {
        const bool first_is_world = std::string(between).find("world") == 2;
        const std::string points = first_is_world ? "[[4, 0, 0], [1, 0, 0]]" : "[[1, 0, 0], [4, 0, 0]]";
        const Scenario s =
            good(one_body(given_mass, "[[load]]\ntype = \"spring\"\nbetween = " + std::string(between) +
                                          "\npoints = " + points + "\nstiffness = 2\nfree_length = 1"));
        const Load& spring = s.model.loads()[0];
        EXPECT_EQ(spring.bodies[0], 0);
        LoadForces F{};
        LoadArguments at;
        at.X[0] = s.model.bodies()[0].X;
        spring.forces(at, F);
        EXPECT_EQ(F[0].column(0), (Vector3{4, 0, 0}))
            << "stretched from 1 to 3 m, it pulls towards the world's point";
    }
}

TEST(Scenario, OutputByIntervalHitsDecimalsToTheBit)
{
    const auto output = [](const std::string& lines) {
        return good(replaced(one_body(given_mass), "end = 1", "end = 1\noutput = " + lines)).output;
    };
    const std::vector<double> tenths = output("0.1");
    ASSERT_EQ(tenths.size(), 11u);
    EXPECT_EQ(tenths[3], 0.3) << "3 * 0.1 is 0.30000000000000004";
    EXPECT_EQ(tenths[7], 0.7);
    EXPECT_EQ(output("0.3"), (std::vector{0.0, 0.3, 0.6, 0.9, 1.0})) << "the end is always there";
    EXPECT_EQ(output("\"250 ms\"").size(), 5u);
    EXPECT_EQ(output("[0.2, 0.7]"), (std::vector{0.2, 0.7}));
    EXPECT_EQ(output("1e-2")[57], 0.57);
    EXPECT_EQ(output("5").size(), 2u);
}

TEST(Scenario, OutputTimesAreElementEndsToTheBit)
{
    const std::string load =
        "[[load]]\ntype = \"force\"\nbody = \"b\"\nvalue = [1, 0, 0]\nfrom = 0.3000000000001\n";
    const Scenario s =
        good(replaced(one_body(given_mass, load), "end = 1", "start = -0.5\nend = 1\noutput = 0.1"));
    const std::vector<double>& ends = std::get<TimeMesh>(s.time).ends;
    for (const double t : s.output) EXPECT_EQ(std::count(ends.begin(), ends.end(), t), 1) << t;
    EXPECT_EQ(std::count(ends.begin(), ends.end(), 0.3000000000001), 1) << "the jump wins";
    EXPECT_EQ(s.output[1], -0.4);
}

TEST(Scenario, ResolvedStatesAllOptions)
{
    const std::string resolved = good(valid_scenario).resolved;
    EXPECT_TRUE(resolved.starts_with(R"({"format": 1, "title": "", "gravity": [0, 0, -9.81], )"
                                     R"("time": {"start": 0, "end": 1, "elements": 10, )"
                                     R"("output": "element ends", "breaks": "from_loads"}, )"
                                     R"("method": {"family": "lobatto", "degree": 4, "window": 1, )"
                                     R"("tolerance": 1e-14, "max_iterations": 30, )"))
        << resolved;   // and other options: see Schema.ResolvedStatesEveryKeyOfTheMethod
    EXPECT_TRUE(resolved.ends_with(
        R"(}, "start": {"given": "state", "initial": "check"}, "end": {"given": "nothing"}})"));
    const Scenario midpoint = good(replaced(valid_scenario, "degree = 4", "family = \"midpoint\""));
    EXPECT_TRUE(std::holds_alternative<Midpoint>(midpoint.method));
    EXPECT_NE(midpoint.resolved.find(R"({"family": "midpoint", "tolerance")"), std::string::npos);
}

TEST(Scenario, LoadsWithoutNameAreNumbered)
{
    const std::string load = "[[load]]\ntype = \"torque\"\nbody = \"b\"\nvalue = [1, 0, 0]\n";
    const Scenario s = good(one_body(given_mass, load + load + load + "name = \"torque on b 2\"\n"));
    EXPECT_EQ(s.model.loads()[0].name, "torque on b");
    EXPECT_EQ(s.model.loads()[1].name, "torque on b 3");
    EXPECT_EQ(s.model.loads()[2].name, "torque on b 2");
}

// One case for each code that a scenario can lead to.

/// The valid scenario with a change; the finding is at `where`, or at what was put in.
Case change(const char* code, const std::string& from, const std::string& to, const std::string& where = "")
{
    return {code, replaced(valid_scenario, from, to), where.empty() ? to : where};
}

const std::string point_body = "shape = { point = true }\nmass = 1\nposition = [1, 0, 0]";

std::string joined(const std::string& body, const std::string& joint)
{
    return one_body(body, "[[joint]]\nname = \"j\"\nbetween = [\"world\", \"b\"]\n" + joint);
}

std::string loaded(const std::string& body, const std::string& load)
{
    return one_body(body, "[[load]]\nname = \"l\"\n" + load);
}

std::string tabled(const std::string& table)
{
    return loaded(given_mass, "type = \"force\"\nbody = \"b\"\ntable = { " + table + " }");
}

/// The file, its keys and their values, and time.
std::vector<Case> cases_of_files()
{
    return {
        change("duplicate-key", "axis = [0, 1, 0]", "axis = [0, 1, 0]\naxis  = [0, 0, 1]", "axis  ="),
        {"empty-file", " \n\t\r\n", " "},
        change("format-version", "format = 1", "format = 2", "2\ngravity"),
        change("misplaced-key", "at = [1, 0, 0]\n", "at = [1, 0, 0]\naxis  = [0, 0, 1]\n", "axis  ="),
        change("missing-key", "between = [\"upper\", \"lower\"]\n", "", "[[joint]]\nname = \"elbow\""),
        {"no-bodies", "format = 1\nbody = []\n[time]\nend = 1\nelements = 1\n", "[]"},
        change("not-finite", "end = 1", "end = nan", "nan"),
        change("accuracy-elements", "elements = 10", "elements = 10\naccuracy = 1e-6", "1e-6"),
        change("not-text", "\"push\"", "\"pu\xffsh\"", "\xff"),
        change("number-overflow", "end = 1", "end = 1e999", "1e999"),
        change("out-of-range", "elements = 10", "elements = 0", "0\n\n[method]"),
        change("resource-limit", "elements = 10", "elements = 10\noutput = 1e-9", "1e-9"),
        change("time-end", "end = 1", "end = -1", "-1\n"),
        change("time-output", "elements = 10", "elements = 10\noutput = [0.1, 0.1]", "0.1]\n\n[method]"),
        change("time-resolution", "end = 1", "start = 1e9\nend = 1000000000.0000001", "10\n\n[method]"),
        change("toml-syntax", "mass = 2", "mass = 2 kg", "kg"),
        {"too-deep", "a = " + std::string(64, '[') + "[ ", "[ "},
        change("unit", "end = 1", "end = \"1 kg\"", "\"1 kg\""),
        change("unknown-choice", "\"spherical\"", "\"sperical\""),
        change("unknown-key", "density", "densty", "densty"),
        change("wrong-type", "density = 1000", "density = [1000]", "[1000]"),
    };
}

/// Mass, shape and start of bodies, and names.
std::vector<Case> cases_of_bodies()
{
    return {
        {"directors-left-handed", one_body(given_mass + "directors = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]"),
         "[[1, 0, 0], [0"},
        {"directors-not-orthonormal",
         one_body(given_mass + "directors = [[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]"), "[[1, 0"},
        {"inertia-negative", one_body("mass = 1\ninertia = [-1, 2, 2]"), "[-1, 2, 2]"},
        {"inertia-not-symmetric", one_body("mass = 1\ninertia = [[2, 1, 0], [0, 2, 0], [0, 0, 3]]"),
         "[[2, 1"},
        change("inertia-triangle", "[0.2, 0.3, 0.4]", "[0.2, 0.3, 0.6]"),
        change("mass-conflict", "density = 1000", "density = 1000\nmass = 1", "1\nposition"),
        change("mass-missing", "inertia = [0.2, 0.3, 0.4]\n", "", "[[body]]\nname = \"lower\""),
        change("name-duplicate", "name = \"lower\"", "name = \"upper\"", "\"upper\"\nmass"),
        change("name-empty", "name = \"push\"", "name = \"\"", "\"\"\ntype"),
        change("name-invalid", "name = \"push\"", "name = \"\\u001b\"", "\"\\u001b"),
        change("name-reserved", "name = \"push\"", "name = \"world\"", "\"world\"\ntype = \"force"),
        {"orientation-conflict",
         one_body(given_mass + "quaternion = [1, 0, 0, 0]\nrotation_vector = [0, 0, 0]"), "[0, 0, 0]"},
        {"point-mass", one_body(point_body + "\nangular_velocity = [9, 0, 0]"), "[9, 0, 0]"},
        {"quaternion-norm", one_body(given_mass + "quaternion = [1, 1, 0, 0]"), "[1, 1, 0, 0]"},
        {"rates-conflict",
         one_body(given_mass + "angular_velocity = [9, 0, 0]\nangular_velocity_body = [8, 0, 0]"), "[8"},
        change("shape", "{ box = [1, 0.2, 0.1] }", "{ }"),
        {"size-inner-radius",
         one_body("shape.cylinder = { radius = 1, length = 1, inner_radius = 1.5 }\ndensity = 1"), "1.5"},
        {"spin-without-inertia", one_body("mass = 1\ninertia = [0, 1, 1]"), "[0, 1, 1]"},
        {"start-velocity", one_body(given_mass + "director_rates = [[0, 0, 0], [0, 0, 0], [0, 1, 0]]"),
         "[[0, 0, 0]"},
    };
}

/// What connects bodies and acts on them.
std::vector<Case> cases_of_joints_and_loads()
{
    const std::string contradiction =
        two_bodies("[[joint]]\nname = \"one\"\ntype = \"rod\"\nbetween = [\"a\", \"b\"]\n"
                   "[[joint]]\nname = \"two\"\ntype = \"rod\"\nbetween = [\"a\", \"b\"]\nlength = 3\n"
                   "[start]\ninitial = \"project\"");
    return {
        {"axes-not-perpendicular",
         joined(given_mass, "type = \"universal\"\nat = [0, 0, 0]\naxes = [[1, 0, 0], [1, 1, 0]]"),
         "[[1, 0, 0], [1, 1"},
        change("axis-zero", "axis = [0, 1, 0]", "axis = [0, 0, 0]", "[0, 0, 0]\n\n[[joint]]"),
        change("body-unknown", "body = \"lower\"", "body = \"lover\"", "\"lover\""),
        {"joint-branch",
         joined(given_mass, "type = \"revolute\"\npoints = [[0, 0, 0], [0, 0, 0]]\n"
                            "axes = [[0, 0, 1], [0, 0, -1]]"),
         "[[0, 0, 1], [0"},
        {"joint-contradiction", contradiction, "\"two\""},
        {"joint-needs-directors", joined(point_body, "type = \"weld\"\nat = [1, 0, 0]"), "\"j\""},
        change("joint-placement", "at = [1, 0, 0]\n", "", "[[joint]]\nname = \"elbow\""),
        change("joint-self", "[\"upper\", \"lower\"]", "[\"lower\", \"lower\"]", "\"lower\"]"),
        {"load-needs-directors", loaded(point_body, "type = \"torque\"\nbody = \"b\"\nvalue = [0, 0, 1]"),
         "\"l\""},
        {"load-self", loaded(given_mass, "type = \"force\"\nbody = \"world\"\nvalue = [0, 0, 1]"),
         "\"world\""},
        change("load-value", "value = [0, 1, 0]\n", "", "[[load]]"),
        {"rod-length", joined(given_mass, "type = \"rod\""), "\"j\""},
        {"start-singular",
         joined(point_body, "type = \"rod\"\n[[joint]]\nname = \"k\"\ntype = \"rod\"\n"
                            "between = [\"world\", \"b\"]\npoints = [[3, 0, 0], [0, 0, 0]]"),
         "\"j\""},
        {"start-position", joined(given_mass, "type = \"spherical\"\npoints = [[1, 0, 0], [0, 0, 0]]"),
         "\"j\""},
        {"table-order", tabled("times = [0, 2, 1], values = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]"), "{ times"},
        {"table-size", tabled("times = [0, 1], values = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]"), "{ times"},
        {"table-slope", tabled("times = [0, 1e-300], values = [[0, 0, 0], [1e200, 0, 0]]"), "{ times"},
        change("window-order", "value = [0, 1, 0]", "value = [0, 1, 0]\nfrom = 0.5\nuntil = 0.25", "0.25"),
    };
}

std::vector<Case> cases()
{
    std::vector<Case> all = cases_of_files();
    for (const std::vector<Case>& more :
         {cases_of_bodies(), cases_of_joints_and_loads(), test::cases_of_mechanisms(), test::cases_of_laws(),
          test::cases_of_mixed()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

TEST(ScenarioCodes, EachIsProvokedAtItsPlace)
{
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.code);
        expect_error(c.text, c.code, c.where);
    }
}

TEST(ScenarioCodes, WarningsLeaveTheScenarioAlone)
{
    const std::string late = replaced(valid_scenario, "value = [0, 1, 0]", "value = [0, 1, 0]\nfrom = 5");
    const std::string second =
        replaced(valid_scenario, "format = 1\ngravity = [0, 0, -9.81]", "gravity = [0, 0, 1]\nformat = 1");
    const std::string missed =
        replaced(replaced(valid_scenario, "at = [1, 0, 0]", "points = [[0.5, 0, 1e-8], [-0.5, 0, 0]]"),
                 "[time]", "[start]\njoints = \"fit\"\n\n[time]");
    const std::string kinked = replaced(
        valid_scenario, "[time]",
        "[[load]]\ntype = \"actuator\"\njoint = \"shoulder\"\ninputs = { w = \"shoulder.angle_rate\" }\n"
        "expression = \"-max(w, 0)\"\n\n[time]\nbreaks = \"ignore\"");
    const std::string hurried =
        replaced(replaced(valid_scenario, "name = \"shoulder\"", "name = \"shoulder\"\nrate = 1"),
                 "name = \"lower\"", "name = \"lower\"\nvelocity = [0, 0, 1]\nangular_velocity = [0, 0, 0]");
    const std::string in_mm = replaced(valid_scenario, "-9.81]", "-9806.65]");
    for (const auto& [code, text] :
         {std::pair("gravity-unit", in_mm), std::pair("expression-kink", kinked),
          std::pair("load-never-acts", late), std::pair("format-first", second),
          std::pair("joint-fitted", missed), std::pair("start-changed", hurried)}) {
        const ScenarioResult result = read(text);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        const Diagnostic* d = find(result, code);
        ASSERT_NE(d, nullptr) << code;
        EXPECT_EQ(d->severity, Severity::warning);
    }
}

/// Whoever adds a code says here how a scenario leads to it, or that none does.
TEST(ScenarioCodes, AllAreProvokedByTheseTests)
{
    std::set<std::string_view> others = codes_of_the_core;
    others.insert({"gravity-unit", "format-first", "load-never-acts", "joint-fitted", "expression-kink",
                   "start-changed", "start-driven", "drive-turns", "end-position", "end-velocity",
                   "point-outside", "spring-kink", "directors-dependent", "directors-metric",
                   "directors-nearly-orthonormal", "io-directory", "io-not-found",
                   "io-unreadable"});   // here, of meshes, of hostile files
    others.insert({"conditions-dependent", "conditions-joints", "conditions-method", "conditions-not-smooth",
                   "conditions-too-few", "conditions-too-many", "conditions-twice", "conditions-unknown",
                   "ranks-conditions", "ranks-elements", "ranks-method",
                   "threads-out-of-range"});   // known_test.cpp, threads_test.cpp
    others.insert({"point-body", "point-unknown", "gravity-differs", "include-file", "include-ignored",
                   "include-limit", "include-path", "include-ring", "include-source"});   // their own tests
    others.insert({"import-lost", "import-mended", "import-merged", "mjcf-read", "urdf-joint", "urdf-tag",
                   "urdf-tree", "urdf-value", "xml-syntax"});   // of files of other programs
    others.insert({"coordinate-twice", "coordinate-unknown", "coordinate-value", "coordinates-dependent",
                   "coordinates-missing", "coordinates-singular", "loop-open", "pose-unreachable"});
    others.insert({"conditions-value", "periodic-free", "periodic-turn", "roots-unused", "guess-bodies",
                   "guess-time", "guess-unused", "unknown-bounds", "unknown-guess", "unknown-march",
                   "unknown-order", "unknown-place", "unknown-unseen"});   // their own tests
    others.insert({"event-action", "event-condition", "event-method", "event-not-finite", "event-reaction",
                   "impact-simultaneous", "stop-limits", "stop-of", "stop-released", "stop-restitution",
                   "stop-self", "stop-violated"});   // decided_events_test.cpp, stops_test.cpp
    others.insert({"controller-ends", "controller-every", "controller-name", "controller-sampled",
                   "controller-size", "controller-state", "controller-states"});   // controllers_test.cpp
    others.insert(codes_of_others.begin(), codes_of_others.end());
    for (const Case& c : cases()) {
        EXPECT_NE(explain(c.code), "") << c.code;
        others.insert(c.code);
    }
    for (const std::string_view code : diagnostic_codes()) EXPECT_EQ(others.count(code), 1u) << code;
}

TEST(Scenario, AnErrorInOnePartDoesNotHideThoseInOthers)
{
    std::string text = valid_scenario;
    text = replaced(text, "density = 1000", "density = -1");
    text = replaced(text, "inertia = [0.2, 0.3, 0.4]", "inertia = [0.2, 0.3, 9]");
    text = replaced(text, "axis = [0, 1, 0]", "axis = [0, 0, 0]");
    text = replaced(text, "[\"upper\", \"lower\"]", "[\"uper\", \"lower\"]");
    text = replaced(text, "body = \"lower\"", "body = \"nobody\"");
    text = replaced(text, "end = 1", "end = 0");
    text = replaced(text, "degree = 4", "degree = 17");
    const ScenarioResult result = read(text);
    std::vector<std::string> codes;
    for (const Diagnostic& d : result.diagnostics) codes.push_back(d.code);
    EXPECT_EQ(codes, (std::vector<std::string>{"out-of-range", "inertia-triangle", "axis-zero",
                                               "body-unknown", "body-unknown", "time-end", "out-of-range"}))
        << shown(result);
}

TEST(Scenario, AFaultyBodyIsNoSecondErrorInItsJoints)
{
    const ScenarioResult result = read(replaced(valid_scenario, "density = 1000", "density = -1"));
    EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
}

TEST(Scenario, SuggestionsNameTheNearestBody)
{
    const ScenarioResult result = read(replaced(valid_scenario, "body = \"lower\"", "body = \"lover\""));
    ASSERT_NE(find(result, "body-unknown"), nullptr);
    EXPECT_EQ(find(result, "body-unknown")->help, "did you mean 'lower'?");
}

}   // namespace
}   // namespace livens::scenario_test
