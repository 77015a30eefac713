// SPDX-License-Identifier: BSD-3-Clause
// Rows and unknowns of one rank's elements, and what goes over the borders to its neighbours (theory.md, "The
// elements of the paper": Ranks).
#include "livens/spacetime/mixed/rank_block.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::mixed {

RankBlock::RankBlock(Equations equations, Ranks& ranks)
    : Block(std::move(equations), SparseBackend::eigen), ranks_(ranks), of_rank_(ranks)
{
    const int n = equations_.space().size();
    for (const bool at_end : {false, true}) {
        if (at_end ? ranks.is_last() : ranks.is_first()) continue;
        Side& one = sides_[at_end ? 1 : 0];
        one = side(at_end);
        const int numbers = static_cast<int>(one.columns.size());
        const int border = ranks.rank() - (at_end ? 0 : 1),
                  first = n + (at_end ? static_cast<int>(sides_[0].rows.size()) : 0);
        for (int i = 0; i < numbers; ++i) {
            places_.columns.push_back(one.columns[i]);
            places_.unknowns.push_back(2 * numbers * border + i);
        }
        for (int i = 0; i < numbers; ++i) {
            places_.columns.push_back(first + i);
            places_.unknowns.push_back(2 * numbers * border + numbers + i);
            outside_.push_back({one.rows[i], first + i, one.sign});
        }
        places_.n_unknowns = 2 * numbers * (ranks.size() - 1);
    }
    places_.n_rows = equations_.space().numbering.n_equations();
    places_.n_own = equations_.space().numbering.n_unknowns();
    places_.from_end = ranks.is_last() && !ranks.is_first();
    transfers_[0].assign(static_cast<std::size_t>(n_transfers()), 0.0);
    transfers_[1] = transfers_[0];
}

RankBlock::Side RankBlock::side(bool at_end) const
{
    const FieldSpace& space = equations_.space();
    const Numbering& n = space.numbering;
    const int A = at_end ? n.n_functions() - 1 : 0;
    const bool has_multipliers = n.n_multiplier_functions() >= n.n_functions();   // equal ones
    Side side;
    side.sign = at_end ? 1 : -1;
    const auto add = [](std::vector<int>& numbers, int first, int count) {
        for (int i = 0; i < count; ++i) numbers.push_back(first + i);
    };
    add(side.columns, n.X(A), space.coordinates.size);
    add(side.columns, n.P(A), space.coordinates.size);
    add(side.rows, n.row_dP(A), space.coordinates.size);
    add(side.rows, n.row_dX(A), space.coordinates.size);
    if (!has_multipliers) return side;
    add(side.columns, n.lambda(at_end ? n.n_multiplier_functions() - 1 : 0), space.coordinates.n_rows());
    add(side.rows, n.row_dlambda(A), space.coordinates.n_rows());
    return side;
}

int RankBlock::n_own() const
{
    return equations_.space().numbering.n_unknowns() - static_cast<int>(sides_[0].columns.size());
}

/// act(row, number among the transfers, sign)
template <class Act>
void RankBlock::for_transfers(const Act& act) const
{
    std::size_t i = 0;
    for (const Side& side : sides_)
        for (const int row : side.rows) act(row, i++, side.sign);
}

void RankBlock::share_guess()
{
    const FieldSpace& space = equations_.space();
    Fields& f = fields();
    const auto n = static_cast<std::size_t>(space.coordinates.size),
               m = sides_[0].columns.size() > 2 * n || sides_[1].columns.size() > 2 * n
                       ? static_cast<std::size_t>(space.coordinates.n_rows())
                       : 0;
    std::vector<double> shared(2 * n + m);
    const auto at = [](std::vector<double>& values, bool at_end, std::size_t count) {
        return at_end ? values.end() - static_cast<std::ptrdiff_t>(count) : values.begin();
    };
    if (!ranks_.is_first()) {
        ranks_.receive_from_before(shared);
        auto from = shared.begin();
        for (auto [values, count] : {std::pair{&f.x, n}, {&f.P, n}, {&f.lambda, m}}) {
            std::copy_n(from, count, at(*values, false, count));
            from += static_cast<std::ptrdiff_t>(count);
        }
        space.tie(f);
    }
    auto to = shared.begin();
    for (auto [values, count] : {std::pair{&f.x, n}, {&f.P, n}, {&f.lambda, m}})
        to = std::copy_n(at(*values, true, count), count, to);
    ranks_.pass_on(shared);
    transfers_[0].assign(transfers_[0].size(), 0.0);
    transfers_[1] = transfers_[0];
}

bool RankBlock::residual()
{
    const bool is_finite = Block::residual();
    for_transfers(
        [&](int row, std::size_t i, double sign) { residual_[row] += sign * transfers_[current_][i]; });
    return ranks_.all(is_finite);
}

bool RankBlock::factorise()
{
    form();
    return of_rank_.factorise(scaled_.all, outside_, n_unknowns(), places_);
}

/// A transfer has the scale of its row, so that it counts one there.
void RankBlock::solve(std::span<double> dx)
{
    const std::size_t n = residual_.size();
    work_.resize(n);
    increment_.assign(dx.size(), 0.0);
    for (std::size_t i = 0; i < n; ++i) work_[i] = -residual_[i] * scaled_.rows[i];
    of_rank_.solve(work_, increment_);
    for (std::size_t i = 0; i < n; ++i) dx[i] = increment_[i] * scaled_.columns[i];
    for_transfers([&](int row, std::size_t i, double) { dx[n + i] = increment_[n + i] / scaled_.rows[row]; });
}

bool RankBlock::move(std::span<const double> dx, double damping)
{
    const std::size_t n = residual_.size();
    Block::move(dx.first(n), damping);
    transfers_[current_] = transfers_[kept_];
    for (std::size_t i = 0; i < transfers_[current_].size(); ++i)
        transfers_[current_][i] += damping * dx[n + i];
    return true;
}

double RankBlock::size_of(std::span<const double> dx) const
{
    return ranks_.largest(scaling_.size_of(dx.first(residual_.size())));
}

NewtonProblem::Rows RankBlock::rows() const
{
    Rows rows = Block::rows();
    double both[] = {rows.size, rows.terms};
    ranks_.largest(both);
    rows.size = both[0];
    rows.terms = both[1];
    return rows;
}

}   // namespace livens::mixed
