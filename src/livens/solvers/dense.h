// SPDX-License-Identifier: BSD-3-Clause
// Small dense factorisations on plain arrays: LU, orthogonal bases of constraint rows, Cholesky.
//
// They run thousands of times a second on matrices of 2 to a few hundred unknowns, so they allocate nothing
// after `resize` and leave exact zeros exact (a planar motion stays planar to the bit).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace livens::inline solvers_internal {

struct RowFunctions;

/// LU with row exchanges of a square matrix stored row by row.
class DenseLU {
public:
    void resize(int n);
    int size() const { return n_; }
    /// Entry (i, j) is row(i)[j]; fill before factorise(), which overwrites it.
    double* row(int i) { return a_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_); }

    /// False if a pivot is zero or not finite. Rows should be of like size (here: in the mass metric).
    bool factorise();
    /// x <- A^-1 x.
    void solve(double* x) const;
    /// x <- A^-T x.
    void solve_transposed(double* x) const;

    /// Exchanges the entries for as many others, row by row: a matrix is factorised where it was made.
    void exchange(std::vector<double>& entries);
    /// Column whose pivot made the last factorise() return false: it depends on those before, or is not
    /// finite.
    int failed_column() const { return failed_; }
    /// Smallest |u_kk| (1 if n = 0) and largest |u_ij|, after a factorise() that returned true.
    double smallest_pivot() const;
    double largest_in_U() const;

private:
    const double* row(int i) const
    {
        return a_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_);
    }
    void eliminate_pair(int k);
    bool choose_pivot(int k);

    int n_ = 0;
    int failed_ = -1;
    std::vector<double> a_;
    std::vector<int> pivot_;
};

/// Of an OrthogonalBasis.
struct Reflection {
    double beta = 0;     // H_j = I - beta v v^T
    double sign = 1;     // of R_jj
    double norm = 0;     // of the column, squared, as far as it is not reduced
    int lead = 0;        // row exchanged with row j before
    int end = 0;         // entries from here on are zero
    int reach = 0;       // rows from here on it leaves alone, the exchange included
    int all_reach = 0;   // likewise this one and all before it
    int used = -1;       // how many entries are not zero, if they are few; else -1
    int filled_first = 0, filled_end = 0;   // of the column before factorise(), what may not be zero
};

/// QR of a tall matrix, given by its k columns of length n, by Householder reflections: A = Q [R; 0].
/// The last n - k columns of Q span the null space of A^T.
///
/// Each reflection leads with the largest entry of its column [Powell1969]. It then touches only
/// rows where the column is not zero, so unknowns that do not see each other (a plane and its normal) stay
/// apart to the bit.
class OrthogonalBasis {
public:
    /// `most` columns at most.
    void resize(int n, int most);
    int n() const { return n_; }
    int rank() const { return k_; }
    /// Column j is filled in by the caller before factorise(); overwritten by it.
    double* column(int j) { return g_.data() + j * stride_; }

    /// Entries of column j that may not be zero, first..end - 1: else it is looked through by factorise().
    void reach_of(int j, int first, int end)
    {
        reflections_[static_cast<std::size_t>(j)].filled_first = first;
        reflections_[static_cast<std::size_t>(j)].filled_end = end;
    }

    /// Factorises the first k columns in their order. Returns the smallest |R_jj| (1 if k = 0).
    /// `keep_choices` leads with the entries, and takes the signs, of the last call, so that the basis varies
    /// smoothly with the matrix; the usual choices jump where two entries are of one size.
    double factorise(int k, bool keep_choices = false);
    /// Factorises `most` columns with column exchanges and stops at `k` columns; order[j] tells which came
    /// j-th.
    double factorise_pivoted(int k, std::span<int> order);

    void apply_transposed(double* x) const;     ///< x <- Q^T x
    void apply(double* x) const;                ///< x <- Q x
    void solve_R(double* y) const;              ///< y <- R^-1 y
    void solve_R_transposed(double* y) const;   ///< y <- R^-T y
    /// The null space, n x (n - k), row by row.
    void null_space(double* z) const;

private:
    void lead(int j, bool keep, int end);
    void reflect(int j, bool keep_sign, int behind);
    int reflect_by_all_before(int j, const RowFunctions& rows);
    int reflect_by_those_before(int j, const RowFunctions& rows);
    void reflect_column(int j, double* x, const RowFunctions& rows) const;
    void reflect_only(int j, double* x, const RowFunctions& rows) const;
    void reflect_rows(int j, double* z, const RowFunctions& rows) const;
    const double* column(int j) const { return g_.data() + j * stride_; }

    int n_ = 0;
    int most_ = 0;
    int k_ = 0;
    std::ptrdiff_t stride_ = 0;   // room for a register behind each column
    std::vector<double> g_;   // R above the diagonal, reflectors (first entry 1 implied) below
    std::vector<Reflection> reflections_;
    std::vector<int> places_;   // of their entries that are not zero, n a reflection
};

/// Cholesky factorisation of a symmetric positive definite matrix stored row by row.
class Cholesky {
public:
    void resize(int n);
    double* row(int i) { return a_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_); }
    /// Uses the lower triangle; false if the matrix is not positive definite.
    bool factorise();
    void solve(double* x) const;

private:
    const double* row(int i) const
    {
        return a_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_);
    }

    int n_ = 0;
    std::vector<double> a_;
};

}   // namespace livens::inline solvers_internal
