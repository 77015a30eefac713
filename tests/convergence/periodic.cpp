// SPDX-License-Identifier: BSD-3-Clause
// Motions that end as they begin, found at once, against marches over many periods.
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/state_quantities.h"
#include "livens/time/time_laws.h"

namespace livens::tests::periodic_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A bar on a hinge under its weight, damped and driven by a torque with this period.
Model driven(double period, double amplitude, double damping = 0.8)
{
    Model model({0, -9.81, 0});
    const int bar = model.add_body(rigid_body("bar", brick({})));
    model.add_joint(revolute("pivot", world, bar, {}));
    const NamedCoordinate angle = model.joints()[0].coordinates[0];
    const std::vector<Matrix34> X{model.bodies()[0].X};
    model.add_load(joint_spring("friction", angle, {0, damping}, X));
    model.add_load(actuator("motor", angle, harmonic(amplitude, 1 / period, 0.3), X));
    return model;
}

State hanging(const Model& model, double rate_of_angle = 0)
{
    State state = model.start();
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        state.X[b] = configuration({}, directors_from_rotation_vector({0, 0, -pi / 2}));
        state.V[b] = rate(state.X[b], {}, {0, 0, rate_of_angle});
    }
    return state;
}

livens::Problem periodic(const State& guess)
{
    livens::Problem problem{{guess, Known::nothing}};
    problem.conditions.is_periodic = true;
    return problem;
}

Solution solve_periodic(const Model& model, const State& guess, double period, int n = 24)
{
    return solve(model, periodic(guess), make_time_mesh(0, period, n), Lobatto{6, 0});
}

/// What a march from rest has come to after so many periods.
State after_periods(const Model& model, double period, int n, const State& start)
{
    SolveOptions options;
    options.estimate = SolveOptions::Estimate::none;
    const Solution s = solve(model, {{start}}, make_time_mesh(0, n * period, 24 * n), Lobatto{6}, options);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    return s.motion.at_end(24 * n);
}

TEST(Periodic, DrivenMotionsAreWhereMarchesEnd)
{
    const double period = 1.3;
    for (const double amplitude : {0.5, 3.0}) {
        const Model model = driven(period, amplitude);
        const Solution s = solve_periodic(model, hanging(model), period);
        ASSERT_TRUE(s.report.converged()) << amplitude << ": " << s.report.message;
        const State settled = after_periods(model, period, 80, hanging(model));
        const State found = s.motion.at_end(0);
        EXPECT_LE(distance(found, settled).X, 1e-9) << amplitude;
        EXPECT_LE(distance(found, settled).V, 1e-8) << amplitude;
        EXPECT_LE(distance(found, s.motion.at_end(24)).X, 1e-12) << amplitude;
        EXPECT_GT(norm(found.V[0]), 0.1) << amplitude;   // no state of rest
    }
}

/// A rotor whose turns are whole: the state is alike, the angle is not.
TEST(Periodic, MotionsMayTurnRound)
{
    const double period = 1;
    Model model;
    const int wheel = model.add_body(rigid_body("wheel", box(100, {0.4, 0.4, 0.1})));
    model.add_joint(revolute("axle", world, wheel, {}));
    const NamedCoordinate angle = model.joints()[0].coordinates[0];
    const std::vector<Matrix34> X{model.bodies()[0].X};
    model.add_load(joint_spring("friction", angle, {0, 0.05}, X));
    // an imbalance in a field that turns: the wheel follows it, once in each period
    const auto field = [&](double phase) { return harmonic(4, 1 / period, phase); };
    model.add_load(point_force("field", wheel, {0.2, 0, 0}, {field(pi / 2), field(0), 0}, Frame::inertial));
    State guess = model.start();
    guess.V[0] = rate(guess.X[0], {}, {0, 0, 2 * pi / period});
    const Solution s = solve_periodic(model, guess, period);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    double turned = 0, before = 0;
    const JointCoordinate& q = angle.coordinate;
    for (int i = 0; i <= 240; ++i) {
        const double now = turned_to(coordinate_change(q, X, s.motion.at(period * i / 240).X), before);
        if (i > 0) turned += now - before;
        before = now;
    }
    EXPECT_NEAR(turned, 2 * pi, 1e-9);
}

TEST(Periodic, ElementsAreFoundForAnAccuracy)
{
    const double period = 1.3;
    const Model model = driven(period, 3);
    const Solution s = solve(model, periodic(hanging(model)), Span{0, period, 1e-10}, Lobatto{0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LE(distance(s.motion.at_end(0), after_periods(model, period, 80, hanging(model))).X, 1e-9);
}

std::string code_of(const Model& model, const livens::Problem& problem, double period)
{
    try {
        solve(model, problem, make_time_mesh(0, period, 24), Lobatto{6, 0});
    } catch (const InputError& error) {
        return error.complaint().code;
    }
    return "none";
}

/// What nothing drives may begin its period at any instant, and is of any size where energy is kept.
TEST(Periodic, MotionsOfWhatNothingDrivesAreRefusedWithoutMore)
{
    for (const Model& model : {two_bricks(), four_bar(), driven(1.3, 0, 0), free_box()})
        EXPECT_EQ(code_of(model, periodic(model.start()), 1.3), "conditions-too-few");
    const Model damped = driven(1.3, 0);
    EXPECT_EQ(code_of(damped, periodic(damped.start()), 1.3), "periodic-free");
    livens::Problem more = periodic(hanging(driven(1.3, 3)));
    more.conditions.components = {
        {state_quantities(driven(1.3, 3), "pivot.angle").at(0), 0, Condition::At::start}};
    EXPECT_EQ(code_of(driven(1.3, 3), more, 1.3), "conditions-too-many");
    EXPECT_EQ(code_of(driven(1.3, 3), periodic(hanging(driven(1.3, 3))), 1.3), "none");
}

/// A motion that comes back once, and goes on otherwise, is no periodic one.
TEST(Periodic, AnotherPeriodOfWhatDrivesIsSuspect)
{
    const Model model = driven(1.3, 3);
    const Solution s = solve_periodic(model, hanging(model), 1.0);
    EXPECT_EQ(s.report.status, SolveStatus::suspect) << s.report.message;
    EXPECT_NE(s.report.message.find("period"), std::string::npos) << s.report.message;
    EXPECT_TRUE(solve_periodic(model, hanging(model), 2.6, 48).report.converged());   // twice the same
}

}   // namespace
}   // namespace livens::tests::periodic_test
