// SPDX-License-Identifier: BSD-3-Clause
// Sums over rows of dense matrices, once for each set of instructions.
#pragma once

#include <cstddef>

namespace livens::inline solvers_internal {

struct Reflection;

/// Factors a_k and what they are of, x_k, so many, so far apart.
struct Terms {
    const double* a;
    std::ptrdiff_t a_apart;
    const double* x;
    std::ptrdiff_t apart;
    int n;
};

/// Numbers less one of the widest register of these functions.
inline constexpr int register_room = 3;

struct RowFunctions {
    /// sum of x_i y_i
    double (*inner)(const double* x, const double* y, int n);
    /// y -= a x
    void (*subtract_scaled)(double* y, double a, const double* x, int n);
    /// head and x <- (1 - beta [1; v] [1; v]^T) of them
    void (*reflect)(double* head, double* x, double beta, const double* v, int n);
    /// y -= a u + b v
    void (*subtract_pair)(double* y, double a, const double* u, double b, const double* v, int n);
    /// y_i -= a_i0 x_0 + a_i1 x_1 + a_i2 x_2 + a_i3 x_3 for so many rows i of n numbers; y_i, a_i and x_k so
    /// far apart each
    void (*subtract_fours)(double* y, const double* a, const double* x, std::ptrdiff_t apart, int rows,
                           int n);
    /// y = sum_k a_k x_k of rows x_k of n numbers. Where n is no multiple of a register, there is
    /// register_room behind rows, of which anything is read and written.
    void (*product)(double* y, const Terms& of, int n);
    /// x <- reflections first..last - 1 of an OrthogonalBasis of it, each after its exchange; their columns
    /// so far apart, and register_room of zeros behind each and behind x.
    void (*reflect_all)(double* x, const double* columns, std::ptrdiff_t apart, const Reflection* reflections,
                        int first, int last);
    /// x <- reflections n - 1..0 of it, each before its exchange.
    void (*reflect_back)(double* x, const double* columns, std::ptrdiff_t apart,
                         const Reflection* reflections, int n);
    /// Sign and beta of the reflection that leaves the head of x, which becomes its v behind the head; n
    /// numbers and register_room of zeros behind it. A sign that is kept must not cancel.
    void (*make_reflection)(double* x, int n, Reflection* made, bool keep_sign);
    /// Rows 1..rows of z, n numbers each, by the reflection 1 - beta [1; v] [1; v]^T with row 0, which is
    /// zero before.
    void (*reflect_rows)(double* z, int n, double beta, const double* v, int rows);
    /// x <- U^-1 L^-1 x of the factors of n rows, one behind the other; L has ones on its diagonal
    void (*solve_factors)(double* x, const double* factors, int n);
    /// the largest |x_i|; infinite where one is not finite
    double (*largest)(const double* x, int n);
};

/// Of the instructions that are in use; to be asked once for a matrix, not for a row.
const RowFunctions& row_functions();

const RowFunctions& rows_sse2();
const RowFunctions& rows_avx2();

}   // namespace livens::inline solvers_internal
