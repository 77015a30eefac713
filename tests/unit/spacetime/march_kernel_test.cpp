// SPDX-License-Identifier: BSD-3-Clause
// The kernel of a march against Newton's iteration with the real tangent, element by element.
#include "livens/spacetime/nodal/kernel/march_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/joints.h"
#include "livens/solvers/instructions.h"
#include "livens/spacetime/nodal/system.h"
#include "livens/spacetime/solve.h"
#include "unit/multibody/random_states.h"
#include "unit/spacetime/kernel_comparison.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::march_kernel_test {
namespace {

TEST(MarchKernel, AgreesWithNewtonOnRandomMechanisms)
{
    with_all_instructions([] {
        int unsolved = 0;
        const std::vector<double> found = differences(300, 0, unsolved);
        EXPECT_LT(unsolved, 30);
        ASSERT_GT(found.size(), 250U);
        EXPECT_LT(found[found.size() / 2], 1e-14);
        EXPECT_LT(found.back(), 1e-13);
    });
}

TEST(MarchKernel, AFaultInOneLaneShows)
{
    with_all_instructions([] {
        int unsolved = 0;
        const std::vector<double> found = differences(100, 1e-9, unsolved);
        ASSERT_GT(found.size(), 50U);
        EXPECT_GT(found[found.size() / 2], 1e-13);
    });
}

// What is solved at an instant by elimination along the joints is what orthogonal bases say.
TEST(JointFactor, AgreesWithOrthogonalBases)
{
    const Model model = testing_models::everything();
    const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
    const ModelTables tables(model, closed.independent);
    InstantState states[2];
    std::vector<double> lambda[2];
    for (const bool sparse : {false, true}) {
        InstantSystem instant(tables, sparse);
        InstantState& state = states[sparse ? 1 : 0];
        state.resize(tables);
        for (int b = 0; b < tables.n_bodies(); ++b)
            std::copy_n(closed.start.X[b].a, 12, state.X.begin() + 12 * b);
        for (std::size_t i = 0; i < state.velocity.size(); ++i)
            state.velocity[i] = std::sin(1.0 + static_cast<double>(i));
        ASSERT_TRUE(instant.prepare(state, tables.independent));
        EXPECT_EQ(state.held.by_joints, sparse);
        EXPECT_EQ(state.held.has_basis, !sparse);
        instant.from_velocity(state);
        const std::vector<double> p = state.p;
        lambda[sparse ? 1 : 0].resize(tables.rows.size());
        instant.from_momentum(state, p.data(), 0.01, lambda[sparse ? 1 : 0].data());
        instant.accelerate(state, Side::right);
    }
    EXPECT_LT(difference(states[0].velocity, states[1].velocity), 1e-14);
    EXPECT_LT(difference(states[0].p, states[1].p), 1e-14);
    EXPECT_LT(difference(lambda[0], lambda[1]), 1e-12);
    EXPECT_LT(difference(states[0].acceleration[1], states[1].acceleration[1]),
              1e-14 * size_of(states[0].acceleration[1]));
    EXPECT_LT(difference(states[0].multipliers[1], states[1].multipliers[1]), 1e-12);
    EXPECT_GT(size_of(lambda[0]), 0.1);
}

// What is left cannot fall below a tolerance below rounding: steps that have shrunk, and stop, are done.
TEST(MarchKernel, StepsThatMeetTheirRoundingAreDone)
{
    SolveOptions options;
    options.judge = false;
    options.tolerance = 1e-15;
    Model pendulum({0, 0, -9.81});
    pendulum.add_body(rigid_body("bar", with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0})));
    pendulum.add_joint(spherical("ball", world, 0, {}));
    const Solution s = solve(pendulum, {pendulum.start()}, make_time_mesh(0, 5, 100), Lobatto{6}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
}

/// P16 with axes in its bodies that are turned by R from those of their edges; steps of 80 elements to 2 s.
int steps_of_bricks(const Matrix3& R, int degree)
{
    Model model({0, 0, -9.81});
    const Model bricks = testing_models::two_bricks();
    for (int b = 0; b < 2; ++b) {
        const Body& body = bricks.bodies()[b];
        const MassProperties own = mass_properties(body.mass);
        const MassProperties turned{own.mass, transpose(R) * own.center_of_mass,
                                    transpose(R) * own.inertia * R};
        Placement placement;
        placement.position = body.X.column(0);
        placement.directors = directors(body.X) * R;
        model.add_body(rigid_body(body.name, turned, placement));
    }
    const Vector3 tip = transpose(R) * Vector3{1, 0, 0};
    model.add_joint(spherical("root", world, 0, {}));
    model.add_joint(spherical("elbow", 0, 1, {.point_first = tip, .point_second = {}}));
    SolveOptions options;
    options.judge = false;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 80), Lobatto{degree}, options);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    return std::accumulate(s.report.iterations.begin(), s.report.iterations.end(), 0);
}

// Turns in still axes, where inertia has no gyroscopic term.
// In those of the bodies it takes 458 and 392 steps.
TEST(MarchKernel, GyroscopicTermsCostNoSteps)
{
    const int six = steps_of_bricks(identity<3>(), 6), eight = steps_of_bricks(identity<3>(), 8);
    EXPECT_LE(six, 340);
    EXPECT_LE(eight, 295);
    // whatever axes a body is described in
    const Matrix3 R = directors_from_rotation_vector({0.4, -0.7, 1.1});
    EXPECT_NEAR(steps_of_bricks(R, 6), six, 8);
    EXPECT_NEAR(steps_of_bricks(R, 8), eight, 8);
}

// Where nothing is compared, the iteration of an element ends at the tolerance that was asked for.
TEST(MarchKernel, EndsAtTheToleranceUnlessMotionsAreCompared)
{
    const Model model = testing_models::two_bricks();
    SolveOptions options;
    options.judge = false;
    const auto run = [&](double tolerance, SolveOptions::Estimate estimate) {
        options.tolerance = tolerance;
        options.estimate = estimate;
        return solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{8}, options);
    };
    const auto off = [](const Solution& a, const Solution& b) {
        double far = 0;
        for (int body = 0; body < 2; ++body)
            far = std::max(far, norm(a.motion.at_end(20).X[body] - b.motion.at_end(20).X[body]));
        return far;
    };
    using enum SolveOptions::Estimate;
    const Solution best = run(1e-14, none), ten = run(1e-10, second);
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-8}) {
        const Solution loose = run(tolerance, none);
        EXPECT_LT(10 * loose.report.evaluations, 9 * best.report.evaluations);
        EXPECT_LT(off(loose, best), 30 * tolerance) << tolerance;   // of 20 elements, grown
        EXPECT_GT(off(loose, best), 1e-4 * tolerance) << tolerance;
        EXPECT_EQ(off(run(tolerance, second), ten), 0) << "an estimate would compare it";
        EXPECT_EQ(off(run(tolerance, local), ten), 0);
    }
}

// Elements so long that steps grow: those of many bodies are combined, and say what Newton's iteration says.
TEST(MarchKernel, ManyBodiesOnLongElementsNeedNoTangent)
{
    Model chain({0, 0, -9.81});
    for (int b = 0; b < 25; ++b) {
        Placement placement;
        placement.position = {static_cast<double>(b), 0, 0};
        chain.add_body(
            rigid_body(std::to_string(b), with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0}), placement));
        JointFrame frame;
        frame.point_first = {b > 0 ? 1.0 : 0.0, 0, 0};
        chain.add_joint(spherical(std::to_string(b), b - 1, b, frame));
    }
    SolveOptions options;
    options.judge = false;
    State ends[2];
    for (const bool by_newton : {false, true}) {
        options.by_newton = by_newton;
        const Solution s = solve(chain, {chain.start()}, make_time_mesh(0, 1, 8), Lobatto{4}, options);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_EQ(s.report.factorisations > 0, by_newton);
        EXPECT_EQ(s.motion.n_elements(), 8);
        // beyond what single steps may take
        EXPECT_GT(s.report.most_iterations, by_newton ? 1 : 10);
        ends[by_newton ? 1 : 0] = s.motion.at_end(8);
    }
    for (int b = 0; b < chain.n_bodies(); ++b) {
        EXPECT_LT(norm(ends[0].X[b] - ends[1].X[b]), 1e-11) << b;
        EXPECT_LT(norm(ends[0].V[b] - ends[1].V[b]), 1e-9) << b;
    }
}

/// A tangent of sixty bodies costs hundreds of elements without one: elements are shortened instead, of the
/// motion and of the second solution on its elements.
TEST(MarchKernel, LongChainsToAnAccuracyNeedNoTangent)
{
    const int n = 60;
    Model model({0, 0, -9.81});
    Vector3 x{};
    for (int b = 0; b < n; ++b) {   // in a zigzag
        Placement placement;
        placement.position = x;
        if (b % 2 == 1) placement.directors = Matrix3{0, 1, 0, -1, 0, 0, 0, 0, 1};
        model.add_body(
            rigid_body(std::to_string(b), with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0}), placement));
        model.add_joint(spherical(std::to_string(b), b - 1, b, {.point_first = {b > 0 ? 1.0 : 0.0, 0, 0}}));
        x = x + (b % 2 == 1 ? Vector3{0, 1, 0} : Vector3{1, 0, 0});
    }
    SolveOptions options;
    options.judge = false;
    const Solution s =
        solve(model, {model.start()}, Span{.start = 0, .end = 1, .accuracy = 1e-4}, Lobatto{}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_LT(s.report.evaluations, 4000) << "some twenty elements of eight nodes and twenty steps";
    TimeMesh mesh = s.motion.mesh;
    mesh.required.clear();
    const Solution second = solve(model, {model.start()}, mesh, Lobatto{9}, options);
    ASSERT_TRUE(second.report.converged()) << second.report.message;
    EXPECT_EQ(second.report.factorisations, 0);
}

// Room and work grow with the bodies: dense bases of 300 would take gigabytes at the nodes alone.
TEST(MarchKernel, SolvesLongChains)
{
    const int n = 300;
    Model model({0, 0, -9.81});
    const MassProperties brick = with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0});
    for (int b = 0; b < n; ++b) {
        Placement placement;
        placement.position = {static_cast<double>(b), 0, 0};
        model.add_body(rigid_body("body " + std::to_string(b), brick, placement));
        JointFrame frame;
        frame.point_first = {b > 0 ? 1.0 : 0.0, 0, 0};
        model.add_joint(spherical("joint " + std::to_string(b), b - 1, b, frame));
    }
    SolveOptions options;
    options.judge = false;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 0.02, 2), Lobatto{4}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    for (int b = 1; b < n; ++b) {
        const State end = s.motion.at_end(2);
        EXPECT_LT(norm(end.X[b - 1] * point({1, 0, 0}) - end.X[b].column(0)), 1e-12 * n);
    }
}

}   // namespace
}   // namespace livens::march_kernel_test
