// SPDX-License-Identifier: BSD-3-Clause
// The motion does not depend on how the mechanism is described, and runs backwards as well as forwards.
#include "mechanisms.h"

namespace livens::tests::symmetries_test {
namespace {

// Tips and long axes to 1e-11. The roll of a brick about its long axis, with a hundredth of the other
// inertias, shows rounding 50 times larger by then, in the true motion as well.
TEST(Lobatto, TurnsItsMotionWithTheMechanism)
{
    const State plain = last(solve_evenly(two_bricks(), 2, 80, 8));
    for (const Vector3& rotation :
         {Vector3{0.3, -1.1, 2.0}, Vector3{-2.2, 0.9, 0.4}, Vector3{1.3, 1.7, -0.8}}) {
        const Matrix3 turn = directors_from_rotation_vector(rotation);
        const State turned = last(solve_evenly(two_bricks({turn, 1}), 2, 80, 8));
        for (int b = 0; b < 2; ++b) {
            EXPECT_LE(norm(tip(turned, b) - turn * tip(plain, b)), 1e-11);
            EXPECT_LE(norm(turned.X[b].column(0) - turn * plain.X[b].column(0)), 1e-11);
            EXPECT_LE(norm(turned.X[b].column(1) - turn * plain.X[b].column(1)), 1e-11);
            EXPECT_LE(norm(turned.V[b].column(0) - turn * plain.V[b].column(0)), 1e-10);
            EXPECT_LE(norm(turned.X[b] - configuration(turned.X[b].column(0), turn * directors(plain.X[b]))),
                      1e-11);
        }
    }
}

TEST(Lobatto, MovesAlikeInMetresAndMillimetres)
{
    const State metres = last(solve_evenly(two_bricks(), 2, 80, 8));
    const State millimetres = last(solve_evenly(two_bricks({identity<3>(), 1000}), 2, 80, 8));
    for (int b = 0; b < 2; ++b) {
        EXPECT_LE(norm(tip(millimetres, b, 1000) - 1000 * tip(metres, b)), 1e-8);   // mm
        EXPECT_LE(norm(directors(millimetres.X[b]) - directors(metres.X[b])), 1e-9);
    }
}

// Other reference points and axes for the same bricks: nothing that can be seen from outside moves.
TEST(Lobatto, MovesAlikeForAnyReferencePointAndAxes)
{
    const State plain = last(solve_evenly(two_bricks(), 2, 80, 8));
    const Model given = two_bricks();
    const Matrix3 axes =
        directors_from_rotation_vector({0.7, -0.4, 1.9});   // of the new axes in the old ones
    const Vector3 origin{0.4, -0.3, 0.8};                   // of the new axes in the old ones
    auto seen = [&](const Vector3& theta) { return transpose(axes) * (theta - origin); };

    Model model(given.gravity());
    const MassProperties brick_1 = brick({});
    const MassProperties other{brick_1.mass, seen(brick_1.center_of_mass),
                               transpose(axes) * brick_1.inertia * axes};
    for (const Body& body : given.bodies())
        model.add_body(rigid_body(body.name, other, {body.X * point(origin), directors(body.X) * axes}));
    JointFrame shoulder, elbow;
    shoulder.point_second = elbow.point_second = seen({0, 0, 0});
    elbow.point_first = seen({1, 0, 0});
    model.add_joint(spherical("shoulder", world, 0, shoulder));
    model.add_joint(spherical("elbow", 0, 1, elbow));
    const State moved = last(solve_evenly(model, 2, 80, 8));
    for (int b = 0; b < 2; ++b) {
        EXPECT_LE(norm(moved.X[b] * point(seen({1, 0, 0})) - tip(plain, b)), 1e-11);
        EXPECT_LE(norm(moved.V[b] * point(seen({1, 0, 0})) - plain.V[b] * point({1, 0, 0})), 1e-10);
        EXPECT_LE(norm(directors(moved.X[b]) - directors(plain.X[b]) * axes), 1e-9);
    }
}

TEST(Lobatto, MovesAlikeForAnyOrderAndNamesOfBodiesAndJoints)
{
    const State plain = last(solve_evenly(two_bricks(), 2, 80, 8));
    const Model given = two_bricks();
    Model model(given.gravity());
    Body lower = given.bodies()[1], upper = given.bodies()[0];
    lower.name = "z";
    upper.name = "a";
    model.add_body(lower);
    model.add_body(upper);
    JointFrame elbow;   // from the lower brick to the upper one
    elbow.point_second = {1, 0, 0};
    model.add_joint(spherical("first", 0, 1, elbow));
    model.add_joint(spherical("second", 1, world, {}));
    const State reordered = last(solve_evenly(model, 2, 80, 8));
    for (int b = 0; b < 2; ++b) {
        EXPECT_LE(norm(tip(reordered, 1 - b) - tip(plain, b)), 1e-11);
        EXPECT_LE(norm(directors(reordered.X[1 - b]) - directors(plain.X[b])), 1e-9);
    }
}

// Frames that move evenly against each other see the same motion (no world joints, no place in space).
TEST(Lobatto, MovesAlikeInAMovingFrame)
{
    auto flying = [](const Vector3& start, const Vector3& boost) {
        Model model({0, 0, -9.81});
        Placement a;
        a.position = start;
        a.velocity = boost;
        a.angular_velocity = {1, 2, -0.5};
        const int first = model.add_body(rigid_body("first", brick({}), a));
        Placement b = a;
        b.position = start + Vector3{1, 0, 0};
        b.velocity = boost + cross(a.angular_velocity, {1, 0, 0});
        b.angular_velocity = {0, -3, 1};
        const int second = model.add_body(rigid_body("second", brick({}), b));
        JointFrame elbow;
        elbow.point_first = {1, 0, 0};
        model.add_joint(spherical("elbow", first, second, elbow));
        return last(solve_evenly(model, 2, 80, 8));
    };
    const Vector3 start{3, -2, 1}, boost{2, 1, -4};
    const State there = flying(start, boost), here = flying({0, 0, 0}, {0, 0, 0});
    for (int b = 0; b < 2; ++b) {
        EXPECT_LE(norm(there.X[b].column(0) - here.X[b].column(0) - start - 2 * boost), 1e-10);
        EXPECT_LE(norm(there.V[b].column(0) - here.V[b].column(0) - boost), 1e-10);
        EXPECT_LE(norm(directors(there.X[b]) - directors(here.X[b])), 1e-10);
    }
}

// Reversed velocities retrace the elements, long and coarse ones too: the method is symmetric in time.
TEST(Lobatto, RetracesItsMotionWhenReversed)
{
    const Model model = two_bricks();
    SolveOptions options;
    options.tolerance = 1e-14;
    for (auto [degree, n] : {std::pair{1, 200}, {2, 50}, {3, 30}, {6, 20}, {9, 10}}) {
        State turning = last(solve_evenly(model, 1, n, degree));
        for (Matrix34& V : turning.V) V *= -1;
        turning.t = 0;
        const Solution back = solve(model, {turning}, make_time_mesh(0, 1, n), Lobatto{degree}, options);
        ASSERT_TRUE(back.report.converged()) << back.report.message;
        const Distance d = distance(last(back), model.start());
        EXPECT_LE(d.X, 1e-10) << "lobatto(" << degree << ")";
        EXPECT_LE(d.V, 1e-9) << "lobatto(" << degree << ")";
    }
}

// Nor does a motion depend on the clock's zero.
TEST(Lobatto, MovesAlikeAtAnyTimeOfDay)
{
    const Model model = two_bricks();
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution later = solve(model, {model.start()}, make_time_mesh(64, 66, 80), Lobatto{8}, options);
    const State plain = last(solve_evenly(model, 2, 80, 8)), other = last(later);
    for (int b = 0; b < 2; ++b) EXPECT_LE(norm(tip(other, b) - tip(plain, b)), 1e-11);
}

}   // namespace
}   // namespace livens::tests::symmetries_test
