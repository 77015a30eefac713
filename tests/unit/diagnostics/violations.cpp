// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "livens/base/error.h"
#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::violations_test {
namespace {

using hand_made::mesh;
using hand_made::motion;

/// A body on a ball joint at its end turns about z, and a point mass hangs from it by a rod of 2 m.
struct Arm {
    Model model;
    static constexpr double spin = 2;

    Arm()
    {
        Placement place;
        place.position = {0.5, 0, 0};
        model.add_body(rigid_body("arm", box(1, {1, 0.1, 0.1}), place));
        model.add_body(point_mass("bob", 1, {1, 0, -2}));
        model.add_joint(spherical("ball", world, 0, {{0, 0, 0}, {-0.5, 0, 0}, {0, 0, 1}, {0, 0, 1}}));
        model.add_joint(rod("rod", 0, 1, {{0.5, 0, 0}, {}, {0, 0, 1}, {0, 0, 1}}, 2));
    }
    State at(double t) const
    {
        const Matrix3 d = directors_from_rotation_vector({0, 0, spin * t});
        const Vector3 tip = d.column(0), w{0, 0, spin};
        const Matrix34 X = configuration(0.5 * tip, d);
        Matrix34 bob{}, v{};
        bob.set_column(0, tip + Vector3{0, 0, -2});
        v.set_column(0, cross(w, tip));
        return {t, {X, bob}, {rate(X, cross(w, 0.5 * tip), w), v}};
    }
    Motion turn(int degree) const
    {
        return motion(model, mesh(0, 1, 4), degree, [this](double t) { return at(t); });
    }
};

TEST(Violations, OfAnExactMotionVanishAtNodes)
{
    const Arm arm;
    const ViolationReport v = violations(arm.model, arm.turn(3));
    EXPECT_LT(v.joints_at_nodes, 1e-15);
    EXPECT_LT(v.rigidity_at_nodes, 1e-15);
    EXPECT_LT(v.velocity_level, 1e-15);
}

TEST(Violations, BetweenNodesFallWithTheDegree)
{
    const Arm arm;
    const ViolationReport coarse = violations(arm.model, arm.turn(2)),
                          fine = violations(arm.model, arm.turn(6));
    EXPECT_GT(coarse.rigidity_between, 1e-5);
    EXPECT_LT(fine.rigidity_between, 1e-8);
    EXPECT_LT(coarse.joints_between, 1e-15);   // all joints are linear in this motion
    EXPECT_EQ(violations(arm.model, arm.turn(2), 0).rigidity_between, 0);
}

TEST(Violations, NameTheWorstRowAndItsInstant)
{
    const Arm arm;
    Motion turn = arm.turn(2);
    turn.X.coefficient(2, 1)[12 + 2] -= 1e-3;   // the bob, a millimetre lower in the middle of element 2
    turn.X.coefficient(1, 0)[2] += 1e-4;        // the arm, a tenth of it off its ball joint
    const ViolationReport v = violations(arm.model, turn);
    EXPECT_EQ(v.worst_row, 3);   // the rod
    EXPECT_EQ(v.worst_time, 0.625);
    // 1/2 (l^2 - 4) / 4 with l = 2.001
    EXPECT_NEAR(v.joints_at_nodes, 0.5 * (2.001 * 2.001 - 4) / 4, 1e-12);
    EXPECT_GT(v.joints_between, 1e-4);
    EXPECT_LT(v.rigidity_at_nodes, 1e-15);
}

TEST(Violations, AreRelativeToTheRowsScale)
{
    Model model;
    model.add_body(point_mass("bob", 1, {0, 0, 0}));
    model.add_joint(spherical("ball", world, 0, {}, 10));
    const Motion off = motion(model, mesh(0, 1, 1), 1, [](double t) {
        return hand_made::state_of_point(t, {0, 0.5, 0}, {0, 0, 3});
    });
    const ViolationReport v = violations(model, off);
    EXPECT_DOUBLE_EQ(v.joints_at_nodes, 0.05);
    EXPECT_EQ(v.worst_row, 1);
    EXPECT_DOUBLE_EQ(v.velocity_level, 0.3);
    EXPECT_EQ(v.rigidity_at_nodes, 0);   // a point mass has no directors to be orthonormal
}

TEST(Violations, SeeEveryEntryOfTheMetric)
{
    const Arm arm;
    for (int i = 1; i < 4; ++i) {
        for (int j = 1; j < 4; ++j) {
            Motion turn = arm.turn(2);
            const std::span<double> x = turn.X.coefficient(0, 0);   // here d_j = e_j
            x[3 * i + (j - 1)] += 1e-6;
            const double exact = i == j ? 1e-6 : 0.5e-6;
            EXPECT_NEAR(violations(arm.model, turn).rigidity_at_nodes, exact, 1e-11) << i << j;
        }
    }
}

TEST(Violations, OfVelocitiesAreSeenAtBothBodies)
{
    const Arm arm;
    Motion turn = arm.turn(2);
    turn.velocities[2 * 3](2, 0) += 1e-3;   // the arm's reference point off its joint, along z
    EXPECT_NEAR(violations(arm.model, turn).velocity_level, 1e-3, 1e-12);
    turn = arm.turn(2);
    turn.velocities[2 * 3 + 1](2, 0) += 1;   // the bob along the rod: 1 m/s times 2 m over (2 m)^2
    EXPECT_NEAR(violations(arm.model, turn).velocity_level, 0.5, 1e-12);
}

TEST(Violations, OfARodAreTheRateAtWhichItsEndsPart)
{
    Model model;
    model.add_body(point_mass("a", 1, {0, 0, 0}));
    model.add_body(point_mass("b", 1, {0, 0, -2}));
    model.add_joint(rod("rod", 0, 1, {}, 2));
    const auto with_velocities = [&](const Vector3& v_a, const Vector3& v_b) {
        return motion(model, mesh(0, 1, 1), 1, [&](double t) {
            State s = hand_made::state_of_point(t, {0, 0, 0}, v_a);
            const State b = hand_made::state_of_point(t, {0, 0, -2}, v_b);
            s.X.push_back(b.X[0]);
            s.V.push_back(b.V[0]);
            return s;
        });
    };
    EXPECT_EQ(violations(model, with_velocities({1, 0, 3}, {0, 5, 3})).velocity_level, 0);
    EXPECT_EQ(violations(model, with_velocities({0, 0, 3}, {0, 0, 2.5})).velocity_level, 0.5 * 2 / 4);
}

TEST(Violations, AreSeenOnBothSidesOfAJump)
{
    const Arm arm;
    const Motion whole = arm.turn(3);
    Motion torn = whole;
    torn.X = hand_made::torn_field(whole.mesh, 24, 3, [&](int, double t) {
        std::vector<double> all;
        for (const Matrix34& X : arm.at(t).X) all.insert(all.end(), X.a, X.a + 12);
        return all;
    });
    EXPECT_LT(violations(arm.model, torn).joints_at_nodes, 1e-15);
    for (const int last : {0, 3}) {   // the first node of element 2 and the last of element 1
        Motion off = torn;
        off.X.coefficient(last == 0 ? 2 : 1, last)[2] += 1e-4;   // the arm off its ball joint, along z
        const ViolationReport v = violations(arm.model, off);
        EXPECT_NEAR(v.joints_at_nodes, 1e-4, 1e-15);
        EXPECT_EQ(v.worst_row, 2);
        EXPECT_EQ(v.worst_time, 0.5);
    }
}

TEST(Violations, OfARationalMotionAreThoseOfTheQuotient)
{
    // A quarter of a circle as a rational parabola lies on it everywhere; without denominators it does not.
    Model model;
    model.add_body(point_mass("bob", 3, {1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    Motion arc = motion(model, mesh(0, 2, 1), 2, [](double t) {
        const double s = t / 2, W = 1 + s * s;
        return hand_made::state_of_point(t, {(1 - s * s) / W, 2 * s / W, 0}, {});
    });
    const ViolationReport parabola = violations(model, arc);
    EXPECT_GT(parabola.joints_between, 1e-3);
    EXPECT_GT(parabola.joints_weakly, 1e-3);
    for (const double s : gauss_lobatto(3).points) arc.X.denominators.push_back(1 + s * s);
    EXPECT_LT(violations(model, arc).joints_between, 1e-15);
    EXPECT_LT(violations(model, arc).joints_weakly, 1e-15);
}

TEST(Violations, HeldWeaklyAreMeansOverElements)
{
    // A point that should stay at the origin swings about it: s - 1/2 has mean 0, s^2 has mean 1/3.
    Model model;
    model.add_body(point_mass("bob", 1, {}));
    model.add_joint(spherical("ball", world, 0, {}, 10));
    const Motion off = motion(model, mesh(0, 2, 1), 2, [](double t) {
        const double s = t / 2;
        return hand_made::state_of_point(t, {s - 0.5, -0.3 * s * s, 0}, {});
    });
    const ViolationReport v = violations(model, off);
    EXPECT_NEAR(v.joints_weakly, 0.1 / 10, 1e-16);
    EXPECT_NEAR(v.joints_at_nodes, 0.05, 1e-16);
    EXPECT_EQ(v.rigidity_weakly, 0);
}

TEST(Violations, OfRigidityHeldWeaklyAreExactIntegrals)
{
    // Directors on a chord: 1/2 (|d|^2 - 1) = -2 sin^2(a / 2) s (1 - s), with mean -1/3 sin^2(a / 2).
    Model model;
    model.add_body(rigid_body("body", box(1, {1, 1, 1})));
    const double angle = 0.2;
    const Motion chord = motion(model, mesh(0, 1, 1), 1, [&](double t) {
        return State{t, {configuration({}, directors_from_rotation_vector({0, 0, angle * t}))}, {Matrix34{}}};
    });
    const double sine = std::sin(angle / 2);
    const ViolationReport v = violations(model, chord);
    EXPECT_NEAR(v.rigidity_weakly, sine * sine / 3, 1e-16);
    EXPECT_LT(v.rigidity_at_nodes, 1e-15);
    // Moved outwards so that the mean vanishes, as the weak form would have it.
    const double larger = 1 / std::sqrt(1 - 2.0 / 3 * sine * sine);
    Motion weak = chord;
    for (const int a : {0, 1})
        for (int i = 3; i < 9; ++i) weak.X.coefficient(0, a)[i] *= larger;
    EXPECT_LT(violations(model, weak).rigidity_weakly, 1e-15);
    EXPECT_GT(violations(model, weak).rigidity_at_nodes, 1e-3);
    EXPECT_GT(violations(model, weak).rigidity_between, 1e-3);
}

TEST(Violations, ANumberThatIsNoneIsAViolation)
{
    const Arm arm;
    Motion turn = arm.turn(2);
    turn.X.coefficient(1, 1)[0] = NAN;
    EXPECT_TRUE(std::isnan(violations(arm.model, turn).joints_at_nodes));
    EXPECT_TRUE(std::isnan(violations(arm.model, turn).joints_weakly));
    turn = arm.turn(2);
    turn.X.coefficient(1, 1)[5] = NAN;
    EXPECT_TRUE(std::isnan(violations(arm.model, turn).rigidity_at_nodes));
}

TEST(Violations, RefuseANegativeNumberOfSamples)
{
    const Arm arm;
    EXPECT_THROW(violations(arm.model, arm.turn(2), -1), InputError);
}

}   // namespace
}   // namespace livens::violations_test
