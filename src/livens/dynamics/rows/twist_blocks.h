// SPDX-License-Identifier: BSD-3-Clause
// Blocks of tangents by scaled twists of two bodies.
#pragma once

#include "livens/dynamics/rows/tables.h"

namespace livens::inline dynamics_internal {

/// block += N(X_row)^T K N(X_column), 6 x 6 row by row.
void add_reduced(const Matrix<12, 12>& K, const double* X_row, const double* X_column, int dofs,
                 double* block);
/// out <- D_i^T block D_j with the maps of body i at a node A and of body j at a node B, 6 x 6 row by row.
void scale_block(const ModelTables& tables, const double* maps_A, int i, const double* maps_B, int j,
                 const double* block, double* out);

/// The largest sum of what a load makes of entries of X and X' in scaled rows: times eps it is what their
/// rounding does to the rows.
double load_terms(const ModelTables& tables, const Load& load, const LoadArguments& at,
                  const LoadTangent& tangent);

}   // namespace livens::inline dynamics_internal
