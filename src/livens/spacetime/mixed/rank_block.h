// SPDX-License-Identifier: BSD-3-Clause
// The part that one rank has of a block, as Newton's iteration sees it in all ranks at once.
#pragma once

#include <span>
#include <vector>

#include "livens/solvers/rank_factors.h"
#include "livens/spacetime/mixed/block.h"

namespace livens::mixed {

/// Elements of one rank. It forms no others: at a border both ranks have the unknowns of the function that
/// lives on both sides, and rows with the share of their own elements. What these lack of each other is a
/// transfer, one more unknown a row, which is added on one side and taken off on the other:
///
///     r_before + t = 0,   r_behind - t = 0
///
/// For rows of momentum balances it is the momentum that is handed on. Increments are those of the rank's own
/// unknowns, then of the transfers at both borders; all numbers that decide are those of all ranks.
class RankBlock final : public Block {
public:
    RankBlock(Equations equations, Ranks& ranks);

    /// Of unknowns at borders those of the rank before are taken by the one behind.
    void share_guess();
    int n_unknowns() const override { return equations_.space().size() + n_transfers(); }
    bool residual() override;
    bool factorise() override;
    void solve(std::span<double> dx) override;
    bool move(std::span<const double> dx, double damping) override;
    double size_of(std::span<const double> dx) const override;
    Rows rows() const override;
    void measure_condition(SolveReport&, const std::function<bool()>&) override {}

    const RankFactors& factors() const { return of_rank_; }
    /// Unknowns of the rank that are not those of the one before.
    int n_own() const;
    int n_chain() const { return places_.n_unknowns; }

private:
    /// Numbers at a border of two ranks, in one order in both.
    struct Side {
        std::vector<int> columns, rows;
        double sign = 0;   ///< of transfers
    };
    Side side(bool at_end) const;
    int n_transfers() const { return static_cast<int>(sides_[0].rows.size() + sides_[1].rows.size()); }
    template <class Act>
    void for_transfers(const Act& act) const;

    Ranks& ranks_;
    RankFactors of_rank_;
    Side sides_[2];
    ChainPlaces places_;
    std::vector<OutsideEntry> outside_;
    std::vector<double> transfers_[2];   // as fields_
};

}   // namespace livens::mixed
