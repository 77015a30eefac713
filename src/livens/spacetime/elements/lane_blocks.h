// SPDX-License-Identifier: BSD-3-Clause
// Products and factors of dense blocks whose rows and columns are numbers at p nodes: (i, A) is row i p + A.
// Nodes are few, so lanes go over columns, and over nodes where each has its own factor.
#pragma once

#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/lane_joints.h"

namespace livens::lanes {
namespace {

/// Factors a_k of rows x_k, that many, apart as said.
struct Terms {
    const double* a;
    int apart;
    const double* x;
    int next, n;
};

/// The columns from y on, R < 16 of them or 16, of y += sign sum_k a_k x_k: all in registers at once.
template <int R>
LIVENS_INLINE void add_terms(double* y, double sign, const Terms& of, const double* x)
{
    constexpr int fours = R / 4, twos = R % 4 / 2, first_two = 4 * fours, last = R - 1;
    Lanes<4> four[fours + 1];
    Lanes<2> two = all<2>(0);
    double one = 0;
    for (int i = 0; i < fours; ++i) four[i] = load_anywhere<4>(y + 4 * i);
    if constexpr (twos > 0) two = load_anywhere<2>(y + first_two);
    if constexpr (R % 2 > 0) one = y[last];
    for (int k = 0; k < of.n; ++k, x += of.next) {
        const double a = sign * of.a[k * of.apart];
        for (int i = 0; i < fours; ++i) four[i] += a * load_anywhere<4>(x + 4 * i);
        if constexpr (twos > 0) two += a * load_anywhere<2>(x + first_two);
        if constexpr (R % 2 > 0) one += a * x[last];
    }
    for (int i = 0; i < fours; ++i) store_anywhere(y + 4 * i, four[i]);
    if constexpr (twos > 0) store_anywhere(y + first_two, two);
    if constexpr (R % 2 > 0) y[last] = one;
}

/// y += sign sum_k a_k x_k, rows of 16 n + R numbers.
template <int R>
void add_rows_of(double* y, double sign, const Terms& of, int columns)
{
    const double* x = of.x;
    for (; columns >= 16; columns -= 16, y += 16, x += 16) add_terms<16>(y, sign, of, x);
    if constexpr (R > 0) add_terms<R>(y, sign, of, x);
}

using AddRows = void (*)(double* y, double sign, const Terms& of, int columns);

/// For rows of so many numbers.
LIVENS_INLINE AddRows rows_of(int columns)
{
    static constexpr AddRows by_rest[16] = {
        add_rows_of<0>,  add_rows_of<1>,  add_rows_of<2>,  add_rows_of<3>, add_rows_of<4>,  add_rows_of<5>,
        add_rows_of<6>,  add_rows_of<7>,  add_rows_of<8>,  add_rows_of<9>, add_rows_of<10>, add_rows_of<11>,
        add_rows_of<12>, add_rows_of<13>, add_rows_of<14>, add_rows_of<15>};
    return by_rest[columns % 16];
}

void add_from_left(const double* M, const BlockSize& of, const double* J, int columns, double* out, int apart)
{
    const AddRows add_rows = rows_of(columns);
    for (int k = 0; k < of.f; ++k)
        for (int A = 0; A < of.p; ++A)
            add_rows(out + (k * of.p + A) * apart, 1,
                     {M + k * of.p + A, of.f * of.p, J + A * columns, of.p * columns, of.n}, columns);
}

/// The last of these lanes may go over some that others have had.
template <int W>
LIVENS_INLINE void add_at_nodes(const double* x, const double* M, int n, int to_next, int p, double* out)
{
    Lanes<W> sums[(18 + W - 1) / W];   // degrees that have lanes
    int count = 0;
    for (int B = 0; B < p; B += W, ++count) {
        const int first = B + W <= p ? B : p - W;
        sums[count] = load_anywhere<W>(out + first);
        for (int j = 0; j < n; ++j)
            sums[count] += load_anywhere<W>(x + j * p + first) * load_anywhere<W>(M + j * to_next + first);
    }
    for (int B = 0, i = 0; B < p; B += W, ++i) store_anywhere(out + (B + W <= p ? B : p - W), sums[i]);
}

/// Of n rows of M at up to `blocks` times W nodes, which stay in registers for all rows of J.
template <int W, int n, int blocks>
LIVENS_INLINE void add_column(const double* J, int rows, const double* M, int to_next, const BlockSize& of,
                              double* out)
{
    const int last = of.p - W;
    Lanes<W> m[blocks][n];
    for (int i = 0; i < blocks; ++i)
        for (int j = 0; j < n; ++j)
            m[i][j] = load_anywhere<W>(M + j * to_next + (i < blocks - 1 ? i * W : last));
    for (int r = 0; r < rows; ++r, J += n * of.p, out += of.f * of.p) {
        Lanes<W> sums[blocks];
        for (int i = 0; i < blocks; ++i) {
            const int first = i < blocks - 1 ? i * W : last;
            sums[i] = load_anywhere<W>(out + first);
            for (int j = 0; j < n; ++j) sums[i] += load_anywhere<W>(J + j * of.p + first) * m[i][j];
        }
        for (int i = 0; i < blocks; ++i) store_anywhere(out + (i < blocks - 1 ? i * W : last), sums[i]);
    }
}

template <int W>
LIVENS_INLINE void add_all_from_right(const double* J, int rows, const double* M, const BlockSize& of,
                                      bool transposed, double* out)
{
    const int to_next = transposed ? of.p : of.f * of.p, to_other = transposed ? of.n * of.p : of.p;
    if (W == part && of.n == 6 && of.p > W && of.p <= 2 * W) {   // a rigid body at as many nodes as usual
        for (int k = 0; k < of.f; ++k)
            add_column<W, 6, 2>(J, rows, M + k * to_other, to_next, of, out + k * of.p);
        return;
    }
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < of.f; ++k)
            add_at_nodes<W>(J + r * of.n * of.p, M + k * to_other, of.n, to_next, of.p,
                            out + (r * of.f + k) * of.p);
}

void add_from_right(const double* J, int rows, const double* M, const BlockSize& of, bool transposed,
                    double* out)
{
    if (of.p >= part) return add_all_from_right<part>(J, rows, M, of, transposed, out);
    if (of.p >= 2) return add_all_from_right<2>(J, rows, M, of, transposed, out);
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < of.f; ++k)
            for (int j = 0; j < of.n; ++j)
                out[r * of.f + k] += J[r * of.n + j] * (transposed ? M[k * of.n + j] : M[j * of.f + k]);
}

void subtract_product(double* to, const double* a, const double* b, int rows, int inner, int columns)
{
    const AddRows add_rows = rows_of(columns);
    for (int r = 0; r < rows; ++r)
        add_rows(to + r * columns, -1, {a + r * inner, 1, b, columns, inner}, columns);
}

void subtract_times(double* y, const double* A, int rows, int columns, const double* x)
{
    for (int r = 0; r < rows; ++r) {
        const double* a = A + r * columns;
        Lanes<part> sums = all<part>(0);
        int c = 0;
        for (; c + part <= columns; c += part)
            sums += load_anywhere<part>(a + c) * load_anywhere<part>(x + c);
        double s = sum(sums);
        for (; c < columns; ++c) s += a[c] * x[c];
        y[r] -= s;
    }
}

bool factorise_square(double* A, int* exchanged, int n)
{
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (__builtin_fabs(A[i * n + k]) > __builtin_fabs(A[pivot * n + k])) pivot = i;
        exchanged[k] = pivot;
        if (!(__builtin_fabs(A[pivot * n + k]) > 0) || !__builtin_isfinite(A[pivot * n + k])) return false;
        for (int j = 0; pivot != k && j < n; ++j) {
            const double kept = A[k * n + j];
            A[k * n + j] = A[pivot * n + j];
            A[pivot * n + j] = kept;
        }
        const double inverse = 1 / A[k * n + k];
        const AddRows add_rows = rows_of(n - k - 1);
        for (int i = k + 1; i < n; ++i) {
            A[i * n + k] *= inverse;
            add_rows(A + i * n + k + 1, -1, {A + i * n + k, 1, A + k * n + k + 1, n, 1}, n - k - 1);
        }
    }
    return true;
}

void solve_square(const double* A, const int* exchanged, int n, double* x, int columns)
{
    for (int k = 0; k < n; ++k)
        for (int c = 0; exchanged[k] != k && c < columns; ++c) {
            const double kept = x[k * columns + c];
            x[k * columns + c] = x[exchanged[k] * columns + c];
            x[exchanged[k] * columns + c] = kept;
        }
    const AddRows add_rows = rows_of(columns);
    const auto take_off = [&](int i, int first, int count) __attribute__((always_inline))
    {
        const double* a = A + i * n + first;
        if (columns == 1) return subtract_times(x + i, a, 1, count, x + first);
        add_rows(x + i * columns, -1, {a, 1, x + first * columns, columns, count}, columns);
    };
    for (int i = 1; i < n; ++i) take_off(i, 0, i);
    for (int i = n; i-- > 0;) {
        take_off(i, i + 1, n - i - 1);
        const double inverse = 1 / A[i * n + i];
        for (int c = 0; c < columns; ++c) x[i * columns + c] *= inverse;
    }
}

constexpr BlockFunctions blocks_of{add_from_left,    add_from_right, subtract_product, subtract_times,
                                   factorise_square, solve_square,   move_joint};

}   // namespace
}   // namespace livens::lanes
