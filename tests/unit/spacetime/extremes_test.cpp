// SPDX-License-Identifier: BSD-3-Clause
// Extremes and accelerations of a pendulum, whose rod is a point mass on a massless rod: 3 m g at its lowest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "livens/diagnostics/extremes.h"
#include "livens/multibody/joints.h"
#include "livens/spacetime/solve.h"

namespace livens::extremes_test {
namespace {

struct Pendulum {
    Pendulum() : model({0, 0, -9.81})
    {
        model.add_body(point_mass("bob", 2, {1, 0, 0}));
        model.add_joint(rod("rod", world, 0, {{0, 0, 0}, {0, 0, 0}}, 1));
        solution = solve(model, {{model.start()}}, make_time_mesh(0, 3, 20), Lobatto{5});
    }
    Extremes of(const std::string& what, bool is_refined) const
    {
        const Quantities quantities(model, solution.motion, {"bob"});
        const auto& all = quantities.all();
        const auto q = std::ranges::find(all, what, &NamedQuantity::name);
        const ExactSampler exact(model, solution.motion, solution.method);
        const BetterState better = [&](double t) -> std::optional<BetterSample> {
            ExactSample sample = exact.at(t);
            return BetterSample{std::move(sample.state), std::move(sample.joints)};
        };
        const QuantitySeries series{*q};
        return find_extremes(quantities, solution.motion, {&series, 1},
                             is_refined ? better : BetterState())[0];
    }
    Model model;
    Solution solution;
};

TEST(Extremes, AreThoseOfTheFormula)
{
    const Pendulum pendulum;
    ASSERT_TRUE(pendulum.solution.report.converged());
    const double exact = 3 * 2 * 9.81;
    EXPECT_NEAR(pendulum.of("rod.force", true).largest.value, exact, 1e-6 * exact);
    EXPECT_NEAR(pendulum.of("bob.acceleration", true).largest.value, 2 * 9.81, 1e-5);
    // Without better states they are those of the polynomials (control).
    EXPECT_GT(std::abs(pendulum.of("rod.force", false).largest.value - exact), 1e-6 * exact);
}

TEST(Accelerations, AreWhatForcesMake)
{
    const Pendulum pendulum;
    const Motion& motion = pendulum.solution.motion;
    const Accelerations accelerations(pendulum.model, motion);
    const ExactSampler exact(pendulum.model, motion, pendulum.solution.method);
    for (const double t : {0.0, 0.13, 0.71, 1.5, 2.99}) {
        const ExactSample sample = exact.at(t);
        const Vector3 a = accelerations.at(sample.state).A[0].column(0);
        const Vector3 force = sample.joints[0].right.force + Vector3{0, 0, -2 * 9.81};
        EXPECT_NEAR(norm(a - 0.5 * force), 0, 1e-10) << t;
    }
}

/// A brick on a hinge, with a point at its free end and one on the ceiling.
TEST(Quantities, OfPointsAndInAxesOfBodiesAreThoseOfTheWorldTurned)
{
    Model model({0, 0, -9.81});
    const Matrix3 turned = directors_from_rotation_vector({0.1, 0.4, -0.2});
    Placement placement;
    placement.directors = turned;
    model.add_body(rigid_body("bar", {2, {0.5, 0, 0}, Matrix3{0.02, 0, 0, 0, 0.3, 0, 0, 0, 0.3}}, placement));
    JointFrame frame;
    frame.axis_first = turned.column(1);
    frame.axis_second = {0, 1, 0};
    model.add_joint(revolute("hinge", world, 0, frame));
    model.add_point({"tip", 0, {1, 0, 0.2}});
    model.add_point({"hook", world, {0, 0, 3}});
    const Solution solution = solve(model, {{model.start()}}, make_time_mesh(0, 1, 10), Lobatto{5});
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    const Quantities quantities(model, solution.motion, {"bar"});
    const State state = sample_state(solution.motion, 0.7);
    std::vector<double> numbers(static_cast<std::size_t>(quantities.n_numbers()));
    quantities.at(state, Side::right, quantities.all(), numbers);
    const auto of = [&](const std::string& name) {
        const auto q = std::ranges::find(quantities.all(), name, &NamedQuantity::name);
        EXPECT_NE(q, quantities.all().end()) << name;
        const double* x = numbers.data() + q->first;
        return Vector3{x[0], x[1], x[2]};
    };
    const Matrix3 R = directors(state.X[0]);
    EXPECT_GT(norm(of("hinge.force") - of("hinge.force_in.bar")), 1) << "other axes, other numbers";
    EXPECT_LE(norm(R * of("hinge.force_in.bar") - of("hinge.force")), 1e-9 * norm(of("hinge.force")));
    EXPECT_LE(norm(R * of("hinge.torque_in.bar") - of("hinge.torque")), 1e-9 * norm(of("hinge.torque")));
    const Vector3 arm = R * Vector3{1, 0, 0.2}, w = of("bar.angular_velocity");
    EXPECT_LE(norm(of("tip.position") - arm), 1e-9);
    EXPECT_LE(norm(of("tip.velocity") - cross(w, arm)), 1e-9);
    const Vector3 a = cross(of("bar.angular_acceleration"), arm) + cross(w, cross(w, arm));
    EXPECT_GT(norm(a), 1);
    EXPECT_LE(norm(of("tip.acceleration") - a), 1e-9 * norm(a));
    EXPECT_EQ(of("hook.position"), (Vector3{0, 0, 3}));
    EXPECT_EQ(of("hook.velocity"), Vector3{});
    for (const NamedQuantity& q : quantities.all())
        EXPECT_EQ(q.is_on_request, q.axes != world || q.of == QuantityOf::point) << q.name();
}

TEST(Accelerations, StandOnTheJointsBetweenElementEnds)
{
    Pendulum pendulum;
    const Motion motion =
        solve(pendulum.model, {{pendulum.model.start()}}, make_time_mesh(0, 3, 12), Lobatto{3}).motion;
    const Accelerations accelerations(pendulum.model, motion);
    double raw_length = 0, raw_rate = 0;
    for (const double t : {0.07, 0.61, 1.33, 2.9}) {
        const State raw = sample_state(motion, t), held = accelerations.on_joints(raw);
        const auto place = [](const State& s) { return s.X[0].column(0); };
        const auto rate = [&](const State& s) { return dot(place(s), s.V[0].column(0)); };
        raw_length = std::max(raw_length, std::abs(norm(place(raw)) - 1));
        raw_rate = std::max(raw_rate, std::abs(rate(raw)));
        EXPECT_NEAR(norm(place(held)), 1, 1e-12) << t;
        EXPECT_NEAR(rate(held), 0, 1e-13) << t;
        EXPECT_LT(norm(place(held) - place(raw)), 2 * std::abs(norm(place(raw)) - 1) + 1e-12)
            << "the nearest";
        // What accelerates it holds the rod: x . x'' + |x'|^2 = 0, and belongs to the reaction there.
        const AcceleratedState at = accelerations.at(raw);
        const Vector3 a = at.A[0].column(0), v = held.V[0].column(0);
        EXPECT_NEAR(dot(place(held), a) + dot(v, v), 0, 1e-10) << t;
        const Vector3 force = sample_joints(pendulum.model, motion, t)[0].right.force;
        EXPECT_LT(norm(2.0 * a - force - Vector3{0, 0, -2 * 9.81}), 1e-10) << t;
    }
    EXPECT_GT(raw_length, 1e-6) << "negative control";
    EXPECT_GT(raw_rate, 1e-5) << "negative control";
    // At ends the motion's own state stands.
    const State end = sample_state(motion, motion.mesh.ends[3]);
    EXPECT_EQ(accelerations.on_joints(end).X[0], end.X[0]);
}

TEST(DenseInstants, KeepElementEndsAndResolveElements)
{
    const Pendulum pendulum;
    const std::vector<SeenInstant> all = dense_instants(pendulum.solution.motion);
    EXPECT_GE(all.size(), 600u);
    for (const double end : pendulum.solution.motion.mesh.ends)
        EXPECT_TRUE(std::ranges::count(all, end, &SeenInstant::t) >= 1) << end;
}

}   // namespace
}   // namespace livens::extremes_test
