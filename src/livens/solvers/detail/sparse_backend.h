// SPDX-License-Identifier: BSD-3-Clause
// What a sparse library has to do to stand behind SparseLU.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "livens/solvers/sparse.h"

namespace livens {

/// SparseLU keeps the books, so that a backend is asked for what its library does and no more: it sees finite
/// matrices of the analysed pattern, with unknowns and at least as many entries, and solves only after a
/// factorisation that went well.
struct SparseLU::Implementation {
    Implementation() = default;
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;
    virtual ~Implementation() = default;

    virtual void analyse(const SparseMatrix& A) = 0;
    /// False if the library finds the matrix singular. Throws std::bad_alloc and Stopped, nothing else.
    virtual bool factorise(const SparseMatrix& A) = 0;
    /// b and x do not overlap.
    virtual void solve(std::span<const double> b, std::span<double> x) const = 0;
    virtual void solve_transposed(std::span<const double> b, std::span<double> x) const = 0;
    virtual long long factor_entries() const = 0;
    virtual std::string description() const = 0;

    int size = 0;
    int n_entries = 0;
    bool analysed = false;
    bool factorised = false;
};

std::unique_ptr<SparseLU::Implementation> make_eigen_backend();
/// Null where the build lacks UMFPACK.
std::unique_ptr<SparseLU::Implementation> make_umfpack_backend();

}   // namespace livens
