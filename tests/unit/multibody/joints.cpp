// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/joints.h"

#include <gtest/gtest.h>

#include <limits>

#include "livens/multibody/body.h"
#include "livens/multibody/joints/spline_curve.h"
#include "unit/multibody/random_states.h"

namespace livens::joints_test {
namespace {

std::vector<double> values(const Joint& joint, const Matrix34& X_first, const Matrix34& X_second)
{
    std::vector<Matrix34> X(static_cast<std::size_t>(std::max(joint.first, joint.second)) + 1);
    if (joint.first != world) X[static_cast<std::size_t>(joint.first)] = X_first;
    X[static_cast<std::size_t>(joint.second)] = X_second;
    std::vector<double> phi;
    for (const ConstraintRow& row : joint.rows) phi.push_back(constraint_value(row, X));
    return phi;
}

std::vector<std::string> labels(const Joint& joint)
{
    std::vector<std::string> all;
    for (const ConstraintRow& row : joint.rows) all.push_back(row.label);
    return all;
}

using Labels = std::vector<std::string>;

TEST(JointFrame, GivesTheSamePlaceInBothBodies)
{
    Random random(1);
    for (int n = 0; n < 200; ++n) {
        const Matrix34 X = random.rigid(), Y = random.rigid();
        const Vector3 at = random.vector(), axis = random.unit();
        const JointFrame frame = joint_frame(X, Y, at, axis);
        EXPECT_LT(largest(X * point(frame.point_first) - at), 3e-15);
        EXPECT_LT(largest(Y * point(frame.point_second) - at), 3e-15);
        EXPECT_LT(largest(X * direction(frame.axis_first) - axis), 3e-15);
        EXPECT_LT(largest(Y * direction(frame.axis_second) - axis), 3e-15);
    }
    const JointFrame frame = joint_frame(world_configuration, random.rigid(), {1, 2, 3}, {0, 1, 0});
    EXPECT_EQ(frame.point_first, (Vector3{1, 2, 3})) << "world coordinates if it is the world";
    EXPECT_EQ(frame.axis_first, (Vector3{0, 1, 0}));
}

TEST(Revolute, LeavesTheTurnAboutItsAxisFreeAndNoOther)
{
    Random random(2);
    for (int n = 0; n < 100; ++n) {
        const Matrix34 X = random.rigid(), Y = random.rigid();
        const Vector3 at = random.vector(), axis = random.unit();
        const Joint joint = revolute("hinge", 0, 1, joint_frame(X, Y, at, axis));
        const auto turned = [&](const Vector3& w) {
            const Matrix3 R = directors_from_rotation_vector(w);
            return configuration(at + R * (Y.column(0) - at), R * directors(Y));
        };
        for (const double phi : values(joint, X, turned(1.3 * axis))) EXPECT_NEAR(phi, 0, 4e-15);
        Vector3 across = cross(axis, random.unit());
        across *= 0.5 / norm(across);
        const std::vector<double> phi = values(joint, X, turned(across));
        EXPECT_NEAR(std::hypot(phi[3], phi[4]), std::sin(0.5), 1e-14)
            << "the two rows see the axis' inclination";
    }
}

TEST(Revolute, UsesCoordinateAxesForACoordinateAxis)
{
    for (int k = 0; k < 3; ++k)
        for (const double length : {1.0, -1.0, 7.0, 1e-200}) {
            JointFrame frame;
            frame.axis_first = frame.axis_second = {};
            frame.axis_first[k] = frame.axis_second[k] = length;
            const Joint joint = revolute("hinge", 0, 1, frame);
            for (const int r : {3, 4})
                for (const double entry : joint.rows[r].c_ij.a)
                    EXPECT_TRUE(entry == 0 || std::abs(entry) == 1) << k << " " << length;
        }
}

TEST(Revolute, RowsAreLabelledAndScaled)
{
    const Joint joint = revolute("hinge", 0, 1, {}, 2.5);
    EXPECT_EQ(labels(joint), (Labels{"x", "y", "z", "axis 1", "axis 2"}));
    for (int r = 0; r < 5; ++r) EXPECT_EQ(joint.rows[r].scale, r < 3 ? 2.5 : 1.0);
    EXPECT_EQ(joint.type, "revolute");
}

TEST(Weld, HoldsEverythingAsItIsNow)
{
    Random random(3);
    for (int n = 0; n < 100; ++n) {
        const Matrix34 X = random.rigid(), Y = random.rigid();
        const Joint joint = weld("glue", 0, 1, joint_frame(X, Y, random.vector()), X, Y);
        EXPECT_EQ(labels(joint), (Labels{"x", "y", "z", "axis 1", "axis 2", "axis 3"}));
        for (const double phi : values(joint, X, Y)) EXPECT_NEAR(phi, 0, 3e-15);
        // A turn w about the joint point is seen whole, to first order: each row sees one component.
        const Vector3 w = 1e-6 * random.unit();
        const Matrix34 Z = configuration(Y.column(0), directors_from_rotation_vector(w) * directors(Y));
        const std::vector<double> phi = values(joint, X, Z);
        EXPECT_NEAR(std::hypot(phi[3], phi[4], phi[5]), 1e-6, 1e-11);
    }
}

TEST(Weld, OfBodiesThatStandAsTheWorldHasExactRows)
{
    const Joint joint = weld("glue", 0, 1, {}, world_configuration, world_configuration);
    for (const double phi : values(joint, world_configuration, world_configuration)) EXPECT_EQ(phi, 0);
}

TEST(Universal, HoldsTwoAxesPerpendicular)
{
    JointFrame frame;
    frame.axis_first = {0, 3, 0};
    frame.axis_second = {2, 0, 0};
    const Joint joint = universal("cross", 0, 1, frame);
    EXPECT_EQ(labels(joint), (Labels{"x", "y", "z", "axis 1"}));
    const Matrix34 X = world_configuration;
    EXPECT_EQ(values(joint, X, X)[3], 0);
    const Matrix34 Y = configuration({}, directors_from_rotation_vector({0, 0, 0.3}));
    EXPECT_NEAR(values(joint, X, Y)[3], std::sin(0.3), 1e-15) << "axes are normalised";
}

TEST(Spherical, HoldsThePointAlone)
{
    const Joint joint = spherical("ball", 0, 1, {{1, 0, 0}, {0, 1, 0}}, 3);
    EXPECT_EQ(labels(joint), (Labels{"x", "y", "z"}));
    const std::vector<double> phi = values(joint, world_configuration, world_configuration);
    EXPECT_EQ(phi, (std::vector<double>{-1, 1, 0})) << "second minus first";
    EXPECT_EQ(joint.rows[0].scale, 3);
}

TEST(Rod, HoldsHalfTheSquareOfItsLength)
{
    const Joint joint = rod("stick", 0, 1, {{1, 0, 0}, {0, 2, 0}}, 2);
    EXPECT_EQ(labels(joint), Labels{"distance"});
    EXPECT_DOUBLE_EQ(values(joint, world_configuration, world_configuration)[0], 0.5 * (5 - 4));
    EXPECT_EQ(joint.rows[0].scale, 4) << "a squared length";
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        expect_complaint([=] { rod("stick", 0, 1, {}, bad); }, "rod-length", "joint[stick]");
}

TEST(Joint, WithTheWorldSecondIsTurnedRound)
{
    Random random(4);
    const Matrix34 X = random.rigid();
    const Vector3 at = random.vector(), axis = random.unit();
    const JointFrame there = joint_frame(X, world_configuration, at, axis);
    for (const Joint& joint : {revolute("a", 3, world, there), spherical("a", 3, world, there),
                               weld("a", 3, world, there, X, world_configuration)}) {
        EXPECT_EQ(joint.first, world);
        EXPECT_EQ(joint.second, 3);
        EXPECT_EQ(joint.point_first, at);
        EXPECT_LT(largest(X * point(joint.point_second) - at), 3e-15);
        for (const double phi : values(joint, world_configuration, X))
            EXPECT_NEAR(phi, 0, 4e-15) << joint.type;
    }
}

TEST(Joint, RefusesItselfZeroAxesAndNumbersThatAreNone)
{
    expect_complaint([] { spherical("j", 2, 2, {}); }, "joint-self", "joint[j]");
    expect_complaint([] { weld("j", world, world, {}, {}, {}); }, "joint-self", "joint[j]");
    JointFrame frame;
    frame.axis_second = {0, 0, 0};
    expect_complaint([&] { revolute("j", 0, 1, frame); }, "axis-zero", "joint[j]");
    expect_complaint([&] { universal("j", 0, 1, frame); }, "axis-zero", "joint[j]");
    EXPECT_NO_THROW(spherical("j", 0, 1, frame)) << "a ball joint has no axis";
    frame.axis_second = {0, std::numeric_limits<double>::quiet_NaN(), 0};
    expect_complaint([&] { revolute("j", 0, 1, frame); }, "not-finite", "joint[j]");
    frame.point_first[0] = std::numeric_limits<double>::infinity();
    expect_complaint([&] { spherical("j", 0, 1, frame); }, "not-finite", "joint[j]");
    expect_complaint([] { spherical("j", 0, 1, {}, 0); }, "joint-scale", "joint[j]");
}

TEST(Joint, SlotKeepsItsWholeCurveToBeDrawn)
{
    const std::vector<Vector3> points{{-0.3, 0.3, 0}, {0, 0.3, 0.1}, {0.3, 0.45, 0}};
    for (const bool is_closed : {false, true}) {
        Matrix34 X = world_configuration;
        X.set_column(0, points[1]);
        const Joint joint = slot("s", world, 0, spline_curve(points, is_closed), {}, world_configuration, X);
        ASSERT_GT(joint.path.size(), 100u);
        EXPECT_LT(norm(joint.path.front() - points.front()), 1e-15);
        EXPECT_LT(norm(joint.path.back() - (is_closed ? points.front() : points.back())), 1e-12);
        double nearest = 1;
        for (const Vector3& place : joint.path) {
            nearest = std::min(nearest, norm(place - points[1]));
            X.set_column(0, place);
            for (const double phi : values(joint, world_configuration, X)) EXPECT_NEAR(phi, 0, 1e-12);
        }
        EXPECT_LT(nearest, 0.01) << "it goes through the points";
    }
}

}   // namespace
}   // namespace livens::joints_test
