// SPDX-License-Identifier: BSD-3-Clause
// Bodies from meshes, from unions and by M, S, E.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "livens/base/text.h"
#include "livens/io/results.h"
#include "livens/spacetime/solve.h"
#include "unit/io/scenario_text.h"

namespace livens::mesh_scenario_test {

namespace {

using test::find;
using test::shown;

/// A box as OBJ.
std::string box_obj(const Vector3& low, const Vector3& high)
{
    std::string text;
    for (int k = 0; k < 8; ++k) {
        text += "v";
        for (int i = 0; i < 3; ++i) text += " " + to_text((k >> i & 1) != 0 ? high[i] : low[i]);
        text += "\n";
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

class MeshScenario : public ::testing::Test {
protected:
    void SetUp() override
    {
        folder_ = std::filesystem::temp_directory_path() / ("livens-meshes-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_ / "parts");
        put("box.obj", box_obj({-1, -0.5, -0.5}, {1, 0.5, 0.5}));
        put("parts/cube.obj", box_obj({-300, -400, -400}, {500, 400, 400}));
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void put(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

    ScenarioResult read(const std::string& body, const std::string& rest = "") const
    {
        const std::string text =
            "format = 1\n[[body]]\nname = \"b\"\n" + body + "\n" + rest + "\n[time]\nend = 1\nelements = 8\n";
        return parse_scenario(text, "test.toml", {folder_});
    }
    /// [[M, S^T], [S, E]] of the body.
    Matrix4 mass(const std::string& body) const
    {
        const ScenarioResult result = read(body);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        return result.scenario ? result.scenario->model.bodies()[0].mass : Matrix4{};
    }
    void expect_error(const std::string& body, const std::string& code, const std::string& words) const
    {
        const ScenarioResult result = read(body);
        const Diagnostic* d = find(result, code);
        ASSERT_NE(d, nullptr) << "no " << code << " but\n" << shown(result);
        EXPECT_NE((d->message + d->note).find(words), std::string::npos) << shown(result);
        EXPECT_EQ(result.diagnostics.size(), 1u) << shown(result);
        EXPECT_GE(d->line, 2);
    }

    std::filesystem::path folder_;
};

double gap(const Matrix4& a, const Matrix4& b) { return norm(a - b) / norm(b); }

/// (P, section 4.3): S = 0.0768, E = diag(0.0486, 0.0410, 0.0410), about a point 0.1 m off the centre.
TEST_F(MeshScenario, GivesThePapersFiguresToAllPrintedDigits)
{
    const Matrix4 m = mass("shape = { mesh = \"parts/cube.obj\", unit = \"mm\" }\ndensity = 1.5");
    const auto printed = [](double x) { return std::round(x * 1e4) / 1e4; };
    EXPECT_NEAR(m(0, 0), 0.768, 1e-15);
    EXPECT_NEAR(m(1, 0), 0.0768, 1e-15);
    EXPECT_EQ(m(2, 0), 0);
    EXPECT_EQ(printed(m(1, 1)), 0.0486);
    EXPECT_EQ(printed(m(2, 2)), 0.0410);
    EXPECT_EQ(printed(m(3, 3)), 0.0410);
    EXPECT_EQ(m(1, 2), 0);
    EXPECT_LE(
        gap(mass("mass = 0.768\nfirst_moment = [0.0768, 0, 0]\nsecond_moment = [0.04864, 0.04096, 0.04096]"),
            m),
        1e-15);
    EXPECT_LE(gap(mass("shape = { box = [0.8, 0.8, 0.8] }\ndensity = 1.5\ncenter_of_mass = [0.1, 0, 0]"), m),
              1e-15);
}

TEST_F(MeshScenario, MovesAsThePrimitiveDoes)
{
    const std::string rest = "velocity = [5, 5, 5]\nangular_velocity = [0.3, -2, 1]\n[[load]]\ntype = "
                             "\"torque\"\nbody = \"b\"\nvalue = [1, 1, 1]\n";
    const ScenarioResult primitive = read("shape = { box = [2, 1, 1] }\ndensity = 1.5", rest);
    const ScenarioResult mesh = read("shape = { mesh = \"box.obj\", unit = \"m\" }\ndensity = 1.5", rest);
    const ScenarioResult moved =
        read("shape = { mesh = \"parts/cube.obj\", unit = \"mm\" }\ndensity = 1.5", rest);
    ASSERT_TRUE(primitive.scenario && mesh.scenario && moved.scenario) << shown(mesh);
    const auto final_X = [](const Scenario& s) {
        const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
        EXPECT_TRUE(solution.report.converged());
        const auto& values = solution.motion.X.values;
        return std::vector<double>(values.end() - 12, values.end());
    };
    const std::vector<double> a = final_X(*primitive.scenario), b = final_X(*mesh.scenario),
                              c = final_X(*moved.scenario);
    double same = 0, other = 0;
    for (int i = 0; i < 12; ++i) {
        same = std::max(same, std::abs(a[i] - b[i]));
        other = std::max(other, std::abs(a[i] - c[i]));
    }
    EXPECT_LE(same, 1e-12);
    EXPECT_GT(other, 1e-3) << "another body moves alike";
}

TEST_F(MeshScenario, UnitesPartsWithHoles)
{
    // A plate with a bore, and a mesh in place of the plate.
    const std::string bore =
        "{ cylinder = { radius = 0.25, length = 1 }, position = [0.5, 0, 0], density = -1 }";
    const Matrix4 a = mass("density = 2\nshape = { parts = [{ box = [2, 1, 1] }, " + bore + "] }");
    const double hole = M_PI / 16, V = 2 - hole;
    EXPECT_NEAR(a(0, 0), 2 * V, 1e-14);
    EXPECT_NEAR(a(1, 0), -2 * hole * 0.5, 1e-15);
    EXPECT_NEAR(a(1, 1), 2 * (2 * 4 / 12. - hole * (1 / 64. + 0.25)), 1e-14);
    EXPECT_NEAR(a(3, 3), 2 * V / 12, 1e-15);
    EXPECT_LE(
        gap(mass("density = 2\nshape = { parts = [{ mesh = \"box.obj\", unit = \"m\" }, " + bore + "] }"), a),
        1e-15);
    // Turned by 90 deg about z, and moved.
    const Matrix4 b =
        mass("density = 2\nshape = { parts = [{ mesh = \"box.obj\", unit = \"m\", position = [0, 0, 3], "
             "rotation_vector = [0, 0, \"90 deg\"] }] }");
    EXPECT_NEAR(b(2, 2), 2 * 2 * 4 / 12., 1e-14);
    EXPECT_NEAR(b(3, 0), 4 * 3, 1e-14);
    // A given mass, a given centre.
    const Matrix4 c =
        mass("mass = 7\ncenter_of_mass = [1, 0, 0]\nshape = { mesh = \"box.obj\", unit = \"m\", scale = 2 }");
    EXPECT_NEAR(c(0, 0), 7, 1e-15);
    EXPECT_NEAR(c(1, 0), 7, 1e-15);
    EXPECT_NEAR(c(1, 1), 7 * (16 / 12. + 1), 1e-14);
    expect_error("density = 1\nshape = { parts = [{ box = [1, 1, 1], density = -1 }] }", "shape",
                 "leave no mass");
    expect_error("density = 1\nshape = { parts = [{ box = [1, 1, 1], density = 0 }] }", "out-of-range",
                 "must not be 0");
    expect_error("density = 1\nshape = { parts = [{ position = [1, 1, 1] }] }", "shape", "is empty");
}

TEST_F(MeshScenario, RefusesWhatItMustNotRead)
{
    std::filesystem::create_directory_symlink("/", folder_ / "root");
    expect_error("density = 1\nshape = { mesh = \"../box.obj\", unit = \"m\" }", "mesh-path",
                 "leaves the scenario's folder");
    expect_error("density = 1\nshape = { mesh = \"parts/../../box.obj\", unit = \"m\" }", "mesh-path",
                 "leaves");
    expect_error("density = 1\nshape = { mesh = \"/box.obj\", unit = \"m\" }", "mesh-path",
                 "from the scenario's folder on");
    expect_error("density = 1\nshape = { mesh = \"root/etc/hostname\", unit = \"m\" }", "mesh-path",
                 "by a link");
    expect_error("density = 1\nshape = { mesh = \"none.obj\", unit = \"m\" }", "mesh-file", "does not exist");
    expect_error("density = 1\nshape = { mesh = \"parts\", unit = \"m\" }", "mesh-file", "is no file");
    const ScenarioResult nowhere = parse_scenario("format = 1\n[[body]]\nname = \"b\"\ndensity = 1\nshape = "
                                                  "{ mesh = \"box.obj\", unit = \"m\" }\n[time]\nend = 1\n",
                                                  "t");
    EXPECT_NE(find(nowhere, "mesh-file"), nullptr) << shown(nowhere);
}

TEST_F(MeshScenario, RefusesWhatIsNoSolid)
{
    put("open.obj", box_obj({}, {1, 1, 1}).substr(0, box_obj({}, {1, 1, 1}).rfind("f ")));
    put("inside.obj", box_obj({1, 0, 0}, {0, 1, 1}));
    put("bad.obj", "v 0 0\n");
    const auto of = [](const std::string& file, const std::string& more = "") {
        return "density = 1\nshape = { mesh = \"" + file + "\", unit = \"m\"" + more + " }";
    };
    expect_error(of("open.obj"), "mesh-open", "open.obj: the surface is open: the edge from");
    expect_error(of("inside.obj"), "mesh-inverted", "turned inside out");
    EXPECT_NEAR(mass(of("inside.obj", ", turn = true"))(0, 0), 1, 1e-15);
    expect_error(of("bad.obj"), "mesh-format", "bad.obj:1: a point has three coordinates");
    expect_error("density = 1\nshape = { mesh = \"box.obj\" }", "mesh-unit", "without 'unit'");
    expect_error("density = 1\nshape = { mesh = \"box.obj\", unit = \"s\" }", "mesh-unit", "unit of length");
    expect_error("density = 1\nshape = { box = [1, 1, 1], unit = \"m\" }", "shape", "no mesh");
    expect_error("shape = { mesh = \"box.obj\", unit = \"m\", densities = { steel = \"1 kg/m^3\" } }",
                 "mesh-region", "no regions of volume");
}

/// 1000 (2 + x) over [-1, 1] x [-1/2, 1/2]^2: the mass is 4000 kg, S_x = 1000 int x^2 = 2000/3 kg m.
TEST_F(MeshScenario, WeighsByADensityThatIsAField)
{
    const std::string shape =
        "shape = { mesh = \"box.obj\", unit = \"m\", density_field = \"1000*(2 + x)\" }";
    const Matrix4 m = mass(shape);
    EXPECT_NEAR(m(0, 0), 4000, 1e-11);
    EXPECT_NEAR(m(1, 0), 2000. / 3, 1e-11);
    EXPECT_NEAR(m(1, 1), 4000. / 3, 1e-11);
    EXPECT_NEAR(m(2, 2), 4000. / 12, 1e-11);
    // The place is in m, whatever the mesh's unit.
    const Matrix4 small =
        mass("shape = { mesh = \"box.obj\", unit = \"mm\", density_field = \"1000*(2 + 1000*x)\" }");
    EXPECT_NEAR(small(0, 0), 4000e-9, 1e-20);
    EXPECT_NEAR(small(1, 0), 2000e-12 / 3, 1e-23);
    // A run needs no file beside it.
    const ScenarioResult result = read(shape);
    ASSERT_TRUE(result.scenario.has_value());
    const ScenarioResult again =
        parse_scenario(result.scenario->text, "again.toml", {std::nullopt, result.scenario->meshes});
    ASSERT_TRUE(again.scenario.has_value()) << shown(again);
    EXPECT_EQ(again.scenario->model.bodies()[0].mass, m);
}

/// A ball of 40,000 triangles is drawn by fewer, whose corners are where is said; without the file, too.
TEST_F(MeshScenario, LargeMeshesAreDrawnThinned)
{
    constexpr int n = 200, m = 100;
    std::string ball = "v 0 0 -1\nv 0 0 1\n", faces;
    const auto at = [&](int i, int j) { return " " + std::to_string(3 + (i - 1) * n + j % n); };
    for (int i = 1; i <= m; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = M_PI * i / (m + 1), v = 2 * M_PI * j / n;
            ball += "v " + to_text(std::sin(u) * std::cos(v)) + " " + to_text(std::sin(u) * std::sin(v)) +
                    " " + to_text(-std::cos(u)) + "\n";
            if (i == m) continue;
            faces += "f" + at(i, j) + at(i, j + 1) + at(i + 1, j + 1) + at(i + 1, j) + "\n";
        }
    for (int j = 0; j < n; ++j)
        faces += "f 1" + at(1, j + 1) + at(1, j) + "\nf 2" + at(m, j) + at(m, j + 1) + "\n";
    put("ball.obj", ball + faces);
    const ScenarioResult result = read("density = 1\nshape = { mesh = \"ball.obj\", unit = \"mm\" }");
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Outline& drawn = result.scenario->outlines[0];
    EXPECT_LE(drawn.triangles.size(), 10000u);
    EXPECT_GT(drawn.triangles.size(), 4000u);
    EXPECT_EQ(drawn.triangles.size() + drawn.n_left_out, 2u * n * m);
    EXPECT_GT(drawn.moved, 0.005);
    EXPECT_LT(drawn.moved, 0.06);
    double farthest = 0;
    for (const Vector3& p : drawn.points) farthest = std::max(farthest, std::abs(norm(p) - 1));
    EXPECT_LE(farthest, drawn.moved);
    const std::string& kept = result.scenario->meshes;
    const auto again = [&](const std::string& meshes) {
        return parse_scenario(result.scenario->text, "again.toml", {std::nullopt, meshes});
    };
    const ScenarioResult opened = again(kept);
    ASSERT_TRUE(opened.scenario.has_value()) << shown(opened);
    EXPECT_EQ(opened.scenario->meshes, kept);
    EXPECT_EQ(opened.scenario->outlines[0].n_left_out, drawn.n_left_out);
    EXPECT_EQ(opened.scenario->outlines[0].moved, drawn.moved);
    // Runs of earlier versions keep no surface of such meshes; what is damaged is not used.
    const std::size_t line = kept.find("thinned ");
    ASSERT_NE(line, std::string::npos);
    const ScenarioResult old = again(kept.substr(0, line));
    ASSERT_TRUE(old.scenario.has_value()) << shown(old);
    EXPECT_TRUE(old.scenario->outlines[0].is_empty());
    for (const char* damage : {"thinned -1 0", "thinned 5 -1", "thinned 5 nan", "thinned"})
        EXPECT_NE(find(again(kept.substr(0, line) + damage + "\n"), "mesh-file"), nullptr) << damage;
}

TEST_F(MeshScenario, RefusesFieldsThatAreNoDensity)
{
    const auto field = [](const std::string& text) {
        return "shape = { mesh = \"box.obj\", unit = \"m\", density_field = \"" + text + "\" }";
    };
    expect_error(field("x"), "density-field", "no density");
    expect_error(field("2 + x*y"), "density-field", "not linear");
    expect_error(field("2 + abs(x)"), "density-field", "bends");
    expect_error(field("2 + t"), "density-field", "time");
    expect_error(field("2 + r"), "expression-name", "r");
    expect_error(field("2 +"), "expression-syntax", "");
    expect_error(field("2") + "\ndensity = 3", "mass-conflict", "density_field");
}

TEST_F(MeshScenario, RefusesHalfOfMSE)
{
    const std::string S = "first_moment = [0.1, 0, 0]\n", E = "second_moment = [1, 1, 1]\n";
    expect_error("mass = 1\n" + S, "mass-missing", "second_moment");
    expect_error("mass = 1\n" + S + E + "inertia = [1, 1, 1]", "mass-conflict", "inertia");
    expect_error("mass = 1\n" + S + E + "shape = { box = [1, 1, 1] }", "mass-conflict", "shape");
    expect_error("mass = 1\n" + S + "second_moment = [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]",
                 "inertia-not-symmetric", "symmetric");
    // Less than what the mass at its centre has.
    expect_error("mass = 1\nfirst_moment = [2, 0, 0]\n" + E, "inertia-negative", "");
    // Skew directors are for these alone, and must span space.
    const std::string skew = "directors = [[1, 0, 0], [0.5, 1, 0], [0, 0, 1]]\n";
    expect_error("mass = 1\ninertia = [1, 1, 1]\n" + skew, "directors-not-orthonormal", "");
    expect_error("mass = 1\n" + S + E + "directors = [[1, 0, 0], [0, 1, 0], [1, 1, 0]]",
                 "directors-dependent", "one plane");
    expect_error("mass = 1\n" + S + E + "directors = [[1, 0, 0], [0.5, 1, 0], [0, 0, -1]]",
                 "directors-left-handed", "");
    const std::string ends = "[start]\ngiven = \"nothing\"\n[end]\ngiven = \"state\"\n";
    expect_error("mass = 1\n" + S + E + skew + "[body.end]\ndirectors = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n" +
                     ends,
                 "directors-metric", "lengths and angles");
    const ScenarioResult turned =
        read("mass = 1\n" + S + E + skew + "[body.end]\ndirectors = [[0, 1, 0], [-1, 0.5, 0], [0, 0, 1]]\n" +
             ends);
    EXPECT_TRUE(turned.scenario.has_value()) << shown(turned);
    const ScenarioResult rounded =
        read("mass = 1\n" + S + E + "directors = [[1, 0, 0], [1e-5, 1, 0], [0, 0, 1]]");
    EXPECT_TRUE(rounded.scenario.has_value()) << shown(rounded);
    EXPECT_NE(find(rounded, "directors-nearly-orthonormal"), nullptr);
}

/// Forces of the first load with the body anywhere, skew directors included.
Matrix34 forces(const Scenario& s)
{
    LoadArguments at;
    at.X[0] = {1, 2, 3, 0.8, 0.6, 0.1, -0.6, 0.8, 0, 0.1, 0, 1.1};
    LoadForces F{};
    s.model.loads()[0].forces(at, F);
    return F[0];
}

const std::string sides =
    "v -1 -0.5 -0.5\nv 1 -0.5 -0.5\nv -1 0.5 -0.5\nv 1 0.5 -0.5\nv -1 -0.5 0.5\nv 1 -0.5 0.5\n"
    "v -1 0.5 0.5\nv 1 0.5 0.5\ng bottom\nf 1 3 4 2\ng top\nf 5 6 8 7\ng others\nf 1 2 6 5\nf 3 7 8 4\n"
    "f 1 5 7 3\nf 2 4 8 6\n";
const std::string sided =
    "shape = { mesh = \"sides.obj\", unit = \"m\" }\ndensity = 1.5\nangular_velocity = [1, 0.1, -0.3]\n";

TEST_F(MeshScenario, LoadsOnSurfacesAreReducedToTheirMoments)
{
    put("sides.obj", sides);
    const auto load = [&](const std::string& text) {
        const ScenarioResult result = read(sided, "[[load]]\nname = \"l\"\nbody = \"b\"\n" + text);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        return result.scenario ? forces(*result.scenario) : Matrix34{};
    };
    const Matrix34 all = load("type = \"pressure\"\nvalue = 1e5");
    EXPECT_LE(norm(all.column(0)), 1e-9) << "no force on a closed surface";
    Vector3 moment{};
    const Matrix34 X{1, 2, 3, 0.8, 0.6, 0.1, -0.6, 0.8, 0, 0.1, 0, 1.1};
    for (int i = 1; i < 4; ++i) moment += cross(X.column(i), all.column(i));
    EXPECT_LE(norm(moment), 1e-9) << "and no moment, with skew directors, too";
    EXPECT_GT(norm(all), 1e5) << "but it squeezes";
    // On one side: 3 Pa on 2 m^2 as a force that follows at the middle of the side.
    const Matrix34 top = load("type = \"pressure\"\nvalue = 3\nsurface = \"top\"");
    EXPECT_LE(norm(top - load("type = \"force\"\nvalue = [0, 0, -6]\npoint = [0, 0, 0.5]\nframe = \"body\"")),
              1e-14);
    const Matrix34 drawn = load("type = \"traction\"\nvalue = [1, 2, 3]\nsurface = \"top\"");
    EXPECT_LE(norm(drawn - load("type = \"force\"\nvalue = [2, 4, 6]\npoint = [0, 0, 0.5]")), 1e-14);
    EXPECT_GT(norm(drawn - load("type = \"force\"\nvalue = [2, 4, 6]")), 0.1);
}

/// Opposite tractions on two sides that follow the body are a torque that follows it; a force per unit mass
/// is gravity.
TEST_F(MeshScenario, LoadsOnSurfacesMoveTheBodyAsForcesDo)
{
    put("sides.obj", sides);
    const auto final_X = [&](const std::string& rest) {
        const ScenarioResult result = read(sided, rest);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        if (!result.scenario) return std::vector<double>(12, 0);
        const Scenario& s = *result.scenario;
        const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
        EXPECT_TRUE(solution.report.converged());
        const auto& values = solution.motion.X.values;
        return std::vector<double>(values.end() - 12, values.end());
    };
    const auto apart = [](const std::vector<double>& a, const std::vector<double>& b) {
        double largest = 0;
        for (int i = 0; i < 12; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
        return largest;
    };
    const std::string on = "[[load]]\nbody = \"b\"\ntype = ";
    const std::vector<double> pair =
        final_X(on + "\"traction\"\nsurface = \"top\"\nvalue = [0.5, 0, 0]\nframe = \"body\"\n" + on +
                "\"traction\"\nsurface = \"bottom\"\nvalue = [-0.5, 0, 0]\nframe = \"body\"\n");
    EXPECT_LE(apart(pair, final_X(on + "\"torque\"\nvalue = [0, 1, 0]\nframe = \"body\"\n")), 1e-12);
    EXPECT_GT(apart(pair, final_X("")), 1e-2);
    const std::vector<double> drawn = final_X(on + "\"body_force\"\nvalue = [1, 2, -9]\n");
    EXPECT_LE(apart(drawn, final_X(on + "\"force\"\nvalue = [3, 6, -27]\n")), 1e-12);
    EXPECT_LE(apart(final_X(on + "\"pressure\"\nvalue = 1\n"), final_X("")), 1e-12);
}

/// What floats upright is borne by the pressure at its bottom: it heaves with omega^2 = rho g A / m.
TEST_F(MeshScenario, FloatsOnAPressureThatGrowsWithDepth)
{
    put("sides.obj", sides);
    const auto height = [&](const std::string& more) {
        const ScenarioResult result =
            read("shape = { mesh = \"sides.obj\", unit = \"m\" }\ndensity = 1.5\nvelocity = [0, 0, 1]\n",
                 "[[load]]\nbody = \"b\"\ntype = \"pressure\"\nsurface = \"bottom\"\n" + more);
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        if (!result.scenario) return 0.;
        const Scenario& s = *result.scenario;
        return solve(s.model, {s.conditions}, s.time, s.method, s.options).motion.at(1).X[0](2, 0);
    };
    // m = 3, A = 2, the bottom at -0.5: at rest with its middle at 0, omega = 2.
    const std::string water = "value = -3\ngradient = [0, 0, -6]\n";
    EXPECT_NEAR(height(water), std::sin(2.) / 2, 1e-9);
    EXPECT_NEAR(height(water + "until = 0.5\n"), std::sin(1.) / 2 + std::cos(1.) / 2, 1e-9);
    EXPECT_NEAR(height("gradient = [0, 0, -6]\n"),   // about 0.5, where p = 0
                0.5 + std::sin(2.) / 2 - std::cos(2.) / 2, 1e-9);
    EXPECT_NEAR(height("value = 0\n"), 1, 1e-12);
}

/// All of a hull with a keel under water: the weight of the water at its centroid, and so a moment about the
/// centre of mass below it.
TEST_F(MeshScenario, IsRightedByThePressureThatGrowsWithDepth)
{
    put("hull.obj", "g hull\n" + box_obj({-1, -0.5, -0.5}, {1, 0.5, 0.5}));
    const ScenarioResult result =
        read("shape = { parts = [{ mesh = \"hull.obj\", unit = \"m\" }, { sphere = 0.1, position = [0, 0, "
             "-0.7], density = 100 }] }\ndensity = 1",
             "[[load]]\nbody = \"b\"\ntype = \"pressure\"\nsurface = \"hull\"\ngradient = [0, 0, -10]\n");
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const double heel = 0.3, c = std::cos(heel), s = std::sin(heel);
    LoadArguments at;
    at.X[0] = {5, 6, -7, 1, 0, 0, 0, c, s, 0, -s, c};
    LoadForces F{};
    result.scenario->model.loads()[0].forces(at, F);
    EXPECT_LE(norm(F[0].column(0) - Vector3{0, 0, 20}), 1e-13);
    const double keel = 100 * 4 * M_PI / 3000, below = 0.7 * keel / (2 + keel);
    const Matrix4& m = result.scenario->model.bodies()[0].mass;
    const Vector3 center{m(1, 0) / m(0, 0), m(2, 0) / m(0, 0), m(3, 0) / m(0, 0)};
    EXPECT_LE(norm(center - Vector3{0, 0, -below}), 1e-15);
    Vector3 moment{};   // about the reference point, less that of the force if it were at the centre of mass
    for (int i = 1; i < 4; ++i) moment += cross(at.X[0].column(i), F[0].column(i));
    moment -= cross(directors(at.X[0]) * center, F[0].column(0));
    EXPECT_LE(norm(moment - Vector3{-20 * below * s, 0, 0}), 1e-13);
}

/// The whole surface of a part with a name, and those with names of their own below it.
TEST_F(MeshScenario, PartsWithNamesAreSurfacesOfLoads)
{
    put("sides.obj", sides);
    const auto force = [&](const std::string& surface) {
        const ScenarioResult result =
            read("shape = { parts = [{ name = \"low\", mesh = \"sides.obj\", unit = \"m\" }, { name = "
                 "\"high\", mesh = "
                 "\"sides.obj\", unit = \"m\", position = [0, 0, 3] }] }\ndensity = 1",
                 "[[load]]\nbody = \"b\"\ntype = \"pressure\"\nvalue = 1\nsurface = \"" + surface + "\"\n");
        EXPECT_TRUE(result.scenario.has_value()) << shown(result);
        LoadArguments at;
        at.X[0] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        LoadForces F{};
        if (result.scenario) result.scenario->model.loads()[0].forces(at, F);
        return F[0];
    };
    EXPECT_NEAR(norm(force("high").column(0)), 0, 1e-15) << "closed";
    EXPECT_NEAR(force("high/top").column(0)[2], -2, 1e-15);
    EXPECT_NEAR(force("top").column(0)[2], -4, 1e-15) << "of both parts";
    EXPECT_NEAR(force("high/top")(2, 3) - force("low/top")(2, 3), -2 * 3, 1e-14) << "it lies 3 m higher";
}

TEST_F(MeshScenario, FieldsThatAreLinearStandAlone)
{
    put("sides.obj", sides);
    const auto load = [&](const std::string& text) {
        return read(sided, "[[load]]\nname = \"l\"\nbody = \"b\"\nsurface = \"top\"\n" + text);
    };
    // Shear that grows from the middle: 3 r over 2 m x 1 m, as a torque about the normal.
    const ScenarioResult twist =
        load("type = \"traction\"\ngradient = [[0, -3, 0], [3, 0, 0], [0, 0, 0]]\nframe = \"body\"");
    ASSERT_TRUE(twist.scenario.has_value()) << shown(twist);
    LoadArguments at;
    LoadForces F{};
    twist.scenario->model.loads()[0].forces(at, F);
    EXPECT_LE(norm(F[0].column(0)), 1e-15);
    EXPECT_NEAR(F[0](1, 1) - F[0](0, 2), 3 * 2 * (4. + 1) / 12, 1e-14);
    const ScenarioResult both =
        load("type = \"pressure\"\ngradient = [0, 0, -6]\nexpression = \"z\"\n"
             "inputs = { z = \"s.x\" }\n[[sensor]]\nname = \"s\"\ntype = \"point\"\nbody = \"b\"\n");
    EXPECT_NE(find(both, "load-value"), nullptr) << shown(both);
    EXPECT_NE(find(load("type = \"pressure\"\n"), "load-value"), nullptr);
}

TEST_F(MeshScenario, RefusesUnknownSurfaces)
{
    put("sides.obj", sides);
    const auto code = [&](const std::string& body, const std::string& load) {
        const ScenarioResult result = read(body, "[[load]]\nbody = \"b\"\n" + load);
        const Diagnostic* d = find(result, "surface-unknown");
        return d == nullptr ? shown(result) : d->message + " " + d->note;
    };
    EXPECT_EQ(code(sided, "type = \"pressure\"\nvalue = 1\nsurface = \"tpo\""),
              "body 'b' has no surface 'tpo' it has 'bottom', 'top', 'others'");
    EXPECT_NE(code("inertia = [1, 1, 1]\nmass = 1", "type = \"traction\"\nvalue = [1, 0, 0]")
                  .find("is not one solid"),
              std::string::npos);
}

/// A run is read where its meshes are not.
TEST_F(MeshScenario, IsMadeAgainWithoutItsFiles)
{
    const ScenarioResult first = read("shape = { mesh = \"parts/cube.obj\", unit = \"mm\" }\ndensity = 1.5");
    ASSERT_TRUE(first.scenario.has_value());
    EXPECT_EQ(first.scenario->outlines[0].triangles.size(), 12u);
    const ScenarioResult again = parse_scenario(first.scenario->text, "run", {{}, first.scenario->meshes});
    ASSERT_TRUE(again.scenario.has_value()) << shown(again);
    EXPECT_EQ(again.scenario->model.bodies()[0].mass, first.scenario->model.bodies()[0].mass);
    EXPECT_EQ(again.scenario->outlines[0].triangles, first.scenario->outlines[0].triangles);
    const std::string& kept = first.scenario->meshes;
    for (std::size_t n = 0; n < kept.size(); n += 7) {
        const ScenarioResult cut = parse_scenario(first.scenario->text, "run", {{}, kept.substr(0, n)});
        const bool is_whole = cut.scenario.has_value() &&
                              cut.scenario->model.bodies()[0].mass == first.scenario->model.bodies()[0].mass;
        EXPECT_TRUE(is_whole || find(cut, "mesh-file") != nullptr) << kept.substr(0, n);
    }
}

}   // namespace

}   // namespace livens::mesh_scenario_test
