// SPDX-License-Identifier: BSD-3-Clause
// Chains of elements that are one chain of all ranks: what is left of each, and what closes it.
#pragma once

#include <memory>
#include <vector>

#include "livens/solvers/linear_solver.h"
#include "livens/solvers/ranks.h"

namespace livens::inline solvers_internal {

/// A part's unknowns at its ends: n_free places at the first node, as many at the last one, then in the
/// border momenta along these, as many at the first node and at the last, then others. Neighbours have the
/// 2 n_free numbers at their border in common; others are those of all ranks, of which some ranks have no
/// column (theory.md, "Lobatto windows on ranks").
class RankEnds final : public ChainEnds {
public:
    /// `others`: numbers of the rank's other columns among those of all ranks, ascending.
    RankEnds(Ranks& ranks, int n_free, std::vector<int> others, int n_others);
    ~RankEnds() override;

    /// What the rank before has at its last node is told to the one behind, and becomes what this one has at
    /// its first: free motions, n_numbers x n_free, row by row, orthonormal at both.
    void meet(int n_numbers, const std::vector<double>& at_first, const std::vector<double>& at_last);
    bool factorise(std::span<const double> rows) override;
    void solve(std::span<const double> rows, std::span<double> ends) override;

    int n_rows() const { return static_cast<int>(scales_.size()); }   ///< of the rank
    int n_unknowns() const;                                           ///< of the chain

private:
    int n_columns() const { return 4 * n_free_ + static_cast<int>(others_.size()); }
    /// Of the first node by those of the rank before, or the other way round; once for places and momenta.
    void turn(const double* from, double* to, bool is_row) const;

    Ranks& ranks_;
    int n_free_;
    std::vector<int> others_;
    int n_others_;
    std::vector<double> turned_;   // n_free x n_free, row by row: this one's by those of the rank before
    std::vector<double> scales_;   // of rows
    std::vector<double> right_, found_;
    std::unique_ptr<RankChain> chain_;
};

}   // namespace livens::inline solvers_internal
