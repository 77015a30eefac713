// SPDX-License-Identifier: BSD-3-Clause
// Some of a dense matrix' unknowns eliminated from all of its rows.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace livens::inline solvers_internal {

/// A matrix with at least as many rows as pivots, row by row: the columns of its first unknowns, the pivots,
/// are eliminated; what is left of the other rows is free of them.
///
/// By rows exchanged, or by reflections, which never let entries grow. Either way P A = [U T; 0 rest] with an
/// invertible P.
class Panel {
public:
    void resize(int n_rows, int n_pivots, int n_others);
    int n_rows() const { return n_rows_; }
    int n_pivots() const { return n_pivots_; }
    int n_left() const { return n_rows_ - n_pivots_; }   ///< rows without pivots
    int width() const { return width_; }
    double* row(int i) { return a_.data() + place(i); }
    const double* row(int i) const { return a_.data() + place(i); }
    void clear();

    /// Pivots come from the first rows while these are not smaller by far than the others. Columns of the
    /// first rows from `reach` on must be zero. False: a column depends on those before, or is not finite.
    bool eliminate(int n_first, int reach);
    bool reflect();   ///< the same by reflections
    /// Column that ended the last of these with false.
    int failed_column() const { return failed_; }
    double largest() const;        ///< |entry| of all rows
    double largest_left() const;   ///< of the rows that are left, without pivots
    double smallest_pivot() const;

    /// n_rows numbers: x <- P x.
    void apply(double* x) const;
    /// x, width numbers: the first, of pivots <- U^-1 (x - T others), the others behind them.
    void solve(double* x) const;
    /// x <- U^-T x, others -= T^T x.
    void solve_transposed(double* x, double* others) const;
    /// x, n_rows numbers <- P^T x.
    void apply_transposed(double* x) const;

private:
    std::size_t place(int i) const { return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride_); }
    /// The largest number of a column so far.
    struct Candidate {
        int row = -1;
        double size = -1;

        void look(int i, double here)
        {
            if (!(here > size)) return;
            row = i;
            size = here;
        }
    };
    Candidate candidate(int k, bool first_alone) const;
    bool choose_pivot(int k, const Candidate& best);
    void exchange(int i, int j);
    template <int n>
    Candidate eliminate_column(int k);
    bool eliminate_block(int first, int end);
    void subtract(int first, int last, std::pair<int, int> of, int from);
    bool reflect_column(int k);
    void reflect_vector(int k, double* x) const;

    int n_rows_ = 0, n_pivots_ = 0, width_ = 0, stride_ = 0;   // from row to row: zeros behind each
    int failed_ = -1;
    std::vector<double> a_;
    std::vector<int> exchanged_, reach_;   // of pivots: the row taken; of rows: columns from here on are zero
    std::vector<char> is_first_;           // rows that pivots come from while they can
    std::vector<double> beta_;             // of reflections I - beta v v^T, v_k = 1; empty: rows exchanged
};

}   // namespace livens::inline solvers_internal
