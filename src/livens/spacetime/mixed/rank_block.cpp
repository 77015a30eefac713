// SPDX-License-Identifier: BSD-3-Clause
// Rows and unknowns of one rank's elements, and what goes over the borders to its neighbours (theory.md, "The
// elements of the paper": Ranks).
#include "livens/spacetime/mixed/rank_block.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::mixed {

/// At each border the chain sees the numbers of the function there and as many transfers, in one order in
/// both ranks. A transfer stands in one row with +1 at the end of a rank and -1 at the start of the next.
RankBlock::RankBlock(Equations equations, Ranks& ranks, Border* border)
    : Block(std::move(equations), SparseBackend::eigen, border), ranks_(ranks), of_rank_(ranks)
{
    const int n = equations_.space().size();
    for (const bool at_end : {false, true}) {
        if (has(at_end)) continue;
        Side& one = sides_[at_end ? 1 : 0];
        one = side(at_end);
        const int numbers = static_cast<int>(one.columns.size());
        const int first = n + (at_end ? static_cast<int>(sides_[0].rows.size()) : 0);
        for (int i = 0; i < numbers; ++i) {
            places_.columns.push_back(one.columns[i]);
        }
        for (int i = 0; i < numbers; ++i) {
            places_.columns.push_back(first + i);
            outside_.push_back({one.rows[i], first + i, one.sign});
        }
        (at_end ? places_.n_behind : places_.n_before) = 2 * numbers;
    }
    places_.n_rows = n_equations_ = equations_.space().numbering.n_equations();
    n_columns_ = n + n_transfers();
    if (border_ != nullptr) place_border();
    place_own();
    transfers_[0].assign(static_cast<std::size_t>(n_transfers()), 0.0);
    transfers_[1] = transfers_[0];
}

/// Beside unknowns at borders of ranks there are those that join the rows of conditions, and numbers.
void RankBlock::place_border()
{
    const int f = border_->n_free(), m = border_->size();
    for (const bool at_end : {false, true}) {
        std::vector<int>& rows = own_.rows[at_end ? 1 : 0];
        rows.assign(static_cast<std::size_t>(m), -1);
        if (!has(at_end)) continue;
        own_.momenta[at_end ? 1 : 0] = n_columns_;
        n_columns_ += f;
        for (int i = 0; i < m; ++i)
            if (border_->at(i) != (at_end ? Condition::At::start : Condition::At::end))
                rows[i] = places_.n_rows++;
    }
    const auto join = [&](bool is_here) {
        const int number = places_.n_of_all++;
        if (!is_here) return -1;
        places_.columns.push_back(n_columns_);
        places_.of_all.push_back(number);
        return n_columns_++;
    };
    own_.between.assign(static_cast<std::size_t>(m), -1);
    for (int i = 0; i < m; ++i)
        if (border_->at(i) == Condition::At::both) own_.between[i] = join(has(false) || has(true));
    own_.numbers = n_columns_;
    for (int j = 0; j < border_->n_numbers(); ++j) join(true);
}

/// In the order of time, or of the last rank against it; momenta beside the places that they belong to.
void RankBlock::place_own()
{
    std::vector<char> is_shared(static_cast<std::size_t>(n_columns_), 0);
    for (const int column : places_.columns) is_shared[column] = 1;
    const auto add_momenta = [&](bool at_end) {
        const int first = own_.momenta[at_end ? 1 : 0];
        for (int j = 0; first >= 0 && j < border_->n_free(); ++j) places_.own.push_back(first + j);
    };
    add_momenta(false);
    for (int c = 0; c < equations_.space().numbering.n_unknowns(); ++c)
        if (is_shared[c] == 0) places_.own.push_back(c);
    add_momenta(true);
    if (ranks_.is_last() && !ranks_.is_first()) std::ranges::reverse(places_.own);
}

/// X, P and, of equal multipliers, lambda; rows as many. Lower multipliers live inside of elements: ranks
/// share none.
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
    const int of_border = ranks_.is_first() && border_ != nullptr ? border_->conditions().n_numbers() : 0;
    return equations_.space().numbering.n_unknowns() - static_cast<int>(sides_[0].columns.size()) + of_border;
}

/// act(row, number among the transfers, sign)
template <class Act>
void RankBlock::for_transfers(const Act& act) const
{
    std::size_t i = 0;
    for (const Side& side : sides_)
        for (const int row : side.rows) act(row, i++, side.sign);
}

/// From the first rank to the last, one after the other: both sides of a border begin with the same numbers.
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

void RankBlock::adopt(const Block& other)
{
    Block::adopt(other);
    const auto& of = static_cast<const RankBlock&>(other);
    transfers_[0] = transfers_[1] = of.transfers_[of.kept_];
}

/// Finite in all ranks or in none, so that all go on or stop together.
bool RankBlock::residual()
{
    const bool is_finite = Block::residual();
    if (is_finite)
        for_transfers(
            [&](int row, std::size_t i, double sign) { residual_[row] += sign * transfers_[current_][i]; });
    return ranks_.all(is_finite);
}

bool RankBlock::factorise()
{
    form_inner();
    outside_.resize(static_cast<std::size_t>(n_transfers()));
    if (border_ != nullptr) add_border();
    return of_rank_.factorise(inner(), outside_, n_columns_, places_);
}

void RankBlock::add_border()
{
    border_->differentiate();
    for (const bool at_end : {false, true}) {
        if (!has(at_end)) continue;
        const int end = at_end ? 1 : 0, first = own_.momenta[end];
        border_->take_momenta(at_end, equations_, fields(), [&](int row, int j, double value) {
            outside_.push_back({row, first + j, value * scaled_.rows[row]});
        });
        const auto take = [&](int i, int column, double value) {
            if (own_.rows[end][i] >= 0) outside_.push_back({own_.rows[end][i], column, value});
        };
        border_->take_conditions(at_end, equations_, fields(), [&](int i, int column, double value) {
            take(i, column, value * scaled_.columns[column]);
        });
        border_->take_closing(at_end, [&](int i, int j, double value) { take(i, first + j, value); });
    }
    add_numbers();
    scale_border();
    for (int i = 0; i < border_->size(); ++i) {
        if (own_.between[i] < 0) continue;
        if (own_.rows[0][i] >= 0) outside_.push_back({own_.rows[0][i], own_.between[i], 1});
        if (own_.rows[1][i] >= 0) outside_.push_back({own_.rows[1][i], own_.between[i], -1});
    }
}

void RankBlock::add_numbers()
{
    const DenseMatrix by_numbers = border_->numbers();
    const int n = equations_.space().size();
    for (int j = 0; j < by_numbers.cols; ++j) {
        const auto add = [&](int row, double value) {
            if (row >= 0 && value != 0) outside_.push_back({row, own_.numbers + j, value});
        };
        for (int r = 0; r < n_equations_; ++r) add(r, by_numbers(r, j) * scaled_.rows[r]);
        for (int i = 0; i < border_->size(); ++i) add(row_of(i), by_numbers(n + i, j));
    }
}

/// Rows of conditions to a largest entry of one, of both rows where there are two.
void RankBlock::scale_border()
{
    std::vector<int> condition(static_cast<std::size_t>(places_.n_rows - n_equations_));
    for (const std::vector<int>& rows : own_.rows)
        for (int i = 0; i < border_->size(); ++i)
            if (rows[i] >= 0) condition[rows[i] - n_equations_] = i;
    own_.scales.assign(static_cast<std::size_t>(border_->size()), 0.0);
    const auto for_entries = [&](const auto& act) {
        for (auto entry = outside_.begin() + n_transfers(); entry != outside_.end(); ++entry)
            if (entry->row >= n_equations_)
                act(own_.scales[condition[entry->row - n_equations_]], entry->value);
    };
    for_entries([](double& largest, double value) { largest = std::max(largest, std::abs(value)); });
    ranks_.largest(own_.scales);
    for (double& scale : own_.scales) scale = scale > 0 ? 1 / scale : 1;
    for_entries([](double scale, double& value) { value *= scale; });
}

/// A transfer has the scale of its row, so that it counts one there.
void RankBlock::solve_for(const Block& other, std::span<double> dx)
{
    const auto& of = static_cast<const RankBlock&>(other);
    const std::size_t n = n_inner(), behind = n + static_cast<std::size_t>(n_transfers());
    work_.assign(static_cast<std::size_t>(places_.n_rows), 0.0);
    increment_.assign(static_cast<std::size_t>(n_columns_), 0.0);
    for (int r = 0; r < n_equations_; ++r) work_[r] = -of.residual_[r] * scaled_.rows[r];
    for (int i = 0; border_ != nullptr && i < border_->size(); ++i)
        if (const int row = row_of(i); row >= 0)
            work_[row] = of.border_->conditions().missed()[i] * own_.scales[i];
    of_rank_.solve(work_, increment_);
    for (std::size_t i = 0; i < n; ++i) dx[i] = increment_[i] * scaled_.columns[i];
    for_transfers([&](int row, std::size_t i, double) { dx[n + i] = increment_[n + i] / scaled_.rows[row]; });
    if (border_ == nullptr) return;
    std::vector<double> along(static_cast<std::size_t>(border_->size()));
    const auto f = static_cast<std::size_t>(border_->n_free());
    for (const bool at_end : {false, true}) {
        const std::span<double> one = std::span(along).subspan(at_end ? f : 0, f);
        if (has(at_end)) std::copy_n(increment_.begin() + own_.momenta[at_end ? 1 : 0], f, one.begin());
        ranks_.broadcast(at_end ? ranks_.size() - 1 : 0, one);
    }
    std::copy(increment_.begin() + own_.numbers, increment_.end(),
              along.begin() + static_cast<std::ptrdiff_t>(2 * f));
    border_->conditions().to_momenta(along.data(), dx.data() + behind);
}

bool RankBlock::move(std::span<const double> dx, double damping)
{
    const std::size_t n = n_inner();
    move_fields(dx.first(n), damping);
    transfers_[current_] = transfers_[kept_];
    for (std::size_t i = 0; i < transfers_[current_].size(); ++i)
        transfers_[current_][i] += damping * dx[n + i];
    if (border_ != nullptr)
        border_->conditions().move(dx.subspan(n + static_cast<std::size_t>(n_transfers())), damping);
    return true;
}

double RankBlock::size_of(std::span<const double> dx) const
{
    const std::size_t n = n_inner();
    double size = scaling_.size_of(dx.first(n));
    if (border_ != nullptr) {
        const double of_momenta =
            border_->conditions().size_of(dx.subspan(n + static_cast<std::size_t>(n_transfers())));
        if (!(of_momenta <= size) && !std::isnan(size)) size = of_momenta;
    }
    return ranks_.largest(size);
}

NewtonProblem::Rows RankBlock::rows() const
{
    double both[] = {worst().value, scaling_.largest(fields())};
    ranks_.largest(both);
    const double terms = std::max(both[1], 1e-300);
    const double missing = border_ != nullptr ? terms * border_->conditions().largest() : 0;
    Rows rows;
    rows.size = std::max(both[0], missing);
    rows.terms = terms;
    return rows;
}

}   // namespace livens::mixed
