// SPDX-License-Identifier: BSD-3-Clause
// Condition numbers of the matrices of lobatto and radau.
#include <gtest/gtest.h>
#include <mechanisms.h>   // of all tests, not of this folder

#include <cmath>
#include <vector>

#include "livens/spacetime/solve.h"
#include "unit/spacetime/mechanisms.h"

namespace livens::condition_test {
namespace {

Model flying_point()
{
    Model model;
    model.add_body(point_mass("point", 2.5, {0, 0, 0}, {1, 2, 3}));
    return model;
}

/// The 2-norm of a dense n x n matrix by power iterations with A^T A.
template <class Entry>
double dense_norm(int n, Entry&& entry)
{
    std::vector<double> x(n), y(n);
    for (int i = 0; i < n; ++i) x[i] = 1 + 0.37 * std::sin(1.7 * i * i);
    double squared = 0;
    for (int round = 0; round < 4000; ++round) {
        for (int i = 0; i < n; ++i) {
            y[i] = 0;
            for (int j = 0; j < n; ++j) y[i] += entry(i, j) * x[j];
        }
        double sum = 0;
        for (int j = 0; j < n; ++j) {
            x[j] = 0;
            for (int i = 0; i < n; ++i) x[j] += entry(i, j) * y[i];
            sum += x[j] * x[j];
        }
        squared = std::sqrt(sum);
        for (double& v : x) v /= squared;
    }
    return std::sqrt(squared);
}

/// Linear elements of a free point: J = -(1/h) (1, -2, 1) and J^-1 = -h (1, 2, 3, ...) by diagonals downwards
/// from the main one, so |J|_1 |J^-1|_1 = (4/h) (h n (n + 1)/2).
TEST(ConditionNumber, OfAFreePointHasTheInverseOfSecondDifferences)
{
    const Model model = flying_point();
    SolveOptions options;
    options.condition = true;
    for (const int n : {3, 20}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, n), Lobatto{1}, options);
        ASSERT_TRUE(s.report.converged());
        EXPECT_NEAR(s.report.condition_1, 2.0 * n * (n + 1), 1e-9 * n * n);
        const double norm = dense_norm(
            n, [](int i, int j) { return i == j || i == j + 2 ? -1.0 : (i == j + 1 ? 2.0 : 0.0); });
        const double inverse_norm = dense_norm(n, [](int i, int j) { return i >= j ? i - j + 1.0 : 0.0; });
        EXPECT_NEAR(s.report.condition_2 / (norm * inverse_norm), 1, 1e-4);
        EXPECT_EQ(s.report.scaled_condition, s.report.condition_1);
        EXPECT_GT(s.report.factor_entries, 3 * n);
    }
}

/// Alone in a motion, or in a phase between two events, an element forms no matrix on its way.
TEST(ConditionNumber, OfASingleElementIsThatOfItsMatrix)
{
    for (const int degree : {1, 2, 4})
        for (const int window : {0, 1, 2}) {
            SolveOptions options;
            options.condition = true;
            Lobatto method{degree};
            method.window = window;
            const Model model = degree == 1 ? flying_point() : tests::two_bricks();
            const Solution s = solve(model, {model.start()}, make_time_mesh(0, 0.1, 1), method, options);
            ASSERT_TRUE(s.report.converged());
            if (degree == 1)
                EXPECT_EQ(s.report.condition_1, 1);
            else
                EXPECT_GT(s.report.condition_2, 1.5);
            EXPECT_TRUE(std::isfinite(s.report.condition_2));
        }
}

Solution with_condition(const Model& model, double end, int n, int degree)
{
    SolveOptions options;
    options.condition = true;
    Solution s = solve(model, {model.start()}, make_time_mesh(0, end, n), Lobatto{degree}, options);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    return s;
}

/// Elements of radau know no element behind: the matrix is that of the last one alone.
TEST(ConditionNumber, OfRadauIsThatOfTheLastElement)
{
    const Model model = tests::two_bricks();
    SolveOptions options;
    options.condition = true;
    for (const int degree : {2, 3, 4, 6}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 0.4, 5), Radau{degree}, options);
        ASSERT_TRUE(s.report.converged());
        const Solution last = solve(model, {s.motion.at_end(4)},
                                    make_time_mesh(s.motion.mesh.ends[4], 0.4, 1), Radau{degree}, options);
        EXPECT_GT(s.report.condition_2, 1) << degree;
        EXPECT_NEAR(s.report.condition_1 / last.report.condition_1, 1, 1e-6) << degree;
        EXPECT_NEAR(s.report.condition_2 / last.report.condition_2, 1, 1e-3) << degree;
        const Solution first =
            solve(model, {model.start()}, make_time_mesh(0, 0.08, 1), Radau{degree}, options);
        EXPECT_GT(std::abs(s.report.condition_1 / first.report.condition_1 - 1), 1e-6) << "a control";
    }
}

/// An element that is divided on the way, in a window that had room for more, is no window of all.
TEST(ConditionNumber, OfADividedMeshIsThatOfAllItsElements)
{
    const Model model = tests::two_bricks();
    SolveOptions options;
    options.condition = true;
    options.judge = false;   // this mesh is too coarse to be believed
    Lobatto method{3};
    method.window = 2;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1.5, 1), method, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    ASSERT_GT(s.motion.mesh.n_elements(), 2);
    const Solution given = solve(model, {model.start()}, s.motion.mesh, method, options);
    EXPECT_EQ(given.motion.mesh.n_elements(), s.motion.mesh.n_elements());
    EXPECT_NEAR(s.report.condition_1 / given.report.condition_1, 1, 1e-6);
}

TEST(ConditionNumber, GrowsWithTheSquareOfTheNumberOfElements)
{
    const Model model = tests::free_box();
    for (const int p : {1, 2}) {
        const SolveReport coarse = with_condition(model, 1, 40, p).report;
        const SolveReport fine = with_condition(model, 1, 160, p).report;
        EXPECT_NEAR(std::log(fine.condition_1 / coarse.condition_1) / std::log(4.0), 2, 0.1) << p;
        EXPECT_NEAR(std::log(fine.condition_2 / coarse.condition_2) / std::log(4.0), 2, 0.1) << p;
        EXPECT_NEAR(static_cast<double>(fine.factor_entries) / static_cast<double>(coarse.factor_entries), 4,
                    0.2)
            << "the factors grow linearly";
    }
}

TEST(ConditionNumber, KnowsNoUnitOfLengthAndNoDirectionOfSpace)
{
    tests::Setting other;
    other.turn = directors_from_rotation_vector({0.3, -1.1, 0.6});
    other.metre = 1000;
    const SolveReport here = with_condition(tests::two_bricks(), 0.5, 10, 3).report;
    const SolveReport there = with_condition(tests::two_bricks(other), 0.5, 10, 3).report;
    EXPECT_GT(here.condition_2, 1e3);
    EXPECT_NEAR(there.condition_2 / here.condition_2, 1, 1e-4);
}

TEST(ConditionNumber, IsComputedOnlyWhenAskedFor)
{
    const Model model = testing_models::two_bricks();
    const TimeMesh mesh = make_time_mesh(0, 0.2, 4);
    const Solution plain = solve(model, {model.start()}, mesh, Lobatto{2});
    EXPECT_EQ(plain.report.condition_1, 0);
    EXPECT_EQ(plain.report.condition_2, 0);
    EXPECT_EQ(plain.report.scaled_condition, 0);
    EXPECT_EQ(plain.report.factor_entries, 0);
    const Solution asked = with_condition(model, 0.2, 4, 2);
    EXPECT_GT(asked.report.condition_1, 1);
    EXPECT_EQ(asked.motion.X.values, plain.motion.X.values);
    EXPECT_EQ(asked.report.factorisations, plain.report.factorisations);
    SolveOptions options;
    options.condition = true;
    const ExactSample sample = sample_exactly(model, plain.motion, Lobatto{2}, 0.13, options);
    EXPECT_EQ(sample.report.condition_1, 0);
}

TEST(ConditionNumber, IsLeftOutWhereTheMarchFailsOrNothingMoves)
{
    SolveOptions options;
    options.condition = true;
    options.progress = [](const Progress& progress) { return progress.done < 2; };
    const Model bricks = testing_models::two_bricks();
    const Solution stopped = solve(bricks, {bricks.start()}, make_time_mesh(0, 0.2, 4), Lobatto{2}, options);
    EXPECT_EQ(stopped.report.status, SolveStatus::cancelled);
    EXPECT_EQ(stopped.report.condition_1, 0);

    Model held({0, 0, -9.81});
    held.add_body(rigid_body("block", box(1, {1, 1, 1})));
    held.add_joint(weld("seat", world, 0, {}, world_configuration, held.bodies()[0].X));
    const Solution still = with_condition(held, 0.2, 4, 2);
    EXPECT_EQ(still.report.condition_1, 0);
}

}   // namespace
}   // namespace livens::condition_test
