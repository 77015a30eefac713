// SPDX-License-Identifier: BSD-3-Clause
// Motions between both ends of time to an accuracy, against the motions that made the conditions.
#include <algorithm>
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "newton_euler.h"

namespace livens::tests::accuracy_ends_test {
namespace {

Model hinged_brick()
{
    Model model({0, -9.81, 0});
    const int bar = model.add_body(rigid_body("bar", brick({})));
    model.add_joint(revolute("hinge", world, bar, {}));
    return model;
}

/// A motion from a state that moves, on a mesh as fine as that it has nothing but rounding.
struct Made {
    std::string name;
    Model model;
    double end;
    Motion motion{};
};

Made made(const std::string& name, const Model& model, double before, double end)
{
    Made run{name, model, end};
    State start = last(solve_evenly(model, before, 40, 8));
    start.t = 0;
    const Solution s = solve(model, {start}, make_time_mesh(0, end, 100, model.load_breaks()), Lobatto{10});
    EXPECT_TRUE(s.report.converged()) << name << ": " << s.report.message;
    run.motion = s.motion;
    return run;
}

State faster(State state, double factor)
{
    for (Matrix34& V : state.V) V *= factor;
    return state;
}

double distance_of(const Model& model, const State& a, const State& b)
{
    double error = 0;
    for (int i = 0; i < model.n_bodies(); ++i) {
        const BodyGap gap = gap_between(a, b, model.bodies()[i], i, model.length());
        error = std::max({error, gap.position, gap.orientation});
    }
    return error;
}

/// At all element ends.
double true_error(const Made& run, const Motion& found)
{
    double error = 0;
    for (int e = 0; e <= found.n_elements(); ++e)
        error = std::max(error, distance_of(run.model, found.at_end(e), run.motion.at(found.mesh.ends[e])));
    return error;
}

/// Rates beside places that are given are 5 % off.
livens::Problem problem_of(const Made& run, Known at_start, Known at_end)
{
    const auto stated = [&](int end, Known known) {
        const State state = run.motion.at_end(end);
        return known == Known::positions ? faster(state, 1.05) : state;
    };
    return {{stated(0, at_start), at_start, stated(run.motion.n_elements(), at_end), at_end}};
}

constexpr Known places = Known::positions, momenta = Known::momenta;

/// What a motion between these ends says of itself is true, and a march of the same motion takes at least
/// half as many elements.
void expect_accurate(const Made& run, Known at_start, Known at_end, double accuracy)
{
    const Solution s =
        solve(run.model, problem_of(run, at_start, at_end), Span{0, run.end, accuracy}, Lobatto{0});
    ASSERT_TRUE(s.report.converged()) << run.name << ", " << accuracy << ": " << s.report.message;
    const double error = true_error(run, s.motion);
    EXPECT_LE(error, accuracy) << run.name;
    EXPECT_LE(s.verdict.estimated_error, accuracy) << run.name;
    // rounding moves the motion that made the conditions, too
    EXPECT_GE(2 * s.verdict.estimated_error + 1e-12, error) << run.name << ", " << accuracy;
    const Solution march = solve(run.model, {run.motion.at_end(0)}, Span{0, run.end, accuracy}, Lobatto{0});
    ASSERT_TRUE(march.report.converged()) << run.name << ": " << march.report.message;
    EXPECT_LE(s.motion.n_elements(), 2 * march.motion.n_elements()) << run.name << ", " << accuracy;
    tell(run.name + ": elements between ends", s.motion.n_elements());
    tell(run.name + ": elements of the march", march.motion.n_elements());
    tell(run.name + ": true error", error);
    tell(run.name + ": estimated error", s.verdict.estimated_error);
}

TEST(AccuracyBetweenEnds, IsReachedWithFewElements)
{
    for (const auto& [known, most] : {std::pair{std::pair{places, places}, 5},
                                      {{places, momenta}, 5},
                                      {{momenta, places}, 4},
                                      {{momenta, momenta}, 2}}) {
        const Made runs[] = {
            made("four-bar", four_bar(), 0.2, 1), made("pendulum", hinged_brick(), 0.2, 0.4),
            made("double pendulum", cubes_on_rods(0.1), 0.3, known.second == momenta ? 1 : 2),
            made("box", free_box(), 0.5, 1), made("two bricks", two_bricks(), 0.2, 0.5)};
        for (int i = 0; i < most; ++i) expect_accurate(runs[i], known.first, known.second, 1e-9);
    }
}

TEST(AccuracyBetweenEnds, OfAnySizeIsReached)
{
    const Made runs[] = {made("double pendulum", cubes_on_rods(0.1), 0.3, 4),
                         made("two bricks", two_bricks(), 0.2, 1.5)};
    for (const Made& run : runs)
        for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10})
            expect_accurate(run, places, places, accuracy);
}

/// Places of the bricks at 0.2 s and at 0.7 s, and between them, by the equations of Newton and Euler with an
/// integrator that shares nothing with the engine.
TEST(AccuracyBetweenEnds, HoldsAgainstAnotherIntegrator)
{
    const Model model = two_bricks();
    const NewtonEuler witness(model, [](double, Movers&) {}, {{world, {}, 0, {}}, {0, {1, 0, 0}, 1, {}}});
    const State start = witness.run(0, 0.2, 60), end = witness.run(0, 0.7, 200);
    const Solution s =
        solve(model, {{faster(start, 1.05), places, faster(end, 0), places}}, Span{0, 0.5, 1e-9}, Lobatto{0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    for (int e = 0; e <= s.motion.n_elements(); ++e) {
        const double t = 0.2 + s.motion.mesh.ends[e];
        EXPECT_LE(distance_of(model, s.motion.at_end(e), witness.run(0, t, 40 + static_cast<int>(240 * t))),
                  1e-9)
            << t;
    }
}

/// As many elements of equal length are worse: the motion is slow at its turning points.
TEST(AccuracyBetweenEnds, PutsElementsWhereTheyAreNeeded)
{
    const Made run = made("double pendulum", cubes_on_rods(0.1), 0.3, 4);
    const Solution s = solve(run.model, problem_of(run, places, places), Span{0, run.end, 1e-9}, Lobatto{0});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const int degree = std::get<Lobatto>(s.method).degree;
    const Solution even = solve(run.model, problem_of(run, places, places),
                                make_time_mesh(0, run.end, s.motion.n_elements()), Lobatto{degree});
    ASSERT_TRUE(even.report.converged()) << even.report.message;
    EXPECT_GT(true_error(run, even.motion), 10 * true_error(run, s.motion));
    EXPECT_GT(true_error(run, even.motion), 1e-9);
}

TEST(AccuracyBetweenEnds, OutputTimesAndJumpsOfLoadsAreElementEnds)
{
    Model model = hinged_brick();
    model.add_load(point_force("push", 0, {1, 0, 0}, {window(8, 0.131, 0.177), 0, 0}, Frame::inertial));
    const Made run = made("pushed", model, 0.05, 0.4);
    Span span{0, run.end, 1e-9};
    for (int k = 1; k <= 40; ++k) span.output.push_back(run.end * k / 40);
    for (const bool has_output : {false, true}) {
        if (!has_output) span.output.clear();
        const Solution s = solve(model, problem_of(run, places, places), span, Lobatto{0});
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LE(true_error(run, s.motion), 1e-9);
        for (const double t : {0.131, 0.177}) EXPECT_EQ(s.motion.mesh.ends[s.motion.mesh.element_at(t)], t);
        for (const double t : span.output) EXPECT_EQ(s.motion.at(t).t, t);
        span.output = {0.02, 0.1, 0.3, 0.399};
    }
}

/// A rope that holds back once it is taut: elements end where its law bends, as far as that is known.
TEST(AccuracyBetweenEnds, EndsElementsWhereLawsBend)
{
    Model model = hinged_brick();
    model.add_load(
        spring_damper("rope", world, {0, -1.2, 0}, 0, {1, 0, 0},
                      {.free_length = 0.9, .law = tabulated_spring({-1, 0, 1}, {0, 0, 300}, false)}));
    const Made run = made("roped", model, 0.1, 0.4);
    for (const double accuracy : {1e-4, 1e-6, 1e-9}) {
        const Solution s =
            solve(model, problem_of(run, places, momenta), Span{0, run.end, accuracy}, Lobatto{0});
        EXPECT_GT(s.motion.n_elements(), 0) << s.report.message;
        tell("roped: tries", s.report.tries);
        tell("roped: elements", s.motion.n_elements());
        tell("roped: true error", true_error(run, s.motion));
        tell("roped: estimated error", s.estimate.largest);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LE(true_error(run, s.motion), accuracy);
        EXPECT_LE(true_error(run, s.motion), 2 * s.estimate.largest + 1e-12);
        EXPECT_LE(s.motion.n_elements(), 20);
    }
}

bool says(const Solution& s, const std::string& words)
{
    return s.report.message.find(words) != std::string::npos;
}

/// Two solutions agree to less than what rounding moves both by.
TEST(AccuracyBetweenEnds, IsGivenUpWhereRoundingIsMore)
{
    const Made run = made("two bricks", two_bricks(), 0.2, 1.5);
    const Solution s =
        solve(run.model, problem_of(run, places, momenta), Span{0, run.end, 1e-11}, Lobatto{0});
    EXPECT_EQ(s.report.status, SolveStatus::inaccurate) << s.report.message;
    EXPECT_TRUE(says(s, "1e-11 is not reached between the two ends")) << s.report.message;
    EXPECT_TRUE(says(s, "rounding may move the motion by")) << s.report.message;
    EXPECT_LE(true_error(run, s.motion), 1e-9) << "the motion is as good as it can be";
    EXPECT_GE(s.estimate.largest, true_error(run, s.motion));
    tell("given up: true error", true_error(run, s.motion));
    tell("given up: estimated error", s.estimate.largest);
}

TEST(AccuracyBetweenEnds, IsGivenUpWhereElementsTakeTooMuchMemory)
{
    const Made run = made("double pendulum", cubes_on_rods(0.1), 0.3, 2);
    SolveOptions options;
    options.most_bytes = 1e5;
    const Solution s =
        solve(run.model, problem_of(run, places, places), Span{0, run.end, 1e-12}, Lobatto{3}, options);
    EXPECT_EQ(s.report.status, SolveStatus::inaccurate) << s.report.message;
    EXPECT_TRUE(says(s, "memory")) << s.report.message;
    EXPECT_GT(s.motion.n_elements(), 0);
}

/// From a guess that stands still, and nothing else.
TEST(AccuracyBetweenEnds, WhatIsNotFoundIsSaid)
{
    const Made run = made("double pendulum", cubes_on_rods(0.1), 0.3, 4);
    livens::Problem problem = problem_of(run, places, places);
    problem.guess = [start = problem.conditions.start](double) { return start; };
    problem.is_only_guess = true;
    const Solution s = solve(run.model, problem, Span{0, run.end, 1e-6}, Lobatto{0});
    EXPECT_EQ(s.report.status, SolveStatus::not_converged) << s.report.message;
    EXPECT_EQ(s.report.tries, 3) << "on meshes each twice as fine";
    EXPECT_EQ(s.report.n_elements, 0);
}

/// Where the conditions leave a motion free, no mesh determines it.
TEST(AccuracyBetweenEnds, WhatIsNotDeterminedIsRefused)
{
    Model model({0, -9.81, 0});
    const int bar = model.add_body(rigid_body("bar", brick({}), {{}, {0, -1, 0, 1, 0, 0, 0, 0, 1}}));
    model.add_joint(revolute("hinge", world, bar, {}));
    const double half = std::numbers::pi * std::sqrt((brick({}).inertia(2, 2) + 0.25) / (9.81 * 0.5));
    State finish = model.start();
    const Solution s =
        solve(model, {{model.start(), places, finish, places}}, Span{0, half, 1e-9}, Lobatto{0});
    EXPECT_EQ(s.report.status, SolveStatus::singular) << s.report.message;
    EXPECT_TRUE(says(s, "do not determine the motion")) << s.report.message;
    const Solution longer =
        solve(model, {{model.start(), places, finish, places}}, Span{0, 1.1 * half, 1e-9}, Lobatto{0});
    EXPECT_TRUE(longer.report.converged()) << longer.report.message;
}

TEST(AccuracyBetweenEnds, StopsAsAsked)
{
    const Made run = made("double pendulum", cubes_on_rods(0.1), 0.3, 2);
    for (const int most : {1, 4, 8}) {
        SolveOptions options;
        int calls = 0;
        options.progress = [&](const Progress&) { return ++calls < most; };
        const Solution s =
            solve(run.model, problem_of(run, places, places), Span{0, run.end, 1e-9}, Lobatto{0}, options);
        EXPECT_EQ(s.report.status, SolveStatus::cancelled) << most << ": " << s.report.message;
    }
}

TEST(AccuracyBetweenEnds, TakesLobattoAndNothingElse)
{
    const Made run = made("pendulum", hinged_brick(), 0.2, 0.4);
    const livens::Problem problem = problem_of(run, places, places);
    const Span span{0, run.end, 1e-8};
    const Solution s = solve(run.model, problem, span, AutomaticFamily{});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_TRUE(std::holds_alternative<Lobatto>(s.method));
    const Solution held = solve(run.model, problem, span, Lobatto{5});
    ASSERT_TRUE(held.report.converged()) << held.report.message;
    EXPECT_EQ(held.motion.X.degree, 5);
    const auto code = [&](const Method& method) -> std::string {
        try {
            solve(run.model, problem, span, method);
        } catch (const InputError& error) {
            return error.complaint().code;
        }
        return "";
    };
    EXPECT_EQ(code(Radau{4}), "boundary-method");
    EXPECT_EQ(code(Mixed{}), "accuracy-elements");
    EXPECT_EQ(code(Lobatto{4, 0}), "accuracy-elements");
}

}   // namespace
}   // namespace livens::tests::accuracy_ends_test
