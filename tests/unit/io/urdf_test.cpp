// SPDX-License-Identifier: BSD-3-Clause
// Robots out of URDFs: what becomes of links and joints, what is told, and what is refused where.
#include "livens/io/import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "livens/multibody/mass_properties.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::urdf_test {

namespace {

using Options = UrdfOptions;

std::string robot(const std::string& content) { return "<robot name=\"r\">\n" + content + "</robot>\n"; }

std::string inertial(const std::string& center, double mass, const std::string& moments)
{
    return "<inertial><origin xyz=\"" + center + "\"/><mass value=\"" + std::to_string(mass) +
           "\"/><inertia " + moments + "/></inertial>";
}

std::string link(const std::string& name,
                 const std::string& content = inertial("0 0 0", 1, "ixx='1' iyy='1' izz='1'"))
{
    return "<link name=\"" + name + "\">" + content + "</link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& content = "")
{
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/>" + content + "</joint>\n";
}

/// A base, an arm that turns about y at (0, 0, 1), a hand that slides along x at its end.
std::string arm(const std::string& more = "")
{
    return robot(
        link("base", "") + link("arm", inertial("0.5 0 0", 2, "ixx='0.1' iyy='0.3' izz='0.3'")) +
        link("hand", inertial("0.1 0 0", 1, "ixx='0.02' iyy='0.03' izz='0.04'")) +
        joint(
            "shoulder", "revolute", "base", "arm",
            "<origin xyz='0 0 1'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='9' velocity='1'/>") +
        joint("slide", "prismatic", "arm", "hand",
              "<origin xyz='1 0 0' rpy='0 0 0'/><dynamics damping='0.5' friction='0.1'/>") +
        more);
}

UrdfResult read_robot(const std::string& text, const Options& options = {})
{
    return parse_urdf(text, "robot.urdf", options);
}

std::string told(const UrdfResult& result)
{
    return render(result.diagnostics, result.text, DiagnosticFormat::gnu);
}

int n_told(const UrdfResult& result, const std::string& code, const std::string& words)
{
    int n = 0;
    for (const Diagnostic& d : result.diagnostics)
        n += d.code == code && d.message.find(words) != std::string::npos ? 1 : 0;
    return n;
}

const Body& body(const UrdfResult& result, const std::string& name)
{
    for (const Body& b : result.scenario->model.bodies())
        if (b.name == name) return b;
    throw std::out_of_range(name);
}

double largest(const Matrix4& m)
{
    double most = 0;
    for (const double entry : m.a) most = std::max(most, std::abs(entry));
    return most;
}

TEST(Urdf, BodiesStandAtThePoseAndCoordinatesAreThoseOfTheFile)
{
    Options options;
    options.at = {{"shoulder", 0.5}, {"slide", 0.2}};
    options.rates = {{"shoulder", 2}, {"slide", 3}};
    const UrdfResult result = read_robot(arm(), options);
    ASSERT_TRUE(result.scenario) << told(result);
    EXPECT_EQ(result.scenario->title, "r");
    const Body& hand = body(result, "hand");
    const double c = std::cos(0.5), s = std::sin(0.5);
    const Vector3 x{c, 0, -s}, at = Vector3{0, 0, 1} + 1.2 * x;   // about y by 0.5: x turns to -z
    EXPECT_LT(norm(hand.X.column(0) - at), 1e-15);
    EXPECT_LT(norm(hand.X.column(1) - x), 1e-15);
    EXPECT_LT(norm(hand.V.column(0) - (3.0 * x + cross({0, 2, 0}, 1.2 * x))), 1e-15);
    EXPECT_EQ(result.scenario->model.bodies().size(), 2u);
    EXPECT_NE(result.toml.find("coordinate = 0.5"), std::string::npos) << result.toml;
}

TEST(Urdf, EachKindIsToldOnceWithItsCountAndItsFirstLine)
{
    const UrdfResult result = read_robot(arm("<gazebo/><transmission/><transmission/>" +
                                             link("tip", "<collision><geometry/></collision><collision/>") +
                                             joint("fix", "fixed", "hand", "tip")));
    ASSERT_TRUE(result.scenario) << told(result);
    EXPECT_EQ(n_told(result, "import-lost", "effort and velocity limits are not kept: 1 joint ('shoulder')"),
              1);
    EXPECT_EQ(n_told(result, "import-lost", "dry friction is not kept: 1 joint ('slide')"), 1)
        << told(result);
    EXPECT_EQ(n_told(result, "import-lost", "(bodies do not touch): 2 shapes ('tip')"), 1);
    EXPECT_EQ(
        n_told(result, "import-lost", "<transmission> is not kept (it does not affect the motion): 2 places"),
        1);
    EXPECT_EQ(n_told(result, "import-lost", "<gazebo> is not kept"), 1);
    EXPECT_EQ(n_told(result, "import-merged", "('tip')"), 1);
    for (const Diagnostic& d : result.diagnostics) {
        EXPECT_EQ(d.file, "robot.urdf");
        EXPECT_GT(d.line, 0) << d.message;
        EXPECT_EQ(d.severity, Severity::warning);
        EXPECT_TRUE(d.message.find("velocity limits are") == std::string::npos || d.line == 5) << d.line;
    }
    EXPECT_TRUE(result.toml.starts_with("# From robot.urdf, by livens import.\n# import-")) << result.toml;
    Options strict;
    strict.is_strict = true;
    EXPECT_FALSE(read_robot(arm(), strict).scenario) << "friction changes the motion";
}

TEST(Urdf, DampingAndLimitsAreThoseOfTheJoint)
{
    const UrdfResult kept = read_robot(arm());
    ASSERT_TRUE(kept.scenario) << told(kept);
    EXPECT_NE(kept.toml.find("limits = [-1.0, 1.0]\nlimit_law = \"penalty\""), std::string::npos);
    EXPECT_NE(kept.toml.find("damping = 0.5"), std::string::npos) << kept.toml;
    EXPECT_EQ(n_told(kept, "import-lost", "joint limits"), 0);
    // A load for each: of the slide against its rate, of the shoulder beyond 1 rad.
    const Model& model = kept.scenario->model;
    ASSERT_EQ(model.loads().size(), 2u);
    State at = model.start();
    at.V[1] = rate(at.X[1], {2, 0, 0}, {});   // along x
    EXPECT_DOUBLE_EQ(model.loads()[1].readings[0].value(load_arguments(model.loads()[1], {0}, at.X, at.V)),
                     -1);
    const Matrix3 R = directors_from_rotation_vector({0, 1.1, 0});
    at.X[0] = configuration({0, 0, 1}, R);
    const Load& limit = model.loads()[0];
    const auto beyond = std::ranges::find(limit.readings, "penetration", &LoadReading::name);
    ASSERT_NE(beyond, limit.readings.end());
    EXPECT_NEAR(beyond->value(load_arguments(limit, {0}, at.X, at.V)), 0.1, 1e-11);
}

TEST(Urdf, LimitsThatCannotActAreToldOrLeftOutAsAsked)
{
    const auto lost = [](const Options& options, const std::string& text, const std::string& words,
                         const std::string& kept = "") {
        const UrdfResult result = read_robot(text, options);
        EXPECT_TRUE(result.scenario) << told(result);
        EXPECT_EQ(n_told(result, "import-lost", words), 1) << told(result);
        EXPECT_EQ(result.toml.find("limits = ") == std::string::npos, kept.empty()) << result.toml;
        EXPECT_NE(result.toml.find(kept), std::string::npos) << result.toml;
        Options strict = options;
        strict.is_strict = true;
        EXPECT_EQ(n_told(read_robot(text, strict), "import-lost", words), 1);
    };
    Options none, beyond;
    none.limits = Options::Limits::ignore;
    lost(none, arm(), "joint limits are not kept: 1 joint ('shoulder')");
    beyond.at = {{"shoulder", 1.01}};
    const std::string at_start = "limits are not kept beyond which a joint begins: 1 joint ('shoulder')";
    lost(beyond, arm(), at_start, "limits = [-1.0, inf]");
    beyond.at = {{"shoulder", -1 - 2e-9}};
    lost(beyond, arm(), at_start, "limits = [-inf, 1.0]");
    std::string text = arm();
    text.replace(text.find("lower='-1'"), 10, "lower='1' ");
    lost({}, text, "limits are not kept whose lower is not below the upper: 1 joint ('shoulder')");
}

TEST(Urdf, LimitsAtWhichAJointBeginsAreKept)
{
    for (const double at : {-1.0, 1.0, -1 - 0.9e-9, 1 + 0.9e-9}) {
        Options options;
        options.at = {{"shoulder", at}};
        const UrdfResult result = read_robot(arm(), options);
        EXPECT_NE(result.toml.find("limits = [-1.0, 1.0]"), std::string::npos) << told(result);
        EXPECT_EQ(n_told(result, "import-lost", "a joint begins"), 0) << told(result);
        const ScenarioResult again = parse_scenario(result.toml, "robot.toml");
        EXPECT_TRUE(again.scenario) << test::shown(again);
    }
}

TEST(Urdf, LinksThatAreNoBodiesArePointsOfTheBodyOrOfTheWorld)
{
    const std::string quarter = "<origin xyz='0.3 0 0' rpy='0 0 1.5707963267948966'/>";
    Options options;
    options.at = {{"shoulder", 0.5}};
    const UrdfResult result = read_robot(
        arm(link("flange", "") + link("tool", "") + joint("f", "fixed", "hand", "flange", quarter) +
            joint("t", "fixed", "flange", "tool", "<origin xyz='0.2 0 0'/>") + link("mast", "") +
            joint("m", "fixed", "base", "mast", "<origin xyz='0 0 2'/>") + link("world", "") +
            joint("w", "fixed", "base", "world")),
        options);
    ASSERT_TRUE(result.scenario) << told(result);
    const Model& model = result.scenario->model;
    const auto point = [&](const std::string& name) {
        for (const NamedPoint& p : model.points())
            if (p.name == name) return p;
        throw std::out_of_range(name);
    };
    ASSERT_EQ(model.points().size(), 4u) << "a point cannot be called 'world'";
    EXPECT_EQ(model.body_name(point("flange").body), "hand");
    EXPECT_LT(norm(point("flange").position - Vector3{0.3, 0, 0}), 1e-15);
    EXPECT_EQ(model.body_name(point("tool").body), "hand");
    EXPECT_LT(norm(point("tool").position - Vector3{0.3, 0.2, 0}), 1e-15);
    EXPECT_EQ(point("mast").body, world);
    EXPECT_LT(norm(point("mast").position - Vector3{0, 0, 2}), 1e-15);
    EXPECT_EQ(point("base").position, Vector3{});
    EXPECT_NE(result.toml.find("[[point]]"), std::string::npos);
    EXPECT_EQ(n_told(result, "import-merged", "kept as points, without axes: 2 links ('flange', 'tool')"), 1)
        << told(result);
}

TEST(Urdf, WhatJointsWithoutACoordinateLoseIsTold)
{
    const std::string terms = "<dynamics damping='5'/><limit lower='-1' upper='1' effort='2' velocity='3'/>";
    for (const std::string type : {"floating", "planar", "continuous", "spherical"}) {
        const std::string text =
            robot(link("base", "") + link("arm") + joint("j", type, "base", "arm", terms));
        const UrdfResult result = read_robot(text);
        ASSERT_TRUE(result.scenario) << told(result);
        const int damping = type == "floating" || type == "planar" ? 1 : 0;
        const auto lost = [&](const UrdfResult& in, const std::string& words) {
            return n_told(in, "import-lost", words + ": 1 joint ('j')");
        };
        EXPECT_EQ(lost(result, "damping of planar and floating joints is not kept"), damping) << told(result);
        EXPECT_EQ(lost(result, "limits are not kept of joints that are neither revolute nor prismatic"), 1)
            << told(result);
        EXPECT_EQ(lost(result, "effort and velocity limits are not kept"), 1) << told(result);
        EXPECT_EQ(result.scenario->model.loads().size(), damping == 1 ? 0u : 1u) << type;
        Options strict;
        strict.is_strict = true;
        const UrdfResult refused = read_robot(text, strict);
        EXPECT_FALSE(refused.scenario) << type;
        EXPECT_EQ(lost(refused, "limits are not kept of joints that are neither revolute nor prismatic"), 1);
    }
}

TEST(Urdf, InertiasHaveAllTheirMoments)
{
    const auto with = [](const std::string& moments) {
        return read_robot(robot(link("base", "") + link("arm", inertial("0 0 0", 1, moments)) +
                                joint("j", "continuous", "base", "arm")));
    };
    EXPECT_TRUE(with("ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'").diagnostics.size() < 2);
    const UrdfResult less = with("ixx='1' iyy='1'");
    EXPECT_FALSE(less.scenario);
    EXPECT_EQ(n_told(less, "urdf-tag", "<inertia> of 'arm' needs the attribute 'izz'"), 1) << told(less);
    const UrdfResult products = with("ixx='1' iyy='1' izz='1' ixz='0'");
    EXPECT_TRUE(products.scenario);
    EXPECT_EQ(n_told(products, "import-mended",
                     "products of inertia that are not stated are taken as 0: 1 link ('arm')"),
              1)
        << told(products);
}

TEST(Urdf, LinksThatFixedJointsHoldAreOneBodyWithTheExactSumOfTheirMasses)
{
    const std::string tool = inertial("0 0.2 0", 3, "ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01'");
    const UrdfResult result =
        read_robot(arm(link("tool", tool) + joint("flange", "fixed", "hand", "tool",
                                                  "<origin xyz='0.3 0 0' rpy='0 0 1.5707963267948966'/>")));
    ASSERT_TRUE(result.scenario) << told(result);
    ASSERT_EQ(result.scenario->model.n_bodies(), 2);
    // About z by 90 degrees: x to y, y to -x, so that xx and yy change places and xy its sign.
    const MassProperties hand{1, {0.1, 0, 0}, {0.02, 0, 0, 0, 0.03, 0, 0, 0, 0.04}},
        turned{3, {0.3 - 0.2, 0, 0}, {0.2, -0.01, 0, -0.01, 0.1, 0, 0, 0, 0.25}};
    const Matrix4 expected = mass_matrix(hand) + mass_matrix(turned);
    EXPECT_LT(largest(body(result, "hand").mass - expected), 1e-15);
}

TEST(Urdf, InertiasThatBelongToNoBodyAreMendedByTheLeastAndNamed)
{
    const std::string broken =
        robot(link("base", "") + link("rod", inertial("0 0 0", 1, "ixx='0.01' iyy='0.002' izz='0.003'")) +
              joint("hinge", "continuous", "base", "rod"));
    const UrdfResult mended = read_robot(broken);
    ASSERT_TRUE(mended.scenario) << told(mended);
    EXPECT_EQ(n_told(mended, "import-mended", "('rod' by 25 %)"), 1) << told(mended);
    // E = diag(-0.0025, 0.0055, 0.0045): without its negative part J = diag(0.01, 0.0045, 0.0055).
    const MassProperties p = mass_properties(body(mended, "rod").mass);
    EXPECT_NEAR(p.inertia(0, 0), 0.01, 1e-17);
    EXPECT_NEAR(p.inertia(1, 1), 0.0045, 1e-17);
    EXPECT_NEAR(p.inertia(2, 2), 0.0055, 1e-17);
    Options strict;
    strict.inertias = Options::Inertias::strict;
    const UrdfResult refused = read_robot(broken, strict);
    EXPECT_FALSE(refused.scenario);
    const auto found = std::ranges::find(refused.diagnostics, "inertia-triangle", &Diagnostic::code);
    ASSERT_NE(found, refused.diagnostics.end()) << told(refused);
    EXPECT_EQ(found->line, 3);
    EXPECT_NE(found->help.find("the nearest that a body can have is [0.0"), std::string::npos) << found->help;
}

TEST(Urdf, AMasslessLinkBetweenJointsGetsALittleAndIsNamed)
{
    const UrdfResult result = read_robot(
        robot(link("base", "") + link("cross", "") + link("rod") + joint("a", "revolute", "base", "cross") +
              joint("b", "revolute", "cross", "rod", "<axis xyz='0 1 0'/>")));
    ASSERT_TRUE(result.scenario) << told(result);
    EXPECT_EQ(n_told(result, "import-mended", "('cross')"), 1) << told(result);
    EXPECT_EQ(body(result, "cross").mass(0, 0), 1e-9);
}

TEST(Urdf, AFreeBaseIsABodyAndAFloatingJointNone)
{
    Options free;
    free.base = Options::Base::free;
    const UrdfResult base =
        read_robot(robot(link("trunk") + link("leg") + joint("hip", "revolute", "trunk", "leg")), free);
    ASSERT_TRUE(base.scenario) << told(base);
    EXPECT_EQ(base.scenario->model.n_bodies(), 2);
    const UrdfResult floating =
        read_robot(robot(link("world", "") + link("trunk") + joint("f", "floating", "world", "trunk")));
    ASSERT_TRUE(floating.scenario) << told(floating);
    EXPECT_EQ(floating.scenario->model.joints().size(), 0u);
    EXPECT_EQ(n_told(floating, "import-merged", "floating"), 1);
}

TEST(Urdf, MimicsOfEveryPairOfKindsAreCoupled)
{
    const auto chain = [](const char* first, const char* second, const char* mimic) {
        return robot(link("base", "") + link("one") + link("two") + joint("lead", first, "base", "one") +
                     joint("follow", second, "base", "two", std::string("<axis xyz='0 1 0'/>") + mimic));
    };
    const char* mimic = "<mimic joint='lead' multiplier='-2' offset='0.5'/>";
    for (const char* first : {"revolute", "prismatic"})
        for (const char* second : {"revolute", "prismatic"}) {
            SCOPED_TRACE(std::string(first) + " " + second);
            Options options;
            options.at = {{"lead", 0.25}};
            options.rates = {{"lead", 1}};
            const UrdfResult result = read_robot(chain(first, second, mimic), options);
            ASSERT_TRUE(result.scenario) << told(result);
            const auto coordinate = [](const std::string& kind) {
                return kind == "prismatic" ? ".displacement" : ".angle";
            };
            EXPECT_NE(result.toml.find(std::string("terms = { \"lead") + coordinate(first) +
                                       "\" = 2.0, \"follow" + coordinate(second) + "\" = 1.0 }"),
                      std::string::npos)
                << result.toml;
            EXPECT_EQ(result.scenario->model.joints().size(), 3u);
            EXPECT_EQ(result.scenario->model.n_bodies(), 2);
        }
    // Angles are coupled in ratios of whole numbers; what is none is changed to the nearest, and told.
    for (const auto& [multiplier, n_changed] : {std::pair{"-1.13125", 0}, {"0.725676731", 1}}) {
        const UrdfResult turned =
            read_robot(chain("continuous", "revolute",
                             ("<mimic joint='lead' multiplier='" + std::string(multiplier) + "'/>").c_str()));
        ASSERT_TRUE(turned.scenario) << told(turned);
        EXPECT_EQ(n_told(turned, "import-mended", n_changed == 0 ? "ratio of whole" : "'follow' by 1.6e-08"),
                  n_changed)
            << multiplier;
        const std::size_t at = turned.toml.find("\"lead.angle\" = ");
        ASSERT_NE(at, std::string::npos) << turned.toml;
        EXPECT_NEAR(std::stod(turned.toml.substr(at + 15)), -std::stod(multiplier), n_changed * 1e-7);
    }
    const UrdfResult held =
        read_robot(chain("revolute", "revolute", "<mimic joint='lead' multiplier='0' offset='1'/>"));
    ASSERT_TRUE(held.scenario) << told(held);
    EXPECT_EQ(n_told(held, "import-merged", "mimic a joint that does not move: 1 joint"), 1);
    EXPECT_EQ(held.scenario->model.n_bodies(), 1);
}

TEST(Urdf, NamesOfJointsDifferFromThoseOfBodies)
{
    const UrdfResult result =
        read_robot(robot(link("base", "") + link("arm") + joint("arm", "revolute", "base", "arm")));
    ASSERT_TRUE(result.scenario) << told(result);
    EXPECT_EQ(result.scenario->model.joints().front().name, "arm joint");
    EXPECT_EQ(n_told(result, "import-merged", "'arm'"), 1);
}

TEST(Urdf, LoopsThatAreStatedAreClosedAtTheStart)
{
    // A four-bar: the coupler's end lies 0.1 m beside the rocker's.
    const std::string bars =
        robot(link("base", "") + link("crank") + link("coupler") + link("rocker") + link("end", "") +
              link("top", "") + joint("a", "revolute", "base", "crank", "<axis xyz='0 1 0'/>") +
              joint("b", "revolute", "crank", "coupler", "<origin xyz='0 0 1'/><axis xyz='0 1 0'/>") +
              joint("c", "revolute", "base", "rocker", "<origin xyz='2 0 0'/><axis xyz='0 1 0'/>") +
              joint("e", "fixed", "coupler", "end", "<origin xyz='1.9 0 0'/>") +
              joint("t", "fixed", "rocker", "top", "<origin xyz='0 0 1'/>"));
    Options options;
    options.loops = {{"end", "top", "spherical"}};
    const UrdfResult result = read_robot(bars, options);
    ASSERT_TRUE(result.scenario) << told(result);
    EXPECT_EQ(result.scenario->model.joints().back().name, "loop end top");
    options.loops = {{"end", "tip", "weld"}};
    EXPECT_EQ(n_told(read_robot(bars, options), "body-unknown", "'tip'"), 1);
    options.loops = {{"end", "coupler", "weld"}};
    EXPECT_EQ(n_told(read_robot(bars, options), "joint-self", "one body"), 1);
    options.loops = {{"end", "top", "glue"}};
    EXPECT_EQ(n_told(read_robot(bars, options), "unknown-choice", "'glue'"), 1);
}

TEST(Urdf, AModelOfMuJoCoIsReferredToItsReader)
{
    const UrdfResult result = parse_urdf("<mujoco model='m'/>", "m.xml");
    ASSERT_EQ(result.diagnostics.size(), 1u);
    EXPECT_NE(result.diagnostics.front().help.find("lv.from_mjcf"), std::string::npos);
}

TEST(Urdf, WhatIsWrongIsRefusedByCodeAndLine)
{
    const auto change = [](const std::string& old, const std::string& by) {
        std::string text = arm();
        const std::size_t at = text.find(old);
        EXPECT_NE(at, std::string::npos) << old;
        return text.replace(at, old.size(), by);
    };
    struct Wrong {
        const char* code;
        std::string text;
        int line;
    };
    const Wrong all[] = {
        {"xml-syntax", "<robot><link></robot>", 1},
        {"xml-syntax", "<robot/><robot/>", 1},
        {"xml-syntax", "<robot name='a' name='b'/>", 1},
        {"xml-syntax", "<!DOCTYPE r SYSTEM 'file:///etc/passwd'>\n<robot/>", 1},
        {"not-text", "<robot name='\xff'/>", 1},
        {"urdf-tag", "<mujoco/>", 1},
        {"urdf-tag", change("<dynamics", "<dynamcis"), 6},
        {"urdf-tag", change("damping=", "dampng="), 6},
        {"urdf-tag", change("<axis xyz='0 1 0'/>", "<axis xyz='0 1 0'/><axis xyz='1 0 0'/>"), 5},
        {"urdf-tag", change("name=\"slide\" ", ""), 6},
        {"urdf-tag", change("<link name=\"hand\">", "<link name=\"hand\">words"), 4},
        {"urdf-tag", change("<origin xyz='1 0 0'", "<xacro:arm/><origin xyz='1 0 0'"), 6},
        {"urdf-value", change("xyz='0 0 1'", "xyz='0 0'"), 5},
        {"urdf-value", change("xyz='0 0 1'", "xyz='0 0 1,5'"), 5},
        {"urdf-value", change("xyz='0 0 1'", "xyz='0 0 nan'"), 5},
        {"urdf-value", change("xyz='0 0 1'", "xyz='0 0 ${height}'"), 5},
        {"urdf-value", change("<axis xyz='0 1 0'/>", "<axis xyz='0 0 0'/>"), 5},
        {"urdf-value", change("damping='0.5'", "damping='-0.5'"), 6},
        {"urdf-joint", change("prismatic", "hinge"), 6},
        {"urdf-joint", change("<dynamics", "<mimic joint='elbow'/><dynamics"), 6},
        {"urdf-joint", change("<dynamics", "<mimic joint='slide'/><dynamics"), 6},
        {"urdf-tree", change("<child link=\"hand\"/>", "<child link=\"hnd\"/>"), 6},
        {"urdf-tree", change("<link name=\"hand\">", "<link name=\"arm\">"), 4},
        {"urdf-tree", change("<parent link=\"base\"/>", "<parent link=\"hand\"/>"), 3},
        {"urdf-tree", arm(link("lost")), 7},
        {"urdf-tree", robot(""), 1},
        {"urdf-tree", robot(link("alone")), 1},
        {"mass-missing", robot(link("a", "") + link("b", "") + joint("j", "revolute", "a", "b")), 3},
    };
    for (const Wrong& wrong : all) {
        SCOPED_TRACE(wrong.text);
        const UrdfResult result = read_robot(wrong.text);
        EXPECT_FALSE(result.scenario);
        ASSERT_FALSE(result.diagnostics.empty());
        const auto found = std::ranges::find(result.diagnostics, wrong.code, &Diagnostic::code);
        ASSERT_NE(found, result.diagnostics.end()) << told(result);
        EXPECT_EQ(found->line, wrong.line) << told(result);
    }
    EXPECT_TRUE(read_robot(arm()).scenario) << "the control: without a change it is read";
}

TEST(Urdf, JointsThatAreAskedForExist)
{
    Options options;
    options.at = {{"sholder", 1}};
    EXPECT_EQ(n_told(read_robot(arm(), options), "joint-unknown", "'sholder'"), 1);
    options.at = {{"shoulder", NAN}};
    EXPECT_EQ(n_told(read_robot(arm(), options), "not-finite", "'shoulder'"), 1);
}

/// A folder of meshes that goes in the end.
class UrdfMeshes : public testing::Test {
protected:
    UrdfMeshes()
        : folder_(std::filesystem::temp_directory_path() / ("livens-urdf-" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(folder_ / "robot");
        write("robot/one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        write("robot/broken.stl", "nothing");
        write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }
    ~UrdfMeshes() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
    UrdfResult with(const std::string& mesh, Options options = {}, const std::string& scale = "1 1 1")
    {
        write("robot/r.urdf", robot(link("base", "") +
                                    link("arm", inertial("0 0 0", 1, "ixx='1' iyy='1' izz='1'") +
                                                    "<visual><geometry><mesh filename='" + mesh +
                                                    "' scale='" + scale + "'/></geometry></visual>") +
                                    joint("j", "revolute", "base", "arm")));
        return read_urdf(folder_ / "robot/r.urdf", options);
    }
    static bool is_drawn(const UrdfResult& result)
    {
        return result.scenario && !result.scenario->outlines.front().visuals.empty();
    }

    std::filesystem::path folder_;
};

TEST_F(UrdfMeshes, AreDrawnFromTheFolderAndPackagesThatWereNamedAndFromNowhereElse)
{
    EXPECT_TRUE(is_drawn(with("one.obj")));
    EXPECT_TRUE(is_drawn(with("file://" + (folder_ / "robot/one.obj").string())));
    for (const std::string outside :
         {"../two.obj", "../robot/../two.obj", "/etc/two.obj", "http://h/two.obj"}) {
        const UrdfResult result = with(outside);
        EXPECT_FALSE(is_drawn(result)) << outside;
        EXPECT_EQ(n_told(result, "import-lost", "outside"), 1) << told(result);
    }
    EXPECT_EQ(n_told(with("package://p/two.obj"), "import-lost", "package 'p' are not drawn"), 1);
    Options named;
    named.packages = {{"p", folder_}};
    const UrdfResult found = with("package://p/two.obj", named);
    EXPECT_TRUE(is_drawn(found)) << told(found);
    EXPECT_EQ(found.folder, std::filesystem::canonical(folder_));
    EXPECT_TRUE(is_drawn(with("package:///p/two.obj", named)));
    EXPECT_TRUE(is_drawn(with("../two.obj", named)));
    EXPECT_EQ(n_told(with("package://p/../../etc/two.obj", named), "import-lost", "outside"), 1);
    named.folder = folder_ / "robot";   // where the scenario goes: meshes have to go there, too
    const UrdfResult beside = with("package://p/two.obj", named);
    EXPECT_TRUE(is_drawn(beside)) << told(beside);
    EXPECT_EQ(beside.folder, std::filesystem::canonical(folder_));
    named.folder = folder_.parent_path();
    EXPECT_EQ(with("package://p/two.obj", named).folder, std::filesystem::canonical(folder_.parent_path()));
    std::error_code error;
    std::filesystem::create_symlink(folder_ / "two.obj", folder_ / "robot/link.obj", error);
    EXPECT_EQ(n_told(with("link.obj"), "import-lost", "outside"), error ? 0 : 1);
}

TEST_F(UrdfMeshes, ThatCannotBeDrawnAreToldAndStopNothing)
{
    EXPECT_EQ(n_told(with("none.obj"), "import-lost", "do not exist"), 1);
    EXPECT_EQ(n_told(with("one.glb"), "import-lost", ".glb meshes"), 1);
    const UrdfResult broken = with("broken.stl");
    EXPECT_TRUE(broken.scenario) << told(broken);
    EXPECT_EQ(n_told(broken, "import-lost", "not drawn: "), 1) << told(broken);
    EXPECT_EQ(n_told(with("one.obj", {}, "1 1 -1"), "import-lost", "uneven or negative scale"), 1);
    Options none;
    none.meshes = Options::Meshes::none;
    EXPECT_EQ(n_told(with("none.obj", none), "import-lost", "do not exist"), 0);
    EXPECT_FALSE(is_drawn(with("one.obj", none)));
}

TEST(Urdf, TheTextOfTheScenarioReadsBackAsTheSameModel)
{
    Options options;
    options.at = {{"shoulder", 0.7}};
    const UrdfResult result = read_robot(arm(), options);
    ASSERT_TRUE(result.scenario) << told(result);
    const ScenarioResult again = parse_scenario(result.toml, "robot.toml");
    ASSERT_TRUE(again.scenario) << test::shown(again);
    ASSERT_EQ(again.scenario->model.n_bodies(), result.scenario->model.n_bodies());
    for (int b = 0; b < again.scenario->model.n_bodies(); ++b) {
        const Body &one = result.scenario->model.bodies()[b], &other = again.scenario->model.bodies()[b];
        EXPECT_EQ(one.X, other.X);
        EXPECT_EQ(one.mass, other.mass);
    }
    EXPECT_EQ(again.scenario->model.loads().size(), 2u);
}

TEST(Urdf, HostileFilesAreAnsweredBeforeTheyGrow)
{
    std::string deep, wide = "<robot>";
    for (int i = 0; i < 500'000; ++i) deep += i < 100'000 ? "<a>" : "", wide += "<a/>";
    for (const std::string& text :
         {deep, wide + "</robot>", std::string(17 << 20, ' '), std::string(),
          std::string("<!DOCTYPE l [<!ENTITY a 'lol'><!ENTITY b '&a;&a;&a;'>]><robot name='&b;'/>")}) {
        const UrdfResult result = read_robot(text);
        EXPECT_FALSE(result.scenario);
        ASSERT_EQ(result.diagnostics.size(), 1u);
        const std::string& code = result.diagnostics.front().code;
        EXPECT_TRUE(code == "xml-syntax" || code == "resource-limit") << code;
    }
    std::string chain = link("l0", ""), joints;   // long, and no recursion ends it
    for (int i = 1; i < (is_sanitized ? 3'000 : 9'000); ++i) {
        const std::string n = std::to_string(i);
        chain += link("l" + n, i == 1 ? inertial("0 0 0", 1, "ixx='1' iyy='1' izz='1'") : "");
        joints += joint("j" + n, i == 1 ? "revolute" : "fixed", "l" + std::to_string(i - 1), "l" + n);
    }
    EXPECT_TRUE(read_robot(robot(chain + joints)).scenario);
    EXPECT_EQ(read_urdf("no/such/file.urdf").diagnostics.front().code, "io-not-found");
}

}   // namespace

}   // namespace livens::urdf_test
