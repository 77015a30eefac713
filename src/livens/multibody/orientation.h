// SPDX-License-Identifier: BSD-3-Clause
// On which side of a singular position rows are.  (docs/theory.md, "Singular positions")
#pragma once

#include <vector>

#include "livens/multibody/tables.h"

namespace livens {

/// The gradients G of some rows at one place, by scaled twists, each of norm 1.
class Orientation {
public:
    /// X: 12 numbers a body.
    void place(const Tables& tables, const std::vector<int>& rows, Instant at, const double* X);
    /// Against a place nearby: the determinant of G G_before^T is negative, since what passed zero on the way
    /// has changed its sign. Two that pass together are not seen.
    bool is_turned_over(const Orientation& before) const;

private:
    int n_rows_ = 0, n_twists_ = 0;
    std::vector<double> gradients_, maps_, one_;   // row by row
};

}   // namespace livens
