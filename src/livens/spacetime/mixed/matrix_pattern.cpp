// SPDX-License-Identifier: BSD-3-Clause
// Where entries of a block's matrix stand among its values. Elements in the middle of many that are alike are
// left out of what is sorted, as if time was shorter, and the matrix is drawn out afterwards: their columns
// are those of the last element before them, so many rows and values further on.
#include <algorithm>
#include <cstdint>

#include "livens/solvers/crew.h"
#include "livens/spacetime/mixed/tangent.h"

namespace livens::mixed {

namespace {

constexpr int least_shared_elements = 64;   // that a thread draws out

}   // namespace

void MatrixPattern::collect()
{
    places_.clear();
    elements_.clear();
    cuts_.clear();
    shift_ = left_out_ = 0;
    first_of_element_ = first_of_ends_ = 0;
}

void MatrixPattern::end_element()
{
    elements_.push_back({first_of_element_, static_cast<int>(cuts_.size()), 0});
    first_of_element_ = first_of_ends_ = places_.size();
}

/// `times` more elements like the last one, each `stride` rows and columns further on than the one before.
/// What is collected behind them has `shift_` taken off its numbers, as if they were not there.
void MatrixPattern::repeat(int times, int stride, int column)
{
    const PlacedElement last = elements_.back();
    for (int i = 1; i <= times; ++i) elements_.push_back({last.begin, last.n_cuts, i});
    cuts_.push_back({column - shift_, times, stride});
    left_out_ += times * stride;
    shift_ = left_out_;
}

/// By rows, then by columns, each by counting.
void MatrixPattern::sort(int size, SparseMatrix& short_J)
{
    const std::size_t n = places_.size();
    std::vector<std::size_t> starts(static_cast<std::size_t>(size) + 1, 0);
    std::vector<std::uint32_t> by_row(n), by_column(n);
    for (const auto& [row, column] : places_) ++starts[row + 1];
    for (int i = 0; i < size; ++i) starts[i + 1] += starts[i];
    for (std::size_t i = 0; i < n; ++i) by_row[starts[places_[i].first]++] = static_cast<std::uint32_t>(i);
    std::ranges::fill(starts, 0);
    for (const auto& [row, column] : places_) ++starts[column + 1];
    for (int i = 0; i < size; ++i) starts[i + 1] += starts[i];
    for (const std::uint32_t i : by_row) by_column[starts[places_[i].second]++] = i;
    short_J.size = size;
    short_J.column_starts.assign(1, 0);
    slots_.resize(n);
    std::size_t k = 0;
    for (int c = 0; c < size; ++c) {
        for (int last = -1; k < n && places_[by_column[k]].second == c; ++k) {
            const int row = places_[by_column[k]].first;
            if (row != last) short_J.rows.push_back(row);
            last = row;
            slots_[by_column[k]] = static_cast<int>(short_J.rows.size()) - 1;
        }
        short_J.column_starts.push_back(static_cast<int>(short_J.rows.size()));
    }
}

/// Of elements, and of the ends of time by their columns.
void MatrixPattern::take_offsets()
{
    std::vector<int> before(1, 0);   // values that are left out before each cut
    for (const PatternCut& cut : cuts_) before.push_back(before.back() + cut.times * cut.entries);
    for (PlacedElement& element : elements_)
        element.offset =
            before[element.n_cuts] + (element.copy > 0 ? element.copy * cuts_[element.n_cuts].entries : 0);
    for (std::size_t k = first_of_ends_; k < places_.size(); ++k)
        for (const PatternCut& cut : cuts_)
            if (places_[k].second >= cut.column) slots_[k] += cut.times * cut.entries;
}

/// Up to a cut columns are copied as they are; then the last `stride` of them `times` more; then what is
/// behind, with rows and values that are so many further on.
void MatrixPattern::draw_out(int size, const SparseMatrix& short_J, SparseMatrix& J) const
{
    const std::vector<int>& starts = short_J.column_starts;
    std::size_t n = short_J.rows.size();
    for (const PatternCut& cut : cuts_) n += static_cast<std::size_t>(cut.times) * cut.entries;
    J.size = size;
    J.column_starts.assign(static_cast<std::size_t>(size) + 1, 0);
    J.rows.resize(n);
    // columns first..last - 1 as columns from `to` on, whose entries begin at `begin`
    const auto copy = [&](int first, int last, int to, int begin, int shift) {
        const int ahead = begin - starts[first];
        for (int c = first; c < last; ++c) J.column_starts[to + c - first + 1] = starts[c + 1] + ahead;
        for (int k = starts[first]; k < starts[last]; ++k) J.rows[k + ahead] = short_J.rows[k] + shift;
    };
    int first = 0, shift = 0, ahead = 0;
    for (const PatternCut& cut : cuts_) {
        copy(first, cut.column, first + shift, starts[first] + ahead, shift);
        in_shares(cut.times, least_shared_elements, [&](int, int begin, int end) {
            for (int i = begin; i < end; ++i)
                copy(cut.column - cut.stride, cut.column, cut.column + shift + i * cut.stride,
                     starts[cut.column] + ahead + i * cut.entries, shift + (i + 1) * cut.stride);
        });
        first = cut.column;
        shift += cut.times * cut.stride;
        ahead += cut.times * cut.entries;
    }
    copy(first, short_J.size, first + shift, starts[first] + ahead, shift);
}

void MatrixPattern::make(int size, SparseMatrix& J)
{
    SparseMatrix short_J;
    sort(size - left_out_, short_J);
    for (PatternCut& cut : cuts_)
        cut.entries = short_J.column_starts[cut.column] - short_J.column_starts[cut.column - cut.stride];
    take_offsets();
    draw_out(size, short_J, J);
    places_ = {};   // nobody needs them any more
}

}   // namespace livens::mixed
