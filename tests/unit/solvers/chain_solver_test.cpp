// SPDX-License-Identifier: BSD-3-Clause
// What the chain is for: two-ended problems of any growth, length and size, borders and periodic motions.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "block_systems.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/linear_solver.h"

namespace livens::chain_solver_test {
namespace {

/// Largest |A x - b| by |A| |x| + |b|, row by row.
double backward_error(const SparseMatrix& A, const Values& x, const Values& b)
{
    Values residual(b), size(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) size[i] = std::abs(b[i]);
    for (int j = 0; j < A.size; ++j)
        for (int k = A.column_starts[static_cast<std::size_t>(j)];
             k < A.column_starts[static_cast<std::size_t>(j) + 1]; ++k) {
            const auto row = static_cast<std::size_t>(A.rows[static_cast<std::size_t>(k)]);
            const double term = A.values[static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(j)];
            residual[row] -= term;
            size[row] += std::abs(term);
        }
    double worst = 0;
    for (std::size_t i = 0; i < b.size(); ++i)
        worst = std::max(worst, size[i] > 0 ? std::abs(residual[i]) / size[i] : 0.0);
    return worst;
}

struct Errors {
    double forwards = 0, transposed = 0;
};

SparseMatrix transpose(const SparseMatrix& A)
{
    SparseMatrix T;
    T.size = A.size;
    T.column_starts.assign(static_cast<std::size_t>(A.size) + 1, 0);
    for (const int row : A.rows) ++T.column_starts[static_cast<std::size_t>(row) + 1];
    for (std::size_t i = 1; i < T.column_starts.size(); ++i) T.column_starts[i] += T.column_starts[i - 1];
    T.rows.resize(A.rows.size());
    T.values.resize(A.values.size());
    std::vector<int> next(T.column_starts.begin(), T.column_starts.end() - 1);
    for (int j = 0; j < A.size; ++j)
        for (int k = A.column_starts[static_cast<std::size_t>(j)];
             k < A.column_starts[static_cast<std::size_t>(j) + 1]; ++k) {
            const auto at = static_cast<std::size_t>(
                next[static_cast<std::size_t>(A.rows[static_cast<std::size_t>(k)])]++);
            T.rows[at] = j;
            T.values[at] = A.values[static_cast<std::size_t>(k)];
        }
    return T;
}

Errors errors_of(LinearSolver& solver, const BlockStructure& s, BlockMatrix& matrix, std::uint64_t seed)
{
    const SparseMatrix A = to_sparse(s, matrix);
    solver.analyse(s);
    if (solver.factorise(matrix) != Outcome::regular) return {INFINITY, INFINITY};
    const Values b = Random(seed).values(A.size);
    Values x = b, y = b;
    solver.solve(x);
    solver.solve_transposed(y);
    return {backward_error(A, x, b), backward_error(transpose(A), y, b)};
}

/// f unknowns and rows at every node, `inner` nodes inside of elements; conditions as `bordered` has them.
BlockStructure uniform(int n_elements, int inner, int f)
{
    BlockStructure s;
    s.n_unknowns.assign(static_cast<std::size_t>(n_elements * (inner + 1) + 1), f);
    s.n_rows = s.n_unknowns;
    for (int e = 0; e < n_elements; ++e) s.elements.push_back({e * (inner + 1), (e + 1) * (inner + 1)});
    return s;
}

/// Balances of linear motions q'' = B q, f of them, on elements of degree 1 of length h, positions known at
/// both ends (f unknowns less there). B symmetric, with eigenvalues `stiff`.
void fill_motion(double h, const std::vector<double>& stiff, std::uint64_t seed, BlockMatrix& matrix)
{
    const int f = static_cast<int>(stiff.size());
    Random random(seed);
    std::vector<Values> axes;   // an orthonormal basis
    for (int i = 0; i < f; ++i) {
        Values a = random.values(f);
        for (const Values& other : axes) {
            double along = 0;
            for (int k = 0; k < f; ++k) along += a[k] * other[k];
            for (int k = 0; k < f; ++k) a[k] -= along * other[k];
        }
        double norm = 0;
        for (const double v : a) norm += v * v;
        for (double& v : a) v /= std::sqrt(norm);
        axes.push_back(a);
    }
    Values B(static_cast<std::size_t>(f * f), 0.0);
    for (int k = 0; k < f; ++k)
        for (int i = 0; i < f; ++i)
            for (int j = 0; j < f; ++j) B[i * f + j] += stiff[k] * axes[k][i] * axes[k][j];
    matrix.clear();
    for (int e = 0; e < matrix.n_elements(); ++e)
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b) {
                const bool is_known = (e == 0 && b == 0) || (e == matrix.n_elements() - 1 && b == 1);
                const bool is_inactive = (e == 0 && a == 0) || (e == matrix.n_elements() - 1 && a == 1);
                if (is_known || is_inactive) continue;
                double* block = matrix.block(e, e + a, e + b);
                for (int i = 0; i < f; ++i)
                    for (int j = 0; j < f; ++j)
                        block[i * matrix.stride(e) + j] = (i == j ? (a == b ? -1.0 : 1.0) / h : 0.0) -
                                                          h * B[i * f + j] * (a == b ? 0.5 : 0);
            }
}

BlockStructure known_places(int n_elements, int f)
{
    BlockStructure s = uniform(n_elements, 0, f);
    s.n_unknowns.front() = s.n_unknowns.back() = s.n_rows.front() = s.n_rows.back() = 0;
    return s;
}

/// Block elimination from the start on, without exchanges between blocks, of one right-hand side.
Values without_exchanges(const BlockStructure& s, const BlockMatrix& matrix, const Values& b)
{
    const int n = s.n_nodes(), f = s.n_unknowns[1];
    std::vector<Values> diagonal(static_cast<std::size_t>(n)), x(static_cast<std::size_t>(n));
    const auto at = [&](int e, int a, int c, int i, int j) {
        return matrix.block(e, a, c)[i * matrix.stride(e) + j];
    };
    Dense D(f);
    Values right;
    std::vector<Dense> factors;
    std::vector<Values> rights;
    for (int A = 1; A + 1 < n; ++A) {
        Dense here(f);
        for (int i = 0; i < f; ++i)
            for (int j = 0; j < f; ++j) here(i, j) = at(A - 1, A, A, i, j) + at(A, A, A, i, j);
        Values r(b.begin() + (A - 1) * f, b.begin() + A * f);
        if (A > 1)
            for (int j = 0; j < f; ++j) {
                Values column(static_cast<std::size_t>(f));
                for (int i = 0; i < f; ++i) column[i] = at(A - 1, A - 1, A, i, j);
                const Values y = dense_solution(factors.back(), column);
                for (int i = 0; i < f; ++i)
                    for (int k = 0; k < f; ++k) here(i, j) -= at(A - 1, A, A - 1, i, k) * y[k];
            }
        if (A > 1) {
            const Values y = dense_solution(factors.back(), rights.back());
            for (int i = 0; i < f; ++i)
                for (int k = 0; k < f; ++k) r[i] -= at(A - 1, A, A - 1, i, k) * y[k];
        }
        factors.push_back(here);
        rights.push_back(r);
    }
    Values solution(b.size()), next;
    for (int A = n - 2; A >= 1; --A) {
        Values r = rights[static_cast<std::size_t>(A - 1)];
        for (int i = 0; i < f && !next.empty(); ++i)
            for (int j = 0; j < f; ++j) r[i] -= at(A, A, A + 1, i, j) * next[j];
        next = dense_solution(factors[static_cast<std::size_t>(A - 1)], r);
        std::copy(next.begin(), next.end(), solution.begin() + (A - 1) * f);
    }
    return solution;
}

TEST(ChainSolver, KeepsItsDigitsWhateverGrowsOneWayOrTheOther)
{
    for (const int n : {1, 2, 3, 10, 40, 41, 300}) {
        for (const double growth : {1.0, 10.0, 60.0}) {   // of e^growth over the chain, forwards and back
            const BlockStructure s = known_places(n, 4);
            BlockMatrix matrix;
            matrix.resize(s);
            const double h = 1.0 / n, k = growth * growth;
            fill_motion(h, {k, 0.5 * k, -4.0, -50.0}, 3, matrix);
            const auto solver = chain_solver();
            const Errors errors = errors_of(*solver, s, matrix, 5);
            EXPECT_LT(errors.forwards, 1e-14) << n << " elements, e^" << growth;
            EXPECT_LT(errors.transposed, 1e-14) << n << " elements, e^" << growth;
        }
    }
}

TEST(ChainSolver, ExchangesRowsBetweenElements)
{
    // A node that its neighbours hold by nothing of its own: -2/h + h omega^2 = 0, as at half a vibration
    // over two elements; the whole is regular for an even number of nodes.
    const int n = 9;
    const double h = 1.0 / n, omega = std::sqrt(2.0) / h;
    const BlockStructure s = known_places(n, 2);
    BlockMatrix matrix;
    matrix.resize(s);
    fill_motion(h, {-omega * omega * (1 + 1e-12), -omega * omega * (1 + 2e-12)}, 3, matrix);
    const SparseMatrix A = to_sparse(s, matrix);
    const Values b = Random(2).values(A.size);
    const double unpivoted = backward_error(A, without_exchanges(s, matrix, b), b);
    EXPECT_GT(unpivoted, 1e-8) << "control: elimination without exchanges loses the digits";
    const auto solver = chain_solver();
    const Errors errors = errors_of(*solver, s, matrix, 2);
    EXPECT_LT(errors.forwards, 1e-14);
    EXPECT_LT(errors.transposed, 1e-14);
}

/// The dense matrix has as good a solution, and the same one.
TEST(ChainSolver, IsAsGoodAsADenseMatrix)
{
    int n_compared = 0;
    for (const int f : {1, 2, 3, 6, 12, 36})
        for (const int n : {1, 2, 5, 6})
            for (const int border : {0, 5, 24}) {
                const BlockStructure s = bordered(uniform(n, f > 3 ? 0 : 3, f), border, 2 * f);
                if (size_of(s) > 240) continue;   // a dense one would take minutes
                BlockMatrix matrix;
                matrix.resize(s);
                fill(s, 11, matrix);
                const SparseMatrix A = to_sparse(s, matrix);
                const Values b = Random(12).values(A.size);
                const auto chain = chain_solver();
                chain->analyse(s);
                ASSERT_EQ(chain->factorise(matrix), Outcome::regular);
                Values x = b;
                chain->solve(x);
                Dense all(A.size);
                for (int j = 0; j < A.size; ++j)
                    for (int k = A.column_starts[j]; k < A.column_starts[j + 1]; ++k)
                        all(A.rows[k], j) = A.values[k];
                const Values y = dense_solution(all, b);
                EXPECT_LT(backward_error(A, x, b), 1e-14) << f << ' ' << n << ' ' << border;
                double off = 0, size = 0;
                for (std::size_t i = 0; i < x.size(); ++i) {
                    off = std::max(off, std::abs(x[i] - y[i]));
                    size = std::max(size, std::abs(x[i]));
                }
                EXPECT_LT(off, 1e-9 * size) << f << ' ' << n << ' ' << border;
                ++n_compared;
            }
    EXPECT_GE(n_compared, 40);
}

TEST(ChainSolver, AgreesWithTheWholeMatrixForAllSizesAndBorders)
{
    for (const int f : {1, 2, 3, 6, 12, 36})
        for (const int inner : {0, 1, 3, 7})
            for (const int border : {0, 1, 5, 24})
                for (const int n_open : {0, f, 2 * f}) {
                    if (f * (inner + 1) > 100) continue;   // the dense parts alone would take minutes
                    const BlockStructure s = bordered(uniform(5, inner, f), border, n_open);
                    BlockMatrix matrix;
                    matrix.resize(s);
                    fill(s, 7, matrix);
                    const auto solver = chain_solver();
                    const Errors errors = errors_of(*solver, s, matrix, 8);
                    EXPECT_LT(errors.forwards, 1e-14) << f << ' ' << inner << ' ' << border << ' ' << n_open;
                    EXPECT_LT(errors.transposed, 1e-14)
                        << f << ' ' << inner << ' ' << border << ' ' << n_open;
                }
}

/// Every sparse library of the build has as good a solution of the same matrix, and the same one.
TEST(ChainSolver, IsAsGoodAsSparseFactors)
{
    int n_backends = 0;
    for (const SparseBackend backend : {SparseBackend::eigen, SparseBackend::umfpack}) {
        if (!has_backend(backend)) continue;
        ++n_backends;
        for (const int f : {1, 3, 12})
            for (const int border : {0, 5}) {
                const BlockStructure s = bordered(uniform(20, 3, f), border, 2 * f);
                BlockMatrix matrix;
                matrix.resize(s);
                fill(s, 9, matrix);
                BlockMatrix same = matrix;
                const SparseMatrix A = to_sparse(s, matrix);
                const auto chain = chain_solver(), whole = whole_solver(backend);
                const Values b = Random(3).values(A.size);
                Values x = b, y = b;
                chain->analyse(s);
                whole->analyse(s);
                ASSERT_EQ(chain->factorise(matrix), Outcome::regular);
                ASSERT_EQ(whole->factorise(same), Outcome::regular);
                chain->solve(x);
                whole->solve(y);
                const auto* name = words_of(backend)[static_cast<std::size_t>(backend)].data();
                EXPECT_LT(backward_error(A, x, b), 1e-14) << name << ' ' << f << ' ' << border;
                EXPECT_LT(backward_error(A, y, b), 1e-14) << name << ' ' << f << ' ' << border;
                double off = 0, size = 0;
                for (std::size_t i = 0; i < x.size(); ++i) {
                    off = std::max(off, std::abs(x[i] - y[i]));
                    size = std::max(size, std::abs(x[i]));
                }
                EXPECT_LT(off, 1e-9 * size) << name << ' ' << f << ' ' << border;
            }
    }
    EXPECT_GE(n_backends, 1);
}

/// Factors, solutions and transposed ones, with conditions that see both ends and with borders.
TEST(ChainSolver, HasTheSameBitsForAnyNumberOfThreads)
{
    for (const auto& [n_border, n_open] : {std::pair{0, 0}, {0, 4}, {3, 4}}) {
        const BlockStructure s = bordered(uniform(41, 3, 4), n_border, n_open);
        std::vector<Values> found;
        for (const int threads : {1, 2, 3, 7}) {
            const Crew crew(threads);
            BlockMatrix matrix;
            matrix.resize(s);
            fill(s, 11, matrix);
            const auto solver = chain_solver();
            solver->analyse(s);
            ASSERT_EQ(solver->factorise(matrix), Outcome::regular);
            Values x = Random(5).values(size_of(s)), y = x;
            solver->solve(x);
            solver->solve_transposed(y);
            const LinearReport report = solver->report();
            x.insert(x.end(), y.begin(), y.end());
            x.push_back(report.smallest_pivot);
            x.push_back(report.largest_entry);
            found.push_back(x);
        }
        for (const Values& of : found) EXPECT_EQ(of, found.front()) << n_border << ", " << n_open;
    }
}

/// Of conditions alone the ends are had without what is between them.
TEST(ChainSolver, ConditionsAloneGiveTheEnds)
{
    const int f = 3;
    for (const int n : {1, 2, 7})
        for (const auto& [border, n_open] : {std::pair{0, f}, {0, 2 * f}, {3, f}, {3, 2 * f}, {2 * f, 0}}) {
            const BlockStructure s = bordered(uniform(n, 2, f), border, n_open);
            BlockMatrix matrix;
            matrix.resize(s);
            fill(s, 5, matrix);
            BlockMatrix same = matrix;
            const auto chain = chain_solver(), whole = whole_solver(SparseBackend::eigen);
            chain->analyse(s);
            whole->analyse(s);
            ASSERT_EQ(chain->factorise(matrix), Outcome::regular);
            ASSERT_EQ(whole->factorise(same), Outcome::regular);
            const Values rows = Random(6).values(s.n_closing);
            Values x(static_cast<std::size_t>(size_of(s)), 0.0);
            std::copy(rows.begin(), rows.end(), x.end() - s.n_closing);
            chain->solve(x);
            for (const LinearSolver* solver : {chain.get(), whole.get()}) {
                Values ends(static_cast<std::size_t>(2 * f + s.n_border));
                solver->solve_closing(rows, ends);
                for (int i = 0; i < f; ++i) EXPECT_NEAR(ends[i], x[i], 1e-10) << n << ' ' << border;
                for (int i = 0; i < f + s.n_border; ++i)
                    EXPECT_NEAR(ends[f + i], x[x.size() - static_cast<std::size_t>(f + s.n_border - i)],
                                1e-10)
                        << n << ' ' << border;
            }
        }
}

TEST(ChainSolver, HoldsPeriodicMotionsThatGrow)
{
    // x at the next node = M x with both growing and decaying parts, and x the same at both ends: nothing is
    // known at either end [Wright1993].
    for (const int n : {2, 7, 60, 400}) {
        const double growth = std::exp(60.0 / n);
        BlockStructure s = uniform(n, 0, 2);
        s.n_rows.front() = 0;
        s.n_closing = 2;
        BlockMatrix matrix;
        matrix.resize(s);
        for (int e = 0; e < n; ++e) {
            double *from = matrix.block(e, e + 1, e), *to = matrix.block(e, e + 1, e + 1);
            const double c = std::cos(0.3), d = std::sin(0.3), a = growth, b = 1 / growth;
            const int stride = matrix.stride(e);
            from[0] = -(a * c * c + b * d * d);
            from[1] = from[stride] = -(a - b) * c * d;
            from[stride + 1] = -(a * d * d + b * c * c);
            to[0] = to[stride + 1] = 1;
        }
        matrix.closing() = {1, 0, -1, 0, 0, 1, 0, -1};
        const auto solver = chain_solver();
        const Errors errors = errors_of(*solver, s, matrix, 4);
        EXPECT_LT(errors.forwards, 1e-14) << n;
        EXPECT_LT(errors.transposed, 1e-14) << n;
    }
}

TEST(ChainSolver, TurnsToReflectionsWhereExchangesLetEntriesGrow)
{
    // x' = M x with M = [-1/6 1; 1 -1/6], at whose tenth of an exponential every exchange is idle, and
    // entries double: after Wright, S. J., "A collection of problems for which Gaussian elimination with
    // partial pivoting is unstable", SIAM J. Sci. Comput. 14 (1993) 231-238.
    const int n = 200;
    const double h = 0.3, a = std::exp(-h / 6) * std::cosh(h), b = std::exp(-h / 6) * std::sinh(h);
    BlockStructure s = uniform(n, 0, 2);
    s.n_rows.front() = 0;
    s.n_closing = 2;
    BlockMatrix matrix;
    matrix.resize(s);
    for (int e = 0; e < n; ++e) {
        double *from = matrix.block(e, e + 1, e), *to = matrix.block(e, e + 1, e + 1);
        const int stride = matrix.stride(e);
        from[0] = from[stride + 1] = -a;
        from[1] = from[stride] = -b;
        to[0] = to[stride + 1] = 1;
    }
    matrix.closing() = {1, 0, 1, 0, 0, 1, 0, 1};
    const auto solver = chain_solver();
    const Errors errors = errors_of(*solver, s, matrix, 4);
    EXPECT_LT(errors.forwards, 1e-14);
    EXPECT_LT(errors.transposed, 1e-14);
}

TEST(ChainSolver, GoesOnForAHundredThousandElements)
{
    for (const int n : {1000, 100000}) {
        const BlockStructure s = known_places(n, 2);
        BlockMatrix matrix;
        matrix.resize(s);
        fill_motion(50.0 / n, {-4.0, 1.0}, 3, matrix);
        const auto solver = chain_solver();
        const Errors errors = errors_of(*solver, s, matrix, 5);
        EXPECT_LT(errors.forwards, 1e-14) << n;
        EXPECT_LT(errors.transposed, 1e-14) << n;
    }
}

TEST(ChainSolver, NamesTheNodeThatIsNotDetermined)
{
    const BlockStructure s = uniform(4, 1, 2);
    BlockMatrix matrix;
    matrix.resize(s);
    fill(s, 3, matrix);
    for (const int e : {1}) {   // nothing holds the node in the middle of element 1
        for (int a = 2; a <= 4; ++a)
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j) matrix.block(e, a, 3)[i * matrix.stride(e) + j] = 0;
    }
    const auto solver = chain_solver();
    solver->analyse(s);
    EXPECT_EQ(solver->factorise(matrix), Outcome::singular);
    EXPECT_EQ(solver->report().singular_node, 3);
}

TEST(ChainSolver, RefusesElementsThatShareMoreThanOneNode)
{
    EXPECT_THROW(chain_solver()->analyse(spline_structure(6, 2, 3)), std::invalid_argument);
    EXPECT_THROW(forward_solver()->analyse(bordered(uniform(2, 0, 2), 1, 0)), std::invalid_argument);
}

}   // namespace
}   // namespace livens::chain_solver_test
