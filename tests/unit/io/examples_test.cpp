// SPDX-License-Identifier: BSD-3-Clause
// The examples as shipped: all are read without a word, and hold every instant that the tests compare at.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "livens/io/scenario.h"
#include "livens/io/scenario/text/tree.h"
#include "livens/io/solve_scenario.h"
#include "livens/spacetime/solve.h"
#include "unit/io/scenario_text.h"

namespace livens::examples_test {

namespace {

const std::filesystem::path folder = std::string(LIVENS_SOURCE_DIR) + "/examples";

Scenario example(const std::string& name)
{
    ScenarioResult result = read_scenario(folder / (name + ".toml"));
    EXPECT_TRUE(result.scenario.has_value()) << test::shown(result);
    EXPECT_TRUE(result.diagnostics.empty()) << test::shown(result);
    return result.scenario ? std::move(*result.scenario) : Scenario();
}

TEST(Examples, AllAreReadWithoutAWord)
{
    int n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".toml") continue;
        const Scenario scenario = example(entry.path().stem());
        EXPECT_FALSE(scenario.title.empty()) << entry.path();
        ++n;
    }
    EXPECT_GE(n, 18);
}

TEST(Examples, AreTheSameAsTrees)
{
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path());
        const Scenario scenario = example(entry.path().stem());
        Findings findings;
        const std::optional<Node> root = parse_toml(scenario.text, findings);
        ASSERT_TRUE(root.has_value());
        const ScenarioResult whole = read_tree(*root, scenario.text);
        ASSERT_TRUE(whole.scenario.has_value()) << test::shown(whole);
        EXPECT_EQ(whole.scenario->resolved, scenario.resolved);
        EXPECT_EQ(whole.scenario->model.length(), scenario.model.length());
        const ScenarioResult model = read_tree(*root, "", {}, TreePart::model);
        EXPECT_TRUE(!model.scenario.has_value() && model.diagnostics.empty()) << test::shown(model);
    }
}

TEST(Examples, BeginWithThreeLinesOnWhatTheyShow)
{
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".toml") continue;
        std::ifstream stream(entry.path());
        std::string line;
        for (int i = 0; i < 3; ++i) {
            std::getline(stream, line);
            EXPECT_EQ(line.substr(0, 2), "# ") << entry.path();
        }
        std::getline(stream, line);
        EXPECT_EQ(line, "format = 1") << entry.path();
    }
}

TEST(Examples, HoldEveryInstantOfTheReferences)
{
    const std::map<std::string, std::vector<double>> instants{{"free_box", {0.5, 1}},
                                                              {"rectangular_torque", {0.5, 1.5, 4}},
                                                              {"double_pendulum_centred", {1, 2, 5, 10}},
                                                              {"double_pendulum_offset", {1, 2, 5}},
                                                              {"double_pendulum_spatial", {1, 2, 5}},
                                                              {"torque_free_top", {1, 5, 20}},
                                                              {"simple_pendulum", {1, 2, 3, 5, 9.99, 10}},
                                                              {"lagrange_top", {1, 2, 5, 10}},
                                                              {"dzhanibekov", {1, 2, 5, 10, 20, 50}},
                                                              {"revolute_double_pendulum", {0.5, 1, 2, 3, 5}},
                                                              {"ball_pendulum_two", {0.5, 1, 2, 3, 5}}};
    for (const auto& [name, times] : instants) {
        const Scenario scenario = example(name);
        const std::vector<double>& output = scenario.output;
        const std::vector<double>& ends = std::get<TimeMesh>(scenario.time).ends;
        for (const double t : times) {
            EXPECT_EQ(std::count(output.begin(), output.end(), t), 1) << name << " at " << t;
            EXPECT_EQ(std::count(ends.begin(), ends.end(), t), 1) << name << " at " << t;
        }
    }
}

void expect_inertia(const Scenario& scenario, int body, double mass, const Vector3& moments)
{
    const MassProperties p = mass_properties(scenario.model.bodies()[body].mass);
    EXPECT_NEAR(p.mass, mass, 1e-14 * mass);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(p.inertia(i, i), moments[i], 1e-13) << i;
}

TEST(Examples, BodiesAreThoseOfTheSources)
{
    expect_inertia(example("free_box"), 0, 3, {0.5, 1.25, 1.25});
    const Scenario pendulum = example("double_pendulum_offset");
    expect_inertia(pendulum, 1, 0.768, {0.08192, 0.08192, 0.08192});
    EXPECT_NEAR(mass_properties(pendulum.model.bodies()[1].mass).center_of_mass[0], 0.1, 1e-16);
    const Scenario bricks = example("ball_pendulum_two");
    for (const int body : {0, 1}) expect_inertia(bricks, body, 1, {0.05 / 12, 1.01 / 12, 1.04 / 12});
}

TEST(Examples, SpinsAreThoseOfTheSources)
{
    const Body top = example("lagrange_top").model.bodies()[0];
    const Vector3 w = transpose(directors(top.X)) * angular_velocity(top.X, top.V);
    EXPECT_NEAR(norm(w - Vector3{0, 0, 50}), 0, 1e-12);
    EXPECT_NEAR(top.X(2, 3), std::cos(0.05), 1e-15);
    EXPECT_NEAR(top.X(1, 3), -std::sin(0.05), 1e-15);
    const Scenario spatial = example("double_pendulum_spatial");
    for (const Body& body : spatial.model.bodies())
        EXPECT_EQ(body.V.column(3), (Vector3{0, 1, 0})) << "d3' as in the source";
}

/// How far the directors of a body are from others.
double gap(const Matrix34& X, const Matrix3& triad) { return norm(project_directors(directors(X)) - triad); }

Motion solved(const Scenario& s)
{
    Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
    EXPECT_TRUE(solution.report.converged()) << s.title << ": " << solution.report.message;
    return std::move(solution.motion);
}

TEST(Examples, BackwardLeadsToWhereTheBricksWereLetGo)
{
    const Scenario forward = example("ball_pendulum_two");
    const State start = solved(example("backward")).at_end(0);
    for (int b = 0; b < 2; ++b) {
        const Matrix34& X = forward.model.bodies()[b].X;
        EXPECT_LT(norm(start.X[b].column(0) - X.column(0)), 1e-8) << b;
        EXPECT_LT(gap(start.X[b], directors(X)), 3e-8) << b;
        EXPECT_LT(norm(start.V[b]), 1e-4) << "at rest";
    }
}

TEST(Examples, TwoPointArrivesWhenItIsThrown)
{
    const Scenario s = example("two_point");
    const Motion motion = solved(s);
    const Matrix34& P = motion.momenta.front();
    Vector3 spin{};   // moment of momentum; the mass centre is the reference point
    for (int c = 1; c < 4; ++c) spin += cross(motion.at_end(0).X[0].column(c), P.column(c));
    const MassProperties m = mass_properties(s.model.bodies()[0].mass);
    State thrown = s.conditions.start;
    thrown.V[0] = rate(thrown.X[0], (1 / m.mass) * P.column(0), inverse(m.inertia) * spin);
    const Solution forward = solve(s.model, {thrown}, make_time_mesh(0, 1, 10), Lobatto{8});
    const Matrix34 arrived = forward.motion.at_end(10).X[0];
    EXPECT_LT(norm(thrown.V[0].column(0) - Vector3{3, 0, 4.905}), 1e-12);
    EXPECT_LT(norm(arrived - s.conditions.end.X[0]), 1e-10);
}

/// The drag by shooting over a march of tight tolerance, which knows nothing of columns by a number.
TEST(Examples, DamperToFindIsTheKnownOneAndBringsItThere)
{
    const Scenario s = example("damper_to_find");
    const SolvedScenario found = solve_scenario(s, s.options, s.prepared);
    ASSERT_TRUE(found.solution.report.converged()) << found.solution.report.message;
    EXPECT_NEAR(found.solution.numbers.values.at(0), 0.763693631412843, 1e-12);
    const Solution march =
        solve(found.found->model, {{found.solution.motion.at_end(0)}}, make_time_mesh(0, 2, 40), Lobatto{8});
    EXPECT_NEAR(march.motion.at_end(40).X[0](0, 0), 0.5, 1e-9);
}

TEST(Examples, TheFourBarIsRedundantAndHasOneFreedom)
{
    const Scenario scenario = example("four_bar");
    const ConsistentStart assembly =
        consistent_start(scenario.model, scenario.model.start(), StartPolicy::check);
    EXPECT_EQ(scenario.model.n_rows(), 20);
    EXPECT_EQ(assembly.independent.size(), 17u);
    EXPECT_EQ(assembly.redundant.size(), 3u);
    EXPECT_EQ(assembly.degrees_of_freedom, 1);
}

}   // namespace

}   // namespace livens::examples_test
