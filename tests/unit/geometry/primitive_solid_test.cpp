// SPDX-License-Identifier: BSD-3-Clause
// Solids of a few lengths with densities that are fields, and their surfaces, against closed forms and
// quadrature by SciPy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "livens/base/error.h"
#include "livens/geometry/primitive_solid.h"

namespace livens::primitive_solid_test {

namespace {

constexpr double pi = std::numbers::pi;

void expect_near(const Matrix3& a, const Matrix3& b, double bound)
{
    EXPECT_LE(norm(a - b), bound * norm(b));
}

Matrix3 diagonal(double a, double b, double c) { return {a, 0, 0, 0, b, 0, 0, 0, c}; }

struct Sample {
    const char* name;
    PrimitiveSolid solid;
    double volume;
    Matrix3 second;   ///< about the centroid, at the origin
};
std::vector<Sample> samples()
{
    const double R = 0.7, r = 0.3, L = 1.5, H = 2;
    const double tube = pi * (R * R - r * r) * L, round = 4 * pi / 3, cone = pi * R * R * H / 3;
    const double rod = pi * R * R * L, caps = round * R * R * R;
    const double across = tube * (R * R + r * r) / 4;
    const double caps_along = caps * (R * R / 5 + L * L / 4 + 3 * L * R / 8);
    return {
        {"box", box_solid({1, 2, 3}), 6, diagonal(0.5, 2, 4.5)},
        {"tube", cylinder_solid(R, L, r), tube, diagonal(across, across, tube * L * L / 12)},
        {"rod", cylinder_solid(R, L, 0), rod, rod * diagonal(R * R / 4, R * R / 4, L * L / 12)},
        {"ellipsoid", ellipsoid_solid({1, 2, 0.5}), round, round / 5 * diagonal(1, 4, 0.25)},
        {"capsule", capsule_solid(R, L), rod + caps,
         diagonal(rod * R * R / 4 + caps * R * R / 5, rod * R * R / 4 + caps * R * R / 5,
                  rod * L * L / 12 + caps_along)},
        {"cone", cone_solid(R, H), cone, cone * diagonal(3 * R * R / 20, 3 * R * R / 20, 3 * H * H / 80)}};
}

TEST(PrimitiveSolid, OfConstantDensityHasItsClosedForms)
{
    for (const Sample& s : samples()) {
        SCOPED_TRACE(s.name);
        const Moments m = weighted_moments(s.solid, [](const Vector3&) { return 2.; });
        EXPECT_NEAR(m.volume, 2 * s.volume, 2e-14 * s.volume);
        EXPECT_LE(norm(m.centroid), 1e-15);
        expect_near(m.second, 2 * s.second, 1e-14);
    }
}

/// rho = 5 + g . x: the first moment is g times the second of the whole.
TEST(PrimitiveSolid, OfLinearDensityFollowsFromItsSecondMoments)
{
    const Vector3 g{0.5, -0.25, 1};
    for (const Sample& s : samples()) {
        SCOPED_TRACE(s.name);
        const Moments m = weighted_moments(s.solid, [&](const Vector3& x) { return 5 + dot(g, x); });
        EXPECT_NEAR(m.volume, 5 * s.volume, 1e-14 * s.volume);
        EXPECT_LE(norm(m.volume * m.centroid - s.second * g), 1e-14 * norm(s.second * g));
    }
}

/// Polynomials to rounding: of a box x^4 y^2 z^6, of a ball r^6 and z^8, of a cylinder x^4 y^2.
TEST(PrimitiveSolid, OfPolynomialsIsExact)
{
    const Moments box = weighted_moments(box_solid({2, 2, 2}), [](const Vector3& x) {
        return std::pow(x[0], 4) * x[1] * x[1] * std::pow(x[2], 6);
    });
    const double mass = 8. / (5 * 3 * 7);
    EXPECT_NEAR(box.volume, mass, 1e-15);
    expect_near(box.second, mass * diagonal(5. / 7, 3. / 5, 7. / 9), 2e-15);
    const PrimitiveSolid unit = ellipsoid_solid({1, 1, 1});
    const Moments shell = weighted_moments(unit, [](const Vector3& x) { return std::pow(dot(x, x), 3); });
    EXPECT_NEAR(shell.volume, 4 * pi / 9, 5e-15);
    expect_near(shell.second, 4 * pi / 33 * identity<3>(), 4e-15);
    const Moments poles = weighted_moments(unit, [](const Vector3& x) { return std::pow(x[2], 8); });
    EXPECT_NEAR(poles.volume, 4 * pi / (9 * 11), 2e-15);
    EXPECT_NEAR(poles.second(2, 2), 4 * pi / (11 * 13), 2e-15);
    const Moments bar = weighted_moments(cylinder_solid(1, 2, 0),
                                         [](const Vector3& x) { return std::pow(x[0], 4) * x[1] * x[1]; });
    EXPECT_NEAR(bar.volume, 2 * pi / 64, 1e-15);   // int cos^4 sin^2 = pi / 8, int r^7 = 1/8
    EXPECT_NEAR(bar.second(0, 0), 2 * 5 * pi / 64 / 10, 1e-15);
}

/// scipy.integrate.tplquad of exp(-x^2 - y) (2 + sin(3 z)), as tests/unit/geometry/data/primitive_fields.py
/// prints it.
TEST(PrimitiveSolid, OfOtherFieldsAgreesWithSciPy)
{
    struct Reference {
        const char* name;
        double mass, first_y, second_xx, second_yz;   ///< about the origin
    };
    const Reference references[] = {
#include "unit/geometry/data/primitive_fields.inc"
    };
    int n_compared = 0;
    for (const Sample& s : samples())
        for (const Reference& known : references) {
            if (std::string(known.name) != s.name) continue;
            SCOPED_TRACE(s.name);
            const Moments m = weighted_moments(s.solid, [](const Vector3& x) {
                return std::exp(-x[0] * x[0] - x[1]) * (2 + std::sin(3 * x[2]));
            });
            EXPECT_NEAR(m.volume, known.mass, 1e-11 * known.mass);
            EXPECT_NEAR(m.volume * m.centroid[1], known.first_y, 1e-11 * known.mass);
            const Matrix3 second = m.second + m.volume * outer(m.centroid, m.centroid);
            EXPECT_NEAR(second(0, 0), known.second_xx, 1e-11 * known.mass);
            EXPECT_NEAR(second(1, 2), known.second_yz, 1e-11 * known.mass);
            ++n_compared;
        }
    EXPECT_EQ(n_compared, 6);
}

TEST(PrimitiveSolid, RefusesWhatIsNoDensity)
{
    const auto refusal = [](const PrimitiveSolid& solid, const std::function<double(const Vector3&)>& rho) {
        try {
            weighted_moments(solid, rho);
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "density-field");
            return error.complaint().message;
        }
        return std::string();
    };
    for (const Sample& s : samples()) {
        SCOPED_TRACE(s.name);
        EXPECT_NE(refusal(s.solid, [](const Vector3& x) { return x[0]; }).find("no density"),
                  std::string::npos);
        EXPECT_NE(refusal(s.solid, [](const Vector3&) { return NAN; }).find("no density"), std::string::npos);
        EXPECT_NE(refusal(s.solid, [](const Vector3&) { return 0.; }).find("no mass"), std::string::npos);
        EXPECT_NE(refusal(s.solid, [](const Vector3& x) { return x[0] + 0.3 * x[1] > 0.1 ? 2. : 1.; })
                      .find("too fast"),
                  std::string::npos);
        EXPECT_EQ(refusal(s.solid, [](const Vector3& x) { return x[2] * x[2]; }), "");
    }
    // A bore is no part of the tube.
    EXPECT_EQ(
        refusal(cylinder_solid(1, 1, 0.2), [](const Vector3& x) { return std::hypot(x[0], x[1]) - 0.19; }),
        "");
    EXPECT_NE(
        refusal(cylinder_solid(1, 1, 0.1), [](const Vector3& x) { return std::hypot(x[0], x[1]) - 0.19; }),
        "");
}

TEST(PrimitiveSurface, HasTheClosedForms)
{
    const double R = 0.7, r = 0.3, L = 1.5, H = 2;
    const auto area_of = [](const PrimitiveSolid& s) { return surface_moments(s, {1, {}, {}}).area; };
    const Matrix4 box = area_of(box_solid({1, 2, 3}));
    EXPECT_NEAR(box(0, 0), 22, 1e-14);
    EXPECT_NEAR(box(1, 1), 12 / 4. + 6 / 12. + 4 / 12., 1e-14);
    EXPECT_NEAR(box(3, 3), 4 * 9 / 4. + 12 * 9 / 12. + 6 * 9 / 12., 1e-13);
    const Matrix4 ball = area_of(ellipsoid_solid({R, R, R}));
    EXPECT_NEAR(ball(0, 0), 4 * pi * R * R, 1e-14);
    for (int i = 1; i < 4; ++i) EXPECT_NEAR(ball(i, i), 4 * pi / 3 * std::pow(R, 4), 1e-14);
    const Matrix4 tube = area_of(cylinder_solid(R, L, r));
    const double ends = 2 * pi * (R * R - r * r);
    EXPECT_NEAR(tube(0, 0), 2 * pi * (R + r) * L + ends, 1e-14);
    EXPECT_NEAR(tube(3, 3), 2 * pi * (R + r) * L * L * L / 12 + ends * L * L / 4, 1e-14);
    EXPECT_NEAR(tube(1, 1), pi * (R * R * R + r * r * r) * L + pi / 2 * (std::pow(R, 4) - std::pow(r, 4)),
                1e-14);
    const double slant = std::hypot(R, H);
    const Matrix4 cone = area_of(cone_solid(R, H));
    EXPECT_NEAR(cone(0, 0), pi * R * R + pi * R * slant, 1e-14);
    EXPECT_NEAR(cone(0, 3), -pi * R * R * H / 4 + pi * R * slant * (H / 3 - H / 4), 1e-14);
    EXPECT_NEAR(cone(1, 1), pi / 4 * std::pow(R, 4) + pi * R * R * R * slant / 4, 1e-14);
    const Matrix4 capsule = area_of(capsule_solid(R, L));
    EXPECT_NEAR(capsule(0, 0), 4 * pi * R * R + 2 * pi * R * L, 1e-14);
    EXPECT_NEAR(capsule(3, 3),
                2 * pi * R * L * L * L / 12 + 4 * pi * R * R * (L * L / 4 + L * R / 2 + R * R / 3), 2e-14);
    // Oblate: 2 pi a^2 + pi c^2 / e ln((1 + e) / (1 - e)), down to 1 to 1000.
    for (const double c : {0.5, 0.1, 0.001}) {
        const double e = std::sqrt(1 - c * c);
        EXPECT_NEAR(area_of(ellipsoid_solid({1, 1, c}))(0, 0),
                    2 * pi + pi * c * c / e * std::log((1 + e) / (1 - e)), 1e-12)
            << c;
    }
}

/// The normals leave the volume and its first moments; a pressure does not push a closed body.
TEST(PrimitiveSurface, IsClosed)
{
    const double R = 0.7, H = 2, V = pi * R * R * H / 3;
    const SurfaceMoments m = surface_moments(cone_solid(R, H), {V, {0.1, 0, 0}, {}});
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(m.normal[i](0, 0), 0);
        for (int j = 0; j < 3; ++j) EXPECT_EQ(m.normal[i](0, j + 1), i == j ? V : 0);
    }
    EXPECT_NEAR(m.normal[0](1, 1), 0.2 * V, 1e-15);
    EXPECT_NEAR(m.normal[1](1, 2), 0.1 * V, 1e-15);
}

}   // namespace
}   // namespace livens::primitive_solid_test
