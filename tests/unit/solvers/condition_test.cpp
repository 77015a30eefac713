// SPDX-License-Identifier: BSD-3-Clause
// Norms and condition numbers against exact ones, and against singular values found by Jacobi rotations.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "livens/solvers/sparse.h"
#include "sparse_matrices.h"

namespace livens::condition_test {
namespace {

constexpr double pi = std::numbers::pi;
using Input = std::span<const double>;
using Output = std::span<double>;

LinearMap map_of(const SparseMatrix& A)
{
    return [A](Input x, Output y) { A.multiply(x, y); };
}
LinearMap transposed_map_of(const SparseMatrix& A)
{
    return [A](Input x, Output y) { A.multiply_transposed(x, y); };
}
double one_norm(const SparseMatrix& A) { return livens::one_norm(A.size, map_of(A), transposed_map_of(A)); }
double two_norm(const SparseMatrix& A) { return livens::two_norm(A.size, map_of(A), transposed_map_of(A)); }

double largest_column_sum(const Dense& A)
{
    double largest = 0;
    for (int j = 0; j < A.size; ++j) {
        double sum = 0;
        for (int i = 0; i < A.size; ++i) sum += std::abs(A(i, j));
        largest = std::max(largest, sum);
    }
    return largest;
}

Dense inverse(const Dense& A)
{
    Dense B(A.size);
    for (int j = 0; j < A.size; ++j) {
        Values e(static_cast<std::size_t>(A.size), 0.0);
        e[static_cast<std::size_t>(j)] = 1;
        const Values column = dense_solution(A, e);
        for (int i = 0; i < A.size; ++i) B(i, j) = column[static_cast<std::size_t>(i)];
    }
    return B;
}

/// Singular values, descending, by one-sided Jacobi rotations: columns are turned until all are orthogonal.
Values singular_values(Dense A)
{
    const int n = A.size;
    const auto inner = [&](int p, int q) {
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += A(i, p) * A(i, q);
        return sum;
    };
    for (int sweep = 0; sweep < 60; ++sweep) {
        double worst = 0;
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q) {
                const double pp = inner(p, p), qq = inner(q, q), pq = inner(p, q);
                if (pq == 0) continue;
                worst = std::max(worst, std::abs(pq) / std::sqrt(pp * qq));
                const double zeta = (qq - pp) / (2 * pq);
                const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
                const double c = 1 / std::hypot(1.0, t), s = c * t;
                for (int i = 0; i < n; ++i) {
                    const double x = A(i, p), y = A(i, q);
                    A(i, p) = c * x - s * y;
                    A(i, q) = s * x + c * y;
                }
            }
        if (worst < 1e-15) break;
    }
    Values values;
    for (int j = 0; j < n; ++j) values.push_back(std::sqrt(inner(j, j)));
    std::sort(values.rbegin(), values.rend());
    return values;
}

Dense diagonal(const Values& d)
{
    Dense A(static_cast<int>(d.size()));
    for (int i = 0; i < A.size; ++i) A(i, i) = d[static_cast<std::size_t>(i)];
    return A;
}

Dense hilbert(int n)
{
    Dense A(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) A(i, j) = 1.0 / (i + j + 1);
    return A;
}

class EveryCondition : public testing::TestWithParam<SparseBackend> {
protected:
    static ConditionNumbers of(const SparseMatrix& A, const Values& R = {}, const Values& C = {})
    {
        SparseLU lu(GetParam());
        lu.analyse(A);
        EXPECT_TRUE(lu.factorise(A));
        return condition_numbers(A, lu, R, C);
    }
};

INSTANTIATE_TEST_SUITE_P(Backends, EveryCondition, testing::ValuesIn(backends_of_this_build()),
                         [](const auto& instance) { return name_of(instance.param); });

TEST_P(EveryCondition, IsThatOfHilbertsMatrix)
{
    // Exact in integers for the 1-norm: column sum 49/20 of the matrix, 11865420 of its inverse.
    const ConditionNumbers k = of(sparse(hilbert(6)));
    EXPECT_NEAR(k.one, 29070279.0, 29070279.0 * 1e-8);
    EXPECT_NEAR(k.two, 1.4951058642254e7, 1.4951e7 * 1e-8);
}

TEST_P(EveryCondition, IsNotKnownWhereItWasStopped)
{
    const SparseMatrix A = sparse(hilbert(6));
    SparseLU lu(GetParam());
    lu.analyse(A);
    ASSERT_TRUE(lu.factorise(A));
    for (const int patience : {0, 3, 10}) {
        int n_asked = 0;
        const ConditionNumbers k = condition_numbers(A, lu, {}, {}, [&] { return n_asked++ < patience; });
        EXPECT_EQ(n_asked, patience + 1) << "nobody asks again who was told to stop";
        EXPECT_EQ(k.one, 0);
        EXPECT_EQ(k.two, 0);
    }
    EXPECT_EQ(condition_numbers(A, lu, {}, {}, [] { return true; }).two, of(A).two);
}

TEST_P(EveryCondition, IsThatOfADiagonal)
{
    const ConditionNumbers k = of(sparse(diagonal({3, -1e-3, 20, 1e6, 7, 0.5, -40, 2, 1, 9})));
    EXPECT_NEAR(k.one, 1e9, 1e-3);
    EXPECT_NEAR(k.two, 1e9, 1e9 * 1e-10);
}

TEST_P(EveryCondition, EqualsSingularValuesAndExplicitInverses)
{
    for (int n = 1; n <= 30; ++n) {
        const Dense A = random_matrix(n, 0.4, 200u + static_cast<unsigned>(n));
        const Values sigma = singular_values(A);
        const ConditionNumbers k = of(sparse(A));
        EXPECT_NEAR(k.two / (sigma.front() / sigma.back()), 1, 1e-6) << n;
        EXPECT_NEAR(k.one / (largest_column_sum(A) * largest_column_sum(inverse(A))), 1, 1e-9) << n;
    }
}

TEST_P(EveryCondition, IsThatOfTheMatrixBeforeItWasScaled)
{
    const int n = 20;
    const Dense A = random_matrix(n, 0.4, 300);
    Random random(301);
    Values R, C;
    for (int i = 0; i < n; ++i) {   // of either sign, over four decades each
        R.push_back((random.next() < 0 ? -1 : 1) * std::pow(10, 2 * random.next()));
        C.push_back((random.next() < 0 ? -1 : 1) * std::pow(10, 2 * random.next()));
    }
    Dense S(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) S(i, j) = R[i] * A(i, j) * C[j];
    const ConditionNumbers expected = of(sparse(A)), found = of(sparse(S), R, C), scaled = of(sparse(S));
    EXPECT_NEAR(found.one / expected.one, 1, 1e-9);
    EXPECT_NEAR(found.two / expected.two, 1, 1e-6);
    EXPECT_GT(scaled.two / expected.two, 10);   // the scales do matter
    const ConditionNumbers rows = of(sparse(S), R), columns = of(sparse(S), {}, C);
    EXPECT_GT(std::abs(rows.two / columns.two - 1), 0.1);
    EXPECT_GT(std::abs(rows.two / expected.two - 1), 0.1);
}

TEST_P(EveryCondition, GrowsWithALongChainAsItShould)
{
    for (int n : {9, 99, 999}) {
        const ConditionNumbers k = of(second_differences(n));
        const double one = 0.5 * (n + 1.0) * (n + 1.0), two = 1 / std::pow(std::tan(pi / (2 * n + 2)), 2);
        EXPECT_NEAR(k.one / one, 1, 1e-6) << n;
        EXPECT_NEAR(k.two / two, 1, 1e-4) << n;
    }
}

TEST(OneNorm, IsALowerBoundAndNearlyAlwaysExact)
{
    int exact = 0;
    const int trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
        const int n = 5 + trial % 60;
        const Dense A = inverse(random_matrix(n, 1.0, 400u + static_cast<unsigned>(trial), false));
        const double norm = largest_column_sum(A), found = one_norm(sparse(A));
        EXPECT_LE(found, norm * (1 + 1e-13)) << n;
        EXPECT_GE(found, norm / 3) << n;
        exact += found > norm * (1 - 1e-12);
    }
    EXPECT_GE(exact, trials * 95 / 100);
}

TEST(OneNorm, IsExactForFewUnknowns)
{
    for (int n = 0; n <= 4; ++n) {
        const Dense A = random_matrix(n, 1.0, 450u + static_cast<unsigned>(n), false);
        EXPECT_DOUBLE_EQ(one_norm(sparse(A)), largest_column_sum(A)) << n;
    }
}

TEST(OneNorm, TellsTheMatrixFromItsTranspose)
{
    const int n = 12;   // one full column: its sum is n, the rows' are 1
    Dense A(n);
    for (int i = 0; i < n; ++i) A(i, 7) = i % 2 ? -1 : 1;
    EXPECT_DOUBLE_EQ(one_norm(sparse(A)), n);
    EXPECT_DOUBLE_EQ(one_norm(sparse(transposed(A))), 1);
}

TEST(OneNorm, FindsTheOneColumnThatMatters)
{
    // Signs and sums hide it from vectors of ones: the column (1, -1, 1, ...) among small ones.
    for (int place : {0, 1, 250, 499}) {
        const int n = 500;
        SparseMatrix A;
        A.size = n;
        A.column_starts.push_back(0);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i)
                if (j == place || i == j) {
                    A.rows.push_back(i);
                    A.values.push_back(j == place ? (i % 2 ? -1.0 : 1.0) : 0.9);
                }
            A.column_starts.push_back(A.n_entries());
        }
        EXPECT_DOUBLE_EQ(one_norm(A), n) << place;
    }
}

TEST(TwoNorm, EqualsTheLargestSingularValueOfSmallMatrices)
{
    for (int n = 1; n <= 40; ++n) {
        const Dense A = random_matrix(n, 1.0, 500u + static_cast<unsigned>(n), false);
        const double norm = singular_values(A).front(), found = two_norm(sparse(A));
        EXPECT_NEAR(found / norm, 1, 1e-6) << n;
        EXPECT_LE(found, norm * (1 + 1e-12)) << n;   // it is met from below
    }
}

TEST(TwoNorm, OfSpecialMatrices)
{
    EXPECT_EQ(two_norm(sparse(Dense(0))), 0);
    EXPECT_EQ(two_norm(sparse(Dense(5))), 0);
    EXPECT_DOUBLE_EQ(two_norm(sparse(diagonal({-3}))), 3);
    EXPECT_NEAR(two_norm(sparse(diagonal(Values(50, -1.0)))), 1, 1e-14);
    Dense nilpotent(2);   // all eigenvalues are zero
    nilpotent(0, 1) = 5;
    EXPECT_NEAR(two_norm(sparse(nilpotent)), 5, 1e-14);
    Dense ones(30);
    for (double& v : ones.a) v = 1;
    EXPECT_NEAR(two_norm(sparse(ones)), 30, 1e-12);
    EXPECT_NEAR(two_norm(sparse(diagonal({1e-200, 2e-200, 3e-200}))), 3e-200, 1e-212);
    EXPECT_NEAR(two_norm(sparse(diagonal({1e200, 2e200, 3e200}))), 3e200, 1e188);
}

TEST(TwoNorm, IsFoundWhateverTheSingularVector)
{
    // I + 0.01 v v^T has the norm 1.01 for a unit vector v, and all other singular values are 1.
    const int n = 400;
    for (int kind = 0; kind < 6; ++kind) {
        Values v(n);
        for (int i = 0; i < n; ++i) {
            const double sine = std::sin((kind == 3 ? 1 : 7) * pi * (i + 1) / (n + 1));
            v[i] = kind == 0 ? 1 : kind == 1 ? (i % 2 ? -1 : 1) : kind == 2 ? double(i == 123) : sine;
            if (kind == 5) v[i] = i - 0.5 * (n - 1);
        }
        double square = 0;
        for (double x : v) square += x * x;
        const LinearMap map = [&](Input x, Output y) {
            double product = 0;
            for (int i = 0; i < n; ++i) product += v[i] * x[i];
            for (int i = 0; i < n; ++i) y[i] = x[i] + 0.01 * v[i] * product / square;
        };
        EXPECT_NEAR(livens::two_norm(n, map, map), 1.01, 1e-6) << kind;
    }
}

TEST(TwoNorm, IsWithin1em4WithoutGapsInTheSpectrum)
{
    const int n = 5000;
    const double expected = 4 * std::pow(std::cos(pi / (2 * n + 2)), 2);
    const double found = two_norm(second_differences(n));
    EXPECT_NEAR(found, expected, 4e-4);
    EXPECT_NEAR(found, expected, 4e-5);   // and "as a rule far closer"
    EXPECT_LE(found, expected * (1 + 1e-12));
    SparseMatrix flat = second_differences(5000);   // most singular values crowd at the largest
    flat.rows.clear();
    flat.values.clear();
    for (int j = 0; j < flat.size; ++j) {
        flat.rows.push_back(j);
        flat.values.push_back(1 - std::pow(j / 5000.0, 4));
        flat.column_starts[static_cast<std::size_t>(j) + 1] = j + 1;
    }
    EXPECT_NEAR(two_norm(flat), 1, 1e-4);
}

TEST(Norms, AreRepeatableToTheBit)
{
    const SparseMatrix A = leapfrog_chain(50, 6, 0.1, 600);
    EXPECT_EQ(one_norm(A), one_norm(A));
    EXPECT_EQ(two_norm(A), two_norm(A));
}

TEST(Norms, AreInfiniteWhereProductsOverflow)
{
    const double huge = std::numeric_limits<double>::max();
    for (int n : {2, 20}) {
        const LinearMap map = [&](Input x, Output y) {
            for (std::size_t i = 0; i < x.size(); ++i) y[i] = huge * x[i] * 10;
        };
        const LinearMap undefined = [&](Input, Output y) {
            std::fill(y.begin(), y.end(), std::numeric_limits<double>::quiet_NaN());
        };
        for (const LinearMap& f : {map, undefined}) {
            EXPECT_EQ(livens::one_norm(n, f, f), std::numeric_limits<double>::infinity()) << n;
            EXPECT_EQ(livens::two_norm(n, f, f), std::numeric_limits<double>::infinity()) << n;
        }
    }
}

}   // namespace
}   // namespace livens::condition_test
