// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows as tables, which the engine evaluates many times.
#pragma once

#include <vector>

#include "livens/multibody/constraint.h"
#include "livens/multibody/state.h"

namespace livens::inline dynamics_internal {

/// A row and the bodies that it touches, its sides.
struct RowTable {
    const ConstraintRow* row = nullptr;
    int n_sides = 0;
    std::vector<int> bodies;   ///< of each side
    struct Entry {
        int from_side, from;   ///< side, and place of the column in the 12 numbers of X
        int to_side, to;
        double value;
    };
    /// Columns of X of a side that the gradient may touch: 0, 3, 6, 9.
    struct Columns {
        int n = 0;
        int at[4];

        const int* begin() const { return at; }
        const int* end() const { return at + n; }
    };
    std::vector<Columns> columns;   ///< of each side
    /// A quadratic form alone has these tables; others are evaluated by constraint.h.
    bool is_quadratic = true;
    std::vector<Entry> form;   ///< entries of K that are not zero, by rows and columns
    Matrix4 K[2][2] = {};      ///< the same as blocks
    Matrix34 B[2] = {};
};

/// Rows by their numbers: those of the joints of a model, then those of rigidity, if asked for.
class RowTables {
public:
    /// Most numbers of a gradient: 12 a side.
    static constexpr int gradient_size = 12 * RowBodies::most;

    RowTables(const Model& model, bool with_rigidity);
    RowTables(const RowTables&) = delete;
    RowTables& operator=(const RowTables&) = delete;

    std::size_t size() const { return tables_.size(); }
    const RowTable& operator[](std::size_t row) const { return tables_[row]; }
    auto begin() const { return tables_.begin(); }
    auto end() const { return tables_.end(); }
    bool are_quadratic() const;
    /// Numbers of the longest gradient of these rows.
    int longest_gradient() const { return longest_gradient_; }

    /// Gradients of row r by X of its sides, 12 numbers each, one after the other. Only the columns that the
    /// row touches (RowTable::columns) are written, and only they may be read.
    void gradient(int r, Instant at, const double* X, double* g) const;
    /// Phi from the absolute configuration and its gradient there: 1/2 <g + B, X> + c.
    double value(int r, Instant at, const double* X, const double* g) const;
    double value(int r, Instant at, const double* X) const;
    /// Phi of a quadratic form at another place less Phi, from the gradients at both and how far they differ.
    double change(int r, const double* g_from, const double* g_to, const double* step) const;
    /// The part of dPhi/dt that stays where X does not move; 0 without drives.
    double rate(int r, Instant at, const double* X) const;
    /// d2 Phi/dt2 less G X'': quadratic in X' = V unless drives add to it.
    double curvature(int r, Instant at, const double* X, const double* V) const;

private:
    std::vector<ConstraintRow> rigidity_;
    std::vector<RowTable> tables_;
    int longest_gradient_ = 0;
};

}   // namespace livens::inline dynamics_internal
