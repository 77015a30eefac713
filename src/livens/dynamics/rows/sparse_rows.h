// SPDX-License-Identifier: BSD-3-Clause
// Rows that each touch few columns, and solutions with G G^T by elimination: their cost grows with their
// number where they hang together like the joints of a tree.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace livens {

/// The rows of a sparse matrix G and a Cholesky factor of G G^T.
class SparseRows {
public:
    /// The smallest pivot at which project() comes to rounding.
    static constexpr double well_held = 1e-5;

    struct Entry {
        int row, column;
        double value;
    };
    /// Entries of the same place are added.
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
    std::unique_ptr<Matrices> matrices_;
    double smallest_pivot_ = 0;
};

}   // namespace livens
