// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component beside the equations of a block: momenta at both ends as unknowns, and rows that
// decide them.
#pragma once

#include <span>
#include <vector>

#include "livens/solvers/sparse.h"
#include "livens/spacetime/march/end_conditions.h"
#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

/// A matrix as it is factorised, and its scales.
struct ScaledMatrix {
    SparseMatrix all, inner;   ///< inner: of the equations alone, where there is a border
    std::vector<double> rows, columns;
};

/// The block has places at both ends as unknowns, and rows of the law there that momenta close.
class Border {
public:
    /// `ends` must outlive it.
    Border(const Model& model, const Ends& ends);
    Border(const Border&) = delete;   // its parts know each other
    Border& operator=(const Border&) = delete;

    EndConditions& conditions() { return conditions_; }
    const EndConditions& conditions() const { return conditions_; }
    int size() const { return conditions_.n_border(); }

    /// Gives the equations the momenta that joints allow where the fields are, and finds what conditions
    /// miss. False: something is not finite, or without a value.
    bool evaluate(Equations& equations, const Fields& fields);
    /// The inner matrix of a block, which is scaled, with columns by momenta along the free motions at both
    /// ends and rows of the conditions behind it, whose scales are appended.
    void add_to(ScaledMatrix& matrix, const Equations& equations, const Fields& fields);

private:
    std::vector<Matrix34> told(const Coordinates& m, const std::vector<Matrix34>& X,
                               const std::vector<double>& momenta) const;
    using Columns = std::vector<std::vector<std::pair<int, double>>>;
    void add_momenta(const Equations& equations, const Fields& fields, std::span<const double> row_scales,
                     Columns& columns) const;
    void add_conditions(const Equations& equations, const Fields& fields,
                        std::span<const double> column_scales, int first_row, Columns& columns) const;

    ModelTables tables_;   // without rigidity
    EndConditions conditions_;
};

}   // namespace livens::mixed
