// SPDX-License-Identifier: BSD-3-Clause
// Parts of a chain that ranks condense and close together, against the chain as one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "livens/solvers/ranks/rank_ends.h"

namespace livens::rank_ends_test {
namespace {

constexpr int f = 3, n_elements = 13;
using Values = std::vector<double>;

/// A rotation in the first two coordinates, row by row.
Values rotation(double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

/// Elements of two nodes with random blocks, momenta at both ends and a number as border; f rows of
/// conditions at the start, f + 1 at the end.
struct Chain {
    std::vector<Values> elements, by_number;   // 2 f x 2 f, 2 f
    Values at_start, at_end;                   // by x and p there, and the number: 2 f + 1 columns
    Values right;                              // nodes, then conditions
};

Chain random_chain()
{
    std::mt19937 random(5);
    std::normal_distribution<double> number;
    const auto some = [&](int n) {
        Values values(static_cast<std::size_t>(n));
        for (double& v : values) v = number(random);
        return values;
    };
    Chain chain;
    for (int e = 0; e < n_elements; ++e) {
        chain.elements.push_back(some(4 * f * f));
        chain.by_number.push_back(some(2 * f));
    }
    chain.at_start = some(f * (2 * f + 1));
    chain.at_end = some((f + 1) * (2 * f + 1));
    chain.right = some((n_elements + 1) * f + 2 * f + 1);
    return chain;
}

struct Part {
    int first = 0, last = 0;
    bool has_start = true, has_end = true;
    Values turn = rotation(0);   ///< its first node has coordinates x' = turn x

    int n_closing() const { return (has_start ? f : 0) + (has_end ? f + 1 : 0); }
};

double turned(const Values& turn, int i, int j) { return turn[static_cast<std::size_t>(i * f + j)]; }

BlockStructure structure_of(const Part& part, bool is_part)
{
    BlockStructure s;
    for (int e = part.first; e <= part.last; ++e) {
        s.n_unknowns.push_back(f);
        s.n_rows.push_back(f);
        if (e < part.last) s.elements.push_back({e - part.first, e - part.first + 1});
    }
    s.n_border = 2 * f + 1;
    s.n_closing = part.n_closing();
    s.is_part = is_part;
    return s;
}

/// Columns and rows of the first node in its own coordinates.
void fill(const Chain& chain, const Part& part, BlockMatrix& matrix)
{
    const int m = 2 * f + 1, n = part.last - part.first;
    for (int e = 0; e < n; ++e) {
        const Values &from = chain.elements[static_cast<std::size_t>(part.first + e)],
                     &seen = chain.by_number[static_cast<std::size_t>(part.first + e)];
        const auto old = [&](int i, int j) { return from[static_cast<std::size_t>(i * 2 * f + j)]; };
        Values& to = matrix.storage(e);
        Values& border = matrix.border_storage(e);
        std::ranges::fill(border, 0.0);
        for (int i = 0; i < 2 * f; ++i) {
            for (int j = 0; j < 2 * f; ++j) {
                double sum = 0;
                for (int k = 0; k < 2 * f; ++k)
                    for (int l = 0; l < 2 * f; ++l) {
                        const double row = e > 0 || i >= f ? i == k : k < f ? turned(part.turn, i, k) : 0;
                        const double column = e > 0 || j >= f ? j == l : l < f ? turned(part.turn, j, l) : 0;
                        sum += row * old(k, l) * column;
                    }
                to[static_cast<std::size_t>(i * 2 * f + j)] = sum;
            }
            double sum = 0;
            for (int k = 0; k < 2 * f; ++k)
                sum += (e > 0 || i >= f ? i == k
                        : k < f         ? turned(part.turn, i, k)
                                        : 0) *
                       seen[static_cast<std::size_t>(k)];
            border[static_cast<std::size_t>(i * m + 2 * f)] = sum;
        }
        for (int i = 0; i < f; ++i) {
            if (e == 0) border[static_cast<std::size_t>(i * m + i)] = 1;
            if (e == n - 1) border[static_cast<std::size_t>((f + i) * m + f + i)] = -1;
        }
    }
    Values& closing = matrix.closing();
    std::ranges::fill(closing, 0.0);
    int row = 0;
    const auto put = [&](const Values& from, int count, bool at_end) {
        for (int i = 0; i < count; ++i, ++row)
            for (int j = 0; j <= 2 * f; ++j) {
                const int column = j == 2 * f ? 4 * f
                                   : j < f    ? (at_end ? f : 0) + j
                                              : 2 * f + (at_end ? f : 0) + j - f;
                closing[static_cast<std::size_t>(row * (4 * f + 1) + column)] =
                    from[static_cast<std::size_t>(i * (2 * f + 1) + j)];
            }
    };
    if (part.has_start) put(chain.at_start, f, false);
    if (part.has_end) put(chain.at_end, f + 1, true);
}

/// Right sides of the part; that of a node between two parts belongs to the one behind, in its coordinates.
Values right_of(const Chain& chain, const Part& part)
{
    Values rows;
    const auto at = [&](int i) { return chain.right[static_cast<std::size_t>(i)]; };
    for (int A = part.first; A <= part.last; ++A)
        for (int i = 0; i < f; ++i) {
            double sum = 0;
            for (int k = 0; A == part.first && k < f; ++k) sum += turned(part.turn, i, k) * at(A * f + k);
            if (A > part.first) sum = A == part.last && !part.has_end ? 0 : at(A * f + i);
            rows.push_back(sum);
        }
    const int behind = (n_elements + 1) * f;
    for (int i = 0; part.has_start && i < f; ++i) rows.push_back(at(behind + i));
    for (int i = 0; part.has_end && i <= f; ++i) rows.push_back(at(behind + f + i));
    return rows;
}

Values solved_alone(const Chain& chain)
{
    Part whole;
    whole.last = n_elements;
    const auto solver = chain_solver();
    const BlockStructure structure = structure_of(whole, false);
    BlockMatrix matrix;
    matrix.resize(structure);
    fill(chain, whole, matrix);
    solver->analyse(structure);
    EXPECT_EQ(solver->factorise(matrix), Outcome::regular);
    Values x = right_of(chain, whole);
    solver->solve(x);
    return x;
}

/// How far unknowns of parts are from those of the whole.
double off(const Chain& chain, int n_ranks, bool are_met)
{
    const Values whole = solved_alone(chain);
    Values distances(static_cast<std::size_t>(n_ranks), 0.0);
    run_as_ranks(n_ranks, [&](Ranks& ranks) {
        const int r = ranks.rank();
        Part part;
        part.first = n_elements * r / n_ranks;
        part.last = n_elements * (r + 1) / n_ranks;
        part.has_start = ranks.is_first();
        part.has_end = ranks.is_last();
        if (r > 0) part.turn = rotation(0.3 * r);
        RankEnds ends(ranks, f, {0}, 1);
        Values transposed(part.turn);   // free motions as rows of Z: Z^T = turn
        for (int i = 0; i < f; ++i)
            for (int j = 0; j < f; ++j)
                transposed[static_cast<std::size_t>(i * f + j)] = turned(part.turn, j, i);
        ends.meet(f, are_met ? transposed : rotation(0), rotation(0));
        const auto solver = solver_of_part(ends);
        const BlockStructure structure = structure_of(part, true);
        BlockMatrix matrix;
        matrix.resize(structure);
        fill(chain, part, matrix);
        solver->analyse(structure);
        const Outcome outcome = solver->factorise(matrix);
        EXPECT_EQ(outcome, Outcome::regular);
        if (outcome != Outcome::regular) return;
        Values x = right_of(chain, part);
        x.resize(std::max(x.size(), static_cast<std::size_t>(size_of(structure))), 0.0);
        solver->solve(x);
        double& distance = distances[static_cast<std::size_t>(r)];
        for (int A = part.first; A <= part.last; ++A)
            for (int i = 0; i < f; ++i) {
                double expected = 0;
                for (int k = 0; k < f; ++k)
                    expected += (A == part.first ? turned(part.turn, i, k) : i == k) *
                                whole[static_cast<std::size_t>(A * f + k)];
                distance = std::max(
                    distance, std::abs(x[static_cast<std::size_t>((A - part.first) * f + i)] - expected));
            }
        distance =
            std::max(distance, std::abs(x[static_cast<std::size_t>(size_of(structure)) - 1] - whole.back()));
    });
    return *std::ranges::max_element(distances);
}

TEST(RankEnds, PartsOfAChainAreSolvedLikeTheWhole)
{
    const Chain chain = random_chain();
    for (const int n : {1, 2, 3, 5, n_elements}) EXPECT_LT(off(chain, n, true), 1e-11) << n;
    EXPECT_GT(off(chain, 3, false), 1e-3) << "coordinates of neighbours differ";
}

/// One rank that has no pivot tells all.
TEST(RankEnds, WhatIsSingularInOneIsSingularInAll)
{
    Chain chain = random_chain();
    std::ranges::fill(chain.at_end, 0.0);
    run_as_ranks(3, [&](Ranks& ranks) {
        Part part;
        part.first = n_elements * ranks.rank() / 3;
        part.last = n_elements * (ranks.rank() + 1) / 3;
        part.has_start = ranks.is_first();
        part.has_end = ranks.is_last();
        RankEnds ends(ranks, f, {0}, 1);
        ends.meet(f, rotation(0), rotation(0));
        const auto solver = solver_of_part(ends);
        BlockMatrix matrix;
        matrix.resize(structure_of(part, true));
        fill(chain, part, matrix);
        solver->analyse(structure_of(part, true));
        EXPECT_EQ(solver->factorise(matrix), Outcome::singular);
    });
    Chain wrong = random_chain();
    wrong.elements[7][0] = std::nan("");
    run_as_ranks(2, [&](Ranks& ranks) {
        Part part;
        part.first = ranks.is_first() ? 0 : 5;
        part.last = ranks.is_first() ? 5 : n_elements;
        part.has_start = ranks.is_first();
        part.has_end = ranks.is_last();
        RankEnds ends(ranks, f, {0}, 1);
        ends.meet(f, rotation(0), rotation(0));
        const auto solver = solver_of_part(ends);
        BlockMatrix matrix;
        matrix.resize(structure_of(part, true));
        fill(wrong, part, matrix);
        solver->analyse(structure_of(part, true));
        EXPECT_NE(solver->factorise(matrix), Outcome::regular);
    });
}

}   // namespace
}   // namespace livens::rank_ends_test
