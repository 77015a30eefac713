// SPDX-License-Identifier: BSD-3-Clause
// Some rows of a sparse matrix, and the columns eliminated in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace livens::inline solvers_internal {

/// Leaves what is new in a vector as it comes: all of it is written before it is read.
template <class T>
struct AsItComes : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = AsItComes<U>;
    };
    template <class U>
    void construct(U* at) noexcept
    {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... Values>
    void construct(U* at, Values&&... values)
    {
        ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }
};

/// Rows of a sparse matrix, columns ascending.
struct StoredRows {
    std::vector<int> starts;   ///< one more than there are rows
    std::vector<int, AsItComes<int>> columns;
    std::vector<double, AsItComes<double>> values;

    int size() const { return static_cast<int>(starts.size()) - 1; }
};

/// Rows on their way: dense, over a window of columns that goes with the pivots, and behind it columns that
/// are kept; with a bit for every number that may differ from zero, by rows and, in the window, by columns.
class Front {
public:
    void resize(int window, int n_kept);
    int window() const { return window_; }
    int slot(int column) const { return column & (window_ - 1); }
    int take();   ///< a row of zeros
    void give_back(int row) { free_.push_back(row); }
    double* row(int i)
    {
        return values_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(width_);
    }
    std::uint64_t* bits(int i)
    {
        return bits_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_words_);
    }
    int n_words() const { return n_words_; }
    /// Rows that may differ from zero at a slot of the window.
    std::uint64_t* holders(int slot)
    {
        return holders_.data() + static_cast<std::ptrdiff_t>(slot) * row_words_;
    }
    int row_words() const { return row_words_; }
    void mark(int slot, int row) { holders(slot)[row / 64] |= std::uint64_t{1} << (row % 64); }
    void unmark(int slot, int row) { holders(slot)[row / 64] &= ~(std::uint64_t{1} << (row % 64)); }

private:
    int window_ = 0, width_ = 0, n_words_ = 0, n_rows_ = 0, row_words_ = 1;
    std::vector<double> values_;
    std::vector<std::uint64_t> bits_, holders_;
    std::vector<int> free_;
};

/// Numbers of consecutive columns in a row: the place of the first among own columns, then kept ones; where
/// it stands in the front.
struct NumberRun {
    int first, slot, size;
};

/// What a row was taken of a pivot row.
struct Multiplier {
    int row;
    double factor;
};

/// Rows as they enter, the places of their first own columns, and those of all entries among own columns,
/// then kept ones, as the entries are stored.
struct StretchPattern {
    int window = 1;   ///< own columns between the first and the last that any row in the front sees, at most
    std::vector<int> own, kept;
    std::vector<int> rows, begins;
    std::vector<int, AsItComes<int>> places;
    int first_entry = 0;
};

/// Of every pivot: its row, the pivot, the runs of the rest of its row, and what others were taken of it.
struct StretchFactors {
    std::vector<int> rows;
    std::vector<double> diagonal, upper;
    std::vector<NumberRun> runs;
    std::vector<Multiplier> lower;
    std::vector<std::size_t> run_starts, upper_starts, lower_starts;

    void clear();
    void end_pivot();
    /// For `n` pivots, by those that are there: what follows time goes on as it began. What grows by itself
    /// would take three times its size on the way.
    void reserve(int n);
};

class Stretch {
public:
    /// Rows first..last - 1; `own`: columns to be eliminated, in this order; `kept`: all others that these
    /// rows see. `work`: as many numbers as there are columns.
    void analyse(const StoredRows& rows, std::pair<int, int> of, std::vector<int> own, std::vector<int> kept,
                 std::vector<int>& work);
    /// False: see StaircaseLU.
    bool eliminate(const StoredRows& rows);

    /// Rows without pivots, and of these what is in the kept columns, row after row.
    const std::vector<int>& left() const { return left_; }
    const std::vector<int>& kept() const { return pattern_.kept; }
    const std::vector<double>& left_values() const { return left_values_; }
    long long n_entries() const
    {
        return static_cast<long long>(factors_.upper.size() + factors_.lower.size() + factors_.rows.size());
    }

    long long flops() const;   ///< of products with pivot rows

    /// y, by rows of the matrix: what eliminations do to it.
    void forward(double* y) const;
    /// x, by columns of the matrix, from y and the kept ones, which it has.
    void backward(const double* y, double* x) const;

private:
    int n_own() const { return static_cast<int>(pattern_.own.size()); }
    void enter(const StoredRows& rows, int k, std::size_t& next);
    int choose(int k);
    void find_runs(int k, const std::uint64_t* bits);
    void take_bits(const std::uint64_t* bits, std::pair<int, int> words, int place);
    void take_off(int k, int pivot_place);
    void drop(int place, std::size_t first_run);
    void leave();

    StretchPattern pattern_;
    StretchFactors factors_;
    std::vector<double> largest_;   // of own columns
    Front front_;
    std::vector<int> row_at_;       // of the matrix, at every place of the front; -1: it is free
    std::vector<int> candidates_;   // places, for the pivot at hand
    std::vector<int> left_;
    std::vector<double> left_values_;
    mutable std::vector<double> x_;
};

}   // namespace livens::inline solvers_internal
