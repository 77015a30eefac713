// SPDX-License-Identifier: BSD-3-Clause
// The equations of all phases between conditions, as Newton's iteration sees them.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "livens/spacetime/nodal/phases_window.h"
#include "livens/spacetime/nodal/unknowns_window.h"
#include "livens/spacetime/planned_phases.h"
#include <mechanisms.h>   // of all tests, not of this folder

namespace livens::tests::phases_window_test {
namespace {

constexpr double end = 0.3, release = 0.17;

/// Two bricks, of which the second lets go.
Model released(double until)
{
    const Model whole = two_bricks();
    Model model(whole.gravity());
    for (const Body& body : whole.bodies()) model.add_body(body);
    for (Joint joint : whole.joints()) {
        if (joint.name == "elbow") joint.until = until;
        model.add_joint(std::move(joint));
    }
    return model;
}

Rebuilt rebuilt(double until, bool is_known)
{
    Rebuilt all{std::make_shared<const Model>(released(until)), {}, 0, end, {}};
    const auto add = [&](std::initializer_list<const char*> names, Condition::At at) {
        for (const char* name : names)
            all.components.push_back({state_quantities(*all.model, name).at(0), 0.1, at});
    };
    if (!is_known) {
        add({"lower.x", "lower.y", "upper.rotation_x", "lower.vx", "lower.vz", "lower.angular_velocity_y"},
            Condition::At::start);
        add({"lower.z", "lower.rotation_y", "upper.angular_velocity_z", "lower.angular_velocity_z",
             "lower.angular_velocity_x", "lower.rotation_z"},
            Condition::At::end);
    }
    add({"lower.vx"}, Condition::At::end);
    return all;
}

/// A share s of Newton's step leaves 1 - s of it, up to s^2: of a tangent that is exact, off a solution.
void expect_exact_tangent(bool is_known)
{
    const Rebuilt first = rebuilt(release, is_known);
    State guess;
    for (const Body& body : first.model->bodies()) {
        guess.X.push_back(body.X);
        guess.V.push_back(rate(body.X, {0.3, -0.2, 0.1}, {0.5, 1, -0.7}));
    }
    Problem problem{{guess, is_known ? Known::state : Known::nothing, {}, Known::nothing, first.components}};
    problem.unknowns = {{{"until", release, 0.05, 0.25}},
                        [&](std::span<const double> v) { return rebuilt(v[0], is_known); }};
    problem.unknowns.rebuild = [&, made = problem.unknowns.rebuild](std::span<const double> v) {
        Rebuilt all = made(v);
        all.state = guess;
        return all;
    };
    const Ends ends = close_ends(*first.model, problem, 0, end, StartPolicy::project);
    EXPECT_EQ(ends.is_start_known(), is_known);
    const TimeMesh mesh = make_time_mesh(0, end, 3, std::vector{release});
    const NumberedProblem numbered(*first.model, ends, mesh, problem.unknowns);
    const ElementRule rule = lobatto_rule(3);
    PlannedPhases phases(problem, numbered, 3);
    ASSERT_EQ(phases.plan().phases.size(), 2U) << phases.why();
    FoundNumbers found;
    UnknownsWindow window(
        numbered, numbered.guesses(),
        [&](const NumberedProblem::Instance& of) {
            return std::make_shared<PhasesWindow>(of.rebuilt.model, of.mesh, of.ends, phases.plan(), rule,
                                                  true);
        },
        found);
    SolveReport report;
    ASSERT_TRUE(window.open(0, mesh.n_elements(), report)) << report.message;
    const State begin = ends.start;
    ASSERT_TRUE(window.start_from([&](double t) {
        State state = begin;
        state.t = t;
        for (std::size_t b = 0; b < state.X.size(); ++b) state.X[b] += t * state.V[b];
        return state;
    }));
    NewtonProblem& equations = window.equations();
    ASSERT_TRUE(equations.residual() && (equations.keep(), true) && equations.factorise());
    std::vector<double> step(static_cast<std::size_t>(equations.n_unknowns())), left(step), off(step);
    equations.solve(step);
    const double size = equations.size_of(step);
    EXPECT_GT(size, 1e-2);
    const double share = 1e-4 / size;
    ASSERT_TRUE(equations.move(step, share) && equations.residual());
    equations.solve(left);
    for (std::size_t i = 0; i < step.size(); ++i) off[i] = left[i] - (1 - share) * step[i];
    EXPECT_LE(equations.size_of(off), 2e-3 * share * size);
}

TEST(PhaseEquations, HaveAnExactTangent) { expect_exact_tangent(false); }

TEST(PhaseEquations, HaveAnExactTangentFromAKnownStart) { expect_exact_tangent(true); }

}   // namespace
}   // namespace livens::tests::phases_window_test
