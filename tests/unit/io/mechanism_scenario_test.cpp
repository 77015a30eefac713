// SPDX-License-Identifier: BSD-3-Clause
// Joints by every placement, couplings and drives: what arrives, and what is told where.
#include <cmath>

#include "livens/multibody/joints.h"
#include "unit/io/scenario_text.h"

namespace livens::mechanism_scenario_test {

namespace {

using test::expect_error;
using test::find;
using test::read;
using test::replaced;
using test::shown;

/// One body on a joint `j` to the world.
std::string joined(const std::string& joint)
{
    return "format = 1\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [1, 2, 2]\n"
           "[[joint]]\nname = \"j\"\nbetween = [\"world\", \"b\"]\n" +
           joint + "\n[time]\nend = 1\nelements = 4\n";
}

Joint joint_of(const std::string& lines)
{
    const ScenarioResult result = read(joined(lines));
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    return result.scenario ? result.scenario->model.joints()[0] : Joint();
}

TEST(MechanismScenario, FramesArePointsAndAxes)
{
    const std::string by_frames =
        "frames = [{ point = [1, 2, 3], rotation_vector = [0, \"90 deg\", 0] }, "
        "{ directors = [[0, 0, -1], [0, 1, 0], [1, 0, 0]] }]\n[start]\ninitial = \"project\"";
    const std::string by_axes = "points = [[1, 2, 3], [0, 0, 0]]\naxes = [[1, 0, 0], [1, 0, 0]]\n"
                                "[start]\ninitial = \"project\"";
    for (const std::string type : {"revolute", "cylindrical", "planar"}) {
        const Joint a = joint_of("type = \"" + type + "\"\n" + by_frames),
                    b = joint_of("type = \"" + type + "\"\n" + by_axes);
        ASSERT_EQ(a.rows.size(), b.rows.size()) << type;
        for (std::size_t i = 0; i < a.rows.size(); ++i) EXPECT_LT(norm(a.rows[i].b_j - b.rows[i].b_j), 1e-14);
    }
    // A weld by frames holds them, not what stands: here a quarter of a turn apart.
    const Joint held = joint_of("type = \"weld\"\nframes = [{ rotation_vector = [0, 0, 1.5] }, {}]\n"
                                "[start]\ninitial = \"project\"");
    const std::vector<Matrix34> there{configuration({}, directors_from_rotation_vector({0, 0, 1.5}))};
    for (const ConstraintRow& row : held.rows) EXPECT_NEAR(constraint_value(row, there), 0, 1e-15);
    EXPECT_GT(std::abs(constraint_value(held.rows[3], std::vector<Matrix34>{world_configuration})), 0.5);
}

/// Two rods on hinges that are stated stretched out along x and start hanging: the mechanism remains the
/// same.
TEST(MechanismScenario, BodiesStartWhereTheyAreNotStated)
{
    const std::string hanging = "[body.start]\nrotation_vector = [0, \"90 deg\", 0]\n";
    const auto rod = [](const std::string& name, double x, const std::string& start) {
        return "[[body]]\nname = \"" + name + "\"\nshape = { box = [1, 0.1, 0.1] }\nmass = 1\nposition = [" +
               std::to_string(x) + ", 0, 0]\n" + start;
    };
    const auto text = [&](const std::string& upper, const std::string& lower, const std::string& rest = "") {
        return "format = 1\ngravity = [0, 0, -9.81]\n" + rod("a", 0.5, upper) + rod("b", 1.5, lower) +
               "[[joint]]\nname = \"h\"\ntype = \"revolute\"\nbetween = [\"world\", \"a\"]\nat = [0, 0, 0]\n"
               "axis = [0, 1, 0]\n[[joint]]\nname = \"k\"\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\n"
               "at = [1, 0, 0]\naxis = [0, 1, 0]\n" +
               rest + "[time]\nend = 1\n";
    };
    const std::string upper = hanging + "position = [0, 0, -0.5]\n",
                      lower = hanging + "position = [0, 0, -1.5]\n";
    const ScenarioResult result = read(text(upper, lower));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Model& model = result.scenario->model;
    EXPECT_LT(norm(model.bodies()[1].X.column(0) - Vector3{0, 0, -1.5}), 1e-15);
    EXPECT_EQ(model.joints()[1].point_first, (Vector3{0.5, 0, 0})) << "on the body as it was stated";
    EXPECT_NEAR(model.joints()[0].coordinates[0].at_stated, std::acos(-1.0) / 2, 1e-15);
    EXPECT_NEAR(model.joints()[1].coordinates[0].at_stated, 0, 1e-15);
    // a whole turn more, which bodies do not tell
    const ScenarioResult turned =
        read(text(upper, lower, "[start]\ncoordinates = [{ joint = \"h\", value = \"450 deg\" }]\n"));
    ASSERT_TRUE(turned.scenario.has_value()) << shown(turned);
    EXPECT_NEAR(turned.scenario->model.joints()[0].coordinates[0].at_stated, 2.5 * std::acos(-1.0), 1e-14);
    EXPECT_LT(norm(turned.scenario->model.bodies()[1].X - model.bodies()[1].X), 1e-15);
    // what is left out is as stated; velocities too
    const ScenarioResult moving =
        read(text("velocity = [0, 0, 0.5]\nangular_velocity = [0, -1, 0]\n[body.start]\n",
                  "velocity = [0, 0, 1.5]\nangular_velocity = [0, -1, 0]\n"));
    ASSERT_TRUE(moving.scenario.has_value()) << shown(moving);
    EXPECT_LT(norm(moving.scenario->model.bodies()[0].V.column(0) - Vector3{0, 0, 0.5}), 1e-15);
    // a start that the joints do not allow is refused by name
    const ScenarioResult apart = read(text(upper, hanging + "position = [0, 0, -1.4]\n"));
    ASSERT_FALSE(apart.scenario.has_value());
    EXPECT_NE(shown(apart).find("'k'"), std::string::npos) << shown(apart);
    expect_error(text(hanging + "quaternion = [1, 0, 0, 0]\n", lower), "orientation-conflict",
                 "[0, \"90 deg\"");
}

/// The drive begins where the bodies were led, and the file's coordinate counts from there.
TEST(MechanismScenario, StartsByCoordinates)
{
    const std::string turn = "type = \"revolute\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n",
                      wanted = "[start]\ncoordinates = [{ joint = \"j\", value = \"450 deg\", rate = 3 }]\n";
    const ScenarioResult result =
        read(joined(turn + wanted + "[[drive]]\ntype = \"joint\"\njoint = \"j\"\nrate = 3"));
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Model& model = result.scenario->model;
    EXPECT_NEAR(model.joints()[0].coordinates[0].at_stated, 2.5 * std::acos(-1.0), 1e-15);
    EXPECT_LT(norm(model.bodies()[0].X.column(1) - Vector3{0, 1, 0}), 1e-14);
    EXPECT_LT(norm(model.bodies()[0].V.column(1) - Vector3{-3, 0, 0}), 1e-14);
    const ScenarioResult by_rate = read(joined(turn + "rate = 3"));
    ASSERT_TRUE(by_rate.scenario.has_value()) << shown(by_rate);
    EXPECT_LT(norm(by_rate.scenario->model.bodies()[0].V.column(1) - Vector3{0, 3, 0}), 1e-14);
    EXPECT_EQ(joint_of(turn).coordinates[0].at_stated, 0) << "negative control";
}

TEST(MechanismScenario, CoordinatesAreNamedAndBeginWhereTheyAreSaid)
{
    EXPECT_EQ(joint_of("type = \"revolute\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\ncoordinate = \"90 deg\"")
                  .coordinates.front()
                  .at_stated,
              std::acos(-1.0) / 2);
    const Joint pipe = joint_of("type = \"cylindrical\"\nat = [0, 0, 0]\naxis = [0, 0, 1]");
    ASSERT_EQ(pipe.coordinates.size(), 2u);
    EXPECT_NE(find_coordinate(pipe, "angle"), nullptr);
    EXPECT_NE(find_coordinate(pipe, "displacement"), nullptr);
    EXPECT_EQ(find_coordinate(pipe, "pitch"), nullptr);
    EXPECT_TRUE(joint_of("type = \"spherical\"\nat = [0, 0, 0]").coordinates.empty());
}

TEST(MechanismScenario, AConstantAngleIsTheOneThatStandsUnlessSaid)
{
    const auto value = [](const std::string& more) {
        const Joint joint = joint_of("type = \"constant_angle\"\naxes = [[1, 0, 0], [3, 4, 0]]\n" + more);
        return constraint_value(joint.rows[0], std::vector<Matrix34>{world_configuration});
    };
    EXPECT_NEAR(value(""), 0, 1e-15);
    EXPECT_NEAR(value("angle = \"60 deg\"\n[start]\ninitial = \"project\""), 0.6 - 0.5, 1e-15);
}

TEST(MechanismScenario, EveryWrongPlacementIsTold)
{
    for (const auto& [lines, where] :
         {std::pair{"type = \"prismatic\"\nat = [0, 0, 0]", "[[joint]]"},
          std::pair{"type = \"prismatic\"\naxis = [0, 0, 1]", "[[joint]]"},
          std::pair{"type = \"point_on_line\"\npoints = [[0, 0, 0], [0, 0, 0]]", "[[joint]]"},
          std::pair{"type = \"parallel_axes\"", "[[joint]]"},
          std::pair{"type = \"perpendicular_axes\"\nat = [0, 0, 0]", "[[joint]]"},
          std::pair{"type = \"parallel_axes\"\naxis = [1, 0, 0]\naxes = [[1, 0, 0], [1, 0, 0]]", "[[1, 0"},
          std::pair{"type = \"planar\"\nframes = [{}, {}]\nat = [1, 1, 1]", "[1, 1, 1]"}})
        expect_error(joined(lines), "joint-placement", where);
}

const std::string turn = "type = \"revolute\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
const std::string on_joint = "type = \"joint\"\njoint = \"j\"\n";

/// With a drive `d`, another joint `k`, or a load.
std::string driven(const std::string& lines) { return joined(turn + "[[drive]]\nname = \"d\"\n" + lines); }
std::string other(const std::string& lines) { return joined(turn + "[[joint]]\nname = \"k\"\n" + lines); }
std::string other_load(const std::string& lines) { return joined(turn + "[[load]]\n" + lines); }

std::string starting(const std::string& tables)
{
    return joined(turn + "[start]\ncoordinates = [" + tables + "]");
}

std::vector<test::Case> cases_of_joints()
{
    return {
        {"joint-angle", joined("type = \"constant_angle\"\naxes = [[1, 0, 0], [1, 0, 0]]\nangle = 0"),
         "0\n[time]"},
        {"joint-angles",
         other("type = \"spherical\"\nbetween = [\"world\", \"c\"]\nat = [0, 0, 0]\nangles = \"xyz\"\n"
               "[[body]]\nname = \"c\"\nmass = 1\nshape = { point = true }"),
         "\"xyz\""},
        {"drive-angle",
         joined("type = \"spherical\"\nat = [0, 0, 0]\nangles = \"xyz\"\n[[drive]]\nname = \"d\"\n" +
                on_joint + "coordinate = \"angle_2\"\nvalue = 2"),
         "\"d\""},
        {"joint-bend", joined("type = \"constant_velocity\"\nat = [0, 0, 0]\naxes = [[1, 0, 0], [-1, 0, 0]]"),
         "[[1, 0, 0], [-1"},
        {"joint-coordinate", driven(on_joint + "coordinate = \"displacement\"\nvalue = 0"), "\"j\"\ncoord"},
        {"joint-factor", other("type = \"gear\"\njoints = [\"j\", \"j\"]\nratio = 0"), "0\n[time]"},
        {"joint-self", other("type = \"gear\"\njoints = [\"j\", \"j\"]\nratio = 2"), "[\"j\", \"j\"]"},
        {"joint-frames", joined("type = \"revolute\"\nframes = [{ point = [0, 0, 0] }]"), "[{ point"},
        {"joint-frames",
         joined("type = \"revolute\"\nframes = [{ directors = [[1, 0, 0], [0, 1, 0], [0, 0, -1]] }, {}]"),
         "[[1, 0, 0], [0, 1, 0], [0, 0, -1]]"},
        {"joint-pitch", joined("type = \"screw\"\nat = [0, 0, 0]\naxis = [1, 0, 0]\npitch = 0"), "0\n[time]"},
        {"joint-unknown", driven("type = \"joint\"\njoint = \"jj\"\nvalue = 0"), "\"jj\""},
        {"joint-unknown", other("type = \"gear\"\njoints = [\"j\", \"jj\"]\nratio = 2"), "\"jj\""},
        {"gear-ratio",
         other("type = \"gear\"\njoints = [\"j\", \"l\"]\nratio = 3.14159265358979\n"
               "[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n"
               "[[joint]]\nname = \"l\"\ntype = \"revolute\"\nbetween = [\"world\", \"c\"]\n"
               "at = [0, 0, 0]\naxis = [0, 0, 1]"),
         "\"k\""}};
}

/// A coupling `k` of the hinges `j` and `l`.
std::string coupled(const std::string& terms)
{
    return other("type = \"coupling\"\nterms = " + terms +
                 "\n[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n"
                 "[[joint]]\nname = \"l\"\ntype = \"revolute\"\nbetween = [\"world\", \"c\"]\n"
                 "at = [0, 0, 0]\naxis = [0, 0, 1]");
}

std::vector<test::Case> cases_of_couplings()
{
    return {
        {"coupling-terms", coupled("{}"), "{}"},
        {"coupling-terms", coupled("{ \"j.angle\" = 1 }"), "{ \"j"},
        {"joint-factor", coupled("{ \"j.angle\" = 1, \"l.angle\" = 0 }"), "{ \"j"},
        {"joint-coordinate", coupled("{ \"j.angle\" = 1, \"l.displacement\" = 1 }"), "{ \"j"},
        {"joint-coordinate", coupled("{ \"j.angle\" = 1, l = 1 }"), "l = 1"},
        {"joint-unknown", coupled("{ \"j.angle\" = 1, \"jj.angle\" = 1 }"), "\"jj"},
        {"joint-unknown", coupled("{ \"j.angle\" = 1, \"k.angle\" = 1 }"), "\"k.a"},
        {"gear-ratio", coupled("{ \"j.angle\" = 1, \"l.angle\" = 3.14159265358979 }"), "\"k\""},
        {"unit", coupled("{ \"j.angle\" = \"5 cm\", \"l.angle\" = \"2 s\" }"), "\"2 s\""},
        {"not-finite", coupled("{ \"j.angle\" = inf, \"l.angle\" = 1 }"), "inf"},
        {"wrong-type", coupled("{ \"j.angle\" = true, \"l.angle\" = 1 }"), "true"},
        {"missing-key", other("type = \"coupling\""), "[[joint]]\nname = \"k\""},
        {"coupling-law",
         coupled("{ \"l.angle\" = 1 }\nlaw = { of = \"j.angle\", expression = \"abs(angle)\" }"), "{ of"},
        {"coupling-range",
         coupled("{ \"l.angle\" = 1 }\nlaw = { of = \"j.angle\", coordinates = [1, 2], values = [0, 1] }"),
         "{ of"},
        {"rope-points", other("type = \"rod\"\nover = [{ body = \"b\" }]"), "[{ body"},
        {"rope-span", other("type = \"rod\"\nover = [{ body = \"world\" }, { body = \"b\" }]"), "[{ body"}};
}

TEST(MechanismScenario, CouplingsTellWhatWasMeant)
{
    // A joint's name that stands without quotes is a table in TOML.
    const ScenarioResult bare = read(coupled("{ j.angle = 1, l.angle = 1 }"));
    ASSERT_NE(find(bare, "wrong-type"), nullptr) << shown(bare);
    EXPECT_NE(find(bare, "wrong-type")->help.find("\"j.angle\" = "), std::string::npos) << shown(bare);
}

TEST(MechanismScenario, FactorsOfACouplingAreNumbersQuantitiesAndFormulas)
{
    const ScenarioResult result =
        read(replaced(coupled("{ \"j.angle\" = \"-2*r\", \"l.angle\" = \"10 cm\" }"), "format = 1\n",
                      "format = 1\n[parameters]\nr = \"5 cm\"\n"));
    ASSERT_TRUE(result.scenario) << shown(result);
    EXPECT_TRUE(result.diagnostics.empty()) << shown(result);
    const Joint& joint = result.scenario->model.joints().back();
    EXPECT_EQ(joint.type, "coupling");
    const auto turned = [](double a) { return configuration({}, directors_from_rotation_vector({0, 0, a})); };
    EXPECT_NEAR(constraint_value(joint.rows[0], std::vector{turned(0.3), turned(0.5)}), 0.02, 1e-15);
    const ScenarioResult unnamed =
        read(replaced(coupled("{ \"j.angle\" = 1, \"l.angle\" = 2 }"), "name = \"k\"\n", ""));
    ASSERT_TRUE(unnamed.scenario) << shown(unnamed);
    EXPECT_EQ(unnamed.scenario->model.joints().back().name, "coupling j.angle-l.angle");
}

std::vector<test::Case> cases_along_joints()
{
    const std::string twice = "{ joint = \"j\", value = 1 }, ";
    return {
        {"start-coordinate", starting("{ joint = \"j\", value = \"5 m\" }"), "\"5 m\""},
        {"start-coordinate", starting("{ joint = \"j\" }"), "{ joint"},
        {"start-coordinate", starting(twice + "{ joint = \"j\", rate = 1 }"), "{ joint = \"j\", rate"},
        {"start-coordinate", starting("{ joint = \"j\", value = 1e5 }"), "{ joint"},
        {"joint-time", joined(turn + "until = 0"), "0\n[time]"},
        {"joint-time", driven(on_joint + "value = 0\nfrom = 2"), "2\n[time]"},
        {"joint-time", driven(on_joint + "value = 0\nfrom = 0.5\nuntil = 0.25"), "\"d\""},
        {"joint-time-mesh", joined(turn + "until = 0.3") + "breaks = \"ignore\"\n", "4\nbreaks"},
        {"joint-time-method", joined(turn + "until = 0.3") + "[method]\nfamily = \"endpoint\"\n",
         "\"endpoint\""},
        {"joint-unknown", starting("{ joint = \"jj\", value = 1 }"), "\"jj\""},
        {"drive-law", driven(on_joint), "[[drive]]"},
        {"drive-law", driven(on_joint + "value = 0\nrate = 1"), "1\n[time]"},
        {"drive-size", driven(on_joint + "value = [0, 1]"), "[0, 1]"},
        {"drive-size", driven("type = \"point\"\nbody = \"b\"\nvalue = 0"), "0\n[time]"},
        {"drive-self", driven("type = \"point\"\nbody = \"world\"\nvalue = [0, 0, 0]"), "\"world\"\nvalue"},
        {"drive-distance",
         driven("type = \"distance\"\nbetween = [\"world\", \"b\"]\npoints = [[0, 0, 0], [0, 0, 0]]\n"
                "rate = 1"),
         "\"d\""},
        {"law-order", driven(on_joint + "step = { from = 1, until = 0, rise = 1 }"), "{ from"},
        {"drive-distance",
         driven("type = \"distance\"\nbetween = [\"world\", \"b\"]\npoints = [[0, 0, 0], [1, 0, 0]]\n"
                "polynomial = [1, -2]"),
         "\"d\""},
        {"joint-self",
         other("type = \"parallel_axes\"\nbetween = [\"world\", \"b\"]\naxis = [0, 0, 1]\n[[joint]]\nname = "
               "\"l\"\n"
               "type = \"gear\"\njoints = [\"j\", \"k\"]\nratio = 2"),
         "[\"j\", \"k\"]"},
        {"unit", other_load("type = \"spring\"\njoint = \"j\"\nstiffness = \"5 N/m\""), "\"5 N/m\""},
        {"unit", other_load("type = \"actuator\"\njoint = \"j\"\nvalue = \"5 N\""), "\"5 N\""},
        {"unit",
         other_load(
             "type = \"spring\"\nbetween = [\"world\", \"b\"]\nfree_length = 1\nstiffness = \"5 N m/rad\""),
         "\"5 N m"},
        {"spring-place", other_load("type = \"spring\"\nstiffness = 1"), "[[load]]"},
        {"spring-place", other_load("type = \"spring\"\nstiffness = 1\nbetween = [\"world\", \"b\"]"),
         "[[load]]"},
        {"spring-place", other_load("type = \"spring\"\nstiffness = 1\njoint = \"j\"\nfree_length = 2"),
         "2\n[time]"},
        {"spring-place",
         other_load(
             "type = \"spring\"\nstiffness = 1\nfree_length = 1\nbetween = [\"world\", \"b\"]\nrest = 3"),
         "3\n[time]"},
        {"joint-unknown", other_load("type = \"actuator\"\njoint = \"jj\"\nvalue = 1"), "\"jj\""},
        {"load-value", other_load("type = \"actuator\"\njoint = \"j\""), "[[load]]"},
        {"name-duplicate",
         driven("type = \"joint\"\njoint = \"j\"\nvalue = 0\n[[drive]]\nname = \"j\"\n" + on_joint +
                "value = 0"),
         "\"j\"\ntype = \"joint\""},
    };
}

}   // namespace
}   // namespace livens::mechanism_scenario_test

namespace livens {

std::vector<test::Case> test::cases_of_mechanisms()
{
    using namespace mechanism_scenario_test;
    std::vector<Case> all = cases_of_joints();
    for (const std::vector<Case>& more : {cases_along_joints(), cases_of_couplings(), cases_of_joint_loads()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

}   // namespace livens
