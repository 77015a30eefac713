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

/// Pivots after which more of the same kind are foreseen.
constexpr int least_foreseen = 100;

/// Pivots below that share of their column's largest entry are none.
constexpr double least_pivot = 1e-10;

}   // namespace

/// The window is a power of two: slots are the last bits of column numbers, and go on without any copies.
void Front::resize(int window, int n_kept)
{
    window_ = window;
    width_ = window + n_kept;
    n_words_ = (width_ + 63) / 64;
    n_rows_ = 0;
    values_.clear();
    bits_.clear();
    free_.clear();
    row_words_ = 1;
    holders_.assign(static_cast<std::size_t>(window), 0);
}

/// Places of rows that have left are taken first, so that there are as many as ever stand in it at once.
int Front::take()
{
    if (free_.empty()) {
        free_.push_back(n_rows_++);
        values_.resize(static_cast<std::size_t>(n_rows_) * static_cast<std::size_t>(width_), 0.0);
        bits_.resize(static_cast<std::size_t>(n_rows_) * static_cast<std::size_t>(n_words_), 0);
        if (n_rows_ > 64 * row_words_) {
            std::vector<std::uint64_t> more(static_cast<std::size_t>(2 * row_words_ * window_), 0);
            for (int slot = 0; slot < window_; ++slot)
                std::copy_n(holders(slot), row_words_,
                            more.data() + static_cast<std::ptrdiff_t>(slot) * 2 * row_words_);
            holders_ = std::move(more);
            row_words_ *= 2;
        }
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

void StretchFactors::reserve(int n)
{
    const double share = 1.3 * n / static_cast<double>(rows.size());
    const auto foresee = [&](auto& numbers) {
        numbers.reserve(static_cast<std::size_t>(share * static_cast<double>(numbers.size())));
    };
    foresee(rows);
    foresee(diagonal);
    foresee(upper);
    foresee(runs);
    foresee(lower);
    for (auto* starts : {&run_starts, &upper_starts, &lower_starts}) foresee(*starts);
}

void StretchFactors::end_pivot()
{
    run_starts.push_back(runs.size());
    upper_starts.push_back(upper.size());
    lower_starts.push_back(lower.size());
}

void Stretch::analyse(const StoredRows& rows, std::pair<int, int> of, std::vector<int> own,
                      std::vector<int> kept, std::vector<int>& work)
{
    pattern_.own = std::move(own);
    pattern_.kept = std::move(kept);
    const auto [first, last] = of;
    const int n = n_own(), n_kept = static_cast<int>(pattern_.kept.size());
    for (int i = 0; i < n; ++i) work[pattern_.own[i]] = i;
    for (int i = 0; i < n_kept; ++i) work[pattern_.kept[i]] = n + i;
    pattern_.first_entry = rows.starts[first];
    pattern_.places.resize(static_cast<std::size_t>(rows.starts[last] - rows.starts[first]));
    // of rows, n: they see no own column; and how many begin before a place
    std::vector<int> begins(static_cast<std::size_t>(last - first)), ends(begins);
    std::vector<int> n_before(static_cast<std::size_t>(n) + 2, 0);
    int* place = pattern_.places.data();
    for (int r = first; r < last; ++r) {
        int begin = n, end = -1;
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k) {
            const int at = work[rows.columns[k]];
            *place++ = at;
            begin = std::min(begin, at);
            end = at < n ? std::max(end, at) : end;
        }
        begins[r - first] = begin;
        ends[r - first] = end;
        ++n_before[begin + 1];
    }
    for (int i = 0; i <= n; ++i) n_before[i + 1] += n_before[i];
    pattern_.rows.resize(begins.size());
    pattern_.begins.resize(begins.size());
    for (int r = first; r < last; ++r) {
        const int at = n_before[begins[r - first]]++;
        pattern_.rows[at] = r;
        pattern_.begins[at] = begins[r - first];
    }
    int reach = -1;
    std::size_t widest = 1;
    for (const int r : pattern_.rows) {
        if (begins[r - first] == n) break;
        reach = std::max(reach, ends[r - first]);
        widest = std::max(widest, static_cast<std::size_t>(reach - begins[r - first] + 1));
    }
    pattern_.window = static_cast<int>(std::bit_ceil(widest));
    front_.resize(pattern_.window, n_kept);
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
        for (int i = rows.starts[row]; i < rows.starts[row + 1]; ++i) {
            const double value = rows.values[i];
            if (value == 0) continue;
            const int place = pattern_.places[i - pattern_.first_entry];
            const int slot = place < n ? front_.slot(place) : pattern_.window + place - n;
            values[slot] = value;
            bits[slot / 64] |= std::uint64_t{1} << (slot % 64);
            if (place >= n) continue;
            front_.mark(slot, at);
            largest_[place] = std::max(largest_[place], std::abs(value));
        }
        if (at >= std::ssize(row_at_)) row_at_.resize(static_cast<std::size_t>(at) + 1, -1);
        row_at_[at] = row;
    }
}

/// The rows that hold column k, and of these the one with the largest entry; -1: none is large enough.
int Stretch::choose(int k)
{
    const int slot = front_.slot(k);
    candidates_.clear();
    int pivot = -1;
    double largest = 0;
    const std::uint64_t* holders = front_.holders(slot);
    for (int w = 0; w < front_.row_words(); ++w)
        for (std::uint64_t left = holders[w]; left != 0; left &= left - 1) {
            const int place = 64 * w + std::countr_zero(left);
            candidates_.push_back(place);
            const double size = std::abs(front_.row(place)[slot]);
            // what is no number stays, and is refused below
            if (!(size <= largest) && !std::isnan(largest)) largest = size, pivot = place;
        }
    return std::isfinite(largest) && largest > least_pivot * largest_[k] ? pivot : -1;
}

/// Of a pivot row, without the pivot.
/// A run ends at the pivot's slot, where the window has its last column beside its first one, and at the
/// window's end: behind either its columns would not follow each other.
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

/// What a row takes over of the places of another one's numbers.
void Stretch::take_bits(const std::uint64_t* bits, std::pair<int, int> words, int place)
{
    std::uint64_t* own = front_.bits(place);
    for (int w = words.first; w < words.second; ++w) {
        std::uint64_t fresh = bits[w] & ~own[w];
        own[w] |= bits[w];
        for (; fresh != 0; fresh &= fresh - 1) {
            const int slot = 64 * w + std::countr_zero(fresh);
            if (slot >= front_.window()) break;
            front_.mark(slot, place);
        }
    }
}

/// The pivot row goes into the factors, and is taken off the other candidates.
void Stretch::take_off(int k, int pivot_place)
{
    const int slot = front_.slot(k), word = slot / 64;
    const std::uint64_t others = ~(std::uint64_t{1} << (slot % 64));
    double* values = front_.row(pivot_place);
    std::uint64_t* bits = front_.bits(pivot_place);
    const double pivot = values[slot];
    values[slot] = 0;
    bits[word] &= others;
    const std::size_t first_run = factors_.runs.size(), first_upper = factors_.upper.size();
    find_runs(k, bits);
    const std::vector<NumberRun>& runs = factors_.runs;
    for (std::size_t r = first_run; r < runs.size(); ++r)   // short
        for (int i = 0; i < runs[r].size; ++i) factors_.upper.push_back(values[runs[r].slot + i]);
    std::pair<int, int> words{0, front_.n_words()};   // with bits
    while (words.first < words.second && bits[words.first] == 0) ++words.first;
    while (words.first < words.second && bits[words.second - 1] == 0) --words.second;
    for (const int place : candidates_) {
        if (place == pivot_place) continue;
        double* y = front_.row(place);
        const double factor = y[slot] / pivot;
        y[slot] = 0;
        front_.bits(place)[word] &= others;
        if (factor == 0) continue;
        factors_.lower.push_back({row_at_[place], factor});
        const double* __restrict u = factors_.upper.data() + first_upper;
        for (std::size_t r = first_run; r < runs.size(); ++r) {
            double* __restrict to = y + runs[r].slot;
            const int size = runs[r].size;
            for (int j = 0; j < size; ++j) to[j] -= factor * u[j];
            u += size;
        }
        take_bits(bits, words, place);
    }
    factors_.rows.push_back(row_at_[pivot_place]);
    factors_.diagonal.push_back(pivot);
    std::fill_n(front_.holders(slot), front_.row_words(), 0);
    drop(pivot_place, first_run);
}

/// A pivot row leaves the front; its runs begin at `first_run`.
void Stretch::drop(int place, std::size_t first_run)
{
    double* values = front_.row(place);
    std::uint64_t* bits = front_.bits(place);
    const std::vector<NumberRun>& runs = factors_.runs;
    for (std::size_t r = first_run; r < runs.size(); ++r)
        for (int slot = runs[r].slot; slot < runs[r].slot + runs[r].size; ++slot) {
            values[slot] = 0;
            if (slot < front_.window()) front_.unmark(slot, place);
        }
    std::fill_n(bits, front_.n_words(), 0);
    front_.give_back(place);
    row_at_[place] = -1;
}

bool Stretch::eliminate(const StoredRows& rows)
{
    const int n = n_own();
    largest_.assign(pattern_.own.size(), 0.0);
    front_.resize(pattern_.window, static_cast<int>(pattern_.kept.size()));
    row_at_.clear();
    factors_.clear();
    std::size_t next = 0;
    for (int k = 0; k < n; ++k) {
        Patience::ask();
        enter(rows, k, next);
        const int pivot = choose(k);
        if (pivot < 0) return false;
        take_off(k, pivot);
        factors_.end_pivot();
        if (k == n / 16 && k > least_foreseen) factors_.reserve(n);
    }
    enter(rows, std::numeric_limits<int>::max(), next);
    leave();
    return true;
}

/// What is left in the front.
void Stretch::leave()
{
    std::vector<std::pair<int, int>> rows;   // of the matrix, and their places
    for (int place = 0; place < static_cast<int>(row_at_.size()); ++place)
        if (row_at_[place] >= 0) rows.emplace_back(row_at_[place], place);
    std::ranges::sort(rows);
    left_.clear();
    left_values_.clear();
    for (const auto& [row, place] : rows) {
        left_.push_back(row);
        const double* values = front_.row(place) + pattern_.window;
        left_values_.insert(left_values_.end(), values, values + pattern_.kept.size());
    }
    row_at_.clear();
}

long long Stretch::flops() const
{
    long long n = 0;
    for (std::size_t k = 0; k < factors_.rows.size(); ++k)
        n += 2 * static_cast<long long>(factors_.lower_starts[k + 1] - factors_.lower_starts[k]) *
             static_cast<long long>(factors_.upper_starts[k + 1] - factors_.upper_starts[k]);
    return n;
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

/// Two sums, of even and of odd terms: neither has to wait for the addition of the other.
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
