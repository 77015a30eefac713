// SPDX-License-Identifier: BSD-3-Clause
// Solids whose density is a field, against closed forms.
#include "unit/geometry/shapes.h"

namespace livens::density_test {

namespace {

using namespace test;

/// int x^a y^b z^c over the box from 0 to the edges.
double monomial(const Vector3& edges, int a, int b, int c)
{
    double value = 1;
    const int powers[] = {a, b, c};
    for (int i = 0; i < 3; ++i) value *= std::pow(edges[i], powers[i] + 1) / (powers[i] + 1);
    return value;
}

/// One monomial of a density.
struct Term {
    double factor;
    std::array<int, 3> powers;
};
using Field = std::vector<Term>;

double value(const Field& field, const Vector3& p)
{
    double sum = 0;
    for (const Term& t : field)
        sum += t.factor * std::pow(p[0], t.powers[0]) * std::pow(p[1], t.powers[1]) *
               std::pow(p[2], t.powers[2]);
    return sum;
}

Moments exact(const Field& field, const Vector3& edges)
{
    Moments m;
    Vector3 first{};
    for (const auto& [factor, n] : field) {
        m.volume += factor * monomial(edges, n[0], n[1], n[2]);
        for (int i = 0; i < 3; ++i) {
            first[i] += factor * monomial(edges, n[0] + (i == 0), n[1] + (i == 1), n[2] + (i == 2));
            for (int j = 0; j < 3; ++j)
                m.second(i, j) += factor * monomial(edges, n[0] + (i == 0) + (j == 0),
                                                    n[1] + (i == 1) + (j == 1), n[2] + (i == 2) + (j == 2));
        }
    }
    m.centroid = (1 / m.volume) * first;
    m.second -= m.volume * outer(m.centroid, m.centroid);
    return m;
}

void expect_same(const Moments& m, const Moments& other, double bound)
{
    EXPECT_NEAR(m.volume, other.volume, bound * other.volume);
    EXPECT_LE(norm(m.centroid - other.centroid), bound * (1 + norm(other.centroid)));
    EXPECT_LE(norm(m.second - other.second), bound * norm(other.second));
}

constexpr auto one_two_three = [](double u, double v, double w) { return Vector3{u, 2 * v, 3 * w}; };
const Vector3 edges{1, 2, 3};

TEST(Density, LinearInABoxIsExactFromSurfacesAndVolumes)
{
    const LinearDensity linear{5, {1, -2, 0.5}};   // 1 at the least, in a corner
    const Field field{{5, {0, 0, 0}}, {1, {1, 0, 0}}, {-2, {0, 1, 0}}, {0.5, {0, 0, 1}}};
    const Moments box = exact(field, edges);
    EXPECT_GT(norm(box.centroid - Vector3{0.5, 1, 1.5}), 0.1) << "the density changes nothing";
    for (const int n : {1, 4}) expect_same(weighted_moments(box_surface({}, edges, n), linear), box, 1e-14);
    for (const ElementKind kind :
         {ElementKind::tetrahedron, ElementKind::hexahedron, ElementKind::tetrahedron10}) {
        SCOPED_TRACE(name_of(kind));
        const Mesh mesh = volume_over({2, 2, 2}, kind, one_two_three);
        expect_same(weighted_moments(mesh, linear), box, 1e-14);
        expect_same(weighted_moments(boundary_of(mesh), linear), box, 1e-14);
    }
}

TEST(Density, PolynomialsAreExactOverVolumes)
{
    const Field field{{1, {0, 0, 0}}, {2, {2, 1, 0}}, {0.3, {0, 0, 5}}, {0.1, {3, 3, 3}}};
    for (const ElementKind kind :
         {ElementKind::tetrahedron, ElementKind::hexahedron, ElementKind::tetrahedron10}) {
        SCOPED_TRACE(name_of(kind));
        const Mesh mesh = volume_over({1, 1, 1}, kind, one_two_three);
        const Moments m = weighted_moments(mesh, [&](const Vector3& p) { return value(field, p); });
        expect_same(m, exact(field, edges), 2e-14);
    }
}

/// Of a density that is the distance from the axis: int r dV = 2 pi h (R^3 - r^3) / 3.
TEST(Density, LONG_AlongTheRadiusConvergesWithTheMesh)
{
    const double h = 1.5, mass = 2 * pi * h * (8 - 1) / 3, x2 = pi * h * (32 - 1) / 5;
    std::vector<double> of_mass, of_second;
    for (const int n : {2, 4, 8}) {
        const Mesh mesh = tube(n, ElementKind::tetrahedron10, 1, 2, h);
        const Moments m = weighted_moments(mesh, [](const Vector3& p) { return std::hypot(p[0], p[1]); });
        of_mass.push_back(std::abs(m.volume / mass - 1));
        of_second.push_back(std::abs(m.second(0, 0) / x2 - 1));
        EXPECT_NEAR(m.second(2, 2), m.volume * h * h / 12, 1e-12 * m.volume);
    }
    for (const auto& errors : {of_mass, of_second}) {
        EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4, 0.15);
        EXPECT_GT(errors[2], 1e-11) << "too fine to tell an order";
    }
}

TEST(Density, OfACurvedSurfaceIsThatOfItsVolume)
{
    const Mesh volume = tube(3, ElementKind::tetrahedron10, 0.7, 2, 1.5);
    const LinearDensity linear{3, {1, 0.2, -0.5}};
    expect_same(weighted_moments(boundary_of(volume), linear), weighted_moments(volume, linear), 1e-13);
}

TEST(Density, FarAwayLosesNothing)
{
    const Vector3 away{1e6, -1e6, 1e6};
    const Mesh far = changed(box_surface({}, edges, 2), [&](const Vector3& p) { return p + away; });
    const Moments m = weighted_moments(far, {4 - 0.5e6 - 1e6, {0.5, -1, 0}});
    Moments box = exact({{4, {0, 0, 0}}, {0.5, {1, 0, 0}}, {-1, {0, 1, 0}}}, edges);
    EXPECT_LE(norm(m.second - box.second), 4e-15 * norm(box.second));
    EXPECT_LE(norm(m.centroid - away - box.centroid), 1e-9);
    EXPECT_NEAR(m.volume, box.volume, 4e-15 * box.volume);
}

std::string refusal(const std::function<void()>& work)
{
    try {
        work();
    } catch (const InputError& error) {
        return error.complaint().code + ": " + error.complaint().message;
    }
    return "";
}

TEST(Density, WhichIsNoneIsRefused)
{
    const Mesh mesh = volume_over({1, 1, 1}, ElementKind::tetrahedron, one_two_three);
    const auto of = [&](auto density) { return refusal([&] { weighted_moments(mesh, density); }); };
    EXPECT_NE(of([](const Vector3& p) { return p[0] - 0.5; }).find("is no density"), std::string::npos);
    EXPECT_NE(of([](const Vector3&) { return NAN; }).find("density-field"), std::string::npos);
    EXPECT_NE(of([](const Vector3&) { return 0.; }).find("no mass"), std::string::npos);
    EXPECT_NE(of([](const Vector3& p) { return p[0] > 0.377 ? 1. : 5.; }).find("too fast"),
              std::string::npos);
    EXPECT_EQ(of([](const Vector3& p) { return 1 + p[0]; }), "");
    const Mesh surface = box_surface({}, edges);
    const auto linear = [&](double c, double g) {
        return refusal([&] { weighted_moments(surface, LinearDensity{c, {0, 0, g}}); });
    };
    EXPECT_NE(linear(2, -1).find("is no density"), std::string::npos);
    EXPECT_EQ(linear(3, -1), "") << "it is 0 at the upper side";
}

}   // namespace

}   // namespace livens::density_test
