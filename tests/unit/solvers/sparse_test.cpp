// SPDX-License-Identifier: BSD-3-Clause
// Sparse factorisations: every backend of the build against dense ones and against its defining equations.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <utility>

#include "livens/base/error.h"
#include "livens/solvers/sparse.h"
#include "short_memory.h"
#include "sparse_matrices.h"

namespace livens::sparse_test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(SparseMatrix, MultipliesLikeTheDenseMatrix)
{
    for (int n : {1, 2, 7, 30}) {
        const Dense A = random_matrix(n, 0.3, 11u + static_cast<unsigned>(n));
        const SparseMatrix S = sparse(A);
        Random random(5);
        const Values x = random.values(n);
        Values y(x.size(), nan), y_transposed(x.size(), nan);   // what was in the result does not matter
        S.multiply(x, y);
        S.multiply_transposed(x, y_transposed);
        for (int i = 0; i < n; ++i) {
            double sum = 0, sum_transposed = 0;
            for (int j = 0; j < n; ++j) {
                sum += A(i, j) * x[j];
                sum_transposed += A(j, i) * x[j];
            }
            EXPECT_NEAR(y[i], sum, 1e-14);
            EXPECT_NEAR(y_transposed[i], sum_transposed, 1e-14);
        }
    }
}

TEST(SparseLU, NamesABackendThatTheBuildLacks)
{
    EXPECT_TRUE(has_backend(SparseBackend::eigen));
    if (has_backend(SparseBackend::umfpack)) {
        EXPECT_NO_THROW(SparseLU{SparseBackend::umfpack});
        return;
    }
    try {
        const SparseLU lu(SparseBackend::umfpack);
        FAIL() << "a backend out of nothing";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "backend-missing");
        EXPECT_EQ(error.complaint().path, "method.linear_solver");
        EXPECT_EQ(error.complaint().value, "umfpack");
        EXPECT_EQ(error.complaint().bound, "eigen");
        EXPECT_NE(error.complaint().help.find("LIVENS_UMFPACK"), std::string::npos);
    }
}

class EverySparseLU : public testing::TestWithParam<SparseBackend> {
protected:
    static SparseLU factors(const SparseMatrix& A)
    {
        SparseLU lu(GetParam());
        lu.analyse(A);
        EXPECT_TRUE(lu.factorise(A));
        return lu;
    }
    static Values solution(const SparseLU& lu, const Values& b)
    {
        Values x(b.size(), nan);
        lu.solve(b, x);
        return x;
    }
    static Values transposed_solution(const SparseLU& lu, const Values& b)
    {
        Values x(b.size(), nan);
        lu.solve_transposed(b, x);
        return x;
    }
};

INSTANTIATE_TEST_SUITE_P(Backends, EverySparseLU, testing::ValuesIn(backends_of_this_build()),
                         [](const auto& instance) { return name_of(instance.param); });

TEST_P(EverySparseLU, EqualsADenseSolve)
{
    for (int n = 1; n <= 60; ++n)
        for (double density : {0.05, 0.3, 1.0}) {
            const Dense A = random_matrix(n, density, 100u + static_cast<unsigned>(n));
            const SparseMatrix S = sparse(A);
            Random random(3);
            const Values b = random.values(n);
            const Values expected = dense_solution(A, b);
            const Values expected_transposed = dense_solution(transposed(A), b);
            ASSERT_FALSE(expected.empty());
            const SparseLU lu = factors(S);
            const Values x = solution(lu, b), x_transposed = transposed_solution(lu, b);
            // The matrices' condition numbers stay below 1e5.
            EXPECT_LT(largest_difference(x, expected), 1e-10 * (1 + largest(expected))) << n;
            EXPECT_LT(largest_difference(x_transposed, expected_transposed),
                      1e-10 * (1 + largest(expected_transposed)))
                << n;
            EXPECT_LT(relative_residual(S, x, b), 1e-15 * (10 + n)) << n;
            EXPECT_LT(relative_residual(sparse(transposed(A)), x_transposed, b), 1e-15 * (10 + n)) << n;
        }
}

TEST_P(EverySparseLU, DoesNotMistakeTheMatrixForItsTranspose)
{
    Dense A(2);
    A(0, 0) = 1;
    A(0, 1) = 2;
    A(1, 1) = 4;
    const SparseLU lu = factors(sparse(A));
    const Values x = solution(lu, {5, 8}), x_transposed = transposed_solution(lu, {5, 8});
    EXPECT_DOUBLE_EQ(x[0], 1);
    EXPECT_DOUBLE_EQ(x[1], 2);
    EXPECT_DOUBLE_EQ(x_transposed[0], 5);
    EXPECT_DOUBLE_EQ(x_transposed[1], -0.5);
}

TEST_P(EverySparseLU, ExchangesRowsWhereTheDiagonalIsZero)
{
    const int n = 9;   // the shift by one: no entry on the diagonal at all
    Dense A(n);
    for (int i = 0; i < n; ++i) A(i, (i + 1) % n) = i + 1;
    const SparseLU lu = factors(sparse(A));
    const Values b = Random(1).values(n), x = solution(lu, b);
    for (int i = 0; i < n; ++i) EXPECT_DOUBLE_EQ(x[(i + 1) % n], b[i] / (i + 1));
}

TEST_P(EverySparseLU, PivotsAcrossBlocks)
{
    for (double h : {1e-2, 1e-6, 1e-10}) {
        const SparseMatrix A = leapfrog_chain(100, 6, h, 8);
        const Values b = Random(2).values(A.size);
        const SparseLU lu = factors(A);
        EXPECT_LT(relative_residual(A, solution(lu, b), b), 1e-13) << h;
    }
}

TEST_P(EverySparseLU, SolvesAThousandBlocksWithFillThatGrowsWithThem)
{
    const SparseMatrix half = leapfrog_chain(500, 12, 1e-2, 4), A = leapfrog_chain(1000, 12, 1e-2, 4);
    const SparseLU lu = factors(A);
    Random random(9);
    const Values b = random.values(A.size), c = random.values(A.size);
    const Values x = solution(lu, b), y = transposed_solution(lu, c);
    EXPECT_LT(relative_residual(A, x, b), 1e-13);
    // c . A^-1 b = A^-T c . b, which no dense solve of 12000 unknowns has to tell.
    const double left = std::inner_product(c.begin(), c.end(), x.begin(), 0.0);
    const double right = std::inner_product(y.begin(), y.end(), b.begin(), 0.0);
    EXPECT_NEAR(left, right, 1e-10 * largest(x) * A.size);
    EXPECT_GT(std::abs(left), 1e-5 * largest(x));   // so that the bound means something
    const auto entries = static_cast<double>(lu.factor_entries());
    EXPECT_GT(entries, A.n_entries());
    EXPECT_NEAR(entries / static_cast<double>(factors(half).factor_entries()), 2, 0.3);
}

TEST_P(EverySparseLU, MayOverwriteTheRightSide)
{
    const SparseMatrix A = leapfrog_chain(10, 4, 0.1, 6);
    const SparseLU lu = factors(A);
    const Values b = Random(7).values(A.size);
    Values x = b, y = b, z = b;
    lu.solve(x, x);
    lu.solve_transposed(y, y);
    solve_refined(lu, A, z, z, 2);
    EXPECT_EQ(x, solution(lu, b));
    EXPECT_EQ(y, transposed_solution(lu, b));
    Values refined(b.size());
    solve_refined(lu, A, b, refined, 2);
    EXPECT_EQ(z, refined);
}

TEST_P(EverySparseLU, IsRefinedToTheMatrixThatIsMeant)
{
    // The factors of a matrix that is 1e-4 off: each step takes three digits and more off the residual.
    const SparseMatrix A = sparse(random_matrix(40, 0.2, 21));
    SparseMatrix off = A;
    Random random(22);
    for (double& v : off.values) v += 1e-4 * random.next();
    const SparseLU lu = factors(off);
    const Values b = random.values(A.size);
    double last = 1;
    for (int steps = 0; steps <= 3; ++steps) {
        Values x(b.size());
        solve_refined(lu, A, b, x, steps);
        const double residual = relative_residual(A, x, b);
        EXPECT_LT(residual, 1e-2 * last) << steps;
        last = residual;
    }
    EXPECT_LT(last, 1e-14);
}

TEST_P(EverySparseLU, RefinesByOneStepUnlessAsked)
{
    const SparseMatrix A = sparse(random_matrix(20, 0.3, 31));
    SparseMatrix off = A;
    Random random(33);
    for (double& v : off.values) v *= 1 + 1e-3 * random.next();
    const SparseLU lu = factors(off);
    const Values b = Random(32).values(A.size);
    Values by_default(b.size()), once(b.size()), never(b.size());
    solve_refined(lu, A, b, by_default);
    solve_refined(lu, A, b, once, 1);
    solve_refined(lu, A, b, never, 0);
    EXPECT_EQ(by_default, once);
    EXPECT_EQ(never, solution(lu, b));
    EXPECT_NE(never, once);
}

TEST_P(EverySparseLU, RefusesSingularMatricesAndRecovers)
{
    const int n = 5;
    const Dense good = random_matrix(n, 1.0, 41);
    Dense zero_column = good, zero_row = good, equal_rows = good, empty(n);
    for (int i = 0; i < n; ++i) {
        zero_column(i, 2) = 0;
        zero_row(3, i) = 0;
        equal_rows(4, i) = good(1, i);
    }
    Dense ones(2);
    for (double& v : ones.a) v = 1;
    SparseMatrix stored_zeros = sparse(good);   // the pattern of a regular matrix
    std::fill(stored_zeros.values.begin(), stored_zeros.values.end(), 0.0);
    for (const SparseMatrix& A : {sparse(zero_column), sparse(zero_row), sparse(equal_rows), sparse(empty),
                                  sparse(ones), stored_zeros}) {
        SparseLU lu(GetParam());
        lu.analyse(A);
        EXPECT_FALSE(lu.factorise(A));
        EXPECT_FALSE(lu.factorise(A));   // and not only for the first time
        lu.analyse(sparse(good));
        EXPECT_TRUE(lu.factorise(sparse(good)));
    }
    SparseLU lu(GetParam());
    lu.analyse(stored_zeros);
    EXPECT_FALSE(lu.factorise(stored_zeros));
    ASSERT_TRUE(lu.factorise(sparse(good)));   // the same pattern, without another analysis
    const Values b = Random(42).values(n);
    EXPECT_LT(relative_residual(sparse(good), solution(lu, b), b), 1e-14);
}

TEST_P(EverySparseLU, RefusesEntriesThatAreNotFinite)
{
    const SparseMatrix good = sparse(random_matrix(6, 0.5, 51));
    SparseLU lu(GetParam());
    lu.analyse(good);
    for (double bad : {nan, inf, -inf})
        for (std::size_t place : {std::size_t{0}, good.values.size() / 2, good.values.size() - 1}) {
            SparseMatrix A = good;
            A.values[place] = bad;
            EXPECT_FALSE(lu.factorise(A));
        }
    EXPECT_TRUE(lu.factorise(good));
}

TEST_P(EverySparseLU, FactorisesOtherValuesOfOnePattern)
{
    SparseMatrix A = leapfrog_chain(20, 5, 0.1, 61);
    SparseLU lu(GetParam());
    // Values do not matter to the analysis, not even such.
    SparseMatrix pattern = A;
    std::fill(pattern.values.begin(), pattern.values.end(), nan);
    lu.analyse(pattern);
    const Values b = Random(62).values(A.size);
    for (int round = 0; round < 4; ++round) {
        ASSERT_TRUE(lu.factorise(A));
        const Values x = solution(lu, b);
        EXPECT_LT(relative_residual(A, x, b), 1e-13);
        EXPECT_EQ(x, solution(factors(A), b));   // nothing is left of the matrices before
        for (double& v : A.values) v *= -1.5;
        A.values.front() += 0.3;
    }
}

TEST_P(EverySparseLU, TakesAnotherPatternAfterAnotherAnalysis)
{
    SparseLU lu(GetParam());
    for (int n : {30, 1, 12, 0, 47, 3}) {
        const SparseMatrix A = sparse(random_matrix(n, 0.2, 70u + static_cast<unsigned>(n)));
        lu.analyse(A);
        ASSERT_TRUE(lu.factorise(A)) << n;
        const Values b = Random(72).values(n);
        const Values x = solution(lu, b);
        EXPECT_EQ(x, solution(factors(A), b)) << n;
        if (n == 0) continue;
        EXPECT_LT(relative_residual(A, x, b), 1e-14) << n;
    }
}

TEST_P(EverySparseLU, MovesWithItsFactors)
{
    const SparseMatrix A = leapfrog_chain(8, 3, 0.1, 81);
    const Values b = Random(82).values(A.size);
    SparseLU first = factors(A);
    const Values x = solution(first, b);
    SparseLU second = std::move(first);
    EXPECT_EQ(solution(second, b), x);
    SparseLU third(GetParam());
    third = std::move(second);
    EXPECT_EQ(solution(third, b), x);
    std::vector<SparseLU> many;
    for (int i = 0; i < 5; ++i) many.push_back(factors(A));   // grows, and moves what it holds
    for (const SparseLU& lu : many) EXPECT_EQ(solution(lu, b), x);
}

TEST_P(EverySparseLU, SaysWhatItIsAndHowMuchItStores)
{
    const SparseMatrix A = leapfrog_chain(30, 4, 0.1, 91);
    SparseLU lu(GetParam());
    const std::string expected = GetParam() == SparseBackend::eigen ? "Eigen" : "UMFPACK";
    EXPECT_EQ(lu.description().rfind(expected, 0), 0u) << lu.description();
    EXPECT_NE(lu.description().find(GetParam() == SparseBackend::eigen ? "natural order" : "METIS order"),
              std::string::npos)
        << lu.description();
    EXPECT_EQ(lu.factor_entries(), 0);
    lu.analyse(A);
    EXPECT_EQ(lu.factor_entries(), 0);
    ASSERT_TRUE(lu.factorise(A));
    EXPECT_GT(lu.factor_entries(), A.n_entries());
}

#ifdef LIVENS_SHORT_MEMORY
TEST(SparseLUDeathTest, RunsOutOfMemoryByBadAllocAlone)
{
    // Eigen as it comes frees its arrays twice in the middle of this range.
    const SparseMatrix A = sparse(random_matrix(500, 0.01, 98));
    SparseLU lu(SparseBackend::eigen);   // nothing is left in disorder
    expect_bad_alloc_alone(
        [&] {
            lu.analyse(A);
            return lu.factorise(A) && lu.factorise(A);
        },
        {1 << 10, 2 << 10, 3 << 10, 4 << 10, 6 << 10, 8 << 10, 12 << 10, 16 << 10, 64 << 10});
}
#endif

TEST(SparseLU, BackendsAgree)
{
    if (!has_backend(SparseBackend::umfpack)) GTEST_SKIP() << "built without UMFPACK";
    const SparseMatrix A = leapfrog_chain(200, 9, 1e-3, 95);
    const Values b = Random(96).values(A.size);
    std::vector<Values> solutions;
    for (SparseBackend backend : backends_of_this_build()) {
        SparseLU lu(backend);
        lu.analyse(A);
        ASSERT_TRUE(lu.factorise(A));
        solutions.emplace_back(b.size());
        solve_refined(lu, A, b, solutions.back());
    }
    EXPECT_LT(largest_difference(solutions[0], solutions[1]), 1e-9 * largest(solutions[0]));
}

}   // namespace
}   // namespace livens::sparse_test
