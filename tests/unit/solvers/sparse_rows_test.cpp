// SPDX-License-Identifier: BSD-3-Clause
// Projections by sparse rows, and sparse systems that are solved once, against dense ones.
#include <gtest/gtest.h>

#include "dense_matrices.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/sparse_rows.h"
#include "short_memory.h"

namespace livens::sparse_rows_test {
namespace {

std::vector<SparseEntry> entries_of(DenseView A)
{
    std::vector<SparseEntry> entries;
    for (int j = 0; j < A.cols; ++j)
        for (int i = 0; i < A.rows; ++i)
            if (A(i, j) != 0) entries.push_back({i, j, A(i, j)});
    return entries;
}

/// Each row touches three columns.
DenseMatrix chain(int n_rows)
{
    DenseMatrix G(n_rows, n_rows + 2);
    Random random(70);
    for (int i = 0; i < n_rows; ++i)
        for (int j = i; j < i + 3; ++j) G(i, j) = random.next() + (j == i ? 2 : 0);
    return G;
}

TEST(SparseRows, ProjectOntoWhatTheyWant)
{
    for (const int n : {1, 2, 30, 48, 49, 200}) {   // many have a sparse factor
        const DenseMatrix G = chain(n);
        const SparseRows rows(n, n + 2, entries_of(G));
        EXPECT_GT(rows.smallest_pivot(), 0.1);
        const Values before = Random(71).values(n + 2), wanted = Random(72).values(n);
        Values y = before;
        const Values mu = rows.project(y, wanted);
        EXPECT_LT(difference(product(G, y), wanted), 1e-14);
        add_scaled(y, 1, transposed_product(G, mu));   // the way there is along the rows: the shortest
        EXPECT_LT(difference(y, before), 1e-14);
    }
}

/// The factor of few rows and the sparse one, by rows that touch nothing of the others.
TEST(SparseRows, OfFewAndOfManyAreTheSame)
{
    const int n = 20, others = 80;
    const DenseMatrix G = chain(n);
    std::vector<SparseEntry> entries = entries_of(G);
    const SparseRows few(n, n + 2, entries);
    for (int k = 0; k < others; ++k) entries.push_back({n + k, n + 2 + k, 1});
    const SparseRows many(n + others, n + 2 + others, entries);
    EXPECT_GT(many.smallest_pivot(), 0.1);
    Values y = Random(73).values(n + 2), wanted = Random(74).values(n), longer = y, more = wanted;
    longer.resize(longer.size() + others, 0.0);
    more.resize(more.size() + others, 0.0);
    Values mu = few.project(y, wanted), mu_of_many = many.project(longer, more);
    mu_of_many.resize(n);
    longer.resize(n + 2);
    EXPECT_LT(difference(mu, mu_of_many), 1e-14);
    EXPECT_LT(difference(y, longer), 1e-14);
}

TEST(SparseRows, WithoutRowsNothingMoves)
{
    const SparseRows rows(0, 3, {});
    EXPECT_EQ(rows.smallest_pivot(), 1);
    Values y{1, 2, 3};
    EXPECT_TRUE(rows.project(y, {}).empty());
    EXPECT_EQ(y, (Values{1, 2, 3}));
}

TEST(SparseRows, TellHowNearTheyAreToOneThatSaysTheSame)
{
    const auto pivot = [](double apart) {
        const std::vector<SparseEntry> entries{{0, 0, 1}, {1, 0, 1}, {1, 1, apart}};
        return SparseRows(2, 2, entries).smallest_pivot();
    };
    EXPECT_NEAR(pivot(1e-3), 1e-3, 1e-6);
    EXPECT_EQ(pivot(0), 0);
    EXPECT_EQ(pivot(no_number), 0);
    EXPECT_GT(pivot(1), 0.7);
}

TEST(SparseRows, EntriesOfTheSamePlaceAreAdded)
{
    const std::vector<SparseEntry> entries{{0, 0, 1}, {0, 0, 2}, {0, 1, 4}, {0, 1, 0}};
    Values y{0, 0};
    SparseRows(1, 2, entries).project(y, Values{25});
    EXPECT_LT(difference(y, Values{3, 4}), 1e-14);
}

TEST(SparseSolution, IsThatOfTheDenseMatrix)
{
    for (const int n : {0, 1, 2, 60}) {
        DenseMatrix A(n, n);
        std::ranges::copy(random_matrix(n, 0.2, 73).a, A.a.begin());
        for (int i = 0; i < n; ++i) A(i, i) += 3;
        const Values b = Random(74).values(n);
        const auto x = sparse_solution(entries_of(A), b);
        ASSERT_TRUE(x);
        EXPECT_LT(difference(*x, lu_solution(A, b).x), 1e-12);
    }
}

TEST(SparseSolution, ExchangesRowsAndAddsEntries)
{
    const std::vector<SparseEntry> A{{0, 1, 1}, {1, 0, 1}, {1, 0, 1}};   // nothing on the diagonal
    const auto x = sparse_solution(A, Values{3, 4});
    ASSERT_TRUE(x);
    EXPECT_EQ(*x, (Values{2, 3}));
}

TEST(SparseSolution, OfWhatIsSingularOrNotFiniteIsNone)
{
    EXPECT_FALSE(sparse_solution(std::vector<SparseEntry>{{0, 0, 1}}, Values{1, 1}));
    EXPECT_FALSE(sparse_solution(std::vector<SparseEntry>{{0, 0, 1}, {1, 1, 0}}, Values{1, 1}));
    EXPECT_FALSE(sparse_solution(std::vector<SparseEntry>{{0, 0, 1}, {1, 1, no_number}}, Values{1, 1}));
}

#ifdef LIVENS_SHORT_MEMORY
TEST(SparseSolutionDeathTest, RunsOutOfMemoryByBadAllocAlone)
{
    const Dense dense = random_matrix(400, 0.01, 75);
    DenseMatrix A(400, 400);
    A.a = dense.a;
    const std::vector<SparseEntry> entries = entries_of(A);
    const Values b = Random(76).values(400);
    expect_bad_alloc_alone([&] { return sparse_solution(entries, b).has_value(); },
                           {64, 128, 256, 512, 1024, 1536, 2048, 3072, 4096, 6144, 8192, 65536});
    expect_bad_alloc_alone(
        [&] {
            std::vector<SparseEntry> many;
            for (int i = 0; i < 20000; ++i)
                for (int j = i; j < i + 3; ++j) many.push_back({i, j, j == i ? 3.0 : 1.0});
            return SparseRows(20000, 20002, many).smallest_pivot() > 0.1;
        },
        {256, 512, 1024, 2048, 3072, 4096, 5120, 6144, 8192, 12288, 65536});
}
#endif

}   // namespace
}   // namespace livens::sparse_rows_test
