// SPDX-License-Identifier: BSD-3-Clause
// Ends that are led along a curve of motions that turns back.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "livens/multibody/joints.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/guess.h"
#include "livens/spacetime/leading.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/solve.h"
#include "sanitized.h"

namespace livens::curve_test {
namespace {

constexpr int degree = 6;

/// Two rods on hinges, which swing in a plane.
Model double_pendulum()
{
    Model model({0, 0, -9.81});
    for (int b = 0; b < 2; ++b) {
        const double x = 0.5 + b;
        model.add_body(rigid_body(b == 0 ? "upper" : "lower", box(1, {1, 0.1, 0.1}), {{x, 0, 0}}));
    }
    model.add_joint(
        revolute("hook", world, 0, joint_frame(world_configuration, model.bodies()[0].X, {}, {0, 1, 0})));
    model.add_joint(
        revolute("elbow", 0, 1, joint_frame(model.bodies()[0].X, model.bodies()[1].X, {1, 0, 0}, {0, 1, 0})));
    return model;
}

State moving(const Model& model, double size)
{
    State start = model.start();
    const Vector3 w[2] = {size * Vector3{0, 1.8, 0}, size * Vector3{0, -2.4, 0}};
    const Vector3 elbow = cross(w[0], {1, 0, 0});
    start.V[0] = rate(start.X[0], 0.5 * elbow, w[0]);
    start.V[1] = rate(start.X[1], elbow + cross(w[1], {0.5, 0, 0}), w[1]);
    return start;
}

struct Led {
    Leading by_curve;
    double missed = 0;   // of the end, by the motion that was found and by a march from its start
};

/// Places at both ends of a motion, from a march with rates that are so many times too large.
Led led(double duration, double factor)
{
    const Model model = double_pendulum();
    const TimeMesh mesh = make_time_mesh(0, duration, static_cast<int>(std::ceil(12 * duration)));
    const auto arrival = [&](const State& start) {
        return solve(model, Problem{{start}}, mesh, Lobatto{degree}).motion.at_end(mesh.n_elements());
    };
    const State there = arrival(moving(model, 1));
    const Problem problem{{moving(model, factor), Known::positions, there, Known::positions}};
    const Ends ends = close_ends(model, problem, 0, duration, StartPolicy::project);
    const UnknownNumbers none;
    const NumberedProblem numbered(model, ends, mesh, none);
    const Guess march = guess_from_state(model, ends.start, mesh.ends, degree).motion;
    Led found{lead(numbered, degree, march, true, true)};
    if (!found.by_curve.motion) return found;
    const auto missed = [&](const State& state) {
        return distance_between(state.X, there.X, model.length());
    };
    found.missed = missed(found.by_curve.motion(duration));
    Problem exact = problem;
    exact.guess = found.by_curve.motion;
    exact.is_only_guess = true;
    const Solution motion = solve(model, exact, mesh, Lobatto{degree});
    EXPECT_TRUE(motion.report.converged()) << motion.report.message;
    found.missed = std::max(found.missed, missed(arrival(motion.motion.at_end(0))));
    return found;
}

TEST(Curve, PassesFoldsWhereTheWayTurnsBack)
{
    struct Case {
        double duration, factor;
    };
    for (const auto& [duration, factor] : {Case{1.5, -1}, {2, -1}, {3, 0.2}}) {
        const Led one = led(duration, factor);
        ASSERT_TRUE(one.by_curve.motion) << duration;
        EXPECT_LT(one.by_curve.share, 0.5) << "straight on it comes no farther";
        EXPECT_GE(one.by_curve.turns, 2) << duration;
        EXPECT_LT(one.missed, 1e-9) << duration;
        if (is_sanitized) return;   // one of them does
    }
}

}   // namespace
}   // namespace livens::curve_test
