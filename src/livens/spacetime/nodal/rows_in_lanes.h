// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows by scaled twists, of norm one, at several nodes side by side.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/lanes/row_sums.h"
#include "livens/dynamics/rows/constraint_basis.h"
#include "livens/spacetime/elements/kernel_functions.h"

namespace livens::inline spacetime_internal {

/// Of those that are one quadratic form each; others are not known (KnownColumns). What one lane has does not
/// depend on the others.
class RowsInLanes {
public:
    /// What a thread needs of its own.
    struct Workspace {
        AlignedDoubles numbers, gradients, entries, scales;
    };

    /// Of these rows of the tables, at so many nodes in all.
    RowsInLanes(const ModelTables& tables, const std::vector<int>& rows, int n_nodes);

    const std::vector<int>& rows() const { return rows_; }
    /// Nodes at a time.
    int width() const { return functions_->width; }
    Workspace workspace() const;
    void place(int lane, const double* X, Workspace& to) const;
    void evaluate(Workspace& of) const;
    /// In the order of the rows.
    KnownColumns at(int lane, const Workspace& of) const
    {
        return {begin_.data(), sums_.twist.data(), of.entries.data() + lane, of.scales.data() + lane,
                width()};
    }

private:
    const ModelTables& tables_;
    std::vector<int> rows_, begin_;
    RowSums sums_;
    lanes::Pattern pattern_{};
    const lanes::Functions* functions_;
};

}   // namespace livens::inline spacetime_internal
