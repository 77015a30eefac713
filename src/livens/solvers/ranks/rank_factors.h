// SPDX-License-Identifier: BSD-3-Clause
// LU of a sparse matrix that follows time, its rows divided among ranks.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/solvers/ranks.h"
#include "livens/solvers/sparse.h"

namespace livens::inline solvers_internal {

/// An entry beside those of a rank's own matrix; those of a row in the order of their columns.
struct OutsideEntry {
    int row, column;   ///< of the rank: columns behind those of its matrix, or rows behind all of its rows
    double value;
};

/// Which of a rank's columns are its own, and which are unknowns of the chain, too.
struct ChainPlaces {
    int n_rows = 0;             ///< of the rank: of its matrix, without empty ones, and those behind
    std::vector<int> own;       ///< columns that no other rank sees, in the order of their elimination
    std::vector<int> columns;   ///< the others: at the borders before and behind, then those of all ranks
    int n_before = 0, n_behind = 0;
    std::vector<int> of_all;   ///< numbers of the latter among all of these, ascending
    int n_of_all = 0;
};

/// Every rank eliminates the columns that it alone sees by its own rows, and what is left of these is solved
/// between ranks (theory.md, "The chain", "Stretches"). All ranks call in the same order.
class RankFactors {
public:
    explicit RankFactors(Ranks& ranks);
    ~RankFactors();

    /// The rank's rows: those of A, with columns behind A's own for `outside`. False, on all ranks: see
    /// StaircaseLU.
    bool factorise(const SparseMatrix& A, const std::vector<OutsideEntry>& outside, int n_columns,
                   const ChainPlaces& places);
    /// Of the rows b, all columns x, refined once.
    void solve(std::span<const double> b, std::span<double> x);
    long long entries() const;
    long long flops() const;   ///< of the last factorisation, of products with pivot rows
    int n_left() const;        ///< rows that elimination left of the rank's
    int n_in_chain() const;    ///< rows of these that see both borders
    int n_chain() const;       ///< unknowns of the chain

private:
    struct Parts;
    void apply_inverse(std::span<const double> b, std::span<double> x);

    Ranks& ranks_;
    std::unique_ptr<Parts> parts_;
};

}   // namespace livens::inline solvers_internal
