// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "livens/base/error.h"
#include "livens/stepping/stepping.h"
#include "stepping_models.h"

namespace livens::march_test {
namespace {

using namespace stepping_test;

const SteppingRule rules[] = {SteppingRule::midpoint, SteppingRule::endpoint};

int order(SteppingRule rule) { return rule == SteppingRule::midpoint ? 2 : 1; }

/// The rates of the last two of five refinements by two are those of the rule, on both sides.
void expect_order(const std::function<double(int)>& error, int first, SteppingRule rule)
{
    std::vector<double> errors;
    for (int k = 0; k < 5; ++k) errors.push_back(error(first << k));
    for (int k = 3; k < 5; ++k) {
        EXPECT_NEAR(std::log2(errors[k - 1] / errors[k]), order(rule), 0.15)
            << errors[k - 1] << ' ' << errors[k];
    }
}

// --- orders

TEST(Stepping, FreeTopConvergesWithTheRulesOrder)
{
    const Matrix3 exact = free_top_directors(1);
    const Model model = free_top();
    for (SteppingRule rule : rules) {
        const int first = rule == SteppingRule::midpoint ? 8 : 64;
        expect_order(
            [&](int steps) {
                const SteppingResult result = march(model, 1, steps, rule);
                EXPECT_TRUE(result.report.converged()) << result.report.message;
                return norm(directors(result.motion.at_end(steps).X[0]) - exact);
            },
            first, rule);
    }
}

TEST(Stepping, FreeTopMovesAtConstantSpeed)
{
    const Model model = free_top();
    for (SteppingRule rule : rules) {
        const Motion motion = march(model, 1, 10, rule).motion;
        const State end = motion.at_end(10);
        EXPECT_LT(norm(end.X[0].column(0) - Vector3{1, 2, -1}), 1e-13);
        EXPECT_LT(norm(end.V[0].column(0) - Vector3{1, 2, -1}), 1e-13);
    }
}

TEST(Stepping, PointMassOnARodConvergesToTheExactPendulum)
{
    // Elliptic functions, to the digits of the benchmark.
    const Vector3 x{0.986291751131875, 0, -0.165010853125541}, v{0.296905515916316, 0, 1.77464364111266};
    const Model model = simple_pendulum();
    for (SteppingRule rule : rules) {
        const int first = rule == SteppingRule::midpoint ? 40 : 200;
        expect_order(
            [&](int n) { return norm(march(model, 1, n, rule).motion.at_end(n).X[0].column(0) - x); }, first,
            rule);
        expect_order(
            [&](int n) { return norm(march(model, 1, n, rule).motion.at_end(n).V[0].column(0) - v); }, first,
            rule);
    }
}

TEST(Stepping, BrickOnAHingeConvergesInPositionAndVelocity)
{
    const Swing swing = brick_pendulum_swing(0.6);
    const Vector3 d1{std::sin(swing.angle), 0, -std::cos(swing.angle)};
    const Model model = brick_pendulum();
    for (SteppingRule rule : rules) {
        const int first = rule == SteppingRule::midpoint ? 10 : 50;
        expect_order(
            [&](int n) { return norm(march(model, 0.6, n, rule).motion.at_end(n).X[0].column(1) - d1); },
            first, rule);
        expect_order(
            [&](int n) {
                const State end = march(model, 0.6, n, rule).motion.at_end(n);
                return std::abs(-angular_velocity(end.X[0], end.V[0])[1] - swing.rate);
            },
            first, rule);
    }
}

TEST(Stepping, DampedSpringConvergesWithTheRulesOrder)
{
    // m x'' + c x' + k x = 0 along x, critically damped: x = (1 + w t) exp(-w t).
    Model model;
    model.add_body(point_mass("mass", 2, {1, 0, 0}));
    model.add_load(spring_damper("spring", world, {-3, 0, 0}, 0, {0, 0, 0}, {50, 20, 3}));
    const double exact = (1 + 5 * 0.8) * std::exp(-5 * 0.8);
    for (SteppingRule rule : rules) {
        expect_order(
            [&](int n) { return std::abs(march(model, 0.8, n, rule).motion.at_end(n).X[0][0] - exact); },
            rule == SteppingRule::midpoint ? 10 : 80, rule);
    }
}

TEST(Stepping, RichardsonMeetsThePublishedDoublePendulum)
{
    const Model model = two_bricks();
    const Vector3 published{1.122007823165, 0.510402770620, -1.376644760952};
    const auto tip = [&](int n) {
        const Matrix34 X = march(model, 0.5, n, SteppingRule::midpoint).motion.at_end(n).X[1];
        return X * Vector4{1, 1, 0, 0};
    };
    // The midpoint rule is symmetric: errors go with h^2, h^4, h^6.
    const Vector3 a = tip(50), b = tip(100), c = tip(200);
    const Vector3 ab = b + (1.0 / 3) * (b - a), bc = c + (1.0 / 3) * (c - b);
    EXPECT_LT(norm(bc + (1.0 / 15) * (bc - ab) - published), 2e-10);
    EXPECT_GT(norm(c - published), 1e-5);   // negative control: it is the extrapolation that is exact
}

// --- what is kept

TEST(Stepping, MidpointKeepsTheEnergyAndEndpointLosesIt)
{
    for (const Model& model : {free_top(), brick_pendulum(), two_bricks(), simple_pendulum()}) {
        const int n = 100;
        const Motion mid = march(model, 5, n, SteppingRule::midpoint).motion;
        const Motion end = march(model, 5, n, SteppingRule::endpoint).motion;
        ASSERT_EQ(mid.n_elements(), n);
        ASSERT_EQ(end.n_elements(), n);
        const double start = energy(model, mid, 0);
        double kinetic = 0, drift = 0;
        for (int k = 0; k <= n; ++k) {
            drift = std::max(drift, std::abs(energy(model, mid, k) - start));
            for (const Matrix34& V : mid.at_end(k).V) kinetic = std::max(kinetic, norm(V) * norm(V));
        }
        EXPECT_LT(drift, 1e-11 * kinetic);
        EXPECT_LT(energy(model, end, n), start - 1e-3 * kinetic);
    }
}

TEST(Stepping, EndpointEnergyNeverGrows)
{
    const Model model = free_top();
    const Motion motion = march(model, 5, 100, SteppingRule::endpoint).motion;
    for (int k = 1; k <= 100; ++k) EXPECT_LT(energy(model, motion, k), energy(model, motion, k - 1)) << k;
}

TEST(Stepping, MidpointKeepsAngularMomentumOfFloatingBodies)
{
    Model model = two_bricks({0, 0, 0}, false);
    State start = model.start();
    start.V[0] = rate(start.X[0], {0.3, 0, 1}, {1, 2, 3});
    start.V[1] = rate(start.X[1], {0, 0.4, 0}, {-2, 1, 0.5});
    const ConsistentStart assembly = consistent_start(model, start, StartPolicy::project);
    const TimeMesh mesh = make_time_mesh(0, 3, 60);
    const auto drift = [&](SteppingRule rule) {
        const Motion motion = march_stepping(model, assembly, mesh, rule, {}).motion;
        double worst = 0;
        for (int k = 0; k <= motion.n_elements(); ++k) {
            worst = std::max(worst, norm(angular_momentum(motion, k) - angular_momentum(motion, 0)));
        }
        return worst / norm(angular_momentum(motion, 0));
    };
    EXPECT_LT(drift(SteppingRule::midpoint), 1e-12);
    EXPECT_GT(drift(SteppingRule::endpoint), 1e-3);   // negative control
}

TEST(Stepping, ConstraintsHoldAtElementEndsAndNotBetween)
{
    const Model model = two_bricks();
    for (SteppingRule rule : rules) {
        const SteppingResult result = march(model, 1, 40, rule);
        double at_ends = 0, between = 0;
        for (int k = 0; k <= 40; ++k)
            at_ends = std::max(at_ends, violation(model, result.motion.at_end(k).X));
        for (int k = 0; k < 40; ++k)
            between = std::max(between, violation(model, result.motion.at(k / 40.0 + 0.0125).X));
        EXPECT_LT(at_ends, 1e-12);
        EXPECT_GT(between, 1e-5);
        EXPECT_LT(result.report.residual_norm, 1e-12);
        EXPECT_EQ(result.motion.constraints_hold, ConstraintsHold::at_element_ends);
    }
}

TEST(Stepping, VelocitiesAreTangent)
{
    const Model model = two_bricks();
    const Motion motion = march(model, 1, 40, SteppingRule::midpoint).motion;
    for (int k = 0; k <= 40; ++k) {
        const State state = motion.at_end(k);
        for (int b = 0; b < 2; ++b) {
            const Vector3 w = angular_velocity(state.X[b], state.V[b]);
            EXPECT_LT(norm(state.V[b] - rate(state.X[b], state.V[b].column(0), w)), 1e-12);
        }
        EXPECT_LT(norm(state.V[0].column(0)), 1e-12);
        EXPECT_LT(norm(state.V[0] * Vector4{1, 1, 0, 0} - state.V[1].column(0)), 1e-12);
    }
}

TEST(Stepping, PlanarMotionStaysPlanar)
{
    const Motion motion = march(brick_pendulum(), 2, 200, SteppingRule::midpoint).motion;
    for (int k = 0; k <= 200; ++k) {
        const Matrix34 X = motion.at_end(k).X[0];
        for (int c : {0, 1, 3}) EXPECT_LT(std::abs(X(1, c)), 1e-14);
    }
}

// --- loads and multipliers

TEST(Stepping, RodTensionIsThatOfThePendulum)
{
    // N = 3 m g cos(theta) = -3 m g z from a horizontal release; the force on the bob is -lambda x.
    const Model model = simple_pendulum();
    for (SteppingRule rule : rules) {
        const int n = 2000;
        const Motion motion = march(model, 1, n, rule).motion;
        ASSERT_EQ(motion.multipliers.values.size(), std::size_t(n));
        for (int k : {100, 700, 1500}) {
            const double z = 0.5 * (motion.at_end(k).X[0][2] + motion.at_end(k + 1).X[0][2]);
            const double tolerance = rule == SteppingRule::midpoint ? 1e-3 : 0.3;
            EXPECT_NEAR(motion.multipliers.coefficient(k, 0)[0], -3 * 9.81 * z, tolerance) << k;
        }
    }
}

TEST(Stepping, HangingChainCarriesTheWeightBelow)
{
    Model model({0, 0, -10});
    const MassProperties link = properties(2, {0, 0, -0.5}, {0.2, 0.2, 0.01});
    for (int k = 0; k < 3; ++k) {
        Placement placement;
        placement.position = {0, 0, -1.0 * k};
        const int body = model.add_body(rigid_body("link" + std::to_string(k), link, placement));
        const Matrix34 above = k == 0 ? world_configuration : model.bodies()[k - 1].X;
        model.add_joint(spherical("pin" + std::to_string(k), k - 1, body,
                                  joint_frame(above, model.bodies()[k].X, placement.position)));
    }
    for (SteppingRule rule : rules) {
        const Motion motion = march(model, 0.1, 10, rule).motion;
        const State end = motion.at_end(10);
        for (int k = 0; k < 3; ++k) {
            const Reaction reaction = joint_reaction(model, k, end.X, motion.multipliers.coefficient(9, 0));
            EXPECT_LT(norm(reaction.force - Vector3{0, 0, 20.0 * (3 - k)}), 1e-9);
        }
        EXPECT_LT(norm(end.X[2] - model.start().X[2]), 1e-13);
    }
}

TEST(Stepping, AJumpOfALoadBelongsToTheElementItEnds)
{
    Model model;
    model.add_body(point_mass("mass", 2, {0, 0, 0}));
    model.add_load(point_force("push", 0, {0, 0, 0}, window({3.0, 0.0, 0.0}, 0.25, 0.75), Frame::inertial));
    for (SteppingRule rule : rules) {
        const Motion motion = march(model, 1, 4, rule).motion;
        const double impulse[] = {0, 0, 0.75, 1.5, 1.5};
        for (int k = 0; k <= 4; ++k) EXPECT_NEAR(motion.momenta[k][0], impulse[k], 1e-14) << k;
    }
}

TEST(Stepping, NewtonIsQuadraticWithLoadsThatDependOnTheState)
{
    Model model = two_bricks();
    model.add_load(spring_damper("spring", 0, {0.2, 0.1, 0}, 1, {0.3, 0, 0.1}, {40, 3, 0.5}));
    model.add_load(torque("motor", 1, {0.5, 0.1, -0.4}, Frame::body_fixed));
    for (SteppingRule rule : rules) {
        const SteppingResult result = march(model, 1, 50, rule);
        ASSERT_TRUE(result.report.converged()) << result.report.message;
        EXPECT_LE(result.report.most_iterations, 6);
        EXPECT_EQ(result.report.factorisations, result.report.newton_iterations);
        EXPECT_EQ(result.report.iterations.size(), 50u);
    }
}

// --- redundancy and size

Model doubled_pendulum()
{
    Model model = two_bricks();
    const Matrix34 X = model.bodies()[0].X;
    model.add_joint(spherical("again", world, 0, joint_frame(world_configuration, X, {0, 0, 0})));
    return model;
}

TEST(Stepping, RedundantRowsAreDroppedAndFlagged)
{
    const SteppingResult twice = march(doubled_pendulum(), 0.5, 20, SteppingRule::midpoint);
    const SteppingResult once = march(two_bricks(), 0.5, 20, SteppingRule::midpoint);
    ASSERT_TRUE(twice.report.converged());
    EXPECT_EQ(twice.report.unknowns, once.report.unknowns);
    EXPECT_EQ(twice.motion.redundant_rows, (std::vector<int>{6, 7, 8}));
    EXPECT_EQ(twice.report.notes.size(), 1u);
    EXPECT_LT(norm(twice.motion.at_end(20).X[1] - once.motion.at_end(20).X[1]), 1e-12);
    for (int r = 6; r < 9; ++r) EXPECT_EQ(twice.motion.multipliers.coefficient(10, 0)[r], 0);
}

TEST(Stepping, SparseAndDenseSolutionsAgree)
{
    Model model = two_bricks();
    for (int k = 0; k < 10; ++k) {
        Placement placement;
        placement.position = {5.0, 1.0 * k, 0};
        model.add_body(
            rigid_body("spare" + std::to_string(k), properties(1, {0, 0, 0}, {1, 1.1, 1.2}), placement));
    }
    const SteppingResult large = march(model, 0.2, 10, SteppingRule::midpoint);
    const SteppingResult small = march(two_bricks(), 0.2, 10, SteppingRule::midpoint);
    ASSERT_TRUE(large.report.converged()) << large.report.message;
    ASSERT_GT(large.report.unknowns, 200);
    for (int b = 0; b < 2; ++b)
        EXPECT_LT(norm(large.motion.at_end(10).X[b] - small.motion.at_end(10).X[b]), 1e-12);
}

TEST(Stepping, ResultsDoNotDependOnTheUnitOfMass)
{
    const auto tip = [](double unit) {
        Model model({0, 0, -9.81});
        const MassProperties p = properties(unit, {0.5, 0, 0}, unit * Vector3{0.02, 0.09, 0.08});
        model.add_body(rigid_body("body", p));
        model.add_joint(
            spherical("pin", world, 0, joint_frame(world_configuration, model.bodies()[0].X, {0, 0.1, 0})));
        const SteppingResult result = march(model, 1, 50, SteppingRule::midpoint);
        EXPECT_TRUE(result.report.converged()) << unit << ' ' << result.report.message;
        return result.motion.at_end(50).X[0];
    };
    const Matrix34 one = tip(1);
    EXPECT_LT(norm(tip(1e-9) - one), 1e-10);
    EXPECT_LT(norm(tip(1e9) - one), 1e-10);
}

// --- failures

TEST(Stepping, RefusesASingularMassByName)
{
    Model model;
    model.add_body(rigid_body("lamina", properties(1, {0, 0, 0}, {1, 2, 3})));
    try {
        march(model, 1, 10, SteppingRule::midpoint);
        FAIL() << "no InputError";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "mass-singular");
        EXPECT_EQ(error.complaint().path, "body[lamina].inertia");
        EXPECT_NE(error.complaint().message.find("'lamina'"), std::string::npos);
    }
}

TEST(Stepping, NamesTheLoadThatIsNotFinite)
{
    Model model;
    model.add_body(point_mass("mass", 1, {0, 0, 0}));
    const TimeFunction bad(
        [](Instant at) {
            return TimeValue{at.t > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1.0, 0, 0};
        },
        {});
    model.add_load(point_force("broken", 0, {0, 0, 0}, {bad, 0.0, 0.0}, Frame::inertial));
    for (SteppingRule rule : rules) {
        const SteppingResult result = march(model, 1, 10, rule);
        EXPECT_EQ(result.report.status, SolveStatus::not_finite);
        EXPECT_NE(result.report.message.find("'broken'"), std::string::npos) << result.report.message;
        EXPECT_DOUBLE_EQ(result.report.failed_at, 0.5);
        EXPECT_EQ(result.motion.n_elements(), 5);
        EXPECT_EQ(result.report.n_elements, 5);
        EXPECT_EQ(result.motion.velocities.size(), 6u);
        EXPECT_TRUE(std::isfinite(result.motion.at_end(5).X[0][0]));
    }
}

TEST(Stepping, SaysWhereNewtonFailed)
{
    SteppingOptions options;
    options.max_iterations = 1;
    const SteppingResult result = march(two_bricks(), 1, 10, SteppingRule::midpoint, options);
    EXPECT_EQ(result.report.status, SolveStatus::not_converged);
    EXPECT_EQ(result.report.failed_at, 0);
    EXPECT_EQ(result.motion.n_elements(), 0);
    EXPECT_EQ(result.motion.at_end(0).X, two_bricks().start().X);
    EXPECT_NE(result.report.message.find("from t = 0 s to 0.1 s"), std::string::npos)
        << result.report.message;
    EXPECT_NE(result.report.message.find("'"), std::string::npos) << result.report.message;
}

TEST(Stepping, TooLongStepsFailOrStayRigid)
{
    // A turn of many radians a step: whatever Newton's iteration finds, no mirrored or deformed triad is
    // handed out.
    Model model;
    Placement placement;
    placement.angular_velocity = {20, 31, -17};
    model.add_body(rigid_body("top", properties(3, {0, 0, 0}, {1, 2, 2.5}), placement));
    for (SteppingRule rule : rules) {
        for (int steps : {1, 2, 3, 5, 8}) {
            const SteppingResult result = march(model, 1, steps, rule);
            EXPECT_EQ(result.report.converged(), result.motion.n_elements() == steps);
            for (int k = 0; k <= result.motion.n_elements(); ++k) {
                const Matrix34 X = result.motion.at_end(k).X[0];
                EXPECT_LT(violation(model, {X}), 1e-9);
                EXPECT_GT(determinant(directors(X)), 0);
            }
            if (!result.report.converged()) {
                EXPECT_NE(result.report.message.find("'top'"), std::string::npos) << result.report.message;
            }
        }
    }
}

TEST(Stepping, AModelWithoutBodiesDoesNothing)
{
    const Model model;
    const SteppingResult result = march(model, 1, 3, SteppingRule::midpoint);
    EXPECT_TRUE(result.report.converged()) << result.report.message;
    EXPECT_EQ(result.motion.n_elements(), 3);
}

TEST(Stepping, StopsWhenTheCallerSaysSo)
{
    int calls = 0;
    SteppingOptions options;
    options.progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.done, calls + 1);
        EXPECT_EQ(progress.n_elements, 20);
        EXPECT_GT(progress.iterations, 0);
        return ++calls < 7;
    };
    const SteppingResult result = march(two_bricks(), 1, 20, SteppingRule::midpoint, options);
    EXPECT_EQ(result.report.status, SolveStatus::cancelled);
    EXPECT_EQ(calls, 7);
    EXPECT_EQ(result.motion.n_elements(), 7);
    EXPECT_DOUBLE_EQ(result.motion.end(), 0.35);
    const Motion whole = march(two_bricks(), 1, 20, SteppingRule::midpoint).motion;
    EXPECT_EQ(result.motion.at_end(7).X, whole.at_end(7).X);
}

TEST(Stepping, UnequalStepsKeepTheOrder)
{
    const Matrix3 exact = free_top_directors(1);
    const Model model = free_top();
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    expect_order(
        [&](int n) {
            TimeMesh mesh;
            for (int k = 0; k <= n; ++k) mesh.ends.push_back(std::pow(k / double(n), 1.5));
            const Motion motion = march_stepping(model, assembly, mesh, SteppingRule::midpoint, {}).motion;
            return norm(directors(motion.at_end(n).X[0]) - exact);
        },
        8, SteppingRule::midpoint);
}

}   // namespace
}   // namespace livens::march_test
