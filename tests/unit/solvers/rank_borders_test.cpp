// SPDX-License-Identifier: BSD-3-Clause
// What ranks have left between their borders, against the whole matrix.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "livens/solvers/dense.h"
#include "livens/solvers/ranks/rank_borders.h"

namespace livens::rank_borders_test {
namespace {

/// Rows of one rank in columns of the whole: borders one after the other, then others.
struct RankRows {
    std::vector<std::vector<double>> rows;
    int first = 0, n_before = 0, n_behind = 0;
};

struct Whole {
    std::vector<RankRows> ranks;
    int n_others = 0, size = 0;
};

/// Of each inner rank `alone` sums of rows see the border before alone, as many that behind; a mixture of all
/// hides it. `faint`: of what they see else.
Whole whole_of(int n_ranks, int width, int alone, int n_others, double faint)
{
    std::mt19937 random(11);
    std::normal_distribution<double> number;
    Whole whole;
    whole.n_others = n_others;
    whole.size = width * (n_ranks - 1) + n_others;
    for (int r = 0; r < n_ranks; ++r) {
        RankRows one;
        const bool is_first = r == 0, is_last = r == n_ranks - 1;
        one.n_before = is_first ? 0 : width;
        one.n_behind = is_last ? 0 : width;
        one.first = width * (r - 1);
        const int n = (one.n_before + one.n_behind) / 2 + (is_last ? n_others : 0);
        std::vector<std::vector<double>> plain(static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i) {
            plain[i].assign(static_cast<std::size_t>(whole.size), 0.0);
            const bool of_before = !is_first && !is_last && i < alone,
                       of_behind = !is_first && !is_last && i >= n - alone;
            const auto fill = [&](int first, int count, double size) {
                for (int c = first; c < first + count; ++c) plain[i][c] = size * number(random);
            };
            fill(is_first ? 0 : one.first, one.n_before, of_behind ? faint : 1);
            fill(one.first + width, one.n_behind, of_before ? faint : 1);
            fill(whole.size - n_others, n_others, of_before || of_behind ? 0 : 1);
        }
        one.rows.assign(static_cast<std::size_t>(n),
                        std::vector<double>(plain.empty() ? 0 : plain[0].size()));
        for (auto& row : one.rows)
            for (const auto& from : plain) {
                const double share = number(random);
                for (std::size_t c = 0; c < row.size(); ++c) row[c] += share * from[c];
            }
        whole.ranks.push_back(one);
    }
    return whole;
}

std::vector<double> right_side(int size)
{
    std::vector<double> b;
    for (int i = 0; i < size; ++i) b.push_back(std::sin(1.0 + i));
    return b;
}

std::vector<double> dense_solution(const Whole& whole)
{
    DenseLU lu;
    lu.resize(whole.size);
    int at = 0;
    for (const RankRows& one : whole.ranks)
        for (const auto& row : one.rows) std::copy(row.begin(), row.end(), lu.row(at++));
    EXPECT_EQ(at, whole.size);
    EXPECT_TRUE(lu.factorise());
    std::vector<double> x = right_side(whole.size);
    lu.solve(x.data());
    return x;
}

struct Outcome {
    double error = 0;
    int n_chain = 0;
    bool is_done = true;
};

/// By ranks, and how far they are from the dense solution.
Outcome solved(const Whole& whole, const std::vector<double>& expected)
{
    const auto n = static_cast<int>(whole.ranks.size());
    std::vector<Outcome> all(static_cast<std::size_t>(n));
    run_as_ranks(n, [&](Ranks& ranks) {
        const auto rank = static_cast<std::size_t>(ranks.rank());
        const RankRows& own = whole.ranks[rank];
        std::vector<int> columns, others;
        for (int c = 0; c < own.n_before + own.n_behind; ++c)
            columns.push_back((own.n_before == 0 ? 0 : own.first) + c);
        for (int c = 0; c < whole.n_others; ++c) {
            columns.push_back(whole.size - whole.n_others + c);
            others.push_back(c);
        }
        std::vector<double> values, b, x(columns.size());
        std::size_t before = 0;
        for (std::size_t r = 0; r < rank; ++r) before += whole.ranks[r].rows.size();
        for (std::size_t i = 0; i < own.rows.size(); ++i) {
            b.push_back(right_side(whole.size)[before + i]);
            for (const int c : columns) values.push_back(own.rows[i][static_cast<std::size_t>(c)]);
        }
        RankBorders borders(ranks);
        Outcome& mine = all[rank];
        mine.is_done = borders.factorise(
            {static_cast<int>(own.rows.size()), own.n_before, own.n_behind, others, whole.n_others, values});
        if (!mine.is_done) return;
        mine.n_chain = borders.n_unknowns();
        borders.solve(b, x);
        for (std::size_t c = 0; c < columns.size(); ++c)
            mine.error =
                std::max(mine.error, std::abs(x[c] - expected[static_cast<std::size_t>(columns[c])]));
    });
    Outcome worst = all[0];
    for (const Outcome& one : all) {
        EXPECT_EQ(one.n_chain, worst.n_chain);
        EXPECT_EQ(one.is_done, worst.is_done);
        worst.error = std::max(worst.error, one.error);
    }
    return worst;
}

TEST(RankBorders, SolveWhatADenseSolverSolves)
{
    for (const int n : {1, 2, 3, 5, 9})
        for (const int alone : {0, 3, 5})
            for (const int n_others : {0, 2}) {
                const int width = 12;
                const Whole whole = whole_of(n, width, alone, n_others, 0);
                if (whole.size == 0) continue;
                const Outcome found = solved(whole, dense_solution(whole));
                EXPECT_TRUE(found.is_done);
                EXPECT_LT(found.error, 1e-9) << n << " " << alone << " " << n_others;
                if (n < 3 || n_others > 0) continue;
                EXPECT_EQ(found.n_chain, (width - 2 * alone) * (n - 2)) << n << " " << alone;
            }
}

/// What sums see of another border is left out below a share of 1e-10, and not above it.
TEST(RankBorders, LeaveOutWhatIsFaint)
{
    const auto chain = [](double faint) {
        const Whole whole = whole_of(5, 12, 5, 0, faint);
        const Outcome found = solved(whole, dense_solution(whole));
        EXPECT_LT(found.error, std::max(1e-9, 1e4 * std::min(faint, 1e-10)));
        return found.n_chain;
    };
    EXPECT_EQ(chain(1e-13), 2 * 3);
    EXPECT_EQ(chain(1e-6), 12 * 3);
}

/// Rows that go into the chain are for its solver to tell.
TEST(RankBorders, SingularRowsAreToldToAll)
{
    for (const int rank : {0, 2, 4}) {
        Whole whole = whole_of(5, 12, 5, 0, 0);
        const std::vector<double> nothing(static_cast<std::size_t>(whole.size), 0.0);
        EXPECT_TRUE(solved(whole, nothing).is_done) << "negative control";
        std::vector<std::vector<double>>& rows = whole.ranks[static_cast<std::size_t>(rank)].rows;
        rows[1] = rows[0];
        EXPECT_FALSE(solved(whole, nothing).is_done) << rank;
    }
}

}   // namespace
}   // namespace livens::rank_borders_test
