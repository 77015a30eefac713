// SPDX-License-Identifier: BSD-3-Clause
// Shapes without files: densities that are fields, loads on their surfaces, and what parts weigh.
#include <cmath>
#include <numbers>

#include "livens/spacetime/solve.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::solid_scenario_test {

namespace {

using test::find;
using test::shown;

constexpr double pi = std::numbers::pi;

ScenarioResult read(const std::string& body, const std::string& rest = "")
{
    return parse_scenario("format = 1\n[[body]]\nname = \"b\"\n" + body + "\n" + rest +
                              "\n[time]\nend = 1\nelements = 8\n",
                          "test.toml");
}

Matrix4 mass(const std::string& body)
{
    const ScenarioResult result = read(body);
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    return result.scenario ? result.scenario->model.bodies()[0].mass : Matrix4{};
}

void expect_error(const std::string& body, const std::string& code, const std::string& words)
{
    const ScenarioResult result = read(body);
    const Diagnostic* d = find(result, code);
    ASSERT_NE(d, nullptr) << "no " << code << " but\n" << shown(result);
    EXPECT_NE((d->message + d->note).find(words), std::string::npos) << shown(result);
}

double gap(const Matrix4& a, const Matrix4& b) { return norm(a - b) / norm(b); }

/// rho = 1000 (2 + z): M = 2000 V, and S = 1000 times the second moment of the volume along z.
TEST(SolidScenario, PrimitivesHaveDensitiesThatAreFields)
{
    struct Shape {
        const char* text;
        double volume, along;   ///< m^3; int z^2, m^5
    };
    const double rod = pi * 0.25 * 2, ball = 4 * pi / 3 * 0.125, cone = pi * 0.25 * 2 / 3,
                 ellipsoid = 4 * pi / 3 * 0.5 * 1 * 1.5, tube = pi * (0.25 - 0.04) * 2;
    const Shape shapes[] = {
        {"box = [1, 2, 3]", 6, 6 * 9 / 12.},
        {"sphere = 0.5", ball, ball * 0.25 / 5},
        {"sphere = { radius = 0.5 }", ball, ball * 0.25 / 5},
        {"cylinder = { radius = 0.5, length = 2 }", rod, rod * 4 / 12},
        {"cylinder = { radius = 0.5, length = 2, inner_radius = 0.2 }", tube, tube * 4 / 12},
        {"capsule = { radius = 0.5, length = 2 }", rod + ball,
         rod * 4 / 12 + ball * (0.25 / 5 + 1 + 3 * 2 * 0.5 / 8)},
        {"ellipsoid = [0.5, 1, 1.5]", ellipsoid, ellipsoid * 2.25 / 5},
        {"cone = { radius = 0.5, height = 2 }", cone, cone * 3 * 4 / 80},
    };
    for (const Shape& s : shapes) {
        SCOPED_TRACE(s.text);
        const Matrix4 m = mass("shape = { " + std::string(s.text) + ", density_field = \"1000*(2 + z)\" }");
        EXPECT_NEAR(m(0, 0), 2000 * s.volume, 2e-11 * s.volume);
        EXPECT_NEAR(m(3, 0), 1000 * s.along, 2e-11 * s.along);
        EXPECT_NEAR(m(1, 0), 0, 1e-11);
        const Matrix4 same = mass("density = 7\nshape = { " + std::string(s.text) + " }");
        EXPECT_LE(gap(mass("shape = { " + std::string(s.text) + ", density_field = \"7\" }"), same), 2e-14);
        EXPECT_GT(gap(m, 2000. / 7 * same), 1e-3) << "the field changes nothing";
    }
    // Where `center_of_mass` says, with what the shape weighs about it.
    const std::string field = "shape = { box = [1, 1, 1], density_field = \"2 + z\" }";
    const Matrix4 moved = mass("center_of_mass = [1, 0, 0]\n" + field);
    EXPECT_NEAR(moved(1, 0), 2, 1e-14);
    EXPECT_NEAR(moved(3, 0), 0, 1e-14);
    EXPECT_NEAR(moved(3, 3), 2 / 12. - 2 * std::pow(1 / 24., 2), 1e-14);
}

/// A box with a field and a bore through it whose field is that of the box: a box with a bore and one field.
TEST(SolidScenario, PartsHaveDensitiesThatAreFields)
{
    const Matrix4 m =
        mass("shape = { parts = [{ box = [2, 2, 2], density_field = \"100 + 30*x\" }, { cylinder = "
             "{ radius = 0.5, length = 2 }, position = [0.25, 0, 0], density = -1, density_field = "
             "\"100 + 30*(x + 0.25)\" }] }");
    const double V = 8, hole = pi / 2, x = 0.25, along_box = V * 4 / 12, along_hole = hole * 0.25 / 4;
    EXPECT_NEAR(m(0, 0), 100 * V - hole * (100 + 30 * x), 1e-11);
    EXPECT_NEAR(m(1, 0), 30 * along_box - (hole * x * (100 + 30 * x) + 30 * along_hole), 1e-11);
    EXPECT_NEAR(m(3, 3), 100 * along_box - hole * (100 + 30 * x) * 4 / 12, 1e-11);
    // Fields are in axes of the part; parts without one have the body's density.
    const Matrix4 turned =
        mass("density = 3\nshape = { parts = [{ box = [1, 1, 1], position = [5, 0, 0], "
             "rotation_vector = [0, 0, \"90 deg\"], density_field = \"2 + x\" }, { box = [1, "
             "1, 1], density = 2 }] }");
    EXPECT_NEAR(turned(0, 0), 2 + 6, 1e-13);
    EXPECT_NEAR(turned(1, 0), 2 * 5, 1e-13);
    EXPECT_NEAR(turned(2, 0), 1 / 12., 1e-13);
    const std::string both =
        "shape = { parts = [{ box = [1, 1, 1], density_field = \"2\" }, { sphere = 1 }] }";
    expect_error(both, "mass-missing", "have no 'density_field'");
    expect_error("mass = 1\n" + both, "mass-conflict", "what parts weigh");
    expect_error("density = 1\nshape = { parts = [{ box = [1, 1, 1], density_field = \"2\" }] }",
                 "mass-conflict", "density_field");
    expect_error(
        "shape = { parts = [{ box = [1, 1, 1], density_field = \"2\" }, { sphere = 0.1, density = -1, "
        "density_field = \"1e6\" }] }",
        "shape", "leave no mass");
    expect_error("density = 1\nshape = { parts = [{ box = [1, 1, 1] }], density_field = \"2\" }", "shape",
                 "parts of a union");
}

TEST(SolidScenario, RefusesFieldsThatAreNoDensity)
{
    const auto of = [](const std::string& text) {
        return "shape = { sphere = 1, density_field = \"" + text + "\" }";
    };
    expect_error(of("z"), "density-field", "no density");
    expect_error(of("1/(x - x)"), "density-field", "no density");
    expect_error(of("2 + t"), "density-field", "time");
    if (!is_sanitized)   // four seconds of dividing it before it is given up, without a sanitizer
        expect_error(of("1 + abs(x + 0.3*y)^0.1"), "density-field", "too fast");
    expect_error(of("2 + r"), "expression-name", "r");
    expect_error("density = 1\n" + of("2"), "mass-conflict", "density_field");
    expect_error("mass = 1\n" + of("2"), "mass-conflict", "density_field");
    expect_error("mass = 1\nshape = { point = true, density_field = \"2\" }", "shape", "no extent");
}

/// A picture is drawn about the centre of mass, which a field moves: the middle of the box stays at the
/// origin.
TEST(SolidScenario, PicturesLieWhereTheShapeIs)
{
    const ScenarioResult result = read("shape = { box = [1, 1, 1], density_field = \"2 + z\" }");
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const Outline& outline = result.scenario->outlines[0];
    const Vector3 center = mass_properties(result.scenario->model.bodies()[0].mass).center_of_mass;
    EXPECT_NEAR(center[2], 1 / 24., 1e-15);
    ASSERT_EQ(outline.parts.size(), 1u);
    EXPECT_LE(norm(center + outline.parts[0].place), 1e-15);
}

Matrix34 forces(const std::string& body, const std::string& load, const Matrix34& X)
{
    const ScenarioResult result = read(body, "[[load]]\nbody = \"b\"\n" + load);
    EXPECT_TRUE(result.scenario.has_value()) << shown(result);
    LoadArguments at;
    at.X[0] = X;
    LoadForces F{};
    if (result.scenario) result.scenario->model.loads()[0].forces(at, F);
    return F[0];
}

Vector3 moment(const Matrix34& X, const Matrix34& F)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), F.column(i));
    return sum;
}

const char* const solids[] = {"box = [1, 2, 3]",
                              "sphere = 0.5",
                              "cylinder = { radius = 0.5, length = 2 }",
                              "cylinder = { radius = 0.5, length = 2, inner_radius = 0.2 }",
                              "capsule = { radius = 0.5, length = 2 }",
                              "ellipsoid = [0.5, 1, 1.5]",
                              "cone = { radius = 0.5, height = 2 }"};

/// No net force and no moment of one pressure; of one that grows with depth rho g V at the centroid.
TEST(SolidScenario, PrimitivesAreSurfacesOfPressures)
{
    const Matrix34 X{1, 2, -30, 0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};
    for (const char* text : solids) {
        SCOPED_TRACE(text);
        const std::string alone = "density = 1\nshape = { " + std::string(text) + " }";
        const double V = mass(alone)(0, 0);
        const Matrix34 squeezed = forces(alone, "type = \"pressure\"\nvalue = 1e5", X);
        EXPECT_EQ(norm(squeezed.column(0)), 0);
        EXPECT_LE(norm(moment(X, squeezed)), 1e-10 * V);
        EXPECT_GT(norm(squeezed), 1e5 * V) << "but it squeezes";
        const Matrix34 buoyed = forces(alone, "type = \"pressure\"\ngradient = [0, 0, -9810]", X);
        EXPECT_LE(norm(buoyed.column(0) - Vector3{0, 0, 9810 * V}), 1e-10 * V);
        EXPECT_LE(norm(moment(X, buoyed)), 1e-8 * V) << "its centroid is the origin";
        // As a part that lies elsewhere: the same force at the part.
        const std::string part =
            "density = 1\nshape = { parts = [{ sphere = 0.1, position = [0, 0, 9] }, { name "
            "= \"float\", position = [0, 3, 0], " +
            std::string(text) + " }] }";
        const Matrix34 raised =
            forces(part, "type = \"pressure\"\nsurface = \"float\"\ngradient = [0, 0, -9810]", X);
        EXPECT_LE(norm(raised.column(0) - Vector3{0, 0, 9810 * V}), 1e-10 * V);
        EXPECT_LE(norm(moment(X, raised) - cross(X.column(2), Vector3{0, 0, 3 * 9810 * V})), 1e-8 * V);
    }
    const ScenarioResult whole = read("density = 1\nshape = { parts = [{ name = \"ball\", sphere = 1 }] }",
                                      "[[load]]\nbody = \"b\"\ntype = \"pressure\"\nvalue = 1");
    const Diagnostic* d = find(whole, "surface-unknown");
    ASSERT_NE(d, nullptr) << shown(whole);
    EXPECT_NE((d->message + d->note).find("it has 'ball'"), std::string::npos) << shown(whole);
}

/// A traction everywhere is its area times it; one that grows from the middle of a ball turns it.
TEST(SolidScenario, PrimitivesAreSurfacesOfTractions)
{
    const Matrix34 X{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double areas[] = {22,
                            pi,
                            pi * 0.5 + pi * 2,
                            2 * pi * 0.7 * 2 + 2 * pi * (0.25 - 0.04),
                            3 * pi,
                            0,
                            pi * 0.25 + pi * 0.5 * std::hypot(0.5, 2)};
    for (std::size_t k = 0; k < std::size(solids); ++k) {
        SCOPED_TRACE(solids[k]);
        const Matrix34 F = forces("density = 1\nshape = { " + std::string(solids[k]) + " }",
                                  "type = \"traction\"\nvalue = [0, 3, 0]", X);
        // scipy.special.ellipkinc and ellipeinc: the area of the ellipsoid 0.5, 1, 1.5
        const double area = areas[k] > 0 ? areas[k] : 12.220536575645516;
        EXPECT_NEAR(F(1, 0), 3 * area, 1e-11);
    }
    const Matrix34 twist =
        forces("density = 1\nshape = { sphere = 0.5 }",
               "type = \"traction\"\ngradient = [[0, -3, 0], [3, 0, 0], [0, 0, 0]]\nframe = "
               "\"body\"",
               X);
    EXPECT_LE(norm(twist.column(0)), 1e-14);
    EXPECT_LE(norm(moment(X, twist) - Vector3{0, 0, 3 * 2 * 4 * pi / 3 * std::pow(0.5, 4)}), 1e-13);
}

TEST(SolidScenario, PartsAreWeighed)
{
    const ScenarioResult result =
        read("mass = 10\ncenter_of_mass = [0, 0, 1]\nshape = { parts = [{ name = \"head\", box = [1, 1, 1], "
             "position "
             "= [0, 0, 3] }, { sphere = 0.1, density = -2, position = [0, 0, 3] }] }");
    ASSERT_TRUE(result.scenario.has_value()) << shown(result);
    const std::vector<ShapePart>& parts = result.scenario->parts.at(0);
    ASSERT_EQ(parts.size(), 2u);
    const double hole = 2 * 4 * pi / 3000, whole = 1 - hole;
    EXPECT_EQ(parts[0].name, "head");
    EXPECT_EQ(parts[1].name, "");
    EXPECT_NEAR(parts[0].mass, 10 / whole, 1e-13);
    EXPECT_NEAR(parts[1].mass, -10 * hole / whole, 1e-14);
    EXPECT_NEAR(parts[0].center[2], 1, 1e-15);
    EXPECT_TRUE(read("density = 1\nshape = { sphere = 1 }").scenario->parts.at(0).empty());
}

}   // namespace
}   // namespace livens::solid_scenario_test
