// SPDX-License-Identifier: BSD-3-Clause
// The part that one rank has of a block, as Newton's iteration sees it in all ranks at once.
#pragma once

#include <span>
#include <vector>

#include "livens/solvers/ranks/rank_factors.h"
#include "livens/spacetime/mixed/block.h"

namespace livens::mixed {

/// Rows and columns of conditions by component that a rank has, behind its others; -1: it has none.
struct BorderOfRank {
    std::vector<int> rows[2];     ///< of each condition, by the start and by the end
    std::vector<int> between;     ///< column of each, that joins its rows at the start and at the end
    int momenta[2] = {-1, -1};    ///< first column by momenta at the start and at the end
    int numbers = -1;             ///< first column by numbers
    std::vector<double> scales;   ///< of conditions, the same in all ranks
};

/// Elements of one rank. It forms no others: at a border both ranks have the unknowns of the function that
/// lives on both sides, and rows with the share of their own elements. What these lack of each other is a
/// transfer, one more unknown a row, which is added on one side and taken off on the other:
///
///     r_before + t = 0,   r_behind - t = 0
///
/// For rows of momentum balances it is the momentum that is handed on. Increments are those of the rank's own
/// unknowns, then of the transfers at both borders; all numbers that decide are those of all ranks.
///
/// Conditions by component are rows of the first rank, by places and momenta at the start, and of the last
/// one, by those at the end. A condition of both is one row in each, joined by a transfer that only an
/// increment has:
///
///     C_0 dx_0 + D_0 dp_0 + s = missed,   C_n dx_n + D_n dp_n - s = 0
///
/// Unknown numbers are unknowns of all ranks. Increments end with those of momenta at both ends and of
/// numbers, which every rank knows.
class RankBlock final : public Block {
public:
    RankBlock(Equations equations, Ranks& ranks, Border* border = nullptr);

    /// Of unknowns at borders those of the rank before are taken by the one behind.
    void share_guess();
    int n_unknowns() const override { return Block::n_unknowns() + n_transfers(); }
    void adopt(const Block& other) override;
    bool residual() override;
    bool factorise() override;
    void solve_for(const Block& other, std::span<double> dx) override;
    bool move(std::span<const double> dx, double damping) override;
    double size_of(std::span<const double> dx) const override;
    Rows rows() const override;
    void measure_condition(SolveReport&, const std::function<bool()>&) override {}

    const RankFactors& factors() const { return of_rank_; }
    /// Unknowns of the rank that are not those of the one before; of the first one those of the border, too.
    int n_own() const;

private:
    /// Numbers at a border of two ranks, in one order in both.
    struct Side {
        std::vector<int> columns, rows;
        double sign = 0;   ///< of transfers
    };
    Side side(bool at_end) const;
    void place_own();
    void place_border();
    void add_border();
    void add_numbers();
    void scale_border();
    /// Row of condition i that has what it misses, and its derivatives by numbers.
    int row_of(int i) const { return own_.rows[border_->at(i) == Condition::At::end ? 1 : 0][i]; }
    int n_transfers() const { return static_cast<int>(sides_[0].rows.size() + sides_[1].rows.size()); }
    template <class Act>
    void for_transfers(const Act& act) const;
    std::size_t n_inner() const { return static_cast<std::size_t>(equations_.space().size()); }
    bool has(bool at_end) const { return at_end ? ranks_.is_last() : ranks_.is_first(); }

    Ranks& ranks_;
    RankFactors of_rank_;
    Side sides_[2];
    BorderOfRank own_;
    int n_equations_ = 0, n_columns_ = 0;   // rows and columns of the rank, those of the border behind
    ChainPlaces places_;
    std::vector<OutsideEntry> outside_;   // transfers, then the border
    std::vector<double> transfers_[2];    // as fields_
};

}   // namespace livens::mixed
