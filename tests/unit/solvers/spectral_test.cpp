// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues and singular values against what defines them and against matrices whose values are known.
#include <gtest/gtest.h>

#include <numbers>

#include "dense_matrices.h"
#include "livens/solvers/spectral.h"
#include "short_memory.h"

namespace livens::spectral_test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// A V = M V diag(values).
void expect_pairs(DenseView A, DenseView M, const SymmetricSpectrum& found, double tolerance)
{
    ASSERT_TRUE(found.is_found);
    ASSERT_EQ(static_cast<int>(found.values.size()), A.rows);
    EXPECT_TRUE(std::ranges::is_sorted(found.values));
    const DenseMatrix MV = product(M, found.vectors);
    EXPECT_LT(difference(product(A, found.vectors), product(MV, diagonal_matrix(found.values))), tolerance);
    EXPECT_LT(difference(transposed_product(found.vectors, MV), unit_matrix(A.rows)), tolerance);
}

TEST(SymmetricSpectrum, FulfilsItsEquation)
{
    for (const int n : {0, 1, 2, 3, 8, 50}) {
        const DenseMatrix A = random_symmetric(n, 20);
        const SymmetricSpectrum found = symmetric_spectrum(A);
        expect_pairs(A, unit_matrix(n), found, 1e-12);
        EXPECT_EQ(symmetric_values(A), found.values);
    }
}

TEST(SymmetricSpectrum, OfAChainIsKnown)
{
    const int n = 12;
    DenseMatrix A(n, n);
    for (int i = 0; i < n; ++i) {
        A(i, i) = 2;
        if (i > 0) A(i, i - 1) = A(i - 1, i) = -1;
    }
    const SymmetricSpectrum of_diagonals = tridiagonal_spectrum(Values(n, 2.0), Values(n - 1, -1.0));
    expect_pairs(A, unit_matrix(n), of_diagonals, 1e-13);
    const Values of_all = symmetric_values(A);
    for (int k = 0; k < n; ++k) {
        const double value = 2 - 2 * std::cos((k + 1) * std::numbers::pi / (n + 1));
        EXPECT_NEAR(of_all[k], value, 1e-14);
        EXPECT_NEAR(of_diagonals.values[k], value, 1e-14);
    }
    EXPECT_TRUE(tridiagonal_spectrum({}, {}).values.empty());
    EXPECT_EQ(tridiagonal_spectrum(Values{3}, {}).values, Values{3});
}

TEST(SymmetricSpectrum, ReadsTheLowerTriangleAlone)
{
    DenseMatrix A = random_symmetric(7, 21), lower = A;
    for (int j = 0; j < 7; ++j)
        for (int i = 0; i < j; ++i) lower(i, j) = 99;
    EXPECT_EQ(symmetric_values(lower), symmetric_values(A));
}

TEST(SymmetricSpectrum, ValuesMayComeManyTimesAndBeZero)
{
    const SymmetricSpectrum of_one = symmetric_spectrum(unit_matrix(5));
    EXPECT_EQ(of_one.values, Values(5, 1.0));
    EXPECT_TRUE(is_orthonormal(of_one.vectors));
    const SymmetricSpectrum of_zero = symmetric_spectrum(DenseMatrix(4, 4));
    EXPECT_EQ(of_zero.values, Values(4, 0.0));
    EXPECT_TRUE(is_orthonormal(of_zero.vectors));
    const DenseMatrix B = random_dense(6, 2, 22), A = product(B, transpose(B));   // of rank 2
    const Values values = symmetric_values(A);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(values[k], 0, 1e-15);
    EXPECT_GT(values[4], 1e-3);
}

TEST(SymmetricSpectrum, OfSmallMatricesIsTheSame)
{
    const DenseMatrix A = random_symmetric(3, 23), B = random_symmetric(4, 24);
    Matrix3 of_three;
    Matrix4 of_four;
    std::ranges::copy(A.a, of_three.a);
    std::ranges::copy(B.a, of_four.a);
    const PrincipalValues found = symmetric_spectrum(of_three);
    const Matrix3 gap =
        of_three * found.vectors -
        found.vectors * Matrix3{found.values[0], 0, 0, 0, found.values[1], 0, 0, 0, found.values[2]};
    EXPECT_LT(norm(gap), 1e-14);
    EXPECT_LT(norm(symmetric_values(of_three) - found.values), 1e-14);
    const Values expected = symmetric_values(B);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(symmetric_values(of_four)[k], expected[k], 1e-14);
    EXPECT_EQ(symmetric_values(identity<3>()), (Vector3{1, 1, 1}));
}

TEST(GeneralisedSpectrum, FulfilsItsEquation)
{
    for (const int n : {0, 1, 2, 9, 40}) {
        const DenseMatrix K = random_symmetric(n, 25), M = random_positive(n, 26);
        const SymmetricSpectrum found = generalised_spectrum(K, M);
        expect_pairs(K, M, found, 1e-11);
        EXPECT_EQ(generalised_values(K, M), found.values);
    }
}

TEST(GeneralisedSpectrum, WantsAPositiveMass)
{
    const DenseMatrix K = random_symmetric(3, 27);
    for (const double last : {0.0, -1.0, no_number}) {
        const SymmetricSpectrum found = generalised_spectrum(K, diagonal_matrix({1, 2, last}));
        EXPECT_FALSE(found.is_found);
        EXPECT_TRUE(all_nan(found.values));
        EXPECT_TRUE(all_nan(found.vectors.a));
        EXPECT_EQ(found.vectors.cols, 3);
        EXPECT_TRUE(all_nan(generalised_values(K, diagonal_matrix({1, 2, last}))));
    }
}

TEST(GeneralSpectrum, FulfilsItsEquation)
{
    for (const int n : {0, 1, 2, 5, 30}) {
        const DenseMatrix A = random_dense(n, n, 28);
        const GeneralSpectrum found = general_spectrum(A);
        ASSERT_EQ(static_cast<int>(found.vectors.size()), n);
        std::complex<double> sum = 0;
        for (int k = 0; k < n; ++k) {
            double size = 0;
            for (int i = 0; i < n; ++i) {
                std::complex<double> left = -found.values[k] * found.vectors[k][i];
                for (int j = 0; j < n; ++j) left += A(i, j) * found.vectors[k][j];
                EXPECT_LT(std::abs(left), 1e-12);
                size += std::norm(found.vectors[k][i]);
            }
            EXPECT_NEAR(size, 1, 1e-12);
            sum += found.values[k];
        }
        double trace = 0;
        for (int i = 0; i < n; ++i) trace += A(i, i);
        EXPECT_LT(std::abs(sum - trace), 1e-12);
    }
}

TEST(GeneralSpectrum, ARotationTurnsByAPair)
{
    DenseMatrix A(2, 2);
    A.a = {0, 3, -3, 0};
    const GeneralSpectrum found = general_spectrum(A);
    EXPECT_NEAR(std::abs(found.values[0] - std::complex<double>(0, 3)), 0, 1e-15);
    EXPECT_EQ(found.values[1], std::conj(found.values[0]));
}

TEST(SingularValues, AreTheRootsOfTheSquareAndDescend)
{
    for (const auto& [rows, cols] : {std::pair{6, 3}, {3, 6}, {5, 5}, {1, 4}, {4, 1}, {1, 1}}) {
        const DenseMatrix A = random_dense(rows, cols, 29),
                          square = rows < cols ? product(A, transpose(A)) : transposed_product(A, A);
        const Values found = singular_values(A), squares = symmetric_values(square);
        ASSERT_EQ(found.size(), squares.size());
        for (std::size_t k = 0; k < found.size(); ++k)
            EXPECT_NEAR(found[k] * found[k], squares[squares.size() - 1 - k], 1e-14);
    }
    EXPECT_TRUE(singular_values(DenseMatrix(0, 3)).empty());
    EXPECT_TRUE(singular_values(DenseMatrix(3, 0)).empty());
}

TEST(SingularValues, ThatVanishHaveDirections)
{
    const DenseMatrix B = random_dense(6, 4, 30), A = product(B, transpose(B));   // of rank 4
    const DenseMatrix null = null_directions(A, 1e-12);
    ASSERT_EQ(null.cols, 2);
    EXPECT_TRUE(is_orthonormal(null));
    EXPECT_LT(largest_size(product(A, null).a), 1e-14);
    EXPECT_EQ(null_directions(unit_matrix(3), 0.5).cols, 0);
    EXPECT_EQ(null_directions(DenseMatrix(3, 3), 0).cols, 3);
    EXPECT_EQ(null_directions({}, 1).cols, 0);
}

TEST(SingularValues, TheOrthogonalFactorIsARotationOfItself)
{
    const Matrix3 turn{0, 1, 0, -1, 0, 0, 0, 0, 1}, stretch{2, 0.5, 0, 0.5, 3, 0, 0, 0, 0};   // singular
    const Matrix3 Q = orthogonal_factor(turn * stretch);
    EXPECT_LT(norm(transpose(Q) * Q - identity<3>()), 1e-14);
    EXPECT_LT(norm(Q.column(0) - turn.column(0)), 1e-14);
    EXPECT_LT(norm(Q.column(1) - turn.column(1)), 1e-14);
}

TEST(Spectra, OfWhatIsNotFiniteAreNoNumbers)
{
    for (const double bad : {no_number, inf, -inf}) {
        DenseMatrix A = random_symmetric(4, 31);
        A(2, 2) = bad;
        EXPECT_TRUE(all_nan(symmetric_values(A)));
        EXPECT_FALSE(symmetric_spectrum(A).is_found);
        EXPECT_TRUE(all_nan(symmetric_spectrum(A).vectors.a));
        EXPECT_FALSE(generalised_spectrum(A, unit_matrix(4)).is_found);
        EXPECT_FALSE(tridiagonal_spectrum(Values{1, bad}, Values{1}).is_found);
        EXPECT_FALSE(tridiagonal_spectrum(Values{1, 2}, Values{bad}).is_found);
        EXPECT_TRUE(std::isnan(general_spectrum(A).values[3].real()));
        EXPECT_TRUE(std::isnan(general_spectrum(A).vectors[3][3].imag()));
        EXPECT_TRUE(all_nan(singular_values(A)));
        EXPECT_EQ(null_directions(A, inf).cols, 0);
        const Matrix3 of_three{1, 0, 0, 0, bad, 0, 0, 0, 1};
        Matrix4 of_four = identity<4>();
        of_four(3, 0) = bad;
        EXPECT_TRUE(all_nan(symmetric_values(of_three).a));
        EXPECT_TRUE(all_nan(symmetric_spectrum(of_three).values.a));
        EXPECT_TRUE(all_nan(symmetric_values(of_four).a));
        EXPECT_TRUE(all_nan(orthogonal_factor(of_three).a));
    }
}

#ifdef LIVENS_SHORT_MEMORY
TEST(SpectraDeathTest, RunOutOfMemoryByBadAllocAlone)
{
    const DenseMatrix A = random_symmetric(120, 32), M = random_positive(120, 33),
                      B = random_dense(120, 60, 34);
    const auto bounds = {64, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 65536};
    expect_bad_alloc_alone([&] { return generalised_spectrum(A, M).is_found; }, bounds);
    expect_bad_alloc_alone([&] { return std::isfinite(general_spectrum(A).values[0].real()); }, bounds);
    expect_bad_alloc_alone([&] { return singular_values(B)[0] > 0; }, bounds);
    expect_bad_alloc_alone([&] { return singular_values(transpose(B))[0] > 0; }, bounds);
    expect_bad_alloc_alone([&] { return null_directions(A, 1e-9).cols == 0; }, bounds);
}
#endif

}   // namespace
}   // namespace livens::spectral_test
