// SPDX-License-Identifier: BSD-3-Clause
// What is left of the rows of ranks, once more divided: what one border alone sees, and the chain.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/solvers/ranks.h"

namespace livens::inline solvers_internal {

/// Rows that a rank has left, dense, row by row, in columns at the border to the rank before, then at that to
/// the rank behind, then in others of all ranks.
struct RowsBetweenBorders {
    int n_rows = 0, n_before = 0, n_behind = 0;
    std::vector<int> others;   ///< numbers among the columns of all ranks, ascending
    int n_others = 0;          ///< of these in all ranks
    std::span<const double> values{};

    int n_columns() const { return n_before + n_behind + static_cast<int>(others.size()); }
};

/// A long stretch of elements hands on less than there are numbers at its borders: sums of its rows see one
/// border alone, to rounding. At each border the rank before it solves those of both sides; what they leave
/// free and the rows that see both borders make a chain (theory.md, "Ranks"). All ranks call in the same
/// order; neighbours have the columns at their border in the same order.
class RankBorders {
public:
    explicit RankBorders(Ranks& ranks);
    ~RankBorders();
    RankBorders(const RankBorders&) = delete;
    RankBorders& operator=(const RankBorders&) = delete;

    /// False, on all ranks: singular.
    bool factorise(const RowsBetweenBorders& rows);
    /// Right side of the rows in, all columns of the rank out; neighbours get the same numbers.
    void solve(std::span<const double> b, std::span<double> x);
    int n_unknowns() const;   ///< of the chain
    int n_rows() const;       ///< of the rank in it

private:
    struct Parts;
    bool solve_borders();
    bool make_chain(const RowsBetweenBorders& rows);

    Ranks& ranks_;
    std::unique_ptr<Parts> parts_;
};

}   // namespace livens::inline solvers_internal
