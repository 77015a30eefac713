// SPDX-License-Identifier: BSD-3-Clause
// The whole matrix of a block, and the sparse matrix that it is put into.
#pragma once

#include <utility>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/spacetime/mixed/element_sums.h"
#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

/// Entries that are made again and again in one order: their places are found once.
class MatrixPattern {
public:
    /// Places are taken down from here on.
    void collect();
    void take_down(int row, int column) { places_.emplace_back(row, column); }
    void end_part() { parts_.push_back(places_.size()); }
    /// Gives J the pattern of these places.
    void make(int size, SparseMatrix& J);
    /// Of the entries of a part: where each stands among the values of the matrix.
    const int* slots(int part) const { return slots_.data() + parts_[static_cast<std::size_t>(part)]; }

private:
    std::vector<std::pair<int, int>> places_;
    std::vector<std::size_t> parts_;   // begins of elements, and of what stands at the ends of time
    std::vector<int> slots_;
};

/// Those of rows low..high - 1, added to the values of a matrix; or taken down, where there are none.
struct EntrySink {
    MatrixPattern* pattern = nullptr;
    double* values = nullptr;
    const int* slots = nullptr;
    int low = 0, high = 0;

    void add(int row, int column, double value)
    {
        if (values == nullptr) return pattern->take_down(row, column);
        const int slot = *slots++;
        if (row >= low && row < high) values[slot] += value;
    }
};

/// d(residual)/d(unknowns) of a block's equations, which must outlive it.
class Tangent {
public:
    explicit Tangent(const Equations& equations);

    /// The matrix at `fields`. Returns whether its pattern differs from the last one.
    bool evaluate(const Fields& fields, SparseMatrix& J);

private:
    void make_pattern(SparseMatrix& J);
    void add_share(const Fields& fields, SparseMatrix& J, int slot, std::pair<int, int> functions);
    void add_element(int e, const ElementSums& sums, EntrySink& entries) const;
    void add_momenta(int e, const ElementSums& sums, EntrySink& entries) const;
    void add_forces(int e, const ElementSums& sums, EntrySink& entries) const;
    void add_constraints(int e, const ElementSums& sums, EntrySink& entries) const;
    void add_boundary(const Fields* fields, EntrySink& entries) const;
    int first_row(int function) const;

    const Equations& equations_;
    const FieldSpace& space_;
    std::vector<ElementSums> sums_;   // of each thread
    MatrixPattern pattern_;
};

}   // namespace livens::mixed
