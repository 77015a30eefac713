// SPDX-License-Identifier: BSD-3-Clause
// Moving a configuration, or its rates, onto joint rows: nearest in the mass metric.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

struct Closing {
    /// Every |Phi| is at its rounding level, or as near as 100 iterations come and |Phi| / scale < 1e-12.
    bool closed = false;
    std::vector<Matrix34> X;
};

/// Moves X onto the given rows, directors by rotation only (d_i <- exp(w) d_i).
///
/// Every iteration solves  [M  G^T; G  0] [dx; lambda] = [-g; -Phi]  for twists about the centres of mass:
/// the step of Gauss and Newton in the mass metric. It takes the rows that are independent there by geometry,
/// with pivots above 1e-4 (1e-7, then 1e-9, where that gets stuck), so that redundant rows do no harm. If
/// `nearest`, g = N^T (X - X_given) m first leads to the nearest configuration, 1/2 tr((X - X_given) m
/// (X - X_given)^T) -> min; otherwise, and in the end, g = 0. Zeros of planar data stay exactly zero.
Closing close_rows(const Model& model, std::span<const Matrix34> X_given, std::span<const int> rows,
                   bool nearest);
/// The same from another place, nearest to X_given none the less.
Closing close_rows_from(const Model& model, std::span<const Matrix34> X_from,
                        std::span<const Matrix34> X_given, std::span<const int> rows, bool nearest);

/// The rates [v, w x d_i] nearest to V in the mass metric with G V = -drive_rates for the given rows, which
/// must be independent; of all rows of the model, or empty: zeros.
std::vector<Matrix34> nearest_rates(const Model& model, std::span<const Matrix34> X,
                                    std::span<const Matrix34> V, std::span<const int> rows,
                                    std::span<const double> drive_rates = {});

}   // namespace livens::inline dynamics_internal
