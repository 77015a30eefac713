// SPDX-License-Identifier: BSD-3-Clause
// The backend that is always there: Eigen's supernodal SparseLU in the natural order.
//
// The unknowns come node by node in time, and that order is as good as any for a few bodies: elimination runs
// along the chain and fills the band. Rows are exchanged for the largest entry of a column (Eigen's threshold
// 1): the diagonal blocks of the paper's elements are O(h) beside couplings of 1/2, so a pivot on the
// diagonal cannot be trusted.
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <new>
#include <optional>
#include <string>

#include "livens/solvers/detail/sparse_backend.h"
#include "livens/solvers/patience.h"

namespace Eigen::internal {

/// Eigen's own, but for the question: one is made for every panel of columns, and a large factorisation has
/// no other place at which it could be stopped. What it throws goes through factorize() as memory that ends.
template <>
struct panel_dfs_traits<Matrix<std::int64_t, Dynamic, 1>> {
    panel_dfs_traits(Index column, std::int64_t* marker) : column_(column), marker_(marker)
    {
        livens::Patience::ask();
    }
    bool update_segrep(Index representative, Index column)
    {
        if (marker_[representative] >= column_) return false;
        marker_[representative] = column;
        return true;
    }
    void mem_expand(Matrix<std::int64_t, Dynamic, 1>&, Index, Index) {}
    enum { ExpandMem = false };

private:
    Index column_;
    std::int64_t* marker_;
};

}   // namespace Eigen::internal

namespace livens {

namespace {

/// Eigen counts the entries of the factors, with the padding of its supernodes, in the matrix' own index
/// type. Millions of unknowns bring 4e8 entries and more, too near to 2^31; the wider type was not measurably
/// slower.
using WideIndex = std::int64_t;
using EigenMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, WideIndex>;
using EigenLU = Eigen::SparseLU<EigenMatrix, Eigen::NaturalOrdering<WideIndex>>;
using EigenVector = Eigen::Map<const Eigen::VectorXd>;

class EigenBackend final : public SparseLU::Implementation {
public:
    void analyse(const SparseMatrix& A) override
    {
        matrix_.resize(A.size, A.size);
        matrix_.resizeNonZeros(A.n_entries());
        std::copy(A.column_starts.begin(), A.column_starts.end(), matrix_.outerIndexPtr());
        std::copy(A.rows.begin(), A.rows.end(), matrix_.innerIndexPtr());
        std::copy(A.values.begin(), A.values.end(), matrix_.valuePtr());
        lu_.emplace();
        lu_->analyzePattern(matrix_);
    }

    bool factorise(const SparseMatrix& A) override
    {
        if (!lu_) analyse(A);
        std::copy(A.values.begin(), A.values.end(), matrix_.valuePtr());
        try {
            lu_->factorize(matrix_);
        } catch (const std::bad_alloc&) {
            lu_.reset();
            throw;
        } catch (const Stopped&) {
            lu_.reset();
            throw;
        }
        // Eigen keeps the message of a failure for ever, and its status is stale after one that came from
        // memory: what has failed once is made anew.
        const std::string failure = lu_->lastErrorMessage();
        if (failure.empty()) return true;
        lu_.reset();
        if (failure.starts_with("UNABLE")) throw std::bad_alloc();   // to allocate working memory
        return false;
    }

    void solve(std::span<const double> b, std::span<double> x) const override
    {
        Eigen::Map<Eigen::VectorXd>(x.data(), size) = lu_->solve(EigenVector(b.data(), size));
    }

    void solve_transposed(std::span<const double> b, std::span<double> x) const override
    {
        Eigen::Map<Eigen::VectorXd>(x.data(), size) = lu_->transpose().solve(EigenVector(b.data(), size));
    }

    long long factor_entries() const override { return lu_->nnzL() + lu_->nnzU(); }

    std::string description() const override
    {
        return "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
               "." + std::to_string(EIGEN_MINOR_VERSION) + " SparseLU, natural order";
    }

private:
    EigenMatrix matrix_;
    mutable std::optional<EigenLU> lu_;   // Eigen's view of the transpose changes nothing, but is not const
};

}   // namespace

std::unique_ptr<SparseLU::Implementation> make_eigen_backend() { return std::make_unique<EigenBackend>(); }

}   // namespace livens
