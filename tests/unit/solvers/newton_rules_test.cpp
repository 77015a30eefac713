// SPDX-License-Identifier: BSD-3-Clause
// The rules of Newton's iteration, each by increments and rows that are written down.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "livens/solvers/newton.h"
#include "newton_problems.h"

namespace livens::newton_rules_test {
namespace {

TEST(NewtonRules, ConvergesWhereTheNextIncrementIsTheTolerance)
{
    const Values rows(10, 1.0);
    for (const double length : {1.0, 1e-3}) {
        Scripted at({1e-3, 1e-8 * length}, rows), above({1e-3, 1.01e-8 * length}, rows);
        at.length = above.length = length;
        EXPECT_EQ(run(at, 1e-8).iterations, 1);
        EXPECT_EQ(run(above, 1e-8).iterations, 2);
    }
    // foretold 1e-13, 1e-8 and 1.01e-8, with rows small enough, or just not
    for (const auto& [row, iterations] : {std::pair{1e-8, 1}, {1.01e-8, 2}}) {
        Scripted problem({1e-5, 1e-14}, {1, row});
        problem.foretell = true;
        EXPECT_EQ(run(problem, 1e-8).iterations, iterations);
    }
    for (const auto& [first, iterations] : {std::pair{1e-3, 1}, {1.01e-3, 2}}) {
        Scripted problem({first, 1e-14}, {1e-4, 1e-9});
        problem.foretell = true;
        EXPECT_EQ(run(problem, 1e-8).iterations, iterations);
        EXPECT_EQ(problem.n_solves, iterations);
    }
}

TEST(NewtonRules, MakesNewFactorsWhereRowsForetoldTooMuch)
{
    Scripted problem({0.05, 0.04, 1e-3}, {1, 0.01, 1e-5});   // foretold 5e-4, solved for 0.04
    problem.foretell = true;
    const NewtonReport report = run(problem);
    EXPECT_EQ(report.status, SolveStatus::converged);
    ASSERT_EQ(report.factorisations, 2);
    EXPECT_EQ(problem.solves_before[1], 2);
    EXPECT_EQ(problem.steps_before[1], 1) << "no step with the increment that did not shrink";
}

TEST(NewtonRules, HalvesDoublesAndRenewsFactorsAfterDampedSteps)
{
    Scripted problem({1, 2, 2, 0.1, 0.5, 0.1, 0.1}, Values(20, 1.0));
    EXPECT_EQ(run(problem).status, SolveStatus::converged);
    EXPECT_EQ(problem.dampings, (Values{1, 0.5, 0.25, 0.5, 1}));
    EXPECT_EQ(problem.solves_before, (std::vector<int>{0, 4, 6}));
}

TEST(NewtonRules, DoesNotConvergeWithADampedStep)
{
    Scripted problem({1, 2, 1e-14}, Values(20, 1.0));
    const NewtonReport report = run(problem);
    EXPECT_EQ(report.status, SolveStatus::converged);
    EXPECT_EQ(report.iterations, 2);
    EXPECT_EQ(problem.dampings, (Values{1, 0.5, 1}));
}

TEST(NewtonRules, StopsWhereRowsAreWithinFourTimesTheirRounding)
{
    for (const bool foretell : {false, true})
        for (const auto& [row, is_there] : {std::pair{3.9e-10, true}, {4.1e-10, false}}) {
            Scripted problem({1e-3, 0.9e-3, 1e-14}, {row, row, 1e-12});
            problem.rounding = 1e-10;
            problem.foretell = foretell;
            const NewtonReport report = run(problem);
            EXPECT_EQ(report.status, SolveStatus::converged);
            EXPECT_EQ(problem.dampings.size() == 1, is_there);
            if (is_there) {
                EXPECT_EQ(problem.n_solves, foretell ? 1 : 2);
            }
        }
}

TEST(NewtonRules, KeepsFactorsAsLongAsTheirContractionIsWorthIt)
{
    // solved for: next increment over this one
    for (const auto& [next, n] : {std::pair{0.58e-9, 1}, {0.62e-9, 2}}) {
        Scripted problem({2e-9, next, 1e-13}, Values(20, 1.0));
        EXPECT_EQ(run(problem).factorisations, n);
    }
    // foretold: near steps only, and a tenth of what the rows of the first tell
    for (const auto& [size, n] : {std::pair{0.09, 1}, {0.11, 2}}) {
        Scripted problem({size, 1e-4}, {1, 1e-3, 1e-9});
        problem.foretell = true;
        EXPECT_EQ(run(problem, 1e-8).factorisations, n);
    }
    Scripted problem({0.05, 1e-3, 1e-7}, {1, 0.35, 1e-4, 1e-9});
    problem.foretell = true;
    EXPECT_EQ(run(problem, 1e-8).factorisations, 1);
    // then by the increments
    Scripted slow({0.05, 0.02, 1e-7}, {1, 0.35, 1e-4, 1e-9});
    slow.foretell = true;
    EXPECT_EQ(run(slow, 1e-8).factorisations, 2);
}

TEST(NewtonRules, GivesUpWhereTheShortestStepIsStillALongOne)
{
    Values increments(13, 4e3);
    increments.front() = 2e3;
    increments[11] = 1.9e3;   // after 1/1024
    Scripted problem(increments, Values(40, 1.0));
    const NewtonReport report = run(problem);
    EXPECT_EQ(report.status, SolveStatus::not_converged);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_EQ(report.smallest_damping, 1.0 / 1024);
    EXPECT_FALSE(report.reached_limit);
}

}   // namespace
}   // namespace livens::newton_rules_test
