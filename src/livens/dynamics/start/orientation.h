// SPDX-License-Identifier: BSD-3-Clause
// On which side of a singular position rows are.  (docs/theory.md, "Singular positions")
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::inline dynamics_internal {

/// The gradients G of some rows at one place, by scaled twists, each of norm 1.
class Orientation {
public:
    /// X: 12 numbers for each body of the model, of which those of the rows' bodies are read.
    void place(const ModelTables& tables, const std::vector<int>& rows, Instant at, const double* X);
    /// Against another place of the same rows: the determinant of G G_before^T is negative, since what passed
    /// zero on the way has changed its sign. Two that pass together are not seen.
    bool is_turned_over(const Orientation& before);

private:
    struct Side {
        int body, row;   // the latter by its place in the rows
        double entries[6];
    };

    void arrange(const ModelTables& tables, const std::vector<int>& rows);

    std::vector<int> rows_;     // which the sides are arranged for
    std::vector<Side> sides_;   // body by body
    std::vector<int> order_;    // of them, by the sides of rows, one row after the other
    std::vector<double> gradient_, product_;
};

}   // namespace livens::inline dynamics_internal
