// SPDX-License-Identifier: BSD-3-Clause
// Sparse matrices by their entries. Rows that each touch few columns, and solutions with G G^T by
// elimination: their cost grows with their number where they hang together like the joints of a tree. Square
// matrices that are solved with once.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace livens::inline solvers_internal {

/// Entries of the same place are added.
struct SparseEntry {
    int row, column;
    double value;
};

/// The rows of a sparse matrix G and a Cholesky factor of G G^T.
class SparseRows {
public:
    /// The smallest pivot at which project() comes to rounding.
    static constexpr double well_held = 1e-5;

    using Entry = SparseEntry;
    SparseRows(int n_rows, int n_columns, std::span<const Entry> entries);
    ~SparseRows();
    SparseRows(const SparseRows&) = delete;
    SparseRows& operator=(const SparseRows&) = delete;

    /// The smallest ratio of a row, less what the rows eliminated before it hold, to the row; 0 where there
    /// is no factor. Half the digits of a double are lost at 1e-8: so much is not told from zero.
    double smallest_pivot() const { return smallest_pivot_; }
    /// y <- the y nearest to it with G y = wanted. Needs a factor. Each pass leaves rounding / pivot^2 of
    /// what it was to take off. Returns mu with y before = y + G^T mu.
    std::vector<double> project(std::span<double> y, std::span<const double> wanted) const;

private:
    struct Matrices;
    struct FewRows;
    std::unique_ptr<Matrices> matrices_;   // or
    std::unique_ptr<FewRows> few_;
    double smallest_pivot_ = 0;
};

/// A^-1 b of a square matrix, by LU with exchanges of rows for the size of pivots and of columns for sparse
/// factors. Nothing where A is singular to the library or not
/// finite. Throws std::bad_alloc alone.
std::optional<std::vector<double>> sparse_solution(std::span<const SparseEntry> A, std::span<const double> b);

}   // namespace livens::inline solvers_internal
