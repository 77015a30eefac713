// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component beside the equations of a block: momenta at both ends as unknowns, and rows that
// decide them.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/ranks.h"
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
    /// `ends` must outlive it. `ranks`: the first one has the start of time and the last one its end, each
    /// knows the places at both, and all call evaluate() together; null: one has all of time.
    Border(const Model& model, const Ends& ends, Ranks* ranks = nullptr);
    Border(const Border&) = delete;   // its parts know each other
    Border& operator=(const Border&) = delete;

    EndConditions& conditions() { return conditions_; }
    const EndConditions& conditions() const { return conditions_; }
    int size() const { return conditions_.n_border(); }
    int n_free() const { return tables_.freedoms(); }
    int n_numbers() const { return size() - 2 * n_free(); }
    /// What condition i is about.
    Condition::At at(int i) const { return ends_.components[static_cast<std::size_t>(i)].at; }
    /// Columns of unknown numbers from here on: of the rows of equations(), then of conditions.
    void number_by(std::function<DenseMatrix()> columns) { numbers_ = std::move(columns); }
    /// At the current point; none, where there are none.
    DenseMatrix numbers() const { return numbers_ ? numbers_() : DenseMatrix(); }

    /// Gives the equations the momenta that joints allow where the fields are, and finds what conditions
    /// miss. False: something is not finite, or without a value.
    bool evaluate(Equations& equations, const Fields& fields);
    /// The inner matrix of a block, which is scaled, with columns by momenta along the free motions at both
    /// ends and by numbers, and rows of the conditions behind it, whose scales are appended.
    void add_to(ScaledMatrix& matrix, const Equations& equations, const Fields& fields);

    /// Finds derivatives at the current point, for what follows.
    void differentiate();
    using Take = std::function<void(int row, int column, double value)>;
    /// Rows dX at an end by momentum j along the free motions there, 0.., not scaled: -P at the start, P at
    /// the end.
    void take_momenta(bool at_end, const Equations& equations, const Fields& fields, const Take& take) const;
    /// Conditions 0.. by X at an end, columns of the equations ascending, not scaled.
    void take_conditions(bool at_end, const Equations& equations, const Fields& fields,
                         const Take& take) const;
    /// Conditions 0.. by momentum 0.. along the free motions at an end.
    void take_closing(bool at_end, const Take& take) const;

private:
    /// Places at an end of time, which all ranks have.
    struct End {
        double t = 0, length = 0;
        std::vector<Matrix34> X;
    };
    End end_of(const FieldSpace& space, const Fields& fields, bool at_end) const;
    double followed(const FieldSpace& space, const Fields& fields, const NamedCoordinate& coordinate,
                    double from, const End& end) const;
    bool has(bool at_end) const
    {
        return ranks_ == nullptr || (at_end ? ranks_->is_last() : ranks_->is_first());
    }
    std::vector<Matrix34> told(const Coordinates& m, const std::vector<Matrix34>& X,
                               const std::vector<double>& momenta) const;

    ModelTables tables_;   // without rigidity
    const Ends& ends_;
    Ranks* ranks_;
    EndConditions conditions_;
    std::function<DenseMatrix()> numbers_;
};

}   // namespace livens::mixed
