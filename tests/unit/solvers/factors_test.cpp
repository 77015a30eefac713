// SPDX-License-Identifier: BSD-3-Clause
// Factorisations that are made once, against what defines them.
#include <gtest/gtest.h>

#include "dense_matrices.h"
#include "livens/solvers/factors.h"
#include "short_memory.h"

namespace livens::factors_test {
namespace {

/// A matrix of a rank.
DenseMatrix of_rank(int rows, int cols, int rank, unsigned seed)
{
    return product(random_dense(rows, rank, seed), random_dense(rank, cols, seed + 1));
}

DenseMatrix exchanged(const DenseMatrix& A, const PivotedQR& qr)
{
    DenseMatrix AP(A.rows, A.cols);
    for (int k = 0; k < A.cols; ++k) std::ranges::copy(A.column(qr.column(k)), AP.column(k).begin());
    return AP;
}

TEST(PivotedQR, SplitsIntoRotationAndTriangle)
{
    for (const auto& [rows, cols] : {std::pair{1, 1}, {5, 3}, {3, 5}, {60, 60}, {7, 1}, {1, 7}}) {
        const DenseMatrix A = random_dense(rows, cols, 40);
        const PivotedQR qr(A);
        ASSERT_EQ(qr.n_pivots(), std::min(rows, cols));
        const DenseMatrix Q = qr.basis(0, rows);
        EXPECT_TRUE(is_orthonormal(Q));
        const DenseMatrix R = transposed_product(Q, exchanged(A, qr));
        for (int j = 0; j < cols; ++j)
            for (int i = j + 1; i < rows; ++i) EXPECT_NEAR(R(i, j), 0, 1e-13);
        for (int k = 0; k < qr.n_pivots(); ++k) {
            EXPECT_NEAR(std::abs(R(k, k)), qr.pivot(k), 1e-13);
            EXPECT_LE(qr.pivot(k), qr.pivot(std::max(0, k - 1)) * (1 + 1e-13));
        }
        EXPECT_LT(difference(qr.basis(1, rows - 1), DenseMatrix({rows, rows - 1, Q.column(0).data() + rows})),
                  1e-15);
    }
}

TEST(PivotedQR, TellsRankAndWhatIsPerpendicular)
{
    const DenseMatrix A = of_rank(8, 6, 3, 41);
    const PivotedQR qr(A);
    EXPECT_GT(qr.pivot(2), 1e-3);
    EXPECT_LT(qr.pivot(3), 1e-14);
    EXPECT_LT(largest_size(transposed_product(qr.basis(3, 5), A).a), 1e-14);
    EXPECT_EQ(PivotedQR(DenseMatrix(3, 2)).pivot(0), 0);   // of rank 0
    EXPECT_TRUE(is_orthonormal(PivotedQR(DenseMatrix(3, 2)).basis(0, 3)));
}

TEST(PivotedQR, TakesTheFirstOfEqualColumns)
{
    DenseMatrix A(3, 3);
    A(0, 0) = A(0, 1) = A(0, 2) = 1;
    EXPECT_EQ(PivotedQR(A).column(0), 0);
    A(0, 2) = 2;
    EXPECT_EQ(PivotedQR(A).column(0), 2);
}

TEST(PivotedQR, SolvesInTheLeastSquares)
{
    const DenseMatrix A = random_dense(9, 4, 42);
    const Values b = Random(43).values(9), x = PivotedQR(A).solve(b);
    Values left = product(A, x);
    add_scaled(left, -1, b);
    EXPECT_LT(largest_size(transposed_product(A, left)), 1e-13);
    EXPECT_EQ(PivotedQR(DenseMatrix(3, 2)).solve(Values{1, 2, 3}), Values(2, 0.0));
}

TEST(PivotedQR, OfNothingHasTheBasisOfAll)
{
    const PivotedQR no_columns(DenseMatrix(3, 0)), no_rows(DenseMatrix(0, 2));
    EXPECT_EQ(no_columns.n_pivots(), 0);
    EXPECT_EQ(difference(no_columns.basis(1, 2), DenseMatrix({3, 2, unit_matrix(3).column(1).data()})), 0);
    EXPECT_TRUE(no_columns.solve(Values{1, 2, 3}).empty());
    EXPECT_EQ(no_rows.solve({}), Values(2, 0.0));
    EXPECT_EQ(no_rows.column(1), 1);
    EXPECT_TRUE(no_rows.basis(0, 0).is_empty());
}

TEST(Factors, WithoutExchangesAreOfTheColumns)
{
    for (const auto& [rows, cols] : {std::pair{5, 3}, {4, 4}, {70, 50}, {1, 1}, {3, 0}}) {
        const DenseMatrix A = random_dense(rows, cols, 44), Q = orthonormal_columns(A), R = upper_factor(A);
        EXPECT_TRUE(is_orthonormal(Q));
        for (int j = 0; j < cols; ++j)
            for (int i = j + 1; i < cols; ++i) EXPECT_EQ(R(i, j), 0);
        EXPECT_LT(difference(product(Q, R), A), 1e-13);
    }
}

TEST(Factors, LeastSquaresLeaveWhatIsPerpendicular)
{
    const DenseMatrix A = random_dense(12, 5, 45), B = random_dense(12, 3, 46);
    DenseMatrix left = product(A, least_squares(A, B));
    add_scaled(left.a, -1, B.a);
    EXPECT_LT(largest_size(transposed_product(A, left).a), 1e-13);
    EXPECT_EQ(least_squares(A, DenseMatrix(12, 0)).rows, 5);
    EXPECT_EQ(least_squares(DenseMatrix(2, 0), DenseMatrix(2, 3)).cols, 3);
}

TEST(Factors, TrianglesAreSolvedFromTheirEnd)
{
    const DenseMatrix R = upper_factor(random_dense(6, 6, 47)), B = random_dense(6, 2, 48);
    const DenseMatrix X = upper_solution(R, B);
    EXPECT_LT(difference(product(R, X), B), 1e-12);
    const Values x = upper_solution(R, B.column(1));
    EXPECT_LT(difference(x, Values(X.column(1).begin(), X.column(1).end())), 1e-12);
    EXPECT_TRUE(upper_solution({}, Values{}).empty());
    EXPECT_FALSE(all_finite(upper_solution(DenseMatrix(2, 2), Values{1, 1})));
}

TEST(NullSpace, IsWhatAMatrixTakesToZero)
{
    const DenseMatrix A = of_rank(5, 7, 4, 49), null = null_space(A, 1e-9);
    ASSERT_EQ(null.cols, 3);
    EXPECT_LT(largest_size(product(A, null).a), 1e-13);
    EXPECT_GT(PivotedQR(null).pivot(2), 1e-3);   // a basis
    EXPECT_EQ(null_space(random_dense(5, 4, 50), 1e-9).cols, 0);
    EXPECT_EQ(null_space(DenseMatrix(2, 3), 1e-9).cols, 3);
    EXPECT_EQ(null_space(DenseMatrix(0, 3), 1e-9).cols, 3);
    EXPECT_EQ(null_space(DenseMatrix(3, 0), 1e-9).rows, 0);
    EXPECT_EQ(null_space(diagonal_matrix({1, 1e-6}), 1e-5).cols, 1);   // by the threshold
    EXPECT_EQ(null_space(diagonal_matrix({1, 1e-6}), 1e-7).cols, 0);
}

TEST(CholeskyFactor, IsALowerTriangleWhoseSquareIsTheMatrix)
{
    for (const int n : {0, 1, 2, 10, 70}) {
        const DenseMatrix A = random_positive(n, 51), L = cholesky(A), B = random_dense(n, 3, 52);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < j; ++i) EXPECT_EQ(L(i, j), 0);
        EXPECT_LT(difference(product(L, transpose(L)), A), 1e-12);
        const DenseMatrix X = cholesky_solution(L, B);
        EXPECT_LT(difference(product(A, X), B), 1e-12);
        const Values x = cholesky_solution(L, B.column(2));
        EXPECT_LT(difference(product(A, x), Values(B.column(2).begin(), B.column(2).end())), 1e-12);
    }
}

TEST(CholeskyFactor, WantsAPositiveMatrix)
{
    EXPECT_TRUE(all_nan(cholesky(diagonal_matrix({1, 0, 1})).a));
    EXPECT_TRUE(all_nan(cholesky(diagonal_matrix({1, -1})).a));
    EXPECT_TRUE(all_nan(cholesky_solution(cholesky(diagonal_matrix({-1})), Values{1})));
    Matrix4 A = identity<4>();
    A(3, 3) = -1;
    EXPECT_TRUE(all_nan(inverse_of_positive(A).a));
}

TEST(CholeskyFactor, InvertsFourByFour)
{
    Matrix4 A;
    std::ranges::copy(random_positive(4, 53).a, A.a);
    EXPECT_LT(norm(A * inverse_of_positive(A) - identity<4>()), 1e-14);
}

TEST(LUSolution, SolvesAndTellsItsPivots)
{
    for (const int n : {0, 1, 3, 40}) {
        const DenseMatrix A = random_dense(n, n, 54);
        const Values b = Random(55).values(n);
        const LUSolution found = lu_solution(A, b);
        EXPECT_LT(difference(product(A, found.x), b), 1e-11);
        EXPECT_GT(found.smallest_pivot, 0);
        EXPECT_GE(found.largest_pivot, found.smallest_pivot);
    }
    const LUSolution of_diagonal = lu_solution(diagonal_matrix({2, -8, 4}), Values{2, 8, 4});
    EXPECT_EQ(of_diagonal.x, (Values{1, -1, 1}));
    EXPECT_EQ(of_diagonal.smallest_pivot, 2);
    EXPECT_EQ(of_diagonal.largest_pivot, 8);
    const LUSolution singular = lu_solution(diagonal_matrix({1, 0}), Values{1, 1});
    EXPECT_EQ(singular.smallest_pivot, 0);
    EXPECT_FALSE(all_finite(singular.x));
}

TEST(Factors, OfWhatIsNotFiniteAreNoNumbers)
{
    for (const double bad : {no_number, std::numeric_limits<double>::infinity()}) {
        DenseMatrix A = random_positive(3, 56);
        A(2, 1) = bad;
        const Values b{1, 2, 3}, bad_b{1, bad, 3};
        const PivotedQR qr(A), good(unit_matrix(3));
        EXPECT_TRUE(std::isnan(qr.pivot(0)));
        EXPECT_EQ(qr.column(2), 2);
        EXPECT_TRUE(all_nan(qr.basis(0, 3).a));
        EXPECT_TRUE(all_nan(qr.solve(b)));
        EXPECT_TRUE(all_nan(good.solve(bad_b)));
        EXPECT_TRUE(all_nan(orthonormal_columns(A).a));
        EXPECT_TRUE(all_nan(upper_factor(A).a));
        EXPECT_TRUE(all_nan(least_squares(A, unit_matrix(3)).a));
        EXPECT_TRUE(all_nan(least_squares(unit_matrix(3), A).a));
        EXPECT_EQ(null_space(A, 1).cols, 0);
        EXPECT_TRUE(all_nan(cholesky(A).a));
        EXPECT_TRUE(all_nan(lu_solution(A, b).x));
        EXPECT_TRUE(std::isnan(lu_solution(A, b).smallest_pivot));
        EXPECT_TRUE(all_nan(lu_solution(unit_matrix(3), bad_b).x));
        Matrix4 of_four = identity<4>();
        of_four(3, 0) = bad;
        EXPECT_TRUE(all_nan(inverse_of_positive(of_four).a));
    }
}

#ifdef LIVENS_SHORT_MEMORY
TEST(FactorsDeathTest, RunOutOfMemoryByBadAllocAlone)
{
    const DenseMatrix A = random_dense(150, 150, 57), P = random_positive(150, 58),
                      thin = random_dense(150, 60, 59);
    const Values b = Random(60).values(150);
    const auto bounds = {64, 128, 192, 256, 384, 512, 768, 1024, 1536, 65536};
    expect_bad_alloc_alone(
        [&] {
            const PivotedQR qr(A);
            return all_finite(qr.solve(b)) && all_finite(qr.basis(50, 100).a);
        },
        bounds);
    expect_bad_alloc_alone([&] { return all_finite(orthonormal_columns(thin).a); }, bounds);
    expect_bad_alloc_alone([&] { return all_finite(least_squares(thin, A).a); }, bounds);
    expect_bad_alloc_alone([&] { return null_space(transpose(thin), 1e-9).cols == 90; }, bounds);
    expect_bad_alloc_alone([&] { return all_finite(cholesky_solution(cholesky(P), A).a); }, bounds);
    expect_bad_alloc_alone([&] { return all_finite(lu_solution(A, b).x); }, bounds);
}
#endif

}   // namespace
}   // namespace livens::factors_test
