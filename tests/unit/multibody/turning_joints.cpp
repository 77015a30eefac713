// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of universal and ball joints against turns that are put together from them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "livens/multibody/joints.h"
#include "livens/multibody/sensors.h"
#include "unit/multibody/random_states.h"

namespace livens::turning_joints_test {
namespace {

constexpr double pi = std::numbers::pi;

Matrix3 about(const Vector3& axis, double angle) { return directors_from_rotation_vector(angle * axis); }

/// Two bodies that are placed anywhere, a cross between them, and where they stand for two angles of it.
struct Cross {
    Matrix34 first, second;
    Vector3 a, b;   // axes in the world, as placed
    Joint joint;

    Cross(Random& random, int i, int j)
    {
        first = i == world ? world_configuration : random.rigid();
        second = j == world ? world_configuration : random.rigid();
        a = random.unit();
        b = cross(a, random.unit());
        b *= 1 / norm(b);
        JointFrame frame = joint_frame(first, second, random.vector(), a);
        frame.axis_second = joint_frame(first, second, {}, b).axis_second;
        joint = universal("cross", i, j, frame);
    }
    /// Of bodies 0 and 1 (or the world), turned by a common turn as well; the world stays.
    std::vector<Matrix34> at(int i, int j, double angle_1, double angle_2) const
    {
        const Matrix3 turn = about(a, angle_1) * about(b, angle_2);
        std::vector<Matrix34> X(2);
        if (j == world) {   // the first body is turned back instead
            X[static_cast<std::size_t>(i)] = configuration({}, transpose(turn) * directors(first));
            return X;
        }
        if (i != world) X[static_cast<std::size_t>(i)] = first;
        X[static_cast<std::size_t>(j)] = configuration({}, turn * directors(second));
        return X;
    }
};

double changed(const NamedCoordinate& q, const std::vector<Matrix34>& from, const std::vector<Matrix34>& to)
{
    return coordinate_change(q.coordinate, from, to);
}

TEST(TurningJoints, TheAnglesOfACrossAreThoseThatItWasTurnedBy)
{
    Random random(3);
    for (int n = 0; n < 200; ++n)
        for (const auto& [i, j] :
             {std::pair(0, 1), std::pair(1, 0), std::pair(world, 0), std::pair(0, world)}) {
            const Cross of(random, i, j);
            ASSERT_EQ(of.joint.coordinates.size(), 2u);
            EXPECT_EQ(of.joint.coordinates[0].name, "angle_1");
            EXPECT_EQ(of.joint.coordinates[1].name, "angle_2");
            const double one = pi * random.number(), two = pi * random.number();
            const std::vector<Matrix34> from = of.at(i, j, 0, 0), to = of.at(i, j, one, two);
            EXPECT_NEAR(std::remainder(changed(of.joint.coordinates[0], from, to) - one, 2 * pi), 0, 1e-13);
            EXPECT_NEAR(std::remainder(changed(of.joint.coordinates[1], from, to) - two, 2 * pi), 0, 1e-13);
            for (const ConstraintRow& row : of.joint.rows)
                EXPECT_TRUE(row.label != "axis 1" || std::abs(constraint_value(row, to)) < 1e-14);
        }
}

TEST(TurningJoints, ACrossCountsTurnsAlongAWay)
{
    Random random(4);
    const Cross of(random, 0, 1);
    double one = 0, two = 0;
    std::vector<Matrix34> before = of.at(0, 1, 0, 0);
    for (int n = 1; n <= 400; ++n) {   // two turns forwards, five turns back
        const std::vector<Matrix34> now = of.at(0, 1, n * pi / 100, -n * pi / 40);
        one += changed(of.joint.coordinates[0], before, now);
        two += changed(of.joint.coordinates[1], before, now);
        before = now;
    }
    EXPECT_NEAR(one, 4 * pi, 1e-11);
    EXPECT_NEAR(two, -10 * pi, 1e-11);
}

/// A ball joint between bodies that are placed anywhere.
struct Ball {
    Matrix34 first, second;
    TriadPair triads;
    Joint joint;

    Ball(Random& random, int i, int j, const std::string& angles)
        : first(i == world ? world_configuration : random.rigid()),
          second(j == world ? world_configuration : random.rigid()), triads{random.rotation(),
                                                                            random.rotation()},
          joint(spherical("ball", i, j, joint_frame(first, second, {}), {triads, angles}, first, second))
    {}
    /// Where the second triad is turned by R from the first, in axes of the first.
    std::vector<Matrix34> at(int i, int j, const Matrix3& R) const
    {
        std::vector<Matrix34> X(2);
        const Matrix3 A = triads.first, B = triads.second;   // D1 A R = D2 B
        if (j == world) {
            X[static_cast<std::size_t>(i)] = configuration({}, B * transpose(A * R));
            return X;
        }
        if (i != world) X[static_cast<std::size_t>(i)] = first;
        X[static_cast<std::size_t>(j)] = configuration({}, directors(first) * A * R * transpose(B));
        return X;
    }
};

Vector3 axis_of(char letter)
{
    Vector3 e{};
    e[letter - 'x'] = 1;
    return e;
}

TEST(TurningJoints, ThreeAnglesPutTheTurnOfABallTogether)
{
    Random random(5);
    for (const std::string order : {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"})
        for (const auto& [i, j] :
             {std::pair(0, 1), std::pair(1, 0), std::pair(world, 0), std::pair(0, world)})
            for (int n = 0; n < 20; ++n) {
                const Ball of(random, i, j, order);
                const std::array<double, 3> angles{pi * random.number(), 1.5 * random.number(),
                                                   pi * random.number()};
                const Matrix3 R = about(axis_of(order[0]), angles[0]) * about(axis_of(order[1]), angles[1]) *
                                  about(axis_of(order[2]), angles[2]);
                const std::vector<Matrix34> X = of.at(i, j, R);
                for (std::size_t k = 0; k < 3; ++k) {
                    const NamedCoordinate& q = of.joint.coordinates[k];
                    EXPECT_EQ(q.name, "angle_" + std::to_string(k + 1));
                    EXPECT_NEAR(coordinate_value(q.coordinate, X), angles[k], 1e-13) << order << k;
                    EXPECT_TRUE(is_known(q.coordinate, X));
                }
            }
}

TEST(TurningJoints, ABallReadsItsRotationVector)
{
    Random random(6);
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(world, 0), std::pair(0, world)})
        for (int n = 0; n < 100; ++n) {
            const Ball of(random, i, j, "");
            EXPECT_TRUE(of.joint.coordinates.empty());
            const double angle = n == 0 ? 0 : n == 1 ? 1e-9 : 3.04 * std::abs(random.number());
            const Vector3 r = angle * random.unit();
            const std::vector<Matrix34> X = of.at(i, j, directors_from_rotation_vector(r));
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(coordinate_value(of.joint.readings[k].coordinate, X), r[static_cast<int>(k)],
                            1e-13);
            const JointCoordinate& length = of.joint.readings[3].coordinate;
            EXPECT_EQ(of.joint.readings[3].name, "rotation_angle");
            EXPECT_NEAR(coordinate_value(length, X), norm(r), 1e-13);
        }
}

TEST(TurningJoints, AreNotKnownWhereTheyAreNotUnique)
{
    Random random(7);
    const Ball of(random, 0, 1, "zyx");
    const auto at = [&](double middle) {
        return of.at(0, 1, about({0, 0, 1}, 0.3) * about({0, 1, 0}, middle) * about({1, 0, 0}, 0.2));
    };
    for (const NamedCoordinate& q : of.joint.coordinates) {
        EXPECT_TRUE(is_known(q.coordinate, at(1.55)));
        EXPECT_FALSE(is_known(q.coordinate, at(1.57)));
        EXPECT_FALSE(is_known(q.coordinate, at(-1.57)));
    }
    for (const NamedCoordinate& q : of.joint.readings) {
        EXPECT_TRUE(is_known(q.coordinate, of.at(0, 1, about({1, 0, 0}, 3.04))));
        EXPECT_FALSE(is_known(q.coordinate, of.at(0, 1, about({1, 0, 0}, 3.06))));
    }
    const Cross everywhere(random, 0, 1);
    for (const NamedCoordinate& q : everywhere.joint.coordinates)
        EXPECT_TRUE(is_known(q.coordinate, everywhere.at(0, 1, 3.1, 1.57))) << "negative control";
}

/// Gradients and second derivatives of all kinds against differences of fourth order.
TEST(TurningJoints, DerivativesMatchDifferences)
{
    using enum CoordinateKind;
    Random random(8);
    constexpr double h = 1e-3;
    for (const CoordinateKind kind :
         {displacement, angle, outer_angle, arc_sine, rotation_component, rotation_angle})
        for (int n = 0; n < 50; ++n) {
            SmoothFunction::Point q{};
            for (double& one : q)
                one = kind == arc_sine ? 0.8 * random.number() : 0.5 + 0.3 * random.number();
            const SmoothFunction::Value at = coordinate_at(kind, q);
            for (std::size_t k = 0; k < q.size(); ++k) {
                const auto moved = [&](double by) {
                    SmoothFunction::Point to = q;
                    to[k] += by;
                    return coordinate_at(kind, to);
                };
                const auto slope = [&](const auto& of) {
                    return (8 * (of(moved(h)) - of(moved(-h))) - (of(moved(2 * h)) - of(moved(-2 * h)))) /
                           (12 * h);
                };
                EXPECT_NEAR(at.gradient[k], slope([](const auto& v) { return v.value; }), 1e-8);
                for (std::size_t l = 0; l < q.size(); ++l)
                    EXPECT_NEAR(at.hessian[l][k], slope([l](const auto& v) { return v.gradient[l]; }), 1e-7);
            }
        }
}

TEST(TurningJoints, ASensorReadsCoordinatesAndReadings)
{
    Random random(9);
    const Sensor sensor = joint_sensor("s", Ball(random, 0, 1, "xyz").joint);
    ASSERT_EQ(sensor.components.size(), 21u);
    EXPECT_EQ(sensor.components[1].name, "angle_1_rate");
    EXPECT_EQ(sensor.components[9].name, "rotation_vector_x");
    EXPECT_EQ(sensor.components[18].name, "rotation_angle");
    EXPECT_EQ(sensor.components[18].unit, "rad");
}

TEST(TurningJoints, AnglesOfABallAreAboutThreeAxes)
{
    for (const char* angles : {"zxz", "xy", "xyzx", "abc"})
        expect_complaint(
            [&] {
                return spherical("b", 0, 1, {}, {{}, angles}, world_configuration, world_configuration);
            },
            "joint-angles", "joint[b].angles");
}

}   // namespace
}   // namespace livens::turning_joints_test
