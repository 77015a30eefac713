// SPDX-License-Identifier: BSD-3-Clause
// What every solver of block systems must do, and what each says of itself.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "allocations.h"
#include "block_systems.h"
#include "livens/solvers/linear_solver.h"

namespace livens::linear_solver_test {
namespace {

struct Case {
    std::string solver;
    std::function<std::unique_ptr<LinearSolver>()> make;
    std::vector<BlockStructure> structures;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.solver; }

std::vector<BlockStructure> forward_structures()
{
    std::vector<BlockStructure> found = {{},
                                         {{0, 4}, {4, 0}, {{0, 1}}},
                                         {{0, 2, 3}, {4, 1, 0}, {{0, 2}}},
                                         {{0, 2, 2, 2}, {2, 2, 2, 0}, {{0, 1}, {1, 2}, {2, 3}}},
                                         {{0, 0, 0}, {0, 0, 0}, {{0, 1}, {1, 2}}},
                                         {{0, 3, 0, 0, 2}, {0, 3, 0, 2, 0}, {{0, 2}, {2, 4}}}};
    for (int n = 1; n <= 12; ++n) found.push_back(random_forward_structure(n, static_cast<std::uint64_t>(n)));
    const std::vector<BlockStructure> from_start = found;
    for (const BlockStructure& s : from_start) found.push_back(mirrored(s));
    return found;
}

std::vector<BlockStructure> chains()
{
    std::vector<BlockStructure> found = forward_structures();
    for (int n = 1; n <= 12; ++n) found.push_back(random_structure(n, static_cast<std::uint64_t>(n)));
    for (int n = 1; n <= 24; ++n)
        found.push_back(bordered(random_structure(1 + n / 2, static_cast<std::uint64_t>(n)), n % 4, n % 2));
    return found;
}

std::vector<BlockStructure> all_structures()
{
    std::vector<BlockStructure> found = chains();
    for (int degree = 1; degree <= 3; ++degree) found.push_back(spline_structure(6, degree, 3));
    return found;
}

std::vector<Case> cases()
{
    std::vector<Case> found = {{"Forward", forward_solver, forward_structures()},
                               {"Chain", chain_solver, chains()}};
    for (const SparseBackend backend : backends_of_this_build())
        found.push_back({std::string("Whole") + name_of(backend), [=] { return whole_solver(backend); },
                         all_structures()});
    return found;
}

/// Largest relative error of solve() and solve_transposed() against a dense solution.
double error_of(const LinearSolver& solver, const Dense& A, std::uint64_t seed)
{
    const Values b = Random(seed).values(A.size);
    Values x = b, y = b;
    solver.solve(x);
    solver.solve_transposed(y);
    const Values x_dense = dense_solution(A, b), y_dense = dense_solution(transposed(A), b);
    if (A.size == 0) return 0;
    return std::max(largest_difference(x, x_dense) / largest(x_dense),
                    largest_difference(y, y_dense) / largest(y_dense));
}

class LinearSolvers : public ::testing::TestWithParam<Case> {};

TEST_P(LinearSolvers, EqualADenseSolution)
{
    for (const BlockStructure& s : GetParam().structures) {
        const auto solver = GetParam().make();
        solver->analyse(s);
        BlockMatrix matrix;
        matrix.resize(s);
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            matrix.clear();
            fill(s, seed, matrix);
            const Dense A = dense(s, matrix);
            ASSERT_EQ(solver->factorise(matrix), Outcome::regular) << A.size;
            EXPECT_LT(error_of(*solver, A, seed), 1e-12) << s.n_elements() << " elements, size " << A.size;
        }
    }
}

TEST_P(LinearSolvers, GoFromStructureToStructure)
{
    const auto solver = GetParam().make();
    BlockMatrix matrix;
    for (int round = 0; round < 2; ++round)
        for (const BlockStructure& s : GetParam().structures) {
            solver->analyse(s);
            matrix.resize(s);
            fill(s, 4, matrix);
            const Dense A = dense(s, matrix);
            ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
            EXPECT_LT(error_of(*solver, A, 4), 1e-12);
        }
}

TEST_P(LinearSolvers, AddUpWhatElementsPutAtANodeTheyShare)
{
    const BlockStructure s{{0, 2, 2, 2}, {2, 2, 2, 0}, {{0, 1}, {1, 2}, {2, 3}}};
    const auto solver = GetParam().make();
    solver->analyse(s);
    const Values b = Random(3).values(6);
    Values x[3];
    for (int variant = 0; variant < 3; ++variant) {
        BlockMatrix matrix;
        matrix.resize(s);
        fill(s, 9, matrix);
        double* of_first = matrix.block(0, 1, 1);
        double* of_second = matrix.block(1, 1, 1);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) {   // the sum stays, but for the last variant
                const int k = i * matrix.stride(0) + j, l = i * matrix.stride(1) + j;
                if (variant == 1) of_second[l] += of_first[k];
                if (variant > 0) of_first[k] = 0;
            }
        ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
        x[variant] = b;
        solver->solve(x[variant]);
    }
    EXPECT_LT(largest_difference(x[0], x[1]), 1e-14);
    EXPECT_GT(largest_difference(x[0], x[2]), 1e-3) << "control: a part that is lost shows";
}

TEST_P(LinearSolvers, ReportSingularAndUndefinedMatricesAndGoOn)
{
    const BlockStructure s = random_forward_structure(5, 7);
    const auto solver = GetParam().make();
    solver->analyse(s);
    BlockMatrix matrix;
    const auto outcome = [&](auto change) {
        matrix.resize(s);
        fill(s, 2, matrix);
        change();
        return solver->factorise(matrix);
    };
    EXPECT_EQ(outcome([] {}), Outcome::regular);
    EXPECT_GT(solver->report().factor_entries, 0);
    for (const double bad : {NAN, INFINITY, -INFINITY})
        for (int e = 0; e < s.n_elements(); ++e)
            if (!matrix.storage(e).empty()) {
                EXPECT_EQ(outcome([&] { matrix.storage(e).back() = bad; }), Outcome::not_finite);
            }
    EXPECT_EQ(outcome([&] { matrix.clear(); }), Outcome::singular);
    EXPECT_EQ(outcome([] {}), Outcome::regular);
    EXPECT_EQ(solver->report().singular_node, -1);
}

TEST_P(LinearSolvers, RefuseStructuresThatAreNone)
{
    const auto solver = GetParam().make();
    EXPECT_THROW(solver->analyse({{0, 1}, {2, 0}, {{0, 1}}}), std::invalid_argument);
    EXPECT_THROW(solver->analyse({{0, 1}, {1, 0}, {}}), std::invalid_argument);
    solver->analyse({{0, 1}, {1, 0}, {{0, 1}}});
}

INSTANTIATE_TEST_SUITE_P(All, LinearSolvers, ::testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.solver; });

TEST(ForwardSolver, SolvesTheMirroredProblemAlike)
{
    const BlockStructure s = random_forward_structure(6, 11), m = mirrored(s);
    BlockMatrix matrix, reflected;
    matrix.resize(s);
    reflected.resize(m);
    fill(s, 5, matrix);
    for (int e = 0; e < s.n_elements(); ++e) {
        const auto [first, last] = s.elements[static_cast<std::size_t>(e)];
        const int n = s.n_nodes() - 1, at = s.n_elements() - 1 - e;
        for (int a = first; a <= last; ++a)
            for (int b = first; b <= last; ++b)
                for (int i = 0; i < s.n_rows[static_cast<std::size_t>(a)]; ++i)
                    std::copy_n(matrix.block(e, a, b) + i * matrix.stride(e),
                                s.n_unknowns[static_cast<std::size_t>(b)],
                                reflected.block(at, n - a, n - b) + i * reflected.stride(at));
    }
    std::vector<int> row, unknown, row_m, unknown_m;
    running_sums(s.n_rows, row);
    running_sums(s.n_unknowns, unknown);
    running_sums(m.n_rows, row_m);
    running_sums(m.n_unknowns, unknown_m);
    Values x = Random(1).values(row.back()), y(x.size());
    const auto reflect = [](const std::vector<int>& from, const std::vector<int>& to, const Values& u,
                            Values& v) {
        for (std::size_t a = 0; a + 1 < from.size(); ++a)
            std::copy(u.begin() + from[a], u.begin() + from[a + 1], v.begin() + to[from.size() - 2 - a]);
    };
    reflect(row, row_m, x, y);
    const auto solver = forward_solver(), other = forward_solver();
    solver->analyse(s);
    other->analyse(m);
    ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
    ASSERT_EQ(other->factorise(reflected), Outcome::regular);
    solver->solve(x);
    other->solve(y);
    Values z(x.size());
    reflect(unknown_m, unknown, y, z);
    EXPECT_LT(largest_difference(x, z), 1e-13 * largest(x));
}

TEST(ForwardSolver, NamesTheNodeThatIsNotDetermined)
{
    const BlockStructure from_start{{0, 2, 3, 1, 2}, {2, 3, 1, 2, 0}, {{0, 2}, {2, 3}, {3, 4}}};
    for (const BlockStructure& s : {from_start, mirrored(from_start)})
        for (int node = 0; node < s.n_nodes(); ++node) {
            if (s.n_unknowns[static_cast<std::size_t>(node)] == 0) continue;
            BlockMatrix matrix;
            matrix.resize(s);
            fill(s, 8, matrix);
            for (int e = 0; e < s.n_elements(); ++e) {
                const auto [first, last] = s.elements[static_cast<std::size_t>(e)];
                if (node < first || node > last) continue;
                double* column = matrix.block(e, first, node);
                for (int i = 0; i < matrix.n_rows(e); ++i) column[i * matrix.stride(e)] = 0;
            }
            const auto solver = forward_solver();
            solver->analyse(s);
            EXPECT_EQ(solver->factorise(matrix), Outcome::singular);
            EXPECT_EQ(solver->report().singular_node, node);
            EXPECT_EQ(solver->report().smallest_pivot, 0);
        }
}

TEST(ForwardSolver, MeasuresItsFactors)
{
    const BlockStructure s{{0, 2}, {2, 0}, {{0, 1}}};
    BlockMatrix matrix;
    matrix.resize(s);
    matrix.storage(0) = {-1, 1, 1, 1};   // U = [-1 1; 0 2]
    const auto solver = forward_solver();
    solver->analyse(s);
    ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
    EXPECT_EQ(solver->report().smallest_pivot, 1);
    EXPECT_EQ(solver->report().largest_entry, 2);
    EXPECT_EQ(solver->report().factor_entries, 4);
}

TEST(ForwardSolver, FactorisesASingleElementInItsOwnStorage)
{
    const BlockStructure s{{0, 2, 3}, {4, 1, 0}, {{0, 2}}};
    BlockMatrix matrix;
    matrix.resize(s);
    fill(s, 1, matrix);
    const double* storage = matrix.storage(0).data();
    const auto solver = forward_solver();
    solver->analyse(s);
    ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
    EXPECT_NE(matrix.storage(0).data(), storage) << "exchanged, not copied";
    EXPECT_EQ(matrix.storage(0).size(), 25u);
    fill(s, 1, matrix);
    ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
    EXPECT_EQ(matrix.storage(0).data(), storage);
}

TEST(ForwardSolver, AllocatesNothingAfterTheAnalysis)
{
    for (const BlockStructure& s : {random_forward_structure(1, 3), random_forward_structure(8, 3)}) {
        BlockMatrix matrix;
        matrix.resize(s);
        const auto solver = forward_solver();
        solver->analyse(s);
        Values x(static_cast<std::size_t>(sum_of(s.n_rows)), 1.0);
        for (int round = 0; round < 3; ++round) {
            matrix.clear();
            fill(s, 6, matrix);
            const long long before = n_allocations();
            ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
            solver->solve(x);
            solver->solve_transposed(x);
            solver->analyse(s);
            matrix.resize(s);
            EXPECT_EQ(n_allocations(), before);
        }
    }
}

TEST(ForwardSolver, RefusesWhatIsNotKnownAtOneEndAndSaysWhy)
{
    const auto solver = forward_solver();
    const auto refusal = [&](const BlockStructure& s) -> std::string {
        try {
            solver->analyse(s);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal({{1, 1}, {1, 1}, {{0, 1}}}),
              "not known at one end: the first node has 1 unknowns and 1 rows, the last 1 and 1");
    EXPECT_EQ(refusal({{0, 2, 1}, {1, 2, 0}, {{0, 1}, {1, 2}}}),
              "not known at one end: element 0 has 1 rows for 2 unknowns");
    EXPECT_EQ(refusal({{0, 1, 1}, {1, 1, 0}, {{0, 1}, {1, 2}}}), "");
    EXPECT_EQ(refusal({{0, 1, 1, 1}, {1, 1, 1, 0}, {{0, 2}, {1, 3}}}),
              "not known at one end: elements 0 and 1 share more than one node");
}

TEST(WholeSolver, TakesUpEntriesThatWereZeroBefore)
{
    for (const SparseBackend backend : backends_of_this_build()) {
        const BlockStructure s = random_structure(4, 6);
        const auto solver = whole_solver(backend);
        solver->analyse(s);
        BlockMatrix matrix;
        matrix.resize(s);
        std::vector<long long> entries;
        for (const double kept : {0.3, 1.0, 0.3}) {
            fill(s, 6, matrix);
            for (int e = 0; e < s.n_elements(); ++e)
                for (double& v : matrix.storage(e))
                    if (std::abs(v) < 2 && std::abs(v) > 0.5 * kept) v = 0;
            const Dense A = dense(s, matrix);
            ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
            EXPECT_LT(error_of(*solver, A, 2), 1e-12);
            entries.push_back(solver->report().factor_entries);
        }
        EXPECT_GT(entries[1], entries[0]) << "zeros were left out at first";
    }
}

}   // namespace
}   // namespace livens::linear_solver_test
