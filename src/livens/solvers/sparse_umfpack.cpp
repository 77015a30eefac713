// SPDX-License-Identifier: BSD-3-Clause
// The backend of the paper: UMFPACK in METIS' order. Compiled where LIVENS_UMFPACK asks for it: UMFPACK is
// under the GPL, and so is a program that contains it.
//
// Called in C, with 64-bit indices throughout: the factors of millions of unknowns have too many entries for
// UMFPACK's 32-bit workspace long before they fill the memory. METIS draws from the C library's random
// numbers, after setting their seed: the order is repeatable, but analyse() is not for two threads at a time.
#include "livens/solvers/detail/sparse_backend.h"

#ifdef LIVENS_HAS_UMFPACK
#include <suitesparse/umfpack.h>

#include <array>
#include <cassert>
#include <new>
#include <vector>
#endif

namespace livens {

#ifndef LIVENS_HAS_UMFPACK

std::unique_ptr<SparseLU::Implementation> make_umfpack_backend() { return nullptr; }

#else

namespace {

using Index = SuiteSparse_long;
using Controls = std::array<double, UMFPACK_CONTROL>;
using Infos = std::array<double, UMFPACK_INFO>;

struct FreeSymbolic {
    void operator()(void* symbolic) const { umfpack_dl_free_symbolic(&symbolic); }
};
struct FreeNumeric {
    void operator()(void* numeric) const { umfpack_dl_free_numeric(&numeric); }
};

Controls controls(double ordering)
{
    Controls c{};
    umfpack_dl_defaults(c.data());
    c[UMFPACK_PRL] = 0;
    c[UMFPACK_ORDERING] = ordering;
    c[UMFPACK_IRSTEP] = 0;   // refinement is the caller's
    // And so is scaling, as with the other backend: dividing rows by their sums besides made the residuals of
    // chains like the paper's 2 to 50 times larger, and changed the fill by less than a tenth.
    c[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
    // Left to itself UMFPACK may take a nearly symmetric pattern for a reason to pivot on the diagonal. There
    // the paper's elements have entries of O(h) beside couplings of 1/2. Forced to it, a chain of 1000 nodes
    // with four bodies took nearly twice the fill and five times the time, for residuals of 1e-11 instead of
    // 4e-15.
    c[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_UNSYMMETRIC;
    return c;
}

class UmfpackBackend final : public SparseLU::Implementation {
public:
    void analyse(const SparseMatrix& A) override
    {
        numeric_.reset();
        symbolic_.reset();
        column_starts_.assign(A.column_starts.begin(), A.column_starts.end());
        rows_.assign(A.rows.begin(), A.rows.end());
        if (!analyse_by(UMFPACK_ORDERING_METIS)) analyse_by(UMFPACK_ORDERING_AMD);   // built without METIS
    }

    bool factorise(const SparseMatrix& A) override
    {
        numeric_.reset();
        // The symbolic analysis already finds a structurally singular matrix.
        if (!symbolic_) return false;
        void* numeric = nullptr;
        const Index status = umfpack_dl_numeric(column_starts_.data(), rows_.data(), A.values.data(),
                                                symbolic_.get(), &numeric, controls_.data(), nullptr);
        numeric_.reset(numeric);
        if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
        assert(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix);
        return status == UMFPACK_OK;
    }

    void solve(std::span<const double> b, std::span<double> x) const override { solve(UMFPACK_A, b, x); }
    void solve_transposed(std::span<const double> b, std::span<double> x) const override
    {
        solve(UMFPACK_At, b, x);
    }

    long long factor_entries() const override
    {
        Index lower = 0, upper = 0, n_rows = 0, n_columns = 0, n_pivots = 0;
        umfpack_dl_get_lunz(&lower, &upper, &n_rows, &n_columns, &n_pivots, numeric_.get());
        return lower + upper;
    }

    std::string description() const override
    {
        return "UMFPACK " + std::to_string(UMFPACK_MAIN_VERSION) + "." + std::to_string(UMFPACK_SUB_VERSION)
            + "." + std::to_string(UMFPACK_SUBSUB_VERSION)
            + (controls_[UMFPACK_ORDERING] == UMFPACK_ORDERING_METIS ? ", METIS order" : ", AMD order");
    }

private:
    bool analyse_by(double ordering)
    {
        controls_ = controls(ordering);
        void* symbolic = nullptr;
        const Index status = umfpack_dl_symbolic(size, size, column_starts_.data(), rows_.data(), nullptr,
                                                 &symbolic, controls_.data(), nullptr);
        symbolic_.reset(symbolic);
        if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
        assert(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix
               || status == UMFPACK_ERROR_ordering_failed);
        return symbolic_ != nullptr;
    }

    void solve(Index system, std::span<const double> b, std::span<double> x) const
    {
        // Without refinement UMFPACK does not look at the matrix.
        [[maybe_unused]] const Index status
            = umfpack_dl_solve(system, nullptr, nullptr, nullptr, x.data(), b.data(), numeric_.get(),
                               controls_.data(), nullptr);
        if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
        assert(status == UMFPACK_OK);
    }

    Controls controls_ = controls(UMFPACK_ORDERING_METIS);
    std::vector<Index> column_starts_, rows_;
    std::unique_ptr<void, FreeSymbolic> symbolic_;
    std::unique_ptr<void, FreeNumeric> numeric_;
};

}   // namespace

std::unique_ptr<SparseLU::Implementation> make_umfpack_backend()
{
    return std::make_unique<UmfpackBackend>();
}

#endif

}   // namespace livens
