// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/start/consistent_start.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "livens/base/error.h"
#include "violations.h"

namespace livens::assembly_test {
namespace {

MassProperties properties(double mass, const Vector3& center, const Vector3& inertia)
{
    Matrix3 J{};
    for (int i = 0; i < 3; ++i) J(i, i) = inertia[i];
    return {mass, center, J};
}

/// A brick with unequal moments, its reference point at the centre.
Body brick(const std::string& name, const Placement& placement = {})
{
    return rigid_body(name, properties(2, {0, 0, 0}, {0.1, 0.2, 0.25}), placement);
}

/// A bar from its reference point at `from` to `to`, in the plane y = 0, with d1 along it.
Body bar(const std::string& name, const Vector3& from, const Vector3& to)
{
    const Vector3 along = to - from;
    const double length = norm(along);
    const Vector3 d1 = (1 / length) * along, d2{0, 1, 0};
    Placement placement;
    placement.position = from;
    placement.directors.set_column(0, d1);
    placement.directors.set_column(1, d2);
    placement.directors.set_column(2, cross(d1, d2));
    const double m = 3 * length;
    return rigid_body(
        name,
        properties(m, {length / 2, 0, 0}, {m * 1e-3, m * length * length / 12, m * length * length / 12}),
        placement);
}

Matrix34 place(const Model& model, int body)
{
    return body == world ? world_configuration : model.bodies()[body].X;
}

JointFrame frame(const Model& model, int first, int second, const Vector3& at,
                 const Vector3& axis = {0, 1, 0})
{
    return joint_frame(place(model, first), place(model, second), at, axis);
}

/// Crank, coupler and rocker on four revolutes about y, the last about another axis if wanted.
Model four_bar(const Vector3& last_axis = {0, 1, 0})
{
    Model model({0, 0, -9.81});
    const Vector3 A{0, 0, 0}, B{0.3, 0, 1}, C{2.2, 0, 1.7}, D{2, 0, 0};
    model.add_body(bar("crank", A, B));
    model.add_body(bar("coupler", B, C));
    model.add_body(bar("rocker", D, C));
    model.add_joint(revolute("a", world, 0, frame(model, world, 0, A)));
    model.add_joint(revolute("b", 0, 1, frame(model, 0, 1, B)));
    model.add_joint(revolute("c", 1, 2, frame(model, 1, 2, C)));
    model.add_joint(revolute("d", world, 2, frame(model, world, 2, D, last_axis)));
    return model;
}

Complaint complaint_of(const std::function<void()>& act)
{
    try {
        act();
    } catch (const InputError& error) {
        return error.complaint();
    }
    ADD_FAILURE() << "no InputError";
    return {};
}

Complaint refusal(const Model& model, const State& state, StartPolicy policy = StartPolicy::check)
{
    return complaint_of([&] { consistent_start(model, state, policy); });
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

Body posed(Body body, const Vector3& position, const Vector3& rotation, const Vector3& velocity,
           const Vector3& w)
{
    body.X = configuration(position, directors_from_rotation_vector(rotation));
    body.V = rate(body.X, velocity, w);
    return body;
}

// --- rank

TEST(ConsistentStart, CountsTheDegreesOfAFreeBodyAndAPointMass)
{
    Model model;
    model.add_body(brick("box"));
    model.add_body(point_mass("dot", 1, {1, 2, 3}));
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    EXPECT_EQ(assembly.degrees_of_freedom, 9);
    EXPECT_TRUE(assembly.independent.empty());
}

TEST(ConsistentStart, FindsThreeRedundantRowsInAFourBar)
{
    const Model model = four_bar();   // 20 rows
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    EXPECT_EQ(assembly.independent.size(), 17u);
    EXPECT_EQ(assembly.degrees_of_freedom, 1);
    ASSERT_EQ(assembly.redundant.size(), 3u);
    EXPECT_TRUE(std::ranges::is_sorted(assembly.independent));
    for (const int r : assembly.redundant)
        EXPECT_FALSE(std::binary_search(assembly.independent.begin(), assembly.independent.end(), r));
    ASSERT_FALSE(assembly.notes.empty());
    const int joint = model.row_joint(assembly.redundant[0]);
    EXPECT_CONTAINS(assembly.notes[0], "joint '" + model.joints()[joint].name);
    EXPECT_CONTAINS(assembly.notes[0], "reactions in this loop are not unique");
}

TEST(ConsistentStart, FourBarTiltedOutOfThePlaneHasFullRank)
{
    // Negative control: the same bars with one axis tilted cannot move, and nothing is redundant but two
    // rows.
    const Model model = four_bar({0.1, 1, 0});
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    EXPECT_EQ(assembly.independent.size(), 18u);
    EXPECT_EQ(assembly.degrees_of_freedom, 0);
}

TEST(ConsistentStart, RevoluteSphericalSphericalRevoluteHasTwoDegreesAndNoRedundancy)
{
    Model model;
    const Vector3 A{0, 0, 0}, B{0.3, 0, 1}, C{2.2, 0.4, 1.7}, D{2, 0.4, 0};
    model.add_body(bar("crank", A, B));
    model.add_body(posed(brick("coupler"), 0.5 * (B + C), {0.2, -0.4, 0.3}, {}, {}));
    model.add_body(bar("rocker", D, {2.2, 0.4, 1.7}));
    model.add_joint(revolute("a", world, 0, frame(model, world, 0, A)));
    model.add_joint(spherical("b", 0, 1, frame(model, 0, 1, B)));
    model.add_joint(spherical("c", 1, 2, frame(model, 1, 2, C)));
    model.add_joint(revolute("d", world, 2, frame(model, world, 2, D)));
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    EXPECT_EQ(model.n_rows(), 16);
    EXPECT_EQ(assembly.independent.size(), 16u);
    EXPECT_EQ(assembly.degrees_of_freedom, 2);
}

TEST(ConsistentStart, DropsTheLaterOfTwoEqualBallJoints)
{
    Model model;
    model.add_body(brick("box"));
    model.add_joint(spherical("first", world, 0, frame(model, world, 0, {0.3, 0.1, -0.2})));
    model.add_joint(spherical("second", world, 0, frame(model, world, 0, {0.3, 0.1, -0.2})));
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    EXPECT_EQ(assembly.independent, (std::vector<int>{0, 1, 2}));
    ASSERT_EQ(assembly.redundant.size(), 3u);
    ASSERT_EQ(assembly.notes.size(), 1u);
    EXPECT_CONTAINS(assembly.notes[0], "joint 'second' is redundant (all of its 3 constraints: x, y, z)");
}

TEST(ConsistentStart, RankDoesNotDependOnUnitsNorOnMasses)
{
    for (const double unit : {1e-6, 1.0, 1e6}) {
        for (const double light : {1e-6, 1.0, 1e6}) {
            Model model;
            const MassProperties one =
                properties(1, {0.5 * unit, 0, 0}, unit * unit * Vector3{0.01, 0.1, 0.1});
            model.add_body(rigid_body("a", one));
            Placement next;
            next.position = {unit, 0, 0};
            model.add_body(rigid_body("b", with_mass(one, light), next));
            const Vector3 hinge{unit, 0, 0};
            model.add_joint(spherical("s", world, 0, frame(model, world, 0, {0, 0, 0}), unit));
            model.add_joint(revolute("r", 0, 1, frame(model, 0, 1, hinge), unit));
            model.add_joint(spherical("again", 0, 1, frame(model, 0, 1, hinge), unit));
            const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
            EXPECT_EQ(assembly.independent.size(), 8u) << unit << ' ' << light;
            EXPECT_EQ(assembly.redundant.size(), 3u) << unit << ' ' << light;
        }
    }
}

// --- inertia

MassProperties needle() { return properties(1, {0.5, 0, 0}, {0, 1.0 / 12, 1.0 / 12}); }

TEST(ConsistentStart, RefusesTheFreeSpinOfANeedle)
{
    Model model;
    model.add_body(brick("box"));
    model.add_body(rigid_body("needle", needle()));
    model.add_joint(spherical("ball", world, 1, frame(model, world, 1, {0, 0, 0})));
    const Complaint c = refusal(model, model.start());
    EXPECT_EQ(c.code, "spin-without-inertia");
    EXPECT_EQ(c.path, "body[needle].inertia");
    EXPECT_CONTAINS(c.message, "'needle'");
    EXPECT_CONTAINS(c.value, "(1, 0, 0)");
    EXPECT_FALSE(c.help.empty());
}

TEST(ConsistentStart, AcceptsTheNeedleWhoseSpinAJointHolds)
{
    Model model;
    model.add_body(rigid_body("needle", needle()));
    model.add_joint(revolute("hinge", world, 0, frame(model, world, 0, {0, 0, 0}, {0, 1, 0})));
    EXPECT_EQ(consistent_start(model, model.start(), StartPolicy::check).degrees_of_freedom, 1);
    // About the needle's own axis the hinge leaves exactly the spin that carries nothing.
    Model along;
    along.add_body(rigid_body("needle", needle()));
    along.add_joint(revolute("hinge", world, 0, frame(along, world, 0, {0, 0, 0}, {1, 0, 0})));
    EXPECT_EQ(refusal(along, along.start()).code, "spin-without-inertia");
}

TEST(ConsistentStart, AcceptsSingularMassesOfBodiesWithInertiaAboutEveryAxis)
{
    // J1 + J2 = J3: a lamina, E = diag(2, 1, 0).
    Model model;
    model.add_body(rigid_body("lamina", properties(1, {0, 0, 0}, {1, 2, 3})));
    EXPECT_EQ(consistent_start(model, model.start(), StartPolicy::check).degrees_of_freedom, 6);
}

// --- positions

TEST(ConsistentStart, CheckNamesJointAndSizeOfAnOpenStart)
{
    Model model = four_bar();
    State start = model.start();
    start.X[2].a[0] += 1e-3;
    const Complaint c = refusal(model, start);
    EXPECT_EQ(c.code, "start-position");
    EXPECT_TRUE(c.path == "joint[c]" || c.path == "joint[d]") << c.path;
    EXPECT_CONTAINS(c.message, "row 'x'");
    EXPECT_CONTAINS(c.value, "0.001");
    EXPECT_CONTAINS(c.help, "projected onto the joints");
}

TEST(ConsistentStart, LeavesAConsistentStartUntouchedToTheBit)
{
    Model model;
    model.add_body(posed(brick("box"), {1, -2, 0.3}, {0.3, 0.2, -0.7}, {0, 0, 0}, {0, 0, 0}));
    model.add_joint(spherical("ball", world, 0, frame(model, world, 0, {1, -2, 0.3})));
    State start = model.start();
    start.V[0] = rate(start.X[0], {0, 0, 0}, {0.1, 2, -3});
    for (const StartPolicy policy : {StartPolicy::check, StartPolicy::project}) {
        const ConsistentStart assembly = consistent_start(model, start, policy);
        EXPECT_EQ(assembly.start.X, start.X);
        EXPECT_EQ(assembly.start.V, start.V);
        EXPECT_TRUE(assembly.notes.empty());
    }
}

TEST(ConsistentStart, LeavesConsistentVelocitiesOfAChainUntouchedToTheBit)
{
    // Rates that keep the joint by construction, at numbers that no second computation would meet to the bit.
    Model model;
    model.add_body(posed(brick("one"), {0.1, 0.2, 0.3}, {0.3, 0.2, -0.7}, {}, {}));
    model.add_body(posed(brick("two"), {0.1, 0.2, 0.3}, {-0.5, 0.1, 0.9}, {}, {}));
    model.add_joint(spherical("ball", 0, 1, frame(model, 0, 1, {0.1, 0.2, 0.3})));
    State start = model.start();
    start.V[0] = rate(start.X[0], {0.7, -0.1, 1.3}, {0.1, 2, -3});
    start.V[1] = rate(start.X[1], {0.7, -0.1, 1.3}, {0.9, -1.7, 0.3});
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_EQ(assembly.start.X, start.X);
    EXPECT_EQ(assembly.start.V, start.V);
    start.V[1].a[0] += 1e-10;   // negative control: here there is something to do
    EXPECT_NE(consistent_start(model, start, StartPolicy::project).start.V, start.V);
}

TEST(ConsistentStart, PolishesSmallViolationsToRoundingUnderCheck)
{
    const Model model = four_bar();
    State start = model.start();
    start.X[1].a[0] += 3e-10;
    start.X[1].a[2] -= 2e-10;
    ASSERT_GT(largest_violation(model, start), 1e-10);
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::check);
    EXPECT_LT(largest_violation(model, assembly.start), 2e-15);
    for (const std::string& note : assembly.notes) EXPECT_CONTAINS(note, "redundant (");
}

TEST(ConsistentStart, KeepsPlanarDataExactlyPlanar)
{
    const Model model = four_bar();
    for (const double size : {1e-10, 0.05}) {
        State start = model.start();
        start.X[1].a[0] += size;
        start.X[2].a[2] -= size;
        start.V[0] = rate(start.X[0], {0, 0, 0}, {0, 1, 0});
        const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
        EXPECT_LT(largest_violation(model, assembly.start), 3e-15);
        for (int b = 0; b < 3; ++b) {
            for (const Matrix34* m : {&assembly.start.X[b], &assembly.start.V[b]}) {
                EXPECT_EQ((*m)(1, 0), 0);
                EXPECT_EQ((*m)(1, 1), 0);
                EXPECT_EQ((*m)(1, 3), 0);
                EXPECT_EQ((*m)(0, 2), 0);
                EXPECT_EQ((*m)(2, 2), 0);
            }
            EXPECT_EQ(assembly.start.X[b](1, 2), 1);
        }
    }
}

TEST(ConsistentStart, ProjectionReachesRoundingFromFarInThreeDimensions)
{
    const Model model = four_bar();
    State start = model.start();
    start.X[0] = configuration({0.1, 0.05, -0.1}, directors_from_rotation_vector({0.1, -0.9, 0.2}));
    start.X[2] = configuration({2.1, -0.1, 0.1}, directors_from_rotation_vector({-0.1, -1.2, 0.15}));
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_LT(largest_violation(model, assembly.start), 1e-14);
    EXPECT_EQ(assembly.degrees_of_freedom, 1);
    EXPECT_FALSE(assembly.notes.empty());
    for (const Matrix34& X : assembly.start.X) {
        const Matrix3 D = directors(X);
        EXPECT_LT(norm(transpose(D) * D - identity<3>()), 1e-14);
    }
}

TEST(ConsistentStart, ProjectionComesBackFromLargeTurns)
{
    Model model;
    model.add_body(brick("box"));
    model.add_joint(weld("weld", world, 0, frame(model, world, 0, {0.4, 0.1, 0}), world_configuration,
                         model.bodies()[0].X));
    for (const Vector3& turn : {Vector3{0, 0, 1.4}, Vector3{0.9, -0.9, 0.3}}) {
        State start = model.start();
        start.X[0] = configuration({0.3, -1, 2}, directors_from_rotation_vector(turn));
        const State closed = consistent_start(model, start, StartPolicy::project).start;
        EXPECT_LT(largest_violation(model, closed), 1e-14);
        EXPECT_LT(norm(closed.X[0] - model.bodies()[0].X), 1e-13);
    }
}

TEST(ConsistentStart, ProjectionFindsTheNearestStateInTheMassMetric)
{
    // Two bodies of unequal mass on one rod that is too long: they share the gap in the inverse ratio of
    // their masses.
    Model model;
    model.add_body(point_mass("light", 1, {0, 0, 0}));
    model.add_body(point_mass("heavy", 3, {1.4, 0, 0}));
    model.add_joint(rod("rod", 0, 1, frame(model, 0, 1, {0, 0, 0}), 1));
    State start = model.start();
    start.V[0].a[0] = 1;
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_NEAR(assembly.start.X[0](0, 0), 0.3, 1e-12);
    EXPECT_NEAR(assembly.start.X[1](0, 0), 1.3, 1e-12);
    EXPECT_NEAR(assembly.start.V[0](0, 0), 0.25, 1e-14);
    EXPECT_NEAR(assembly.start.V[1](0, 0), 0.25, 1e-14);
}

TEST(ConsistentStart, ProjectionIsNearestForFiniteTurnsToo)
{
    // A bar from its hinge, shifted: among all closed states none nearby is nearer to what was given.
    Model model;
    model.add_body(posed(brick("box"), {0, 0, 0}, {0.2, 0.1, 0.4}, {}, {}));
    model.add_joint(spherical("ball", world, 0, frame(model, world, 0, {0.5, 0.2, 0.1})));
    State start = model.start();
    start.X[0].a[0] += 0.1;
    start.X[0].a[2] -= 0.2;
    const State closed = consistent_start(model, start, StartPolicy::project).start;
    const auto distance = [&](const Matrix34& X) {
        return dot((X - start.X[0]) * model.bodies()[0].mass, X - start.X[0]);
    };
    const double nearest = distance(closed.X[0]);
    const Vector3 hinge{0.5, 0.2, 0.1};
    for (int k = 0; k < 6; ++k) {
        Vector3 turn{};
        turn[k % 3] = k < 3 ? 1e-3 : -1e-3;
        const Matrix3 R = directors_from_rotation_vector(turn);
        const Matrix34 other =
            configuration(hinge + R * (closed.X[0].column(0) - hinge), R * directors(closed.X[0]));
        EXPECT_GT(distance(other), nearest) << k;
    }
}

TEST(ConsistentStart, RefusesMirroredAndSkewDirectors)
{
    Model model;
    model.add_body(brick("box"));
    State start = model.start();
    start.X[0].set_column(3, {0, 0, -1});
    EXPECT_EQ(refusal(model, start, StartPolicy::project).code, "start-position");
    start = model.start();
    start.X[0].set_column(2, {1e-3, 1, 0});
    const Complaint c = refusal(model, start);
    EXPECT_EQ(c.code, "start-position");
    EXPECT_CONTAINS(c.message, "d1.d2");
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    const Matrix3 D = directors(assembly.start.X[0]);
    EXPECT_LT(norm(transpose(D) * D - identity<3>()), 1e-15);
}

// --- contradiction

TEST(ConsistentStart, NamesTheRodThatContradictsAnother)
{
    Model model;
    model.add_body(point_mass("dot", 1, {0, 0, -1.2}));
    model.add_joint(rod("short", world, 0, frame(model, world, 0, {0, 0, 0}), 1));
    model.add_joint(rod("long", world, 0, frame(model, world, 0, {0, 0, 0}), 2));
    for (const StartPolicy policy : {StartPolicy::check, StartPolicy::project}) {
        const Complaint c = refusal(model, model.start(), policy);
        EXPECT_EQ(c.code, "joint-contradiction");
        EXPECT_EQ(c.path, "joint[long]");
        EXPECT_CONTAINS(c.message, "row 'distance'");
    }
}

TEST(ConsistentStart, NamesBallJointsThatDoNotFitEachOther)
{
    Model model;
    model.add_body(brick("box"));
    JointFrame left, right;
    left.point_first = {0, 0, 0};
    left.point_second = {0, 0, 0};
    right.point_first = {1.5, 0, 0};
    right.point_second = {1, 0, 0};
    model.add_joint(spherical("left", world, 0, left));
    model.add_joint(spherical("right", world, 0, right));
    const Complaint c = refusal(model, model.start(), StartPolicy::project);
    EXPECT_EQ(c.code, "joint-contradiction");
    EXPECT_CONTAINS(c.message, "row 'x'");
    EXPECT_CONTAINS(c.value, "0.5");
}

TEST(ConsistentStart, SaysWhenAMechanismDoesNotReach)
{
    // Two bars of length 1 between points 3 apart: no row is redundant where they point at each other,
    // nothing closes.
    Model model;
    model.add_body(bar("a", {0, 0, 0}, {0, 0, 1}));
    model.add_body(bar("b", {0, 0, 1}, {1, 0, 1}));
    JointFrame far;
    far.point_first = {3, 0, 0};
    far.point_second = {1, 0, 0};
    model.add_joint(revolute("left", world, 0, frame(model, world, 0, {0, 0, 0})));
    model.add_joint(spherical("middle", 0, 1, frame(model, 0, 1, {0, 0, 1})));
    model.add_joint(spherical("right", world, 1, far));
    const Complaint c = refusal(model, model.start(), StartPolicy::project);
    EXPECT_TRUE(c.code == "start-position" || c.code == "joint-contradiction") << c.code;
    EXPECT_CONTAINS(c.path, "joint[");
}

// --- velocities

TEST(ConsistentStart, NamesTheJointThatVelocitiesBreak)
{
    Model model;
    model.add_body(brick("box"));
    model.add_joint(spherical("ball", world, 0, frame(model, world, 0, {0, 0, 0})));
    State start = model.start();
    start.V[0] = rate(start.X[0], {0, 0.2, 0}, {0, 0, 3});
    const Complaint c = refusal(model, start);
    EXPECT_EQ(c.code, "start-velocity");
    EXPECT_EQ(c.path, "joint[ball]");
    EXPECT_CONTAINS(c.message, "row 'y'");
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_LT(largest_rate(model, assembly.start), 1e-15);
    EXPECT_NEAR(angular_velocity(assembly.start.X[0], assembly.start.V[0])[2], 3, 1e-14);
    EXPECT_FALSE(assembly.notes.empty());
}

/// Velocities that are zero but for rounding break no joint.
TEST(ConsistentStart, TakesRoundingForRest)
{
    Model model({0, 0, -9.81});
    model.add_body(brick("box"));
    model.add_joint(spherical("ball", world, 0, frame(model, world, 0, {0, 0, 0})));
    State start = model.start();
    start.V[0] = rate(start.X[0], {0, 1e-16, 0}, {});
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::check);
    EXPECT_LT(largest_rate(model, assembly.start), 1e-16);
    start.V[0] = rate(start.X[0], {0, 1e-8, 0}, {});
    EXPECT_EQ(refusal(model, start).code, "start-velocity") << "that is no rounding";
}

TEST(ConsistentStart, ProjectsThePapersInconsistentDirectorRates)
{
    // d3' = (0, 1, 0) with d2' = 0 breaks d2 . d3 and projects to half the spin.
    Model model;
    model.add_body(rigid_body("cube", properties(1, {0, 0, 0}, {0.4, 0.4, 0.4})));
    State start = model.start();
    start.V[0].set_column(3, {0, 1, 0});
    const Complaint c = refusal(model, start);
    EXPECT_EQ(c.code, "start-velocity");
    EXPECT_EQ(c.path, "body[cube].director_rates");
    EXPECT_CONTAINS(c.message, "'cube'");
    EXPECT_CONTAINS(c.message, "d2.d3");
    EXPECT_EQ(c.value, "d(d2.d3)/dt = 1 1/s");
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    const Vector3 w = angular_velocity(assembly.start.X[0], assembly.start.V[0]);
    EXPECT_NEAR(w[0], -0.5, 1e-13);
    EXPECT_EQ(w[1], 0);
    EXPECT_EQ(w[2], 0);
    EXPECT_LT(norm(assembly.start.V[0] - rate(assembly.start.X[0], {0, 0, 0}, w)), 1e-15);
}

TEST(ConsistentStart, UnequalMomentsShareInconsistentRatesByMass)
{
    // d3' = a, d2' = 0 with E = diag(e1, e2, e3): w1 (e2 + e3) = -e3 a.
    Model model;
    model.add_body(brick("box"));
    State start = model.start();
    start.V[0].set_column(3, {0, 2, 0});
    const Matrix4& m = model.bodies()[0].mass;
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_NEAR(angular_velocity(assembly.start.X[0], assembly.start.V[0])[0],
                -2 * m(3, 3) / (m(2, 2) + m(3, 3)), 1e-13);
}

TEST(ConsistentStart, VelocityProjectionIsNearestUnderRedundantJoints)
{
    const Model model = four_bar();
    State start = model.start();
    start.V[0] = rate(start.X[0], {0, 0, 0}, {0, 1, 0});   // the crank alone
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_LT(largest_rate(model, assembly.start), 1e-14);
    // The rest of the given rates is perpendicular, by mass, to the one motion that is left.
    double along = 0, moved = 0;
    for (int b = 0; b < 3; ++b) {
        along += dot((start.V[b] - assembly.start.V[b]) * model.bodies()[b].mass, assembly.start.V[b]);
        moved += dot(assembly.start.V[b] * model.bodies()[b].mass, assembly.start.V[b]);
    }
    EXPECT_GT(moved, 1e-2);
    EXPECT_NEAR(along, 0, 1e-13 * moved);
}

TEST(ConsistentStart, KeepsTheAngularVelocityOfABodyThatIsTurnedByTheProjection)
{
    Model model;
    model.add_body(posed(brick("box"), {0, 0, 0}, {0, 0, 0}, {}, {}));
    model.add_joint(revolute("hinge", world, 0, frame(model, world, 0, {0, 0, 0}, {0, 0, 1})));
    State start = model.start();
    start.X[0] = configuration({0, 0, 0}, directors_from_rotation_vector({0.1, 0, 0}));
    start.V[0] = rate(start.X[0], {0, 0, 0}, {0, 0, 2});
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_LT(largest_violation(model, assembly.start), 1e-15);
    EXPECT_NEAR(angular_velocity(assembly.start.X[0], assembly.start.V[0])[2], 2, 1e-13);
}

TEST(ConsistentStart, RefusesNumbersThatAreNone)
{
    Model model;
    model.add_body(brick("box"));
    State start = model.start();
    start.X[0].a[0] = std::nan("");
    EXPECT_EQ(refusal(model, start).code, "start-position");
    start = model.start();
    start.V[0].a[5] = INFINITY;
    EXPECT_EQ(refusal(model, start).code, "start-velocity");
    EXPECT_EQ(refusal(model, State{}).path, "start");
}

TEST(ConsistentStart, ClosesAChainOfPointMassesOnRods)
{
    Model model;
    for (int k = 0; k < 5; ++k) {
        model.add_body(point_mass(std::string(1, 'm') + std::to_string(k), 1 + k, {1.0 + k, 0, 0.1 * k}));
        JointFrame f;
        model.add_joint(rod(std::string(1, 'r') + std::to_string(k), k == 0 ? world : k - 1, k, f, 1));
    }
    State start = model.start();
    start.V[4].a[2] = 1;
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    EXPECT_EQ(assembly.degrees_of_freedom, 10);
    EXPECT_LT(largest_violation(model, assembly.start), 5e-15);   // the squares that cancel are of size 25
    EXPECT_LT(largest_rate(model, assembly.start), 1e-15);
    for (const Matrix34& X : assembly.start.X) {
        for (int i = 3; i < 12; ++i) EXPECT_EQ(X[i], 0);
        EXPECT_EQ(X(1, 0), 0);
    }
}

}   // namespace
}   // namespace livens::assembly_test
