// SPDX-License-Identifier: BSD-3-Clause
// Gaussian elimination along time: rows enter a front when their first column is due, and leave it as pivots.
// The front is dense but for its bits, which tell the runs of numbers that are worth a product; theory.md,
// "The chain", "Stretches".
#include "livens/solvers/detail/stretch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/solvers/patience.h"

namespace livens::inline solvers_internal {

namespace {

/// Runs that are no farther apart are one: its zeros cost less than another run.
constexpr int most_between = 2;

/// Pivots below that share of their column's largest entry are none.
constexpr double least_pivot = 1e-10;

}   // namespace

void Front::resize(int window, int n_kept)
{
    window_ = window;
    width_ = window + n_kept;
    n_words_ = (width_ + 63) / 64;
    n_rows_ = 0;
    values_.clear();
    bits_.clear();
    free_.clear();
}

int Front::take()
{
    if (free_.empty()) {
        free_.push_back(n_rows_++);
        values_.resize(static_cast<std::size_t>(n_rows_) * static_cast<std::size_t>(width_), 0.0);
        bits_.resize(static_cast<std::size_t>(n_rows_) * static_cast<std::size_t>(n_words_), 0);
    }
    const int row = free_.back();
    free_.pop_back();
    return row;
}

void StretchFactors::clear()
{
    rows.clear();
    diagonal.clear();
    upper.clear();
    runs.clear();
    lower.clear();
    for (auto* starts : {&run_starts, &upper_starts, &lower_starts}) starts->assign(1, 0);
}

void StretchFactors::end_pivot()
{
    run_starts.push_back(runs.size());
    upper_starts.push_back(upper.size());
    lower_starts.push_back(lower.size());
}

void Stretch::analyse(const StoredRows& rows, int first, int last, std::vector<int> own,
                      std::vector<int> kept)
{
    pattern_.own = std::move(own);
    pattern_.kept = std::move(kept);
    const int n = n_own(), none = std::numeric_limits<int>::max();
    std::vector<std::pair<int, int>> place_of;   // of columns
    place_of.reserve(pattern_.own.size() + pattern_.kept.size());
    for (int i = 0; i < n; ++i) place_of.emplace_back(pattern_.own[i], i);
    for (int i = 0; i < static_cast<int>(pattern_.kept.size()); ++i)
        place_of.emplace_back(pattern_.kept[i], n + i);
    std::ranges::sort(place_of);
    const int lowest = place_of.empty() ? 0 : place_of.front().first;
    const int n_columns = place_of.empty() ? 0 : place_of.back().first - lowest + 1;
    std::vector<int> places(static_cast<std::size_t>(n_columns), -1);
    for (const auto& [column, place] : place_of) places[column - lowest] = place;
    std::vector<int> begin(static_cast<std::size_t>(last - first), none), end(begin.size(), -1);
    for (int r = first; r < last; ++r)
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k) {
            const int place = places[rows.columns[k] - lowest];
            if (place >= n) continue;
            begin[r - first] = std::min(begin[r - first], place);
            end[r - first] = std::max(end[r - first], place);
        }
    pattern_.rows.resize(begin.size());
    for (int r = first; r < last; ++r) pattern_.rows[r - first] = r;
    std::ranges::stable_sort(pattern_.rows, {}, [&](int r) { return begin[r - first]; });
    pattern_.begins.clear();
    pattern_.places.clear();
    pattern_.place_starts.assign(1, 0);
    int reach = -1;
    std::size_t widest = 1;
    for (const int r : pattern_.rows) {
        pattern_.begins.push_back(begin[r - first]);
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k)
            pattern_.places.push_back(places[rows.columns[k] - lowest]);
        pattern_.place_starts.push_back(static_cast<int>(pattern_.places.size()));
        if (begin[r - first] == none) continue;
        reach = std::max(reach, end[r - first]);
        widest = std::max(widest, static_cast<std::size_t>(reach - begin[r - first] + 1));
    }
    pattern_.window = static_cast<int>(std::bit_ceil(widest));
    front_.resize(pattern_.window, static_cast<int>(pattern_.kept.size()));
    x_.assign(pattern_.own.size() + pattern_.kept.size(), 0.0);
}

/// Rows whose first column is k.
void Stretch::enter(const StoredRows& rows, int k, std::size_t& next)
{
    const int n = n_own();
    for (; next < pattern_.rows.size() && pattern_.begins[next] <= k; ++next) {
        const int row = pattern_.rows[next], at = front_.take();
        double* values = front_.row(at);
        std::uint64_t* bits = front_.bits(at);
        const double* value = rows.values.data() + rows.starts[row];
        for (int i = pattern_.place_starts[next]; i < pattern_.place_starts[next + 1]; ++i, ++value) {
            if (*value == 0) continue;
            const int place = pattern_.places[i];
            const int slot = place < n ? front_.slot(place) : pattern_.window + place - n;
            values[slot] = *value;
            bits[slot / 64] |= std::uint64_t{1} << (slot % 64);
            if (place < n) largest_[place] = std::max(largest_[place], std::abs(*value));
        }
        active_.push_back({row, at});
    }
}

/// The rows that hold column k, and of these the one with the largest entry; -1: none is large enough.
int Stretch::choose(int k)
{
    const int slot = front_.slot(k), word = slot / 64;
    const std::uint64_t bit = std::uint64_t{1} << (slot % 64);
    candidates_.clear();
    int pivot = -1;
    double largest = 0;
    for (int i = 0; i < static_cast<int>(active_.size()); ++i) {
        if ((front_.bits(active_[i].place)[word] & bit) == 0) continue;
        candidates_.push_back(i);
        const double size = std::abs(front_.row(active_[i].place)[slot]);
        if (!(size <= largest)) largest = size, pivot = i;
    }
    return std::isfinite(largest) && largest > least_pivot * largest_[k] ? pivot : -1;
}

/// Of a pivot row, without the pivot.
void Stretch::find_runs(int k, const std::uint64_t* bits)
{
    const int here = front_.slot(k), n = n_own(), window = front_.window();
    const std::size_t begin = factors_.runs.size();
    const auto add = [&](int slot, int size) {
        if (factors_.runs.size() > begin) {
            NumberRun& before = factors_.runs.back();
            const int gap = slot - before.slot - before.size;
            const bool is_broken =
                (before.slot < here && slot > here) || (before.slot < window && slot >= window);
            if (gap <= most_between && !is_broken) {
                before.size += gap + size;
                return;
            }
        }
        const int first = slot >= window ? n + slot - window : k + ((slot - k) & (window - 1));
        factors_.runs.push_back({first, slot, size});
    };
    for (int w = 0; w < front_.n_words(); ++w)
        for (std::uint64_t left = bits[w]; left != 0;) {
            const int from = std::countr_zero(left), size = std::countr_one(left >> from);
            const int slot = 64 * w + from, in_window = std::clamp(pattern_.window - slot, 0, size);
            if (in_window > 0) add(slot, in_window);
            if (in_window < size) add(slot + in_window, size - in_window);
            left = from + size == 64 ? 0 : left & (~std::uint64_t{0} << (from + size));
        }
}

/// The pivot row goes into the factors, and is taken off the other candidates.
void Stretch::take_off(int k, int of)
{
    const int slot = front_.slot(k), word = slot / 64;
    const std::uint64_t others = ~(std::uint64_t{1} << (slot % 64));
    const auto [row, place] = active_[of];
    double* values = front_.row(place);
    std::uint64_t* bits = front_.bits(place);
    const double pivot = values[slot];
    values[slot] = 0;
    bits[word] &= others;
    const std::size_t first_run = factors_.runs.size(), first_upper = factors_.upper.size();
    find_runs(k, bits);
    const std::vector<NumberRun>& runs = factors_.runs;
    for (std::size_t r = first_run; r < runs.size(); ++r)
        factors_.upper.insert(factors_.upper.end(), values + runs[r].slot,
                              values + runs[r].slot + runs[r].size);
    for (const int i : candidates_) {
        if (i == of) continue;
        double* y = front_.row(active_[i].place);
        std::uint64_t* own_bits = front_.bits(active_[i].place);
        const double factor = y[slot] / pivot;
        y[slot] = 0;
        own_bits[word] &= others;
        if (factor == 0) continue;
        factors_.lower.push_back({active_[i].row, factor});
        const double* __restrict u = factors_.upper.data() + first_upper;
        for (std::size_t r = first_run; r < runs.size(); ++r) {
            double* __restrict to = y + runs[r].slot;
            const int size = runs[r].size;
            for (int j = 0; j < size; ++j) to[j] -= factor * u[j];
            u += size;
        }
        for (int w = 0; w < front_.n_words(); ++w) own_bits[w] |= bits[w];
    }
    for (std::size_t r = first_run; r < runs.size(); ++r)
        std::fill_n(values + runs[r].slot, runs[r].size, 0.0);
    std::fill_n(bits, front_.n_words(), 0);
    front_.give_back(place);
    active_[of] = active_.back();
    active_.pop_back();
    factors_.rows.push_back(row);
    factors_.diagonal.push_back(pivot);
}

bool Stretch::eliminate(const StoredRows& rows)
{
    const int n = n_own();
    largest_.assign(pattern_.own.size(), 0.0);
    front_.resize(pattern_.window, static_cast<int>(pattern_.kept.size()));
    active_.clear();
    factors_.clear();
    std::size_t next = 0;
    for (int k = 0; k < n; ++k) {
        Patience::ask();
        enter(rows, k, next);
        const int pivot = choose(k);
        if (pivot < 0) return false;
        take_off(k, pivot);
        factors_.end_pivot();
    }
    enter(rows, std::numeric_limits<int>::max(), next);
    leave();
    return true;
}

/// What is left in the front.
void Stretch::leave()
{
    std::ranges::sort(active_, {}, &InFront::row);
    left_.clear();
    left_values_.clear();
    for (const auto& [row, place] : active_) {
        left_.push_back(row);
        const double* values = front_.row(place) + pattern_.window;
        left_values_.insert(left_values_.end(), values, values + pattern_.kept.size());
    }
    active_.clear();
}

void Stretch::forward(double* y) const
{
    for (std::size_t k = 0; k < factors_.rows.size(); ++k) {
        const double value = y[factors_.rows[k]];
        if (value == 0) continue;
        for (std::size_t i = factors_.lower_starts[k]; i < factors_.lower_starts[k + 1]; ++i)
            y[factors_.lower[i].row] -= factors_.lower[i].factor * value;
    }
}

void Stretch::backward(const double* y, double* x) const
{
    const std::size_t n = pattern_.own.size();
    for (std::size_t i = 0; i < pattern_.kept.size(); ++i) x_[n + i] = x[pattern_.kept[i]];
    for (std::size_t k = n; k-- > 0;) {
        const double* u = factors_.upper.data() + factors_.upper_starts[k];
        double sum = y[factors_.rows[k]], other = 0;
        for (std::size_t r = factors_.run_starts[k]; r < factors_.run_starts[k + 1]; ++r) {
            const double* from = x_.data() + factors_.runs[r].first;
            const int size = factors_.runs[r].size;
            int j = 0;
            for (; j + 1 < size; j += 2) {
                sum -= u[j] * from[j];
                other -= u[j + 1] * from[j + 1];
            }
            if (j < size) sum -= u[j] * from[j];
            u += size;
        }
        x_[k] = (sum + other) / factors_.diagonal[k];
    }
    for (std::size_t i = 0; i < n; ++i) x[pattern_.own[i]] = x_[i];
}

}   // namespace livens::inline solvers_internal
