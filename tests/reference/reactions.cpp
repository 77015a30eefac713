// SPDX-License-Identifier: BSD-3-Clause
// Reactions by hand: what each joint exerts on its second body, at rest and in steady rotation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::tests::reactions_test {
namespace {

constexpr double g = 9.81;

/// Reaction of a joint at an element end; side 0 is left of it, 1 right.
Reaction reaction(const Model& model, const Motion& motion, int joint, int end, int side)
{
    const std::size_t rows = static_cast<std::size_t>(model.n_rows());
    const double* lambda = motion.end_multipliers.data() + static_cast<std::size_t>(2 * end + side) * rows;
    return joint_reaction(model, joint, motion.at_end(end).X, {lambda, rows});
}

/// Reaction of a joint at the inner nodes of an element, from the multipliers that the element was solved
/// with.
Reaction inner_reaction(const Model& model, const Motion& motion, int joint, int element, int node)
{
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies));
    const auto values = motion.X.coefficient(element, node);
    for (std::size_t b = 0; b < X.size(); ++b)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(12 * b), 12, X[b].a);
    return joint_reaction(model, joint, X, motion.multipliers.coefficient(element, node));
}

/// A thing that hangs on a joint: all bodies beyond it.
struct Hanging {
    double mass;
    Vector3 center;
};

/// Everything hangs still: the joint carries the weight, and its moment about the joint's point `at`.
Reaction by_hand(const Vector3& at, const std::vector<Hanging>& things)
{
    Reaction r;
    for (const Hanging& thing : things) {
        const Vector3 weight{0, 0, -thing.mass * g};
        r.force -= weight;
        r.torque -= cross(thing.center - at, weight);
    }
    return r;
}

void expect_near(const Reaction& computed, const Reaction& expected, double tolerance)
{
    EXPECT_LE(norm(computed.force - expected.force), tolerance);
    EXPECT_LE(norm(computed.torque - expected.torque), tolerance);
}

/// A beam welded to the wall; from its tip hangs a plate on a hinge about x, not below the hinge but beside
/// it along x; from the plate a bar on a ball joint, and from the bar a bob on a rod. Besides, a sign on a
/// universal joint with its axes along x and z, so that it may hang beside its joint along x.
class HangingChain {
public:
    const Hanging beam{2, {0.5, 0.2, 0}}, plate{3, {1.3, 0, -0.5}};
    const Hanging bar{1.5, {1.4, 0, -1.6}}, bob{0.8, {1.4, 0, -2.5}}, sign{0.7, {-0.8, 0, -0.4}};
    const Vector3 wall{0, 0, 0}, hinge{1, 0, 0}, ball{1.4, 0, -1}, eye{1.4, 0, -2}, hook{-1, 0, 0};
    Model model{{0, 0, -g}};

    HangingChain()
    {
        add("beam", beam);
        add("plate", plate);
        add("bar", bar);
        model.add_body(point_mass("bob", bob.mass, bob.center));
        add("sign", sign);
        model.add_joint(weld("wall", world, 0, frame(world, 0, wall), X(world), X(0)));
        model.add_joint(revolute("hinge", 0, 1, frame(0, 1, hinge, {1, 0, 0})));
        // the bar is named first here: the reaction is the one on the plate, downwards
        model.add_joint(spherical("ball", 2, 1, frame(2, 1, ball)));
        JointFrame string = frame(2, 3, eye);
        string.point_second = {0, 0, 0};
        model.add_joint(rod("string", 2, 3, string, 0.5));
        JointFrame gimbal = frame(world, 4, hook, {1, 0, 0});
        gimbal.axis_second = frame(world, 4, hook, {0, 0, 1}).axis_second;
        model.add_joint(universal("hook", world, 4, gimbal));
    }

    /// In the order of the joints.
    std::vector<Reaction> reactions() const
    {
        Reaction on_plate = by_hand(ball, {bar, bob});
        on_plate.force *= -1;
        on_plate.torque *= -1;
        return {by_hand(wall, {beam, plate, bar, bob}), by_hand(hinge, {plate, bar, bob}), on_plate,
                by_hand(bob.center, {bob}), by_hand(hook, {sign})};
    }

private:
    /// Reference points away from centres, and axes that are nobody's.
    void add(const char* name, const Hanging& thing)
    {
        const Matrix3 axes = directors_from_rotation_vector({0.3 * thing.mass, -0.2, 0.5});
        const Vector3 position = thing.center + Vector3{0.1, -0.2, 0.3};
        const MassProperties shape = with_center(with_mass(box(1, {0.4, 0.3, 0.2}), thing.mass),
                                                 transpose(axes) * (thing.center - position));
        model.add_body(rigid_body(name, shape, {position, axes, {}, {}}));
    }
    Matrix34 X(int body) const { return body == world ? world_configuration : model.bodies()[body].X; }
    JointFrame frame(int first, int second, const Vector3& at, const Vector3& axis = {0, 0, 1}) const
    {
        return joint_frame(X(first), X(second), at, axis);
    }
};

TEST(Reactions, OfAHangingChainAreItsWeights)
{
    const HangingChain chain;
    const Model& model = chain.model;
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 10), Lobatto{4}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.unknowns, 4 * (4 * 6 + 3 - 6 - 5 - 3 - 1 - 4));

    const std::vector<Reaction> expected = chain.reactions();
    EXPECT_GT(norm(expected[1].torque), 1) << "the hinge carries no moment";
    EXPECT_GT(norm(expected[4].torque), 1) << "the universal joint carries no moment";
    for (int joint = 0; joint < 5; ++joint) {
        SCOPED_TRACE(model.joints()[joint].name);
        const Reaction& r = expected[joint];
        for (int end = 0; end <= 10; ++end)
            for (int side = 0; side < 2; ++side)
                expect_near(reaction(model, s.motion, joint, end, side), r, 1e-10);
        for (int node = 0; node <= 4; ++node)
            expect_near(inner_reaction(model, s.motion, joint, 5, node), r, 1e-9);
    }
    for (std::size_t b = 0; b < 5; ++b)
        EXPECT_LE(norm(s.motion.at_end(10).X[b] - model.start().X[b]), 1e-12) << "not at rest";
}

// A bob circles below its pivot: the rod pulls with m g / cos(angle), which holds it up and turns it round.
TEST(Reactions, OfAConicalPendulumAreWeightAndCentripetalForce)
{
    const double length = 1.3, angle = 0.7, mass = 0.4;
    const double rate = std::sqrt(g / (length * std::cos(angle))), radius = length * std::sin(angle);
    Model model({0, 0, -g});
    const int bob = model.add_body(
        point_mass("bob", mass, {radius, 0, -length * std::cos(angle)}, {0, rate * radius, 0}));
    model.add_joint(rod("rod", world, bob, {}, length));
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 3, 60), Lobatto{8}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    for (int end = 0; end <= 60; ++end) {
        const double turn = rate * s.motion.mesh.ends[end];
        const Vector3 inwards{-std::cos(turn), -std::sin(turn), 0};
        const Vector3 force = mass * rate * rate * radius * inwards + Vector3{0, 0, mass * g};
        EXPECT_NEAR(norm(force), mass * g / std::cos(angle), 1e-12);
        for (int side = 0; side < 2; ++side)
            expect_near(reaction(model, s.motion, 0, end, side), {force, {}}, 1e-9);
    }
}

// An askew box turns steadily on an upright hinge: its bearing carries the weight, holds the centre on its
// circle, and turns the angular momentum that does not lie along the axis: torque = w x J w - r x W.
TEST(Reactions, OfAnUnbalancedRotorAreThoseOfEuler)
{
    const double w = 4, mass = 2.5;
    const Matrix3 tilt = directors_from_rotation_vector({0, 0.4, 0});
    const Vector3 center{0.5, 0, 0.2}, spin{0, 0, w};
    const MassProperties shape = with_mass(box(1, {1, 0.4, 0.2}), mass);
    const Matrix3 about_center = tilt * shape.inertia * transpose(tilt);
    Placement placement;
    placement.angular_velocity = spin;
    Model model({0, 0, -g});
    const int rotor = model.add_body(rigid_body("rotor", {mass, center, about_center}, placement));
    model.add_joint(revolute("bearing", world, rotor, {}));
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 80), Lobatto{8}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    for (int end = 0; end <= 80; ++end) {
        const Matrix3 turn = directors_from_rotation_vector(s.motion.mesh.ends[end] * spin);
        const Vector3 r = turn * center, weight{0, 0, -mass * g};
        const Vector3 turning =
            turn * (about_center * (transpose(turn) * spin)) + mass * cross(r, cross(spin, r));
        const Reaction expected{mass * cross(spin, cross(spin, r)) - weight,
                                cross(spin, turning) - cross(r, weight)};
        for (int side = 0; side < 2; ++side)
            expect_near(reaction(model, s.motion, 0, end, side), expected, 1e-9);
    }
}

// Where a load jumps, so does the reaction; each side is that of its own load.
TEST(Reactions, JumpWithTheLoad)
{
    Model model({0, 0, -g});
    const int body = model.add_body(rigid_body("block", box(1000, {0.1, 0.1, 0.1})));
    model.add_joint(weld("glue", world, body, {}, world_configuration, model.bodies()[body].X));
    model.add_load(
        point_force("push", body, {0, 0, 0.05}, window(TimeVector{7, 0, 0}, 0.5, 1), Frame::inertial));
    const TimeMesh mesh = make_time_mesh(0, 1.5, 6, model.load_breaks());
    const Solution s = solve(model, {model.start()}, mesh, Lobatto{3});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    auto at = [&](double t, int side) {
        const auto& ends = s.motion.mesh.ends;
        const auto end = std::find(ends.begin(), ends.end(), t) - ends.begin();
        return reaction(model, s.motion, 0, static_cast<int>(end), side);
    };
    const Reaction idle{{0, 0, g}, {}}, pushed{{-7, 0, g}, {0, -0.35, 0}};
    expect_near(at(0.5, 0), idle, 1e-10);
    expect_near(at(0.5, 1), pushed, 1e-10);
    expect_near(at(1, 0), pushed, 1e-10);
    expect_near(at(1, 1), idle, 1e-10);
}

}   // namespace
}   // namespace livens::tests::reactions_test
