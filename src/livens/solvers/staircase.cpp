// SPDX-License-Identifier: BSD-3-Clause
// Stretches of a sparse matrix eliminated apart from each other, and joined by what is left of them
// (theory.md, "The chain", "Stretches").
#include "livens/solvers/staircase.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "livens/solvers/crew.h"
#include "livens/solvers/detail/stretch.h"

namespace livens::inline solvers_internal {

namespace {

constexpr int several = -1;               // whose column it is
constexpr int least_shared_rows = 1000;   // that a thread copies

/// The pattern row by row, and where their entries stand in the matrix.
/// A thread goes through all columns and takes the entries of its rows: each row is filled by one thread, in
/// the order of columns.
void take_rows(const SparseMatrix& A, StoredRows& rows, std::vector<int, AsItComes<int>>& places)
{
    rows.starts.assign(static_cast<std::size_t>(A.size) + 1, 0);
    rows.columns.resize(A.rows.size());
    rows.values.resize(A.rows.size());
    places.resize(A.rows.size());
    // act(row, entry, column), columns ascending, of the rows of a share; a column's rows ascend
    const auto for_entries = [&](int begin, int end, const auto& act) {
        for (int c = 0; c < A.size; ++c) {
            const int first = A.column_starts[c], last = A.column_starts[c + 1];
            if (first == last || A.rows[first] >= end || A.rows[last - 1] < begin) continue;
            const bool is_whole = A.rows[first] >= begin && A.rows[last - 1] < end;
            for (int k = first; k < last; ++k)
                if (is_whole || (A.rows[k] >= begin && A.rows[k] < end)) act(A.rows[k], k, c);
        }
    };
    in_shares(A.size, least_shared_rows, [&](int, int begin, int end) {
        for_entries(begin, end, [&](int row, int, int) { ++rows.starts[row + 1]; });
    });
    std::partial_sum(rows.starts.begin(), rows.starts.end(), rows.starts.begin());
    std::vector<int> next(rows.starts.begin(), rows.starts.end() - 1);
    in_shares(A.size, least_shared_rows, [&](int, int begin, int end) {
        for_entries(begin, end, [&](int row, int entry, int column) {
            const int at = next[row]++;
            rows.columns[at] = column;
            places[at] = entry;
        });
    });
}

}   // namespace

struct StaircaseLU::Parts {
    StoredRows rows;                           // of the matrix
    std::vector<int, AsItComes<int>> places;   // of their entries among its values
    std::vector<Stretch> stretches;
    StoredRows left;   // what is left of them, in shared columns
    Stretch last;
};

StaircaseLU::StaircaseLU() : parts_(std::make_unique<Parts>()) {}
StaircaseLU::~StaircaseLU() = default;

int StaircaseLU::n_stretches() const { return static_cast<int>(parts_->stretches.size()); }

void StaircaseLU::analyse(const SparseMatrix& A, std::span<const int> cuts)
{
    size_ = A.size;
    take_rows(A, parts_->rows, parts_->places);
    const StoredRows& rows = parts_->rows;
    const int n = std::max(static_cast<int>(cuts.size()) - 1, 0);
    first_behind_ = n > 0 ? cuts.back() : 0;
    std::vector<int> stretch_of(static_cast<std::size_t>(size_), several);   // of rows
    for (int s = 0; s < n; ++s) std::fill(stretch_of.begin() + cuts[s], stretch_of.begin() + cuts[s + 1], s);
    std::vector<int> owner(static_cast<std::size_t>(size_), several);
    for (int c = 0; c < size_; ++c) {
        if (A.column_starts[c] == A.column_starts[c + 1]) continue;
        // rows ascend, and so do their stretches
        const int of_first = stretch_of[A.rows[A.column_starts[c]]],
                  of_last = stretch_of[A.rows[A.column_starts[c + 1] - 1]];
        if (of_first == of_last) owner[c] = of_first;
    }
    shared_.clear();
    column_places_.assign(static_cast<std::size_t>(size_), -1);
    for (int c = 0; c < size_; ++c)
        if (owner[c] < 0) {
            column_places_[c] = static_cast<int>(shared_.size());
            shared_.push_back(c);
        }
    std::vector<std::vector<int>> own(static_cast<std::size_t>(n)), kept(own);
    std::vector<std::vector<int>> work(static_cast<std::size_t>(Crew::size()));
    for (std::vector<int>& columns : own) columns.reserve(static_cast<std::size_t>(size_ / n));
    for (int c = 0; c < size_; ++c) {
        if (owner[c] >= 0) own[owner[c]].push_back(c);
        for (int k = A.column_starts[c]; owner[c] < 0 && k < A.column_starts[c + 1]; ++k) {
            const int s = stretch_of[A.rows[k]];
            if (s >= 0 && (kept[s].empty() || kept[s].back() != c)) kept[s].push_back(c);
        }
    }
    parts_->stretches.clear();
    parts_->stretches.resize(static_cast<std::size_t>(n));
    in_shares(n, 1, [&](int slot, int begin, int end) {
        work[slot].resize(static_cast<std::size_t>(size_));
        for (int s = begin; s < end; ++s) {
            // from both ends of time towards the middle: nothing of the ends is kept then
            if (s > 0 && s == n - 1) std::ranges::reverse(own[s]);
            parts_->stretches[s].analyse(rows, {cuts[s], cuts[s + 1]}, std::move(own[s]), std::move(kept[s]),
                                         work[slot]);
        }
    });
    values_.assign(static_cast<std::size_t>(size_), 0.0);
}

/// A stretch is one thread's, so that no sum depends on how many there are.
bool StaircaseLU::factorise(const SparseMatrix& A)
{
    assert(A.size == size_ && A.values.size() == parts_->places.size());
    StoredRows& rows = parts_->rows;
    in_shares(size_, least_shared_rows, [&](int, int begin, int end) {
        for (int k = rows.starts[begin]; k < rows.starts[end]; ++k)
            rows.values[k] = A.values[parts_->places[k]];
    });
    std::vector<char> is_done(parts_->stretches.size());
    for_each_item(n_stretches(), 1, [&](int s) { is_done[s] = parts_->stretches[s].eliminate(rows); });
    return std::ranges::all_of(is_done, [](char is) { return is != 0; }) && join();
}

/// What is left, in shared columns, then rows behind all stretches.
bool StaircaseLU::join()
{
    parts_->left.starts.assign(1, 0);
    parts_->left.columns.clear();
    parts_->left.values.clear();
    const auto add = [&](int column, double value) {
        if (value == 0) return;
        parts_->left.columns.push_back(column_places_[column]);
        parts_->left.values.push_back(value);
    };
    for (const Stretch& s : parts_->stretches) {
        const double* value = s.left_values().data();
        for (std::size_t i = 0; i < s.left().size(); ++i) {
            for (const int column : s.kept()) add(column, *value++);
            parts_->left.starts.push_back(static_cast<int>(parts_->left.columns.size()));
        }
    }
    for (int r = first_behind_; r < size_; ++r) {
        for (int k = parts_->rows.starts[r]; k < parts_->rows.starts[r + 1]; ++k)
            add(parts_->rows.columns[k], parts_->rows.values[k]);
        parts_->left.starts.push_back(static_cast<int>(parts_->left.columns.size()));
    }
    if (parts_->left.size() != std::ssize(shared_)) return false;
    std::vector<int> all(shared_.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<int> work(all);
    parts_->last.analyse(parts_->left, {0, parts_->left.size()}, std::move(all), {}, work);
    return parts_->last.eliminate(parts_->left);
}

void StaircaseLU::solve(std::span<const double> b, std::span<double> x) const
{
    std::ranges::copy(b, values_.begin());
    for_each_item(n_stretches(), 1, [&](int s) { parts_->stretches[s].forward(values_.data()); });
    shared_values_.clear();
    for (const Stretch& s : parts_->stretches)
        for (const int row : s.left()) shared_values_.push_back(values_[row]);
    shared_values_.insert(shared_values_.end(), values_.begin() + first_behind_, values_.end());
    parts_->last.forward(shared_values_.data());
    parts_->last.backward(shared_values_.data(), shared_values_.data());
    for (std::size_t i = 0; i < shared_.size(); ++i) x[shared_[i]] = shared_values_[i];
    for_each_item(n_stretches(), 1, [&](int s) { parts_->stretches[s].backward(values_.data(), x.data()); });
}

void StaircaseLU::subtract_product(std::span<const double> x, std::span<double> y) const
{
    const StoredRows& rows = parts_->rows;
    for_each_item(size_, least_shared_rows, [&](int r) {
        double sum = 0;
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k) sum += rows.values[k] * x[rows.columns[k]];
        y[r] -= sum;
    });
}

long long StaircaseLU::factor_entries() const
{
    long long n = parts_->last.n_entries();
    for (const Stretch& s : parts_->stretches) n += s.n_entries();
    return n;
}

}   // namespace livens::inline solvers_internal
