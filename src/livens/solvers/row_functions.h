// SPDX-License-Identifier: BSD-3-Clause
// Sums over rows of dense matrices, once for each set of instructions.
#pragma once

namespace livens::inline solvers_internal {

struct RowFunctions {
    /// sum of x_i y_i
    double (*inner)(const double* x, const double* y, int n);
    /// y -= a x
    void (*subtract_scaled)(double* y, double a, const double* x, int n);
    /// head and x <- (1 - beta [1; v] [1; v]^T) of them
    void (*reflect)(double* head, double* x, double beta, const double* v, int n);
    /// y -= a u + b v
    void (*subtract_pair)(double* y, double a, const double* u, double b, const double* v, int n);
};

/// Of the instructions that are in use; to be asked once for a matrix, not for a row.
const RowFunctions& row_functions();

const RowFunctions& rows_sse2();
const RowFunctions& rows_avx2();

}   // namespace livens::inline solvers_internal
