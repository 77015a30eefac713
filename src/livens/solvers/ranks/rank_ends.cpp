// SPDX-License-Identifier: BSD-3-Clause
// The chain of ranks' chains: of each what its elements leave, by what it has in common with its neighbours.
#include "livens/solvers/ranks/rank_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::inline solvers_internal {

RankEnds::RankEnds(Ranks& ranks, int n_free, std::vector<int> others, int n_others)
    : ranks_(ranks), n_free_(n_free), others_(std::move(others)), n_others_(n_others)
{}

RankEnds::~RankEnds() = default;

int RankEnds::n_unknowns() const { return 2 * n_free_ * (ranks_.size() + 1) + n_others_; }

/// T = Z_0^T Z_N of this rank's first and of the last node of the rank before, which is orthogonal, as both
/// bases span the same motions (theory.md, "Lobatto windows on ranks"); the first rank keeps its own basis.
void RankEnds::meet(int n_numbers, const std::vector<double>& at_first, const std::vector<double>& at_last)
{
    const auto f = static_cast<std::size_t>(n_free_), n = static_cast<std::size_t>(n_numbers);
    std::vector<double> before(n * f);
    turned_.assign(f * f, 0.0);
    if (ranks_.is_first())
        for (std::size_t i = 0; i < f; ++i) turned_[i * f + i] = 1;
    ranks_.receive_from_before(before);
    ranks_.pass_on(at_last);
    for (std::size_t k = 0; k < n && !ranks_.is_first(); ++k)
        for (std::size_t i = 0; i < f; ++i)
            for (std::size_t j = 0; j < f; ++j) turned_[i * f + j] += at_first[k * f + i] * before[k * f + j];
}

/// Unknowns at the first node are x_0 = T x of the chain's, so that a row's coefficients a become a T.
void RankEnds::turn(const double* from, double* to, bool is_row) const
{
    const auto f = static_cast<std::size_t>(n_free_);
    std::fill_n(to, f, 0.0);
    for (std::size_t i = 0; i < f; ++i)
        for (std::size_t j = 0; j < f; ++j) {
            const double value = turned_[i * f + j];
            is_row ? to[j] += from[i] * value : to[i] += value * from[j];
        }
}

/// A rank's columns are places at its first and last node, momenta at these, others; in the chain places and
/// momenta of one border stand together. Rows get the largest entry 1: pivots are chosen among rows of all
/// ranks, whose units differ.
bool RankEnds::factorise(std::span<const double> rows)
{
    const auto n = static_cast<std::size_t>(n_columns()), f = static_cast<std::size_t>(n_free_);
    const bool is_good =
        !rows.empty() && std::ranges::all_of(rows, [](double value) { return std::isfinite(value); });
    if (!ranks_.all(is_good)) return false;
    ChainRows own;
    own.n_unknowns = n_unknowns();
    const int first = 2 * n_free_ * ranks_.rank(), behind = 2 * n_free_ * (ranks_.size() + 1);
    for (int i = 0; i < 4 * n_free_; ++i) own.columns.push_back(first + i);
    for (const int other : others_) own.columns.push_back(behind + other);
    own.values.resize(rows.size());
    scales_.assign(rows.size() / n, 1.0);
    for (std::size_t r = 0; r < scales_.size(); ++r) {
        const double* from = rows.data() + r * n;
        double* to = own.values.data() + r * n;
        turn(from, to, true);
        turn(from + 2 * f, to + f, true);
        std::copy_n(from + f, f, to + 2 * f);
        std::copy_n(from + 3 * f, f, to + 3 * f);
        std::copy_n(from + 4 * f, others_.size(), to + 4 * f);
        double size = 0;
        for (std::size_t c = 0; c < n; ++c) size = std::max(size, std::abs(to[c]));
        if (size > 0) scales_[r] = 1 / size;
        for (std::size_t c = 0; c < n; ++c) to[c] *= scales_[r];
    }
    right_.resize(scales_.size());
    found_.resize(n);
    if (!chain_) chain_ = ranks_.make_chain();
    return chain_->factorise(own);
}

void RankEnds::solve(std::span<const double> rows, std::span<double> ends)
{
    const auto f = static_cast<std::size_t>(n_free_);
    for (std::size_t r = 0; r < right_.size(); ++r) right_[r] = rows[r] * scales_[r];
    chain_->solve(right_, found_);
    const double* from = found_.data();
    turn(from, ends.data(), false);
    turn(from + f, ends.data() + 2 * f, false);
    std::copy_n(from + 2 * f, f, ends.data() + f);
    std::copy_n(from + 3 * f, f, ends.data() + 3 * f);
    std::copy_n(from + 4 * f, others_.size(), ends.data() + 4 * f);
}

}   // namespace livens::inline solvers_internal
