// SPDX-License-Identifier: BSD-3-Clause
// Elimination along time in stretches, against the matrix itself and the general solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/staircase.h"

namespace livens::staircase_test {
namespace {

/// Nodes of `width` unknowns that see their neighbours, and a border that sees both ends; a third is filled.
SparseMatrix chain(int width, int nodes, int border)
{
    std::mt19937 random(7);
    std::normal_distribution<double> number;
    const int n = width * nodes, size = n + border;
    std::vector<std::vector<std::pair<int, double>>> columns(static_cast<std::size_t>(size));
    for (int c = 0; c < size; ++c)
        for (int r = 0; r < size; ++r) {
            const bool is_seen = r < n && c < n ? std::abs(r / width - c / width) <= 1
                                 : r >= n       ? c < width || c >= n - width
                                                : true;
            if (is_seen && (random() % 3 == 0 || r == c)) columns[c].emplace_back(r, number(random));
        }
    return sparse_from_columns(columns);
}

std::vector<int> cuts_of(int width, int nodes, int stretches)
{
    std::vector<int> cuts;
    for (int s = 0; s <= stretches; ++s) cuts.push_back(nodes * s / stretches * width);
    return cuts;
}

TEST(Staircase, SolvesWhatTheGeneralSolverSolves)
{
    for (const int width : {1, 3, 30})
        for (const int stretches : {1, 2, 3, 4})
            for (const int border : {0, 3}) {
                const SparseMatrix A = chain(width, 20, border);
                StaircaseLU lu;
                lu.analyse(A, cuts_of(width, 20, stretches));
                SparseLU general(SparseBackend::eigen);
                general.analyse(A);
                ASSERT_TRUE(general.factorise(A));
                for (int again = 0; again < 2; ++again) ASSERT_TRUE(lu.factorise(A));
                std::vector<double> b(static_cast<std::size_t>(A.size)), x(b), y(b);
                for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(static_cast<double>(i));
                lu.solve(b, x);
                general.solve(b, y);
                double largest = 0, error = 0;
                for (std::size_t i = 0; i < b.size(); ++i) {
                    largest = std::max(largest, std::abs(y[i]));
                    error = std::max(error, std::abs(x[i] - y[i]));
                }
                EXPECT_LT(error, 1e-9 * largest) << width << ' ' << stretches << ' ' << border;
            }
}

/// Its diagonal is so small that as pivots it costs ten digits.
TEST(Staircase, TakesTheLargestPivot)
{
    for (const int stretches : {1, 3}) {
        SparseMatrix A = chain(6, 20, 0);
        double largest = 0;
        for (int c = 0; c < A.size; ++c)
            for (int k = A.column_starts[c]; k < A.column_starts[c + 1]; ++k) {
                if (A.rows[k] == c) A.values[k] *= 1e-9;
                largest = std::max(largest, std::abs(A.values[k]));
            }
        StaircaseLU lu;
        lu.analyse(A, cuts_of(6, 20, stretches));
        ASSERT_TRUE(lu.factorise(A));
        std::vector<double> b(static_cast<std::size_t>(A.size), 1.0), x(b), back(b);
        lu.solve(b, x);
        A.multiply(x, back);
        double size = 0, error = 0;
        for (std::size_t i = 0; i < b.size(); ++i) {
            size = std::max(size, std::abs(x[i]));
            error = std::max(error, std::abs(back[i] - b[i]));
        }
        EXPECT_LT(error, 1e-12 * (1 + largest * size)) << stretches;
    }
}

TEST(Staircase, HasTheSameBitsForAnyNumberOfThreads)
{
    const SparseMatrix A = chain(5, 40, 2);
    std::vector<double> alone;
    for (const int threads : {1, 2, 3, 7}) {
        const Crew crew(threads);
        StaircaseLU lu;
        lu.analyse(A, cuts_of(5, 40, 4));
        ASSERT_TRUE(lu.factorise(A));
        std::vector<double> x(static_cast<std::size_t>(A.size), 1.0);
        lu.solve(x, x);
        if (threads == 1) alone = x;
        EXPECT_EQ(x, alone) << threads;
    }
}

TEST(Staircase, TellsOfAColumnThatDependsOnOthers)
{
    SparseMatrix A = chain(3, 20, 0);
    StaircaseLU lu;
    lu.analyse(A, cuts_of(3, 20, 2));
    ASSERT_TRUE(lu.factorise(A)) << "the control";
    for (const int column : {4, 30, 55}) {   // in the first stretch, between both, in the last
        SparseMatrix singular = A;
        for (int k = A.column_starts[column]; k < A.column_starts[column + 1]; ++k) singular.values[k] = 0;
        EXPECT_FALSE(lu.factorise(singular)) << column;
    }
    A.values[7] = std::nan("");
    EXPECT_FALSE(lu.factorise(A));
}

}   // namespace
}   // namespace livens::staircase_test
