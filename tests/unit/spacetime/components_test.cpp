// SPDX-License-Identifier: BSD-3-Clause
// The equations of conditions by component, as Newton's iteration sees them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"
#include "livens/spacetime/march/condition_rows.h"
#include "livens/spacetime/nodal/window.h"
#include <mechanisms.h>   // of all tests, not of this folder

namespace livens::tests::components_test {
namespace {

struct Case {
    const char* name;
    Model model;
    std::vector<std::string> at_start, at_end, at_both;
};

std::vector<Condition> conditions_of(const Case& one)
{
    std::vector<Condition> all;
    for (const auto& [names, at] : {std::pair{&one.at_start, Condition::At::start},
                                    {&one.at_end, Condition::At::end},
                                    {&one.at_both, Condition::At::both}})
        for (const std::string& name : *names)
            all.push_back({state_quantities(one.model, name).at(0), 0.1, at});
    return all;
}

std::vector<Case> cases()
{
    return {{"hinged links", hinged_links(), {"shoulder.angle", "lower.vx"}, {"elbow.angle", "lower.y"}, {}},
            {"four-bar", four_bar(), {"crank shaft.angle_rate"}, {}, {"rocker shaft.angle"}},
            {"two bricks",
             two_bricks(),
             {"lower.x", "lower.y", "upper.rotation_x", "lower.vx", "lower.vz", "lower.angular_velocity_y"},
             {"lower.z", "lower.rotation_y", "upper.angular_velocity_z", "lower.angular_velocity_z"},
             {"lower.angular_velocity_x", "lower.rotation_z"}},
            {"box",
             free_box({1, 2, 0}),
             {"box.x", "box.y", "box.z", "box.rotation_x", "box.rotation_y", "box.rotation_z"},
             {"box.vx", "box.vy", "box.vz"},
             {"box.angular_velocity_x", "box.angular_velocity_y", "box.angular_velocity_z"}}};
}

/// What is alike at both ends is the end less the start: where both are given beside it, one of three rows
/// says nothing, and unknown numbers, of which the same holds, do not hide that.
TEST(ComponentEquations, OfBothEndsAreThoseOfTheEndLessThoseOfTheStart)
{
    const Model model = hinged_links();
    const ModelTables tables(model, consistent_start(model, model.start(), StartPolicy::project).independent);
    State there = model.start();
    for (std::size_t b = 0; b < there.X.size(); ++b)
        there.V[b] = rate(there.X[b], {0.3, -0.2, 0.1}, {0, 1.3 - 0.5 * static_cast<double>(b), 0});
    EndPoint start(tables), end(tables);
    ASSERT_TRUE(start.place(model.start()) && end.place(there));
    for (const char* name : {"shoulder.angle", "elbow.angle_rate", "lower.vx"}) {
        const StateQuantity q = state_quantities(model, name).at(0);
        const std::vector<Condition> all{
            {q, 0.1, Condition::At::start}, {q, 0.1, Condition::At::end}, {q, 0, Condition::At::both}};
        const DenseMatrix rows = rows_at({&tables, &tables}, all, {&start, &end}, 0.7, {});
        double largest = 0;
        for (int j = 0; j < rows.cols; ++j) {
            EXPECT_EQ(rows(2, j), rows(1, j) - rows(0, j)) << name << ' ' << j;
            largest = std::max({largest, std::abs(rows(0, j)), std::abs(rows(1, j))});
        }
        EXPECT_GT(largest, 0.01);
    }
}

/// A share s of Newton's step leaves 1 - s of it, up to s^2: of a tangent that is exact, off a solution, with
/// momenta at both ends that turn with the bodies.
TEST(ComponentEquations, HaveAnExactTangent)
{
    for (const Case& one : cases()) {
        State guess;
        for (const Body& body : one.model.bodies()) {
            guess.X.push_back(body.X);
            guess.V.push_back(rate(body.X, {0.3, -0.2, 0.1}, {0.5, 1, -0.7}));
        }
        const Problem problem{{guess, Known::nothing, {}, Known::nothing, conditions_of(one)}};
        Ends ends = close_ends(one.model, problem, 0, 0.3, StartPolicy::project);
        const ModelTables tables(one.model, ends.independent);
        const TimeMesh mesh = make_time_mesh(0, 0.3, 2);
        NodalWindow window(tables, mesh, ends, lobatto_rule(3));
        SolveReport report;
        ASSERT_TRUE(window.open(0, 2, report)) << one.name;
        // steadily on, which is no motion under these loads, and turns the joints off their places
        const State begin = ends.start;
        ASSERT_TRUE(window.start_from([&](double t) {
            State state = begin;
            state.t = t;
            for (std::size_t b = 0; b < state.X.size(); ++b) state.X[b] += t * state.V[b];
            return state;
        })) << one.name;
        NewtonProblem& equations = window.equations();
        ASSERT_TRUE(equations.residual() && (equations.keep(), true) && equations.factorise()) << one.name;
        std::vector<double> step(static_cast<std::size_t>(equations.n_unknowns())), left(step), off(step);
        equations.solve(step);
        const double size = equations.size_of(step);
        EXPECT_GT(size, 1e-2) << one.name;
        const double share = 1e-4 / size;
        ASSERT_TRUE(equations.move(step, share) && equations.residual()) << one.name;
        equations.solve(left);
        for (std::size_t i = 0; i < step.size(); ++i) off[i] = left[i] - (1 - share) * step[i];
        EXPECT_LE(equations.size_of(off), 2e-3 * share * size) << one.name;
    }
}

}   // namespace
}   // namespace livens::tests::components_test
