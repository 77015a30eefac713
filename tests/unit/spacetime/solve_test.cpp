// SPDX-License-Identifier: BSD-3-Clause
// What the one entry refuses, and how it says so.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/spacetime/solve.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::solve_test {
namespace {

Model stone()
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("stone", 1, {0, 0, 2}));
    return model;
}

/// The complaint about a call, or an empty one.
template <class Call>
Complaint complaint_of(Call call)
{
    try {
        call();
    } catch (const InputError& error) {
        return error.complaint();
    }
    return {};
}

TEST(Solve, NamesSmallNumbersToTheLastDigit)
{
    const Model model = stone();
    SolveOptions options;
    options.tolerance = -1e-9;
    const Complaint refused =
        complaint_of([&] { solve(model, {model.start()}, make_time_mesh(0, 1, 2), Lobatto{1}, options); });
    EXPECT_EQ(refused.code, "tolerance-out-of-range");
    EXPECT_EQ(refused.value, "-1e-09");

    const Solution fall = solve(model, {model.start()}, make_time_mesh(0, 1e-7, 2), Lobatto{1});
    const Complaint outside = complaint_of([&] { sample_exactly(model, fall.motion, Lobatto{1}, 2e-7); });
    EXPECT_EQ(outside.value + " of " + outside.bound, "2e-07 of 0 to 1e-07");
}

TEST(Solve, ASampleIsNoProgressOfARun)
{
    const Model model = stone();
    const Solution fall = solve(model, {model.start()}, make_time_mesh(0, 1, 2), Lobatto{1});
    SolveOptions options;
    int told = 0;
    options.progress = [&](const Progress&) { return ++told < 0; };   // which would stop a run
    EXPECT_TRUE(sample_exactly(model, fall.motion, Lobatto{1}, 0.3, options).report.converged());
    EXPECT_EQ(told, 0);
}

TEST(Solve, NamesRadauAndRefusesWhatItCannotDo)
{
    EXPECT_EQ(name_of(Radau{3}), "radau(3)");
    Model model;
    model.add_body(point_mass("mass", 1, {}, {1, 0, 0}));
    const TimeMesh mesh = make_time_mesh(0, 1, 4);
    const auto code = [&](const Conditions& conditions, int degree) -> std::string {
        try {
            solve(model, {conditions}, mesh, Radau{degree});
        } catch (const InputError& error) {
            return error.complaint().code + " " + error.complaint().path;
        }
        return "";
    };
    State end = model.start();
    end.t = 1;
    end.X[0].set_column(0, {1, 0, 0});
    EXPECT_EQ(code({model.start()}, 8), "");
    EXPECT_EQ(code({model.start()}, 0), "degree-out-of-range method.degree");
    EXPECT_EQ(code({model.start()}, 10), "degree-out-of-range method.degree");
    EXPECT_EQ(code({model.start(), Known::nothing, end, Known::state}, 4), "boundary-method start.given");
    EXPECT_EQ(code({model.start(), Known::positions, end, Known::positions}, 4),
              "boundary-method start.given");
}

TEST(Solve, AdvisesInConceptsAndNotInTheKeysOfFiles)
{
    const Model model = stone();
    const Problem problem{{model.start(), Known::positions, model.start(), Known::momenta}};
    const Complaint refused =
        complaint_of([&] { solve(model, problem, make_time_mesh(0, 1, 2), Midpoint{}); });
    EXPECT_EQ(refused.code, "boundary-method");
    for (const std::string& text : {refused.message, refused.bound, refused.note, refused.help})
        EXPECT_EQ(text.find(" = "), std::string::npos) << text;
}

/// The end of the motion of 0.2 s.
State end_of(const Model& model, const State& start, const std::shared_ptr<Prepared>& prepared = nullptr)
{
    SolveOptions options;
    options.judge = false;
    const Problem problem{{start}, {}, nullptr, prepared};
    const Solution solution = solve(model, problem, make_time_mesh(0, 0.2, 4), Lobatto{4}, options);
    EXPECT_TRUE(solution.report.converged()) << solution.report.message;
    return solution.motion.at_end(solution.motion.n_elements());
}

bool are_alike(const State& a, const State& b) { return a.X == b.X && a.V == b.V; }

// What was found of a model serves it until it changes.
TEST(Solve, ChangesOfAModelThatWasSolvedCount)
{
    const std::function<void(Model&)> changes[] = {
        [](Model& m) {
            m.add_load(point_force("push", 1, {}, {0.0, 3.0, 1.0}, Frame::inertial));
        },
        [](Model& m) {
            m.add_joint(
                rod("tie", world, 1, {.point_first = {1, -1, 1}, .point_second = {}}, std::sqrt(2.0)));
        },
        [](Model& m) {
            m.add_body(rigid_body("far", box(1, {1, 2, 3}), {.position = {50, 0, 0}}));
        }};
    for (const auto& change : changes) {
        Model solved = testing_models::two_bricks(), fresh = testing_models::two_bricks();
        const auto prepared = std::make_shared<Prepared>();
        const State before = end_of(solved, solved.start(), prepared);
        EXPECT_TRUE(are_alike(before, end_of(fresh, fresh.start())));
        const Model copy = solved;
        EXPECT_EQ(copy.version(), solved.version());
        change(solved);
        change(fresh);
        EXPECT_TRUE(are_alike(end_of(solved, solved.start(), prepared), end_of(fresh, fresh.start())));
        EXPECT_EQ(solved.length(), fresh.length());
        EXPECT_TRUE(are_alike(end_of(copy, copy.start(), prepared), before)) << "a copy is its own model";
        EXPECT_EQ(copy.length(), testing_models::two_bricks().length());
    }
}

TEST(Solve, EveryStartIsCheckedAndClosed)
{
    const Model model = testing_models::two_bricks();
    const auto prepared = std::make_shared<Prepared>();
    State open = model.start();
    open.X[1] += configuration({0, 0, 1e-3}, Matrix3{});
    SolveOptions project;
    project.judge = false;
    project.initial = StartPolicy::project;
    const auto solved = [&](const State& start, const SolveOptions& options) {
        const Problem problem{{start}, {}, nullptr, prepared};
        return solve(model, problem, make_time_mesh(0, 0.1, 2), Lobatto{4}, options);
    };
    for (int i = 0; i < 2; ++i) {   // what one of them was found to be is nothing to the others
        end_of(model, model.start(), prepared);
        EXPECT_EQ(complaint_of([&] { solved(open, {}); }).code, "start-position");
        const Solution moved = solved(open, project);
        EXPECT_TRUE(moved.report.converged());
        EXPECT_FALSE(moved.report.notes.empty()) << "says what it moved";
        EXPECT_EQ(complaint_of([&] { solved(open, {}); }).code, "start-position");
    }
    Model left = testing_models::two_bricks();
    const Model taken = std::move(left);
    EXPECT_TRUE(are_alike(end_of(taken, taken.start()), end_of(model, model.start())));
    left = testing_models::two_bricks();
    EXPECT_TRUE(are_alike(end_of(left, left.start()), end_of(model, model.start())));
}

}   // namespace
}   // namespace livens::solve_test
