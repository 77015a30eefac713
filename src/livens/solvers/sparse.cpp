// SPDX-License-Identifier: BSD-3-Clause
// Sparse matrices in compressed columns, and the sparse LU behind one face: what all backends promise is
// checked and kept here, so that a library is asked for its factorisation alone (theory.md, "The elements of
// the paper", Scaling).
#include "livens/solvers/sparse.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>

#include "livens/base/error.h"
#include "livens/solvers/detail/sparse_backend.h"

namespace livens {

namespace {

bool all_finite(const std::vector<double>& values)
{
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Compressed columns as SparseMatrix promises them; for assertions.
[[maybe_unused]] bool well_formed(const SparseMatrix& A)
{
    if (A.size < 0 || static_cast<int>(A.column_starts.size()) != A.size + 1) return false;
    if (A.column_starts.front() != 0 || A.column_starts.back() != A.n_entries()) return false;
    if (A.values.size() != A.rows.size()) return false;
    for (int j = 0; j < A.size; ++j) {
        const int begin = A.column_starts[j], end = A.column_starts[j + 1];
        if (begin > end || end > A.n_entries()) return false;
        for (int k = begin; k < end; ++k) {
            if (A.rows[k] < 0 || A.rows[k] >= A.size) return false;
            if (k > begin && A.rows[k] <= A.rows[k - 1]) return false;
        }
    }
    return true;
}

bool overlap(std::span<const double> b, std::span<const double> x)
{
    // Pointers into different arrays have an order by std::less alone.
    const std::less<const double*> before;
    return before(b.data(), x.data() + x.size()) && before(x.data(), b.data() + b.size());
}

std::unique_ptr<SparseLU::Implementation> make_backend(SparseBackend backend)
{
    auto made = backend == SparseBackend::umfpack ? make_umfpack_backend() : make_eigen_backend();
    if (!made)
        throw InputError({.code = "backend-missing",
                          .path = "method.linear_solver",
                          .message = "this build has no UMFPACK",
                          .value = "umfpack",
                          .bound = "eigen",
                          .note = "UMFPACK is under the GPL and therefore optional",
                          .help = "use eigen, or build with -DLIVENS_UMFPACK=ON"});
    return made;
}

}   // namespace

SparseMatrix sparse_from_columns(const std::vector<std::vector<std::pair<int, double>>>& columns)
{
    SparseMatrix A;
    A.size = static_cast<int>(columns.size());
    A.column_starts.push_back(0);
    for (const auto& column : columns) {
        for (const auto& [row, value] : column) {
            A.rows.push_back(row);
            A.values.push_back(value);
        }
        A.column_starts.push_back(static_cast<int>(A.rows.size()));
    }
    return A;
}

void SparseMatrix::multiply(std::span<const double> x, std::span<double> y) const
{
    assert(static_cast<int>(x.size()) == size && static_cast<int>(y.size()) == size && !overlap(x, y));
    std::fill(y.begin(), y.end(), 0.0);
    for (int j = 0; j < size; ++j)
        for (int k = column_starts[j]; k < column_starts[j + 1]; ++k) y[rows[k]] += values[k] * x[j];
}

void SparseMatrix::multiply_transposed(std::span<const double> x, std::span<double> y) const
{
    assert(static_cast<int>(x.size()) == size && static_cast<int>(y.size()) == size && !overlap(x, y));
    for (int j = 0; j < size; ++j) {
        double sum = 0;
        for (int k = column_starts[j]; k < column_starts[j + 1]; ++k) sum += values[k] * x[rows[k]];
        y[j] = sum;
    }
}

bool has_backend(SparseBackend backend)
{
    return backend == SparseBackend::eigen || make_umfpack_backend() != nullptr;
}

SparseLU::SparseLU(SparseBackend backend) : implementation_(make_backend(backend)) {}
SparseLU::~SparseLU() = default;
SparseLU::SparseLU(SparseLU&&) noexcept = default;
SparseLU& SparseLU::operator=(SparseLU&&) noexcept = default;

void SparseLU::analyse(const SparseMatrix& A)
{
    assert(well_formed(A));
    Implementation& lu = *implementation_;
    lu.analysed = lu.factorised = false;   // stays so if memory runs out
    lu.size = A.size;
    lu.n_entries = A.n_entries();
    if (A.size > 0 && A.n_entries() >= A.size) lu.analyse(A);
    lu.analysed = true;
}

bool SparseLU::factorise(const SparseMatrix& A)
{
    Implementation& lu = *implementation_;
    assert(lu.analysed && A.size == lu.size && A.n_entries() == lu.n_entries && well_formed(A));
    lu.factorised = false;   // stays so if memory runs out
    // Fewer entries than rows leave a row empty. The backends see finite matrices alone.
    if (A.n_entries() < A.size || !all_finite(A.values)) return false;
    lu.factorised = A.size == 0 || lu.factorise(A);
    return lu.factorised;
}

void SparseLU::solve(std::span<const double> b, std::span<double> x) const
{
    const Implementation& lu = *implementation_;
    assert(lu.factorised && static_cast<int>(b.size()) == lu.size && static_cast<int>(x.size()) == lu.size);
    if (lu.size == 0) return;
    if (overlap(b, x)) return lu.solve(std::vector<double>(b.begin(), b.end()), x);
    lu.solve(b, x);
}

void SparseLU::solve_transposed(std::span<const double> b, std::span<double> x) const
{
    const Implementation& lu = *implementation_;
    assert(lu.factorised && static_cast<int>(b.size()) == lu.size && static_cast<int>(x.size()) == lu.size);
    if (lu.size == 0) return;
    if (overlap(b, x)) return lu.solve_transposed(std::vector<double>(b.begin(), b.end()), x);
    lu.solve_transposed(b, x);
}

long long SparseLU::factor_entries() const
{
    return implementation_->factorised && implementation_->size > 0 ? implementation_->factor_entries() : 0;
}

std::string SparseLU::description() const { return implementation_->description(); }

void solve_refined(const SparseLU& lu, const SparseMatrix& A, std::span<const double> b, std::span<double> x,
                   int steps)
{
    const std::vector<double> right_side(b.begin(), b.end());   // b and x may be the same
    std::vector<double> residual(right_side.size()), correction(right_side.size());
    // Iterative refinement in working precision: it repairs what pivots of an almost singular block have
    // cost.
    lu.solve(right_side, x);
    for (int step = 0; step < steps; ++step) {
        A.multiply(x, residual);
        for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = right_side[i] - residual[i];
        lu.solve(residual, correction);
        for (std::size_t i = 0; i < residual.size(); ++i) x[i] += correction[i];
    }
}

}   // namespace livens
