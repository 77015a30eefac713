// SPDX-License-Identifier: BSD-3-Clause
// LU of sparse matrices that follow time, in stretches that do not wait for each other.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/solvers/sparse.h"

namespace livens::inline solvers_internal {

/// Rows are divided into stretches; the columns that one of them alone sees are eliminated in it, in their
/// order (in the last one from the end), each with the largest entry of the rows of the stretch that hold it
/// as pivot. What is left of all rows, in the columns that several of them see, makes one more stretch.
///
/// Natural order, as of SparseLU's Eigen, which is the reference for tests; zeros are left out, exact ones
/// that come on the way as well. Stretches share threads; no bit depends on these.
class StaircaseLU {
public:
    StaircaseLU();
    ~StaircaseLU();
    StaircaseLU(const StaircaseLU&) = delete;
    StaircaseLU& operator=(const StaircaseLU&) = delete;

    /// `cuts`: first rows of stretches, then the end of the last; rows behind it see what they like, and are
    /// eliminated at the end.
    void analyse(const SparseMatrix& A, std::span<const int> cuts);
    /// False: an entry is not finite, or some column is all but dependent on those before in its stretch
    /// (pivots below 1e-10 of the column's largest entry): another solver may still do. `A` is not kept.
    bool factorise(const SparseMatrix& A);
    /// x = A^-1 b; they may be the same.
    void solve(std::span<const double> b, std::span<double> x) const;
    /// y -= A x with the matrix of the last factorise().
    void subtract_product(std::span<const double> x, std::span<double> y) const;
    long long factor_entries() const;

private:
    struct Parts;
    int n_stretches() const;
    bool join();

    int size_ = 0;
    std::vector<int> shared_;          // columns that several stretches see
    std::vector<int> column_places_;   // of every column in shared_; -1: it belongs to a stretch
    int first_behind_ = 0;             // row
    std::unique_ptr<Parts> parts_;
    mutable std::vector<double> values_, shared_values_;
};

}   // namespace livens::inline solvers_internal
