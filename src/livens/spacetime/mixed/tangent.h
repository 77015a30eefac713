// SPDX-License-Identifier: BSD-3-Clause
// The whole matrix of a block, and the sparse matrix that it is put into.
#pragma once

#include <utility>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/spacetime/mixed/element_sums.h"
#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

/// An element whose places are taken down, or follow from those of another one.
struct PlacedElement {
    std::size_t begin;   ///< of its places, or of those of the one that it is like
    int n_cuts, copy;    ///< before it, and how many elements after that one
    int offset = 0;
};

/// Behind the columns before `column` as many as an element has are left out, `times`.
struct PatternCut {
    int column, times, stride;
    int entries = 0;   ///< of the columns of an element
};

/// Entries that are made again and again in one order: their places are found once. Of many elements in a row
/// that are alike, each `stride` rows and columns after the one before, some are taken down, and the others
/// follow from them.
class MatrixPattern {
public:
    /// Of the entries of an element: where each stands among the values of the matrix, less an offset.
    struct Slots {
        const int* slots;
        int offset;
    };

    /// Places are taken down from here on.
    void collect();
    void take_down(int row, int column) { places_.emplace_back(row - shift_, column - shift_); }
    void end_element();
    /// `times` elements that are like the last one follow; the unknowns of the first of these begin at
    /// `column`. The columns of the last one, and those which its rows see, must be alike as well.
    void repeat(int times, int stride, int column);
    /// What is taken down stands at the start of time, or at its end.
    void stand_at(bool end) { shift_ = end ? left_out_ : 0; }
    /// Gives J the pattern of these places.
    void make(int size, SparseMatrix& J);
    Slots of_element(int e) const
    {
        const PlacedElement& element = elements_[static_cast<std::size_t>(e)];
        return {slots_.data() + element.begin, element.offset};
    }
    Slots of_ends() const { return {slots_.data() + first_of_ends_, 0}; }

private:
    void sort(int size, SparseMatrix& short_J);
    void take_offsets();
    void draw_out(int size, const SparseMatrix& short_J, SparseMatrix& J) const;

    std::vector<std::pair<int, int>> places_;   // as if what is left out was not there
    std::vector<PlacedElement> elements_;
    std::vector<PatternCut> cuts_;
    int shift_ = 0, left_out_ = 0;   // numbers that are left out before what is taken down, and in all
    std::size_t first_of_element_ = 0, first_of_ends_ = 0;
    std::vector<int> slots_;
};

/// Those of rows low..high - 1, added to the values of a matrix; or taken down, where there are none.
struct EntrySink {
    MatrixPattern* pattern = nullptr;
    double* values = nullptr;
    MatrixPattern::Slots at{};
    int low = 0, high = 0;

    void add(int row, int column, double value)
    {
        if (values == nullptr) return pattern->take_down(row, column);
        const int slot = at.offset + *at.slots++;
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
    int stride_before(int e) const;
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
