// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/body.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "unit/multibody/random_states.h"

namespace livens::body_test {
namespace {

double gap_of(const Matrix3& D) { return largest(transpose(D) * D - identity<3>()); }

TEST(SkewBodies, AreTheirOrthonormalSelvesInOtherCoordinates)
{
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const MassProperties box{2, {0.3, 0.1, -0.2}, {0.11, 0.01, 0, 0.01, 0.09, 0.02, 0, 0.02, 0.1}};
        const Matrix3 E = directors_from_rotation_vector(random.unit());
        const Matrix3 C = identity<3>() + 0.3 * random.matrix<3, 3>();
        Matrix4 back{};   // (1, theta) of (1, C theta)
        back(0, 0) = 1;
        const Matrix3 inverted = inverse(C);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) back(a + 1, b + 1) = inverted(a, b);
        Placement straight, skew;
        straight.directors = E;
        skew.directors = E * C;
        straight.angular_velocity = skew.angular_velocity = {1, -2, 3};
        straight.position = skew.position = {4, 5, 6};
        const Body a = rigid_body("a", box, straight),
                   b = skew_body("b", back * a.mass * transpose(back), skew);
        // X m X^T is what the mass is in the world, in any coordinates.
        const Matrix34 X = b.X;
        EXPECT_LT(largest(a.X * a.mass * transpose(a.X) - X * b.mass * transpose(X)), 1e-13);
        EXPECT_LT(largest(a.V * a.mass * transpose(a.V) - b.V * b.mass * transpose(b.V)), 1e-13);
        EXPECT_LT(gap_of(directors(X)), 1e-15);
        EXPECT_LT(largest(directors(X) * b.stretch - E * C), 1e-14);
        EXPECT_EQ(largest(b.stretch - transpose(b.stretch)), 0);
        EXPECT_TRUE(is_skew(b));
        EXPECT_FALSE(is_skew(a));
    }
    // One of its directors a millimetre long: theta is in millimetres.
    Placement small;
    small.directors = 1e-3 * identity<3>();
    Matrix4 m{};
    m(0, 0) = 1;
    for (int i = 1; i < 4; ++i) m(i, i) = 1e6;
    EXPECT_LT(largest(skew_body("b", m, small).mass - identity<4>()), 1e-15);
}

TEST(Orientation, QuaternionsGoThereAndBackOverRandomRotations)
{
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        Vector4 q = random.matrix<4, 1>();
        q *= (q[0] < 0 ? -1 : 1) / norm(q);
        const Matrix3 D = directors_from_quaternion(q);
        EXPECT_LT(gap_of(D), 2e-15);
        EXPECT_GT(determinant(D), 0);
        EXPECT_LT(largest(quaternion_from_directors(D) - q), 1e-15);
    }
}

TEST(Orientation, QuaternionsKeepTheirDigitsNearHalfTurns)
{
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const Vector3 axis = random.unit();
        for (const double gap : {0.0, 1e-15, 1e-9, 1e-5}) {
            const double w = std::sin(gap), s = std::cos(gap);
            const Vector4 q{w, s * axis[0], s * axis[1], s * axis[2]};
            const Vector4 back = quaternion_from_directors(directors_from_quaternion(q));
            EXPECT_GE(back[0], 0);
            EXPECT_NEAR(norm(back), 1, 1e-15);
            EXPECT_LT(std::min(largest(back - q), largest(back + q)), 1e-15);
        }
    }
}

TEST(Orientation, QuaternionPartsAreWXYZAndTurnBodyToWorld)
{
    const double half = std::sqrt(0.5);   // a quarter turn about z takes x to y
    const Matrix3 D = directors_from_quaternion({half, 0, 0, half});
    EXPECT_LT(largest(D.column(0) - Vector3{0, 1, 0}), 1e-15);
    EXPECT_LT(largest(D.column(1) - Vector3{-1, 0, 0}), 1e-15);
    const Matrix3 same = directors_from_rotation_vector({0, 0, std::numbers::pi / 2});
    EXPECT_LT(largest(D - same), 1e-15);
}

TEST(Orientation, QuaternionsOfAnySizeAreNormalised)
{
    const Matrix3 D = directors_from_quaternion({1, 2, 3, 4});
    EXPECT_LT(largest(directors_from_quaternion({1e-300, 2e-300, 3e-300, 4e-300}) - D), 1e-15);
    EXPECT_LT(largest(directors_from_quaternion({1e300, 2e300, 3e300, 4e300}) - D), 1e-15);
    EXPECT_EQ(directors_from_quaternion({5, 0, 0, 0}), identity<3>());
    expect_complaint([] { directors_from_quaternion({0, 0, 0, 0}); }, "quaternion-zero");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_complaint([=] { directors_from_quaternion({nan, 0, 0, 1}); }, "quaternion-zero");
    expect_complaint([=] { directors_from_quaternion({1, 0, nan, 1}); }, "quaternion-zero");
}

TEST(Orientation, RotationVectorsTurnAboutThemselves)
{
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const Vector3 axis = random.unit();
        const double angle = 3 * random.number();
        const Matrix3 D = directors_from_rotation_vector(angle * axis);
        EXPECT_LT(largest(D * axis - axis), 1e-15);
        EXPECT_NEAR(trace(D), 1 + 2 * std::cos(angle), 2e-15);
        // sin(angle) axis is the skew part; it tells the sense.
        const Vector3 skew{D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1)};
        EXPECT_LT(largest(0.5 * skew - std::sin(angle) * axis), 1e-15);
    }
    EXPECT_EQ(directors_from_rotation_vector({}), identity<3>());
    const Matrix3 tiny = directors_from_rotation_vector({1e-200, 0, 0});
    EXPECT_EQ(tiny(2, 1), 1e-200);
}

TEST(Orientation, PlanarRotationsStayPlanarToTheBit)
{
    for (const double angle : {0.1, 1.0, 2.5, -3.0}) {
        const Matrix3 D = project_directors(directors_from_rotation_vector({0, angle, 0}));
        for (const int i : {0, 2}) EXPECT_TRUE(D(1, i) == 0 && D(i, 1) == 0) << angle;
        EXPECT_EQ(D(1, 1), 1);
    }
}

TEST(Orientation, ProjectionIsThePolarFactor)
{
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        // R times a symmetric positive definite stretch: R is the polar factor by construction.
        const Matrix3 R = random.rotation(), Q = random.rotation();
        const Matrix3 U = Q * Matrix3{1 + 0.9 * random.number(), 0, 0, 0, 1.5, 0, 0, 0, 0.3} * transpose(Q);
        const Matrix3 D = project_directors(R * U);
        EXPECT_LT(largest(D - R), 1e-14);
        EXPECT_LT(gap_of(D), 1e-15);
    }
}

TEST(Orientation, ProjectionIsOrthonormalToTheLastBitsEvenFarAway)
{
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        for (const double size : {1e-12, 1e-3, 1.0, 1e8}) {
            const Matrix3 D = project_directors(size * random.matrix<3, 3>());
            EXPECT_LT(gap_of(D), 2e-14);
        }
        const Matrix3 near = random.rotation() + 1e-8 * random.matrix<3, 3>();
        EXPECT_LT(gap_of(project_directors(near)), 1e-15);
    }
    Matrix3 flat = identity<3>();
    flat(2, 2) = 0;   // singular: any of the factors, but a triad
    EXPECT_LT(gap_of(project_directors(flat)), 1e-15);
    EXPECT_LT(gap_of(project_directors(Matrix3{})), 1e-15);
}

TEST(Rate, SpinsDirectorsAndIsFoundAgain)
{
    Random random(6);
    for (int i = 0; i < 500; ++i) {
        const Matrix34 X = random.rigid();
        const Vector3 v = random.vector(), w = random.vector();
        const Matrix34 V = rate(X, v, w);
        EXPECT_EQ(V.column(0), v);
        for (int a = 1; a < 4; ++a) EXPECT_EQ(V.column(a), cross(w, X.column(a)));
        EXPECT_LT(largest(angular_velocity(X, V) - w), 2e-15);
    }
}

TEST(Rate, AngularVelocityIsTheBestFitOfRatesThatDeform)
{
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const Matrix34 X = random.skew(), V = random.matrix<3, 4>();
        const Vector3 w = angular_velocity(X, V);
        const auto misfit = [&](const Vector3& trial) {
            double sum = 0;
            for (int a = 1; a < 4; ++a) {
                const Vector3 gap = cross(trial, X.column(a)) - V.column(a);
                sum += dot(gap, gap);
            }
            return sum;
        };
        for (int k = 0; k < 6; ++k) {
            Vector3 other = w;
            other[k % 3] += k < 3 ? 1e-3 : -1e-3;
            EXPECT_GT(misfit(other), misfit(w));
        }
    }
    EXPECT_EQ(angular_velocity(Matrix34{1, 2, 3}, Matrix34{4, 5, 6}), Vector3{})
        << "a point mass does not turn";
}

TEST(Body, CarriesMassMatrixPlacementAndRates)
{
    Random random(8);
    Placement placement;
    placement.position = random.vector();
    placement.directors = random.rotation();
    placement.velocity = random.vector();
    placement.angular_velocity = random.vector();
    const MassProperties properties = with_center(box(2, {1, 2, 3}), {0.1, 0.2, 0.3});
    const Body body = rigid_body("brick", properties, placement);
    EXPECT_FALSE(body.is_point);
    EXPECT_EQ(body.mass, mass_matrix(properties));
    EXPECT_EQ(body.X.column(0), placement.position);
    EXPECT_LT(largest(directors(body.X) - placement.directors), 2e-15);
    EXPECT_EQ(body.V, rate(body.X, placement.velocity, placement.angular_velocity));
}

TEST(Body, DirectorsAreOrthonormalisedWithinTheBoundAndRefusedBeyond)
{
    const MassProperties cube = box(1, {1, 1, 1});
    Placement placement;
    placement.directors(0, 1) = 0.9e-10;
    EXPECT_LT(gap_of(directors(rigid_body("a", cube, placement).X)), 1e-15);
    placement.directors(0, 1) = 1.1e-10;
    expect_complaint([&] { rigid_body("a", cube, placement); }, "directors-not-orthonormal",
                     "body[a].directors");
    placement.directors = Matrix3{1, 0, 0, 0, 1, 0, 0, 0, -1};
    expect_complaint([&] { rigid_body("a", cube, placement); }, "directors-left-handed", "body[a].directors");
    placement.directors = Matrix3{2, 0, 0, 0, 1, 0, 0, 0, 1};
    expect_complaint([&] { rigid_body("a", cube, placement); }, "directors-not-orthonormal");
    placement.directors(0, 0) = std::numeric_limits<double>::quiet_NaN();
    expect_complaint([&] { rigid_body("a", cube, placement); }, "not-finite", "body[a].directors");
}

TEST(Body, NumbersMustBeFinite)
{
    const MassProperties cube = box(1, {1, 1, 1});
    const double inf = std::numeric_limits<double>::infinity();
    expect_complaint(
        [&] {
            rigid_body("a", cube, {.position = {inf, 0, 0}});
        },
        "not-finite", "body[a].position");
    expect_complaint(
        [&] {
            rigid_body("a", cube, {.velocity = {0, inf, 0}});
        },
        "not-finite", "body[a].velocity");
    expect_complaint(
        [&] {
            rigid_body("a", cube, {.angular_velocity = {0, 0, inf}});
        },
        "not-finite", "body[a].angular_velocity");
    expect_complaint([&] { point_mass("a", 1, {inf, 0, 0}); }, "not-finite", "body[a].position");
    expect_complaint([&] { point_mass("a", 0, {}); }, "mass-not-positive", "body[a].mass");
}

TEST(Body, PointMassIsZeroOutsideTheFirstColumn)
{
    const Body body = point_mass("ball", 3, {1, 2, 3}, {4, 5, 6});
    EXPECT_TRUE(body.is_point);
    EXPECT_EQ(body.mass, Matrix4{3});
    EXPECT_EQ(body.X, (Matrix34{1, 2, 3}));
    EXPECT_EQ(body.V, (Matrix34{4, 5, 6}));
}

}   // namespace
}   // namespace livens::body_test
