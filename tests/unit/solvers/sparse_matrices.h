// SPDX-License-Identifier: BSD-3-Clause
// Matrices for the tests of the sparse solvers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "livens/solvers/dense.h"
#include "livens/solvers/sparse.h"

namespace livens {

using Values = std::vector<double>;

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// Uniform in [-1, 1).
    double next() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }
    Values values(int n)
    {
        Values v(static_cast<std::size_t>(n));
        for (double& x : v) x = next();
        return v;
    }

private:
    std::mt19937_64 engine_;
};

/// A square matrix row by row, zeros included.
struct Dense {
    explicit Dense(int n) : size(n), a(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0) {}
    double& operator()(int i, int j) { return a[static_cast<std::size_t>(i * size + j)]; }
    double operator()(int i, int j) const { return a[static_cast<std::size_t>(i * size + j)]; }

    int size;
    Values a;
};

inline SparseMatrix sparse(const Dense& A)
{
    SparseMatrix S;
    S.size = A.size;
    S.column_starts.push_back(0);
    for (int j = 0; j < A.size; ++j) {
        for (int i = 0; i < A.size; ++i)
            if (A(i, j) != 0) {
                S.rows.push_back(i);
                S.values.push_back(A(i, j));
            }
        S.column_starts.push_back(S.n_entries());
    }
    return S;
}

inline Dense transposed(const Dense& A)
{
    Dense T(A.size);
    for (int i = 0; i < A.size; ++i)
        for (int j = 0; j < A.size; ++j) T(j, i) = A(i, j);
    return T;
}

inline Values dense_solution(const Dense& A, Values b)
{
    DenseLU lu;
    lu.resize(A.size);
    for (int i = 0; i < A.size; ++i)
        for (int j = 0; j < A.size; ++j) lu.row(i)[j] = A(i, j);
    if (!lu.factorise()) return {};
    lu.solve(b.data());
    return b;
}

inline double largest(std::span<const double> x)
{
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    return size;
}

inline double largest_difference(std::span<const double> x, std::span<const double> y)
{
    double size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) size = std::max(size, std::abs(x[i] - y[i]));
    return size;
}

/// |A x - b| over |x| and the largest row sums: a few roundings for a backward stable solution.
inline double relative_residual(const SparseMatrix& A, std::span<const double> x, std::span<const double> b)
{
    Values product(b.size()), sums(b.size(), 0.0);
    A.multiply(x, product);
    for (std::size_t k = 0; k < A.rows.size(); ++k)
        sums[static_cast<std::size_t>(A.rows[k])] += std::abs(A.values[k]);
    return largest_difference(product, b) / (largest(sums) * largest(x));
}

/// Random entries in about `density` of the places, on the diagonal too; the diagonal's part is 1 where
/// `safe`.
inline Dense random_matrix(int n, double density, std::uint64_t seed, bool safe = true)
{
    Random random(seed);
    Dense A(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const bool taken = std::abs(random.next()) < density;
            const double value = random.next();
            if (taken) A(i, j) = value;
            if (safe && i == j) A(i, j) += 1;
        }
    return A;
}

/// Block tridiagonal, as the linear elements of the paper: blocks of O(h) on the diagonal, +-1/2 beside it,
/// and at the last node 1/2 on the diagonal, which alone keeps the chain regular. Pivots on the diagonal are
/// fatal.
inline SparseMatrix leapfrog_chain(int n_blocks, int block, double h, std::uint64_t seed)
{
    Random random(seed);
    SparseMatrix A;
    A.size = n_blocks * block;
    A.column_starts.push_back(0);
    const auto put = [&](int i, double value) {
        A.rows.push_back(i);
        A.values.push_back(value);
    };
    for (int b = 0; b < n_blocks; ++b)
        for (int j = 0; j < block; ++j) {
            if (b > 0) put((b - 1) * block + j, 0.5);
            for (int i = 0; i < block; ++i) {
                const double last = b + 1 == n_blocks && i == j ? 0.5 : 0.0;
                put(b * block + i, h * random.next() + last);
            }
            if (b + 1 < n_blocks) put((b + 1) * block + j, -0.5);
            A.column_starts.push_back(A.n_entries());
        }
    return A;
}

/// Second differences (-1, 2, -1): eigenvalues 4 sin^2(k pi / (2 n + 2)), inverse known in closed form.
inline SparseMatrix second_differences(int n)
{
    SparseMatrix A;
    A.size = n;
    A.column_starts.push_back(0);
    for (int j = 0; j < n; ++j) {
        for (int i = std::max(0, j - 1); i <= std::min(n - 1, j + 1); ++i) {
            A.rows.push_back(i);
            A.values.push_back(i == j ? 2.0 : -1.0);
        }
        A.column_starts.push_back(A.n_entries());
    }
    return A;
}

inline std::vector<SparseBackend> backends_of_this_build()
{
    std::vector<SparseBackend> found;
    for (SparseBackend backend : {SparseBackend::eigen, SparseBackend::umfpack})
        if (has_backend(backend)) found.push_back(backend);
    return found;
}

inline const char* name_of(SparseBackend backend)
{
    return backend == SparseBackend::eigen ? "Eigen" : "Umfpack";
}

inline void PrintTo(SparseBackend backend, std::ostream* out) { *out << name_of(backend); }

}   // namespace livens
