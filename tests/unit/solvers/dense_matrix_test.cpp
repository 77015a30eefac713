// SPDX-License-Identifier: BSD-3-Clause
// Products and norms against sums that are written out.
#include <gtest/gtest.h>

#include "dense_matrices.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::dense_matrix_test {
namespace {

TEST(DenseMatrix, IsZeroWhenItIsMadeAndStandsColumnByColumn)
{
    DenseMatrix A(2, 3);
    EXPECT_EQ(A.a, Values(6, 0.0));
    A(1, 2) = 5;
    EXPECT_EQ(A.a[5], 5);
    EXPECT_EQ(A.column(2)[1], 5);
    EXPECT_EQ(transpose(A)(2, 1), 5);
    EXPECT_EQ(DenseMatrix(A.left_columns(2)).a, Values(4, 0.0));
}

TEST(DenseMatrix, TakesAndGivesRowsAndColumns)
{
    DenseMatrix A = random_dense(5, 3, 1);
    const DenseMatrix part = A.middle_rows(1, 2);
    ASSERT_EQ(part.rows, 2);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(part(1, j), A(2, j));
    A.set_rows(3, part);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(A(4, j), A(2, j));
    DenseMatrix grown;
    grown.append_column(A.column(2));
    grown.append_column(A.column(0));
    EXPECT_EQ(grown.rows, 5);
    EXPECT_EQ(grown(4, 1), A(4, 0));
}

TEST(DenseMatrix, ProductsAreSumsOfProducts)
{
    for (const int n : {0, 1, 2, 3, 7, 20, 61})
        for (const int m : {0, 1, 5, 33})
            for (const int k : {0, 1, 4, 40}) {
                const DenseMatrix A = random_dense(n, k, 2), B = random_dense(k, m, 3);
                EXPECT_LT(difference(product(A, B), plain_product(A, B)), 1e-13) << n << m << k;
                EXPECT_LT(difference(transposed_product(transpose(A), B), plain_product(A, B)), 1e-13);
                const Values x = Random(4).values(k), y = product(A, x);
                EXPECT_LT(difference(y, plain_product(A, DenseView{k, 1, x.data()}).a), 1e-13);
                EXPECT_LT(difference(transposed_product(transpose(A), x), y), 1e-13);
            }
}

TEST(DenseMatrix, SplitsIntoSymmetricAndSkew)
{
    const DenseMatrix A = random_dense(6, 6, 5), S = symmetric_part(A), W = skew_part(A);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
            EXPECT_EQ(S(i, j), S(j, i));
            EXPECT_EQ(W(i, j), -W(j, i));
            EXPECT_NEAR(S(i, j) + W(i, j), A(i, j), 1e-16);
        }
    EXPECT_TRUE(symmetric_part({}).is_empty());
}

template <int R, int C>
Matrix<R, C> random_fixed(unsigned seed)
{
    Matrix<R, C> A;
    Random random(seed);
    for (double& entry : A.a) entry = random.next();
    return A;
}

template <int N>
double largest_gap(const Matrix<6, N>& gap)
{
    return largest_size(gap.a);
}

TEST(DenseMatrix, CongruencesAreProductsOfThree)
{
    const auto A = random_fixed<12, 6>(6), B = random_fixed<12, 6>(7);
    const auto K = random_fixed<12, 12>(8);
    EXPECT_LT(largest_gap(congruence(-0.3, A, K, B) - -0.3 * (transpose(A) * K * B)), 1e-13);
    const auto D = random_fixed<6, 6>(9), S = random_fixed<6, 6>(10);
    EXPECT_LT(largest_gap(congruence(D, S) - transpose(D) * S * D), 1e-13);
}

TEST(DenseMatrix, NormsAreThoseOfSums)
{
    EXPECT_EQ(dot({}, {}), 0);
    EXPECT_EQ(norm({}), 0);
    EXPECT_EQ(norm(Values{-3, 4}), 5);
    EXPECT_EQ(squared_norm(Values{1, 2, 3}), 14);
    EXPECT_EQ(dot(Values{1, 2, 3, 4, 5}, Values{5, 4, 3, 2, 1}), 35);
    DenseMatrix A(2, 2);
    A.a = {3, 0, 4, -2};
    EXPECT_EQ(row_norms(A), (Values{5, 2}));
    EXPECT_EQ(row_norms(DenseMatrix(2, 0)), (Values{0, 0}));
    Values y{1, 2};
    add_scaled(y, -2, Values{1, 3});
    EXPECT_EQ(y, (Values{-1, -4}));
}

TEST(DenseMatrix, ANumberThatIsNoneIsTheLargest)
{
    EXPECT_EQ(largest_size({}), 0);
    EXPECT_EQ(largest_size(Values{1, -7, 3}), 7);
    EXPECT_TRUE(std::isnan(largest_size(Values{1, no_number, 3})));
    EXPECT_TRUE(all_finite(Values{1, -7}));
    EXPECT_FALSE(all_finite(Values{1, no_number}));
    EXPECT_FALSE(all_finite(Values{-std::numeric_limits<double>::infinity()}));
}

}   // namespace
}   // namespace livens::dense_matrix_test
