// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration on systems of one to three equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "allocations.h"
#include "livens/solvers/newton.h"
#include "newton_problems.h"

namespace livens::newton_test {
namespace {

NewtonReport converged(Equations& problem, double tolerance = 1e-12)
{
    const NewtonReport report = run(problem, tolerance);
    EXPECT_EQ(report.status, SolveStatus::converged);
    return report;
}

TEST(Newton, SolvesLinearSystemsInOneStepWithOneFactorisation)
{
    for (const bool foretell : {false, true}) {
        Equations problem({-7, 5}, linear, linear_tangent);
        problem.foretell = foretell;
        const NewtonReport report = converged(problem);
        EXPECT_EQ(report.iterations, 1);
        EXPECT_EQ(report.factorisations, 1);
        EXPECT_EQ(report.smallest_damping, 1);
        EXPECT_LT(problem.distance({1, 1}), 1e-14);
        EXPECT_LT(report.residual, 1e-14);
    }
}

TEST(Newton, ConvergesQuadratically)
{
    Equations problem({2}, square, square_tangent);
    problem.solution = {std::sqrt(2.0)};
    converged(problem, 1e-15);
    EXPECT_LT(problem.distance(problem.solution), 4e-16);
    ASSERT_GE(problem.errors.size(), 2u);
    // e' = e^2 / (2 x) for a whole step; steps with old factors in between make it smaller still
    for (std::size_t i = 1; i < problem.errors.size(); ++i)
        EXPECT_LT(problem.errors[i], 0.4 * problem.errors[i - 1] * problem.errors[i - 1] + 1e-15);
}

TEST(Newton, DampsWhereThePathIsCurved)
{
    Equations problem({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    const NewtonReport report = converged(problem);
    EXPECT_LT(report.smallest_damping, 1);
    EXPECT_LT(problem.distance({1, 1}), 1e-12);
}

TEST(Newton, DampsWhereWholeStepsDiverge)
{
    Equations problem({10}, arctangent, arctangent_tangent);
    const NewtonReport report = converged(problem);
    EXPECT_LT(report.smallest_damping, 0.25);
    EXPECT_LT(problem.distance({0}), 1e-12);
    EXPECT_LE(report.factorisations, 5) << "damping 1/16, 1/8, 1/4, 1/2, 1";
}

TEST(Newton, FailsWithoutTheDampingThatItAsksFor)
{
    class Whole : public Equations {
    public:
        using Equations::Equations;
        bool move(std::span<const double> dx, double damping) override
        {
            return Equations::move(dx, damping > 0 ? 1 : 0);
        }
    };
    Whole problem({10}, arctangent, arctangent_tangent);
    const NewtonReport report = run(problem);
    EXPECT_EQ(report.status, SolveStatus::not_converged);
    EXPECT_FALSE(report.reached_limit);
    EXPECT_EQ(problem.x[0], 10);
    EXPECT_EQ(problem.rows_here[0], std::atan(10.0)) << "rows of the point where it stays";
}

TEST(Newton, ReportsSingularTangents)
{
    Equations problem({0}, square, square_tangent);
    const NewtonReport report = run(problem);
    EXPECT_EQ(report.status, SolveStatus::singular);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(problem.x[0], 0);
}

TEST(Newton, FindsNoRootWhereThereIsNone)
{
    const auto f = [](const Values& x, Values& r) { r[0] = x[0] * x[0] + 1; };
    Equations problem({3}, f, square_tangent);
    const NewtonReport report = run(problem);
    EXPECT_NE(report.status, SolveStatus::converged);
    EXPECT_EQ(problem.x, problem.kept);
    EXPECT_EQ(problem.rows_here[0], problem.x[0] * problem.x[0] + 1);
}

TEST(Newton, StepsAroundPlacesWhereRowsAreNotFinite)
{
    Equations problem({5}, logarithm, logarithm_tangent);   // a whole step leads to -3
    const NewtonReport report = converged(problem);
    EXPECT_LT(report.smallest_damping, 1);
    EXPECT_LT(problem.distance({1}), 1e-12);
}

TEST(Newton, ReportsRowsThatAreNotFinite)
{
    Equations at_start({-1}, logarithm, logarithm_tangent);
    NewtonReport report = run(at_start);
    EXPECT_EQ(report.status, SolveStatus::not_finite);
    EXPECT_EQ(report.factorisations, 0);
    EXPECT_EQ(report.residual, std::numeric_limits<double>::infinity());

    const auto f = [](const Values& x, Values& r) { r[0] = x[0] == 1 ? 1 : NAN; };
    Equations around({1}, f, square_tangent);
    report = run(around);
    EXPECT_EQ(report.status, SolveStatus::not_finite);
    EXPECT_EQ(around.x[0], 1);
    EXPECT_EQ(around.rows_here[0], 1);
}

TEST(Newton, StaysAtASolution)
{
    for (const bool foretell : {false, true}) {
        Equations problem({1, 1}, linear, linear_tangent);
        problem.foretell = foretell;
        const NewtonReport report = converged(problem);
        EXPECT_LE(report.iterations, 1);
        EXPECT_EQ(problem.distance({1, 1}), 0);
    }
}

TEST(Newton, HasNothingToDoWithoutUnknowns)
{
    const auto nothing = [](const Values&, Values&) {};
    Equations problem({}, nothing, nothing);
    const NewtonReport report = converged(problem);
    EXPECT_EQ(report.factorisations, 0);
    EXPECT_EQ(problem.n_residuals, 1);
}

TEST(Newton, StopsAtTheRoundingOfTheRows)
{
    for (const bool foretell : {false, true})
        for (const bool is_known : {false, true})
            for (int digits = 6; digits <= 16; ++digits) {
                Noisy problem({2, 1}, rosenbrock, rosenbrock_tangent);
                problem.rounding = is_known ? problem.level : 0;
                problem.foretell = foretell;
                const NewtonReport report = run(problem, std::pow(10.0, -digits));
                EXPECT_EQ(report.status, SolveStatus::converged) << digits << foretell << is_known;
                EXPECT_LE(report.iterations, 8) << digits << foretell << is_known;
                EXPECT_LT(problem.distance({1, 1}), std::max(1e-12, std::pow(10.0, -digits)));
            }
}

TEST(Newton, DoesNotTakeNoiseAboveTheRoundingForASolution)
{
    Noisy problem({2, 1}, rosenbrock, rosenbrock_tangent);
    problem.level = 1e-4;
    problem.rounding = 1e-13;
    EXPECT_EQ(run(problem).status, SolveStatus::not_converged);
}

TEST(Newton, KeepsFactorsWhileTheyContract)
{
    for (const bool foretell : {false, true}) {
        Equations problem({0, 0}, mild, mild_tangent);
        problem.foretell = foretell;
        const NewtonReport report = converged(problem);
        EXPECT_EQ(report.factorisations, 1);
        EXPECT_GE(report.iterations, 4);
        EXPECT_LT(report.contraction, 0.1);
        EXPECT_EQ(problem.errors.size(), 1u);
        EXPECT_LT(largest(problem.rows_here), 1e-12);
    }
}

TEST(Newton, MakesNewFactorsWhereOldOnesWouldNeedTooManySteps)
{
    // contraction is 0.2: about seventeen steps with one factorisation
    Equations problem({1.6}, square, square_tangent);
    const NewtonReport report = converged(problem);
    EXPECT_LE(report.iterations, 9);
    EXPECT_GE(report.factorisations, 2);
}

TEST(Newton, UndoesStepsOfFactorsThatNoLongerServe)
{
    // slope 1 leads past a bend, behind which the slope is 10: with the factors of the start it would go
    // around in a circle
    constexpr double bend = 5e-4;
    const auto f = [](const Values& x, Values& r) { r[0] = x[0] > bend ? x[0] : 10 * x[0] - 9 * bend; };
    const auto tangent = [](const Values& x, Values& J) { J[0] = x[0] > bend ? 1 : 10; };
    for (const bool foretell : {false, true}) {
        Equations problem({0.05}, f, tangent);
        problem.foretell = foretell;
        const NewtonReport report = converged(problem);
        EXPECT_EQ(report.factorisations, 2);
        EXPECT_EQ(report.iterations, 2);
        EXPECT_EQ(report.smallest_damping, 1);
        EXPECT_LT(problem.distance({0.9 * bend}), 1e-12);
    }
}

TEST(Newton, AppliesTheIncrementThatWasSolvedForAndMetTheTolerance)
{
    Equations problem({0, 0}, mild, mild_tangent), strict({0, 0}, mild, mild_tangent);
    const NewtonReport report = run(problem, 1e-6);
    run(strict, 1e-15);
    EXPECT_LT(report.last_increment, 1e-6);
    EXPECT_GT(report.last_increment, 1e-8);
    EXPECT_LT(problem.distance(strict.x), 0.1 * report.last_increment);
    EXPECT_EQ(problem.x, problem.kept);
}

TEST(Newton, GoesTheSameWayWhateverTheScaleOfTheRows)
{
    Equations problem({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    Equations stiff({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    stiff.row_factor = 0x1p27;   // 1.3e8, exactly representable
    const NewtonReport report = run(problem), same = run(stiff);
    EXPECT_EQ(same.status, SolveStatus::converged);
    EXPECT_EQ(same.iterations, report.iterations);
    EXPECT_EQ(same.factorisations, report.factorisations);
    EXPECT_EQ(stiff.x, problem.x);
}

TEST(Newton, IsCancelledBetweenFactorisations)
{
    Equations problem({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    std::vector<int> asked;
    NewtonOptions options;
    options.goes_on = [&](int iterations) {
        asked.push_back(iterations);
        return asked.size() < 3;
    };
    const NewtonReport report = Newton().run(problem, options);
    EXPECT_EQ(report.status, SolveStatus::cancelled);
    EXPECT_EQ(report.factorisations, 2);
    ASSERT_EQ(asked.size(), 3u);
    EXPECT_EQ(asked[0], 0);
    EXPECT_GE(asked[1], 1);
    EXPECT_EQ(asked[2], report.iterations);
    EXPECT_EQ(problem.x, problem.kept);
}

TEST(Newton, StopsAtTheLimitOfIterations)
{
    for (int limit = 0; limit <= 3; ++limit) {
        Equations problem({10}, arctangent, arctangent_tangent);
        const NewtonReport report =
            Newton().run(problem, {.tolerance = 1e-12, .max_iterations = limit, .goes_on = {}});
        EXPECT_EQ(report.status, SolveStatus::not_converged);
        EXPECT_TRUE(report.reached_limit);
        EXPECT_EQ(report.iterations, limit);
        EXPECT_EQ(problem.x, problem.kept);
        EXPECT_EQ(problem.rows_here[0], std::atan(problem.x[0]));
    }
}

TEST(Newton, ForetellingAndSolvingGiveTheSameAnswer)
{
    for (const Values& start : {Values{0, 0}, Values{0.5, -0.8}, Values{2, 3}}) {
        Equations solving(start, mild, mild_tangent), foretelling(start, mild, mild_tangent);
        foretelling.foretell = true;
        const NewtonReport a = run(solving), b = run(foretelling);
        EXPECT_EQ(a.status, SolveStatus::converged);
        EXPECT_EQ(b.status, SolveStatus::converged);
        EXPECT_LT(solving.distance(foretelling.x), 1e-12);
        EXPECT_EQ(foretelling.n_solves, b.iterations) << "one a step, none for the stopping rule";
        EXPECT_GT(solving.n_solves, a.iterations);
    }
}

TEST(Newton, SolvesWhereRowsForetellGrowth)
{
    // rows grow along a whole step, which is right all the same: increments with the same factors shrink
    Equations problem({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    problem.foretell = true;
    const NewtonReport report = converged(problem);
    EXPECT_GT(problem.n_solves, report.iterations);
    EXPECT_LT(problem.distance({1, 1}), 1e-12);
}

TEST(Newton, WaitsForTheCorrectionsOfTheMoves)
{
    class Corrected : public Equations {
    public:
        using Equations::Equations;
        bool move(std::span<const double> dx, double damping) override
        {
            correction_ /= 100;
            return Equations::move(dx, damping);
        }
        Rows rows() const override
        {
            Rows rows = Equations::rows();
            rows.correction = correction_;
            return rows;
        }

    private:
        double correction_ = 1;
    };
    for (const bool foretell : {false, true}) {
        Corrected problem({-7, 5}, linear, linear_tangent);
        problem.foretell = foretell;
        const NewtonReport report = converged(problem, 1e-7);
        EXPECT_LE(problem.rows().correction, 1e-7);
        EXPECT_GE(report.iterations, 4);
    }
}

TEST(Newton, MovesOnTheRotationGroup)
{
    for (const double angle : {0.1, 1.0, 1.2}) {
        Turning problem;
        const Turning::Vector w = {0.6 * angle, 0, 0.8 * angle};
        for (int p = 0; p < 2; ++p) problem.b[p] = Turning::rotated(w, problem.a[p]);
        const NewtonReport report = run(problem);
        EXPECT_EQ(report.status, SolveStatus::converged) << angle;
        for (int p = 0; p < 2; ++p)
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(problem.turned(p)[i], problem.b[p][i], 1e-12);
        EXPECT_NEAR(Turning::dot(problem.R[0], problem.R[1]), 0, 1e-14);
        EXPECT_NEAR(Turning::dot(problem.R[2], problem.R[2]), 1, 1e-14);
    }
}

TEST(Newton, AllocatesNothingInTheSecondRun)
{
    Newton newton;
    NewtonOptions options;
    Equations problem({-1.2, 1}, rosenbrock, rosenbrock_tangent);
    problem.errors.reserve(100);
    newton.run(problem, options);
    problem.x = {-1.2, 1};
    const long long before = n_allocations();
    const NewtonReport report = newton.run(problem, options);
    EXPECT_EQ(n_allocations(), before);
    EXPECT_EQ(report.status, SolveStatus::converged);
    const Values control(3);
    EXPECT_GT(n_allocations(), before) << "the count sees allocations";
}

}   // namespace
}   // namespace livens::newton_test
