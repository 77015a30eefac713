// SPDX-License-Identifier: BSD-3-Clause
// Factorisations against their defining equations.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "livens/solvers/dense.h"
#include "livens/solvers/instructions.h"

namespace livens::dense_test {
namespace {

using Values = std::vector<double>;

double uniform(std::mt19937_64& engine) { return 2 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1; }

Values random_values(std::size_t n, std::uint64_t seed)
{
    std::mt19937_64 engine(seed);
    Values v(n);
    for (double& x : v) x = uniform(engine);
    return v;
}

/// Largest |A x - b| for A stored row by row.
double residual(const Values& A, const Values& x, const Values& b)
{
    const std::size_t n = b.size();
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double sum = -b[i];
        for (std::size_t j = 0; j < n; ++j) sum += A[i * n + j] * x[j];
        worst = std::max(worst, std::abs(sum));
    }
    return worst;
}

void fill(DenseLU& lu, const Values& A, int n)
{
    lu.resize(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) lu.row(i)[j] = A[static_cast<std::size_t>(i * n + j)];
}

TEST(DenseLU, SolvesRandomSystemsOfEverySizeToRounding)
{
    const Instructions before = instructions();
    for (const Instructions set : {Instructions::sse2, Instructions::avx2}) {
        if (!use_instructions(set)) continue;
        for (int n = 1; n <= 65; ++n) {
            const Values A = random_values(static_cast<std::size_t>(n * n), 7u + static_cast<unsigned>(n));
            const Values b = random_values(static_cast<std::size_t>(n), 99);
            DenseLU lu;
            fill(lu, A, n);
            ASSERT_TRUE(lu.factorise());
            Values x = b;
            lu.solve(x.data());
            double size = 0;
            for (double v : x) size = std::max(size, std::abs(v));
            EXPECT_LT(residual(A, x, b), 1e-14 * n * (1 + size)) << "n = " << n << ", " << to_string(set);
        }
    }
    use_instructions(before);
}

TEST(DenseLU, ExchangesRowsWhereTheDiagonalIsZero)
{
    const Values A = {0, 2, 1, 0};
    DenseLU lu;
    fill(lu, A, 2);
    ASSERT_TRUE(lu.factorise());
    Values x = {4, 3};
    lu.solve(x.data());
    EXPECT_DOUBLE_EQ(x[0], 3);
    EXPECT_DOUBLE_EQ(x[1], 2);
}

TEST(DenseLU, RefusesSingularAndUndefinedMatrices)
{
    for (const Values& A :
         {Values{1, 2, 2, 4}, Values{0, 0, 1, 1}, Values{NAN, 1, 1, 1}, Values{INFINITY, 1, 1, 1}}) {
        DenseLU lu;
        fill(lu, A, 2);
        EXPECT_FALSE(lu.factorise());
    }
}

TEST(DenseLU, SolvesTransposedSystems)
{
    for (int n = 0; n <= 33; ++n) {
        const auto size = static_cast<std::size_t>(n);
        const Values A = random_values(size * size, 3u + static_cast<unsigned>(n));
        const Values b = random_values(size, 5);
        DenseLU lu;
        fill(lu, A, n);
        ASSERT_TRUE(lu.factorise());
        Values x = b, transposed(A);
        lu.solve_transposed(x.data());
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j) transposed[i * size + j] = A[j * size + i];
        double largest = 0;
        for (double v : x) largest = std::max(largest, std::abs(v));
        EXPECT_LE(residual(transposed, x, b), 1e-14 * n * (1 + largest)) << "n = " << n;
    }
}

TEST(DenseLU, FactorisesEntriesThatAreHandedOver)
{
    DenseLU lu;
    lu.resize(2);
    Values entries = {1, 2, 4, 2};
    const double* place = entries.data();
    lu.exchange(entries);
    EXPECT_EQ(lu.row(0), place);
    EXPECT_EQ(entries, Values(4, 0.0));
    ASSERT_TRUE(lu.factorise());   // U = [4 2; 0 1.5]
    EXPECT_EQ(lu.smallest_pivot(), 1.5);
    EXPECT_EQ(lu.largest_in_U(), 4);
    Values x = {3, 6};
    lu.solve(x.data());
    EXPECT_DOUBLE_EQ(x[0], 1);
    EXPECT_DOUBLE_EQ(x[1], 1);
}

TEST(DenseLU, NamesTheColumnThatDependsOnThoseBefore)
{
    for (int column = 0; column < 7; ++column) {
        Values A = random_values(49, 21);
        for (std::size_t i = 0; i < 7; ++i) A[7 * i + static_cast<std::size_t>(column)] = 0;
        DenseLU lu;
        fill(lu, A, 7);
        EXPECT_FALSE(lu.factorise());
        EXPECT_EQ(lu.failed_column(), column);
    }
}

TEST(DenseLU, KeepsDecoupledUnknownsExactlyZero)
{
    // unknowns 0, 2 and 1, 3 do not see each other
    const Values A = {3, 0, 0.3, 0, 0, 7, 0, 0.1, 0.7, 0, 5, 0, 0, 0.2, 0, 1};
    DenseLU lu;
    fill(lu, A, 4);
    ASSERT_TRUE(lu.factorise());
    Values x = {1, 0, 0.3, 0};
    lu.solve(x.data());
    EXPECT_EQ(x[1], 0.0);
    EXPECT_EQ(x[3], 0.0);
}

struct Columns {
    int n, k;
    Values a;   // column after column
    double at(int i, int j) const { return a[static_cast<std::size_t>(j * n + i)]; }
};

Columns random_columns(int n, int k, std::uint64_t seed)
{
    return {n, k, random_values(static_cast<std::size_t>(n * k), seed)};
}

OrthogonalBasis basis_of(const Columns& c, bool keep_signs = false)
{
    OrthogonalBasis q;
    q.resize(c.n, c.k);
    for (int j = 0; j < c.k; ++j)
        for (int i = 0; i < c.n; ++i) q.column(j)[i] = c.at(i, j);
    q.factorise(c.k, keep_signs);
    return q;
}

Values null_space(const OrthogonalBasis& q)
{
    Values z(static_cast<std::size_t>(q.n() * (q.n() - q.rank())));
    q.null_space(z.data());
    return z;
}

TEST(OrthogonalBasis, NullSpaceIsOrthonormalAndOrthogonalToTheColumns)
{
    for (int n : {3, 6, 12, 18}) {
        for (int k = 0; k <= n; k += 2) {
            const Columns c = random_columns(n, k, 5);
            const OrthogonalBasis q = basis_of(c);
            const Values z = null_space(q);
            const int f = n - k;
            for (int a = 0; a < f; ++a) {
                for (int j = 0; j < k; ++j) {
                    double sum = 0;
                    for (int i = 0; i < n; ++i) sum += z[static_cast<std::size_t>(i * f + a)] * c.at(i, j);
                    EXPECT_NEAR(sum, 0, 1e-13);
                }
                for (int b = 0; b < f; ++b) {
                    double sum = 0;
                    for (int i = 0; i < n; ++i)
                        sum +=
                            z[static_cast<std::size_t>(i * f + a)] * z[static_cast<std::size_t>(i * f + b)];
                    EXPECT_NEAR(sum, a == b ? 1 : 0, 1e-13);
                }
            }
        }
    }
}

/// Columns of joints of chains and trees, which are zero but on two bodies, in any order.
TEST(OrthogonalBasis, LeavesOutNothingButZeros)
{
    constexpr int bodies = 9, n = 6 * bodies, k = 5 * bodies;
    for (int kind = 0; kind < 4; ++kind) {
        Columns c{n, k, Values(static_cast<std::size_t>(n * k), 0.0)};
        const Values entries =
            random_values(static_cast<std::size_t>(12 * k), 31 + static_cast<unsigned>(kind));
        for (int j = 0; j < k; ++j) {
            const int joint = kind == 1 ? bodies - 1 - j / 5 : kind == 3 ? (4 * (j / 5) + 1) % bodies : j / 5;
            const int before = kind == 2 ? (joint - 1) / 2 : joint - 1;   // in a tree, else in a chain
            for (int i = 0; i < 12; ++i) {
                const int body = i < 6 ? before : joint;
                // Rows of joints have zeros on their bodies, too, so that exchanges go far.
                if (body >= 0 && (i + j % 5) % 6 != 0 && (i + j % 5) % 6 != 3)
                    c.a[static_cast<std::size_t>(j * n + 6 * body + i % 6)] =
                        entries[static_cast<std::size_t>(12 * j + i)];
            }
        }
        OrthogonalBasis q = basis_of(c);
        for (const bool again : {false, true}) {   // with the choices kept as well
            if (again) {
                for (int j = 0; j < k; ++j)
                    for (int i = 0; i < n; ++i) q.column(j)[i] = c.at(i, j);
                q.factorise(k, true);
            }
            for (int j = 0; j < k; ++j) {
                Values x(c.a.begin() + j * n, c.a.begin() + (j + 1) * n);
                q.apply_transposed(x.data());
                for (int i = j + 1; i < n; ++i)
                    ASSERT_NEAR(x[static_cast<std::size_t>(i)], 0, 1e-13) << kind << " " << j << " " << i;
            }
        }
    }
}

TEST(OrthogonalBasis, AppliesQAndItsTransposeAsInverses)
{
    const OrthogonalBasis q = basis_of(random_columns(9, 4, 11));
    const Values x = random_values(9, 3);
    Values y = x;
    q.apply(y.data());
    q.apply_transposed(y.data());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i], x[i], 1e-14);
}

TEST(OrthogonalBasis, TriangularSolvesInvertTheColumns)
{
    // A y for y = R^-1 Q^T b is b for b in the range of A; and A^T Q R^-T c = c
    const Columns c = random_columns(7, 3, 23);
    const OrthogonalBasis q = basis_of(c);
    const Values wanted = {0.3, -2, 1.5};
    Values b(7, 0.0);
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 3; ++j)
            b[static_cast<std::size_t>(i)] += c.at(i, j) * wanted[static_cast<std::size_t>(j)];
    q.apply_transposed(b.data());
    q.solve_R(b.data());
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(b[j], wanted[j], 1e-13);

    Values y(7, 0.0);
    std::copy(wanted.begin(), wanted.end(), y.begin());
    q.solve_R_transposed(y.data());
    q.apply(y.data());
    for (int j = 0; j < 3; ++j) {
        double sum = 0;
        for (int i = 0; i < 7; ++i) sum += c.at(i, j) * y[static_cast<std::size_t>(i)];
        EXPECT_NEAR(sum, wanted[static_cast<std::size_t>(j)], 1e-13);
    }
}

TEST(OrthogonalBasis, PivotedChoiceLeavesOutTheDependentColumn)
{
    Columns c = random_columns(6, 4, 31);
    for (int i = 0; i < 6; ++i) c.a[static_cast<std::size_t>(6 + i)] = 1e-3 * (c.at(i, 0) - c.at(i, 2));
    OrthogonalBasis q;
    q.resize(6, 4);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 6; ++i) q.column(j)[i] = c.at(i, j);
    std::vector<int> order(4);
    EXPECT_GT(q.factorise_pivoted(3, order), 1e-2);
    EXPECT_EQ(order[3], 1);
}

TEST(OrthogonalBasis, KeptChoicesMakeTheNullSpaceVaryContinuously)
{
    // the largest entry changes place between two matrices that are 2e-9 apart
    auto columns = [](double tilt) { return Columns{3, 1, {0.6, 0.7 + tilt, 0.7 - tilt}}; };
    OrthogonalBasis q = basis_of(columns(1e-9));
    const Values before = null_space(q);
    auto step = [&](bool keep) {
        OrthogonalBasis next = q;
        for (int i = 0; i < 3; ++i) next.column(0)[i] = columns(-1e-9).at(i, 0);
        next.factorise(1, keep);
        const Values after = null_space(next);
        double worst = 0;
        for (std::size_t i = 0; i < after.size(); ++i)
            worst = std::max(worst, std::abs(after[i] - before[i]));
        return worst;
    };
    EXPECT_LT(step(true), 1e-8);
    EXPECT_GT(step(false), 0.1) << "negative control: the usual choice jumps";
}

TEST(OrthogonalBasis, LeavesUnknownsThatNoColumnTouchesAlone)
{
    // columns that never touch unknowns 1 and 4: there the null space is the unit vectors to the bit
    Columns c{6, 2, {1, 0, 2, -3, 0, 1, 0.5, 0, 1, 1, 0, 2}};
    const Values z = null_space(basis_of(c));
    for (int i : {1, 4}) {
        int ones = 0, zeros = 0;
        for (int a = 0; a < 4; ++a) {
            const double v = z[static_cast<std::size_t>(4 * i + a)];
            ones += v == 1.0;
            zeros += v == 0.0;
        }
        EXPECT_EQ(ones, 1);
        EXPECT_EQ(zeros, 3);
    }
}

TEST(Cholesky, SolvesDefiniteSystemsAndRefusesOthers)
{
    const int n = 8;
    const Values g = random_values(n * n, 41);
    Values A(n * n, 0.0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k)
                A[static_cast<std::size_t>(n * i + j)] +=
                    g[static_cast<std::size_t>(n * i + k)] * g[static_cast<std::size_t>(n * j + k)];
    Cholesky c;
    c.resize(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) c.row(i)[j] = A[static_cast<std::size_t>(n * i + j)];
    ASSERT_TRUE(c.factorise());
    const Values b = random_values(n, 43);
    Values x = b;
    c.solve(x.data());
    EXPECT_LT(residual(A, x, b), 1e-10);

    c.resize(2);
    c.row(0)[0] = 1;
    c.row(1)[0] = 2;
    c.row(1)[1] = 1;
    EXPECT_FALSE(c.factorise());
}

}   // namespace
}   // namespace livens::dense_test
