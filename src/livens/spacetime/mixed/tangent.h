// SPDX-License-Identifier: BSD-3-Clause
// The whole matrix of a block, and the sparse matrix that it is put into.
#pragma once

#include <utility>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/spacetime/mixed/element_sums.h"
#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

/// Entries that are made again and again in one order: their places are found once, then values are added.
class MatrixEntries {
public:
    /// add() takes down places from here on.
    void collect();
    /// Gives J the pattern of these places.
    void make_pattern(int size, SparseMatrix& J);
    /// add() adds to the values of J from here on, which begin with zero.
    void begin(SparseMatrix& J);
    void add(int row, int column, double value)
    {
        if (values_ != nullptr)
            values_[slots_[next_++]] += value;
        else
            take_down(row, column);
    }

private:
    void take_down(int row, int column);

    std::vector<std::pair<int, int>> places_;
    std::vector<int> slots_;   ///< place in the matrix of every entry
    double* values_ = nullptr;
    std::size_t next_ = 0;
};

/// d(residual)/d(unknowns) of a block's equations, which must outlive it.
class Tangent {
public:
    explicit Tangent(const Equations& equations);

    /// The matrix at `fields`. Returns whether its pattern differs from the last one.
    bool evaluate(const Fields& fields, SparseMatrix& J);

private:
    void make_pattern(SparseMatrix& J);
    void add_all(const Fields* fields);
    void add_momenta(int e);
    void add_forces(int e);
    void add_constraints(int e);
    void add_boundary(const Fields* fields);

    const Equations& equations_;
    const FieldSpace& space_;
    ElementSums sums_;
    MatrixEntries entries_;
};

}   // namespace livens::mixed
