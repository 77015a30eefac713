// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/mass_properties.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "livens/multibody/nearest_inertia.h"
#include "unit/multibody/random_states.h"

namespace livens::mass_properties_test {
namespace {

/// A cross-section at height z: an ellipse of half axes (x, y), with a similar hole.
struct Section {
    double x = 0, y = 0, hole_x = 0, hole_y = 0;
};

/// Mass, centre and inertia of stacked sections by Simpson's rule in z, knowing nothing of the closed forms.
MassProperties integrate(double density, double bottom, double top,
                         const std::function<Section(double)>& section)
{
    const int n = 20000;
    double volume = 0, first = 0, xx = 0, yy = 0, zz = 0;
    for (int i = 0; i <= n; ++i) {
        const double z = bottom + (top - bottom) * i / n;
        const double w = (top - bottom) / (3 * n) * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2);
        const Section s = section(z);
        const double area = std::numbers::pi * (s.x * s.y - s.hole_x * s.hole_y);
        volume += w * area;
        first += w * z * area;
        xx += w * std::numbers::pi / 4 * (std::pow(s.x, 3) * s.y - std::pow(s.hole_x, 3) * s.hole_y);
        yy += w * std::numbers::pi / 4 * (s.x * std::pow(s.y, 3) - s.hole_x * std::pow(s.hole_y, 3));
        zz += w * z * z * area;
    }
    return {density * volume,
            {0, 0, first / volume},
            density * Matrix3{yy + zz, 0, 0, 0, xx + zz, 0, 0, 0, xx + yy}};
}

void expect_same(const MassProperties& got, const MassProperties& want)
{
    EXPECT_NEAR(got.mass, want.mass, 1e-10 * want.mass);
    EXPECT_LT(largest(got.center_of_mass - want.center_of_mass), 1e-10);
    EXPECT_LT(largest(got.inertia - want.inertia), 1e-10 * largest(want.inertia));
    EXPECT_NO_THROW(check_mass_properties(got, "body[shape]"));
}

TEST(MassProperties, SphereAndEllipsoidMatchIntegration)
{
    expect_same(sphere(3, 0.7), integrate(3, -0.7, 0.7, [](double z) {
                    const double r = std::sqrt(std::max(0.0, 0.49 - z * z));
                    return Section{r, r};
                }));
    expect_same(ellipsoid(3, {0.7, 0.2, 1.3}), integrate(3, -1.3, 1.3, [](double z) {
                    const double s = std::sqrt(std::max(0.0, 1 - z * z / 1.69));
                    return Section{0.7 * s, 0.2 * s};
                }));
}

TEST(MassProperties, CylinderTubeAndConeMatchIntegration)
{
    expect_same(cylinder(3, 0.7, 1.9), integrate(3, -0.95, 0.95, [](double) { return Section{0.7, 0.7}; }));
    expect_same(cylinder(3, 0.7, 1.9, 0.4), integrate(3, -0.95, 0.95, [](double) {
                    return Section{0.7, 0.7, 0.4, 0.4};
                }));
    // The apex lies 3/4 of the height above the centroid.
    expect_same(cone(3, 0.7, 1.2), integrate(3, -0.3, 0.9, [](double z) {
                    const double r = 0.7 * (0.9 - z) / 1.2;
                    return Section{r, r};
                }));
}

TEST(MassProperties, CapsuleMatchesIntegration)
{
    // Three pieces, since Simpson's rule loses its order where they meet.
    const auto cap = [](double z) {
        const double r = std::sqrt(std::max(0.0, 0.16 - z * z));
        return Section{r, r};
    };
    const MassProperties top = integrate(3, 0.6, 1.0, [&](double z) { return cap(z - 0.6); });
    const MassProperties tube = integrate(3, -0.6, 0.6, [](double) { return Section{0.4, 0.4}; });
    const MassProperties bottom = integrate(3, -1.0, -0.6, [&](double z) { return cap(z + 0.6); });
    expect_same(capsule(3, 0.4, 1.2),
                {top.mass + tube.mass + bottom.mass, {}, top.inertia + tube.inertia + bottom.inertia});
}

TEST(MassProperties, BoxMatchesASumOverSmallCubes)
{
    const Vector3 edges{0.5, 2.0, 1.25};
    const int n = 20;   // the cubes' own moments are 1/n^2 of the box's and are added
    double volume = 0;
    Matrix3 E{};
    for (int i = 0; i < n * n * n; ++i) {
        const Vector3 x{((i % n + 0.5) / n - 0.5) * edges[0], ((i / n % n + 0.5) / n - 0.5) * edges[1],
                        ((i / n / n + 0.5) / n - 0.5) * edges[2]};
        const double cube = edges[0] * edges[1] * edges[2] / (n * n * n);
        volume += cube;
        E += cube * outer(x, x);
        for (int k = 0; k < 3; ++k) E(k, k) += cube * edges[k] * edges[k] / (12.0 * n * n);
    }
    expect_same(box(3, edges), {3 * volume, {}, 3.0 * (trace(E) * identity<3>() - E)});
}

TEST(MassProperties, MassMatrixHoldsTheSecondMomentsAboutTheReferencePoint)
{
    // Four unequal point masses: sums over them are the definition of m.
    Random random(1);
    Matrix4 m{};
    MassProperties properties;
    std::vector<std::pair<double, Vector3>> cloud;
    for (int i = 0; i < 5; ++i) {
        const double mass = 1.5 + random.number();
        const Vector3 x = random.vector();
        cloud.emplace_back(mass, x);
        m += mass * outer(point(x), point(x));
        properties.mass += mass;
        properties.center_of_mass += mass * x;
    }
    properties.center_of_mass *= 1 / properties.mass;
    for (const auto& [mass, x] : cloud) {
        const Vector3 r = x - properties.center_of_mass;
        properties.inertia += mass * (dot(r, r) * identity<3>() - outer(r, r));
    }
    EXPECT_LT(largest(mass_matrix(properties) - m), 1e-14);
    const MassProperties back = mass_properties(m);
    EXPECT_DOUBLE_EQ(back.mass, properties.mass);
    EXPECT_LT(largest(back.center_of_mass - properties.center_of_mass), 1e-15);
    EXPECT_LT(largest(back.inertia - properties.inertia), 1e-14);
}

TEST(MassProperties, MassMatrixIsSymmetricToTheBit)
{
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Matrix3 R = random.rotation();
        const Matrix3 J = R * Matrix3{2, 0, 0, 0, 3, 0, 0, 0, 4} * transpose(R);
        const Matrix4 m = mass_matrix({2, random.vector(), J});
        EXPECT_EQ(m, transpose(m));
    }
}

MassProperties principal(double j1, double j2, double j3) { return {1, {}, {j1, 0, 0, 0, j2, 0, 0, 0, j3}}; }

MassProperties turned(const MassProperties& properties, const Matrix3& R)
{
    MassProperties result = properties;
    result.inertia = R * properties.inertia * transpose(R);
    return result;
}

TEST(MassProperties, NeedlesAndLaminaeAreLegalInEveryOrientation)
{
    Random random(3);
    for (const MassProperties& limit :
         {principal(0, 1, 1), principal(1, 2, 3), principal(0, 0, 0), principal(1, 1, 2),
          principal(1e-9, 2e-9, 3e-9), principal(1, 2, 3 * (1 + 1e-13)), principal(-1e-13, 1, 1)})
        for (int i = 0; i < 100; ++i)
            EXPECT_NO_THROW(
                check_mass_properties(i == 0 ? limit : turned(limit, random.rotation()), "body[x]"));
}

TEST(MassProperties, ImpossibleInertiasAreRefusedByTheLawTheyBreak)
{
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Matrix3 R = i == 0 ? identity<3>() : random.rotation();
        const auto check = [&](const MassProperties& p) {
            return [&R, p] { check_mass_properties(turned(p, R), "body[x]"); };
        };
        expect_complaint(check(principal(1, 2, 3 * (1 + 1e-11))), "inertia-triangle", "body[x].inertia");
        expect_complaint(check(principal(4, 1, 2)), "inertia-triangle", "body[x].inertia");
        expect_complaint(check(principal(1e-9, 2e-9, 3.01e-9)), "inertia-triangle", "body[x].inertia");
        expect_complaint(check(principal(-1e-11, 1, 1)), "inertia-negative", "body[x].inertia");
        expect_complaint(check(principal(-1, -1, -1)), "inertia-negative", "body[x].inertia");
    }
}

TEST(MassProperties, MomentsThatWereMovedToTheCentreMayBeNegativeByTheirRounding)
{
    // As a link of iCub came out of its parts: M |c|^2 is 1.25e-3 kg m^2.
    const auto check = [](double moment, const Vector3& center) {
        return [=] { check_mass_properties({0.5, center, {moment, 0, 0, 0, 1e-21, 0, 0, 0, 0}}, "body[x]"); };
    };
    EXPECT_NO_THROW(check(-5.4e-20, {0, 0, -0.05})());
    EXPECT_NO_THROW(check(-1e-15, {0, 0, -0.05})());
    expect_complaint(check(-2e-15, {0, 0, -0.05}), "inertia-negative", "body[x].inertia");
    expect_complaint(check(-5.4e-20, {}), "inertia-negative", "body[x].inertia");
}

TEST(MassProperties, TheNearestInertiaHasTheEulerTensorWithoutItsNegativePart)
{
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        // E = diag(-0.0025, 0.0055, 0.0045), so that J = diag(0.01, 0.0045, 0.0055) is left of it.
        const MassProperties broken = principal(0.01, 0.002, 0.003), mended = principal(0.01, 0.0045, 0.0055);
        const Matrix3 R = i == 0 ? identity<3>() : random.rotation();
        const Matrix3 nearest = nearest_inertia(turned(broken, R).inertia);
        EXPECT_LT(norm(nearest - turned(mended, R).inertia), 1e-16);
        EXPECT_NO_THROW(check_mass_properties({1, {}, nearest}, "body[x]"));
        const Matrix3 legal = turned(principal(1, 2, 3), R).inertia;
        EXPECT_EQ(nearest_inertia(legal), legal);
    }
    EXPECT_EQ(nearest_inertia(principal(-1, -1, -1).inertia), Matrix3{});
}

TEST(MassProperties, WrongMassAndAsymmetryAreRefused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    const Matrix3 J = identity<3>();
    const auto check = [](const MassProperties& p) { return [p] { check_mass_properties(p, "body[x]"); }; };
    expect_complaint(check({0, {}, J}), "mass-not-positive", "body[x].mass");
    expect_complaint(check({-1, {}, J}), "mass-not-positive", "body[x].mass");
    expect_complaint(check({nan, {}, J}), "not-finite", "body[x].mass");
    expect_complaint(check({inf, {}, J}), "not-finite", "body[x].mass");
    expect_complaint(check({1, {0, inf, 0}, J}), "not-finite", "body[x].center_of_mass");
    Matrix3 skew = J;
    skew(0, 1) = 1e-11;
    expect_complaint(check({1, {}, skew}), "inertia-not-symmetric", "body[x].inertia");
    skew(0, 1) = 1e-13;
    EXPECT_NO_THROW(check_mass_properties({1, {}, skew}, "body[x]"));
    skew(0, 1) = nan;
    expect_complaint(check({1, {}, skew}), "not-finite", "body[x].inertia");
}

TEST(MassProperties, SingularMassesAreThoseOfNeedlesLaminaeAndPoints)
{
    Random random(5);
    for (const double size : {1.0, 1e-9, 1e9})
        for (int i = 0; i < 50; ++i) {
            const Matrix3 R = i == 0 ? identity<3>() : random.rotation();
            const Vector3 center = i % 2 == 0 ? Vector3{} : std::sqrt(size) * random.vector();
            const auto singular = [&](const MassProperties& p) {
                MassProperties q = with_center(turned(p, R), center);
                q.inertia *= size;
                return is_singular(mass_matrix(q), false);
            };
            EXPECT_TRUE(singular(principal(0, 1, 1))) << "needle";
            EXPECT_TRUE(singular(principal(1, 2, 3))) << "lamina";
            EXPECT_TRUE(singular(principal(0, 0, 0))) << "all mass in one point";
            EXPECT_FALSE(singular(principal(1, 2, 2.999)));
            EXPECT_FALSE(singular(principal(0.0001, 1, 1)));
            EXPECT_FALSE(singular(box(1, {1, 1e-3, 1})));
        }
    Matrix4 thin = identity<4>();   // scaled to ones on its diagonal it is the identity, however thin
    thin(2, 2) = 1e-13;
    EXPECT_FALSE(is_singular(thin, false));
    thin(2, 2) = 1e-15;
    EXPECT_TRUE(is_singular(thin, false));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Matrix4 m = mass_matrix(box(1, {1, 2, 3}));
    EXPECT_FALSE(is_singular(m, false));
    m(2, 2) = nan;
    EXPECT_TRUE(is_singular(m, false));
    Matrix4 point{};
    EXPECT_TRUE(is_singular(point, true));
    point(0, 0) = 2;
    EXPECT_FALSE(is_singular(point, true)) << "a point mass has no directors to want inertia";
    EXPECT_TRUE(is_singular(point, false));
}

TEST(MassProperties, InverseMassGivesTheVelocityBack)
{
    Random random(6);
    for (const double size : {1.0, 1e-4, 1e4})
        for (int i = 0; i < 50; ++i) {
            MassProperties p = turned(box(1, {1, 2, 3}), random.rotation());
            p.center_of_mass = size * random.vector();
            p.inertia *= size * size;
            const Matrix4 m = mass_matrix(p), inverse = inverse_mass(m, false);
            EXPECT_EQ(inverse, transpose(inverse));
            Matrix34 V{};
            for (int k = 0; k < 12; ++k) V[k] = random.number() / (k < 3 ? 1 : size);
            const Matrix34 error = V * m * inverse - V;
            for (int k = 0; k < 12; ++k) EXPECT_LT(std::abs(error[k]) * (k < 3 ? 1 : size), 1e-13) << size;
        }
    Matrix4 point{}, exact{};
    point(0, 0) = 4;
    exact(0, 0) = 0.25;
    EXPECT_EQ(inverse_mass(point, true), exact);
}

TEST(MassProperties, SizesMustBePositive)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        expect_complaint([=] { box(1, {1, bad, 1}); }, "size-not-positive");
        expect_complaint([=] { box(bad, {1, 1, 1}); }, "size-not-positive");
        expect_complaint([=] { sphere(1, bad); }, "size-not-positive");
        expect_complaint([=] { cylinder(1, bad, 1); }, "size-not-positive");
        expect_complaint([=] { cylinder(1, 1, bad); }, "size-not-positive");
        expect_complaint([=] { capsule(1, 1, bad); }, "size-not-positive");
        expect_complaint([=] { ellipsoid(1, {1, 1, bad}); }, "size-not-positive");
        expect_complaint([=] { cone(1, bad, 1); }, "size-not-positive");
    }
    expect_complaint([] { cylinder(1, 1, 1, 1); }, "size-inner-radius");
    expect_complaint([] { cylinder(1, 1, 1, -0.1); }, "size-inner-radius");
    expect_complaint([=] { cylinder(1, 1, 1, nan); }, "size-inner-radius");
}

TEST(MassProperties, ThinTubesKeepTheirDigits)
{
    const double thin = 1e-9;
    const MassProperties tube = cylinder(1, 1, 1, 1 - thin);
    const double wall = 1 - (1 - thin);   // as rounded
    EXPECT_NEAR(tube.mass / (2 * std::numbers::pi * wall * (1 - wall / 2)), 1, 1e-15);
    EXPECT_NO_THROW(check_mass_properties(tube, "body[tube]"));
}

TEST(MassProperties, ScalingTheMassScalesTheInertia)
{
    const MassProperties one = box(2, {1, 2, 3}), three = with_mass(one, 3 * one.mass);
    EXPECT_DOUBLE_EQ(three.mass, 36);
    EXPECT_LT(largest(three.inertia - 3.0 * one.inertia), 1e-13);
    expect_complaint([] { with_mass({}, 1); }, "mass-not-positive");
    const MassProperties moved = with_center(one, {1, 2, 3});
    EXPECT_EQ(moved.center_of_mass, (Vector3{1, 2, 3}));
    EXPECT_EQ(moved.inertia, one.inertia);
}

}   // namespace
}   // namespace livens::mass_properties_test
