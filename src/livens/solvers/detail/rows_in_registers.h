// SPDX-License-Identifier: BSD-3-Clause
// Sums over rows on registers of LIVENS_ROW_REGISTER doubles. All names are the source's own: no two sources
// may share code through the linker.
#pragma once

#include <cstring>

#include "livens/solvers/dense.h"
#include "livens/solvers/row_functions.h"

#ifndef LIVENS_ROW_REGISTER
#define LIVENS_ROW_REGISTER 2   // what every processor has, when this header is compiled alone
#endif

namespace livens::inline solvers_internal {
namespace {

constexpr int held = LIVENS_ROW_REGISTER;
typedef double Held __attribute__((vector_size(8 * held)));

// Copies of bytes, as rows begin wherever a double may: compilers make one move of each.
inline Held at(const double* x)
{
    Held v;
    std::memcpy(&v, x, sizeof(v));
    return v;
}
inline void put(double* x, Held v) { std::memcpy(x, &v, sizeof(v)); }

double inner(const double* x, const double* y, int n)
{
    Held s0{}, s1{};   // so that two products are in flight
    int i = 0;
    for (; i + 2 * held <= n; i += 2 * held) {
        s0 += at(x + i) * at(y + i);
        s1 += at(x + i + held) * at(y + i + held);
    }
    s0 += s1;
    if (i + held <= n) {
        s0 += at(x + i) * at(y + i);
        i += held;
    }
    double sum = 0;
    for (int k = 0; k < held; ++k) sum += s0[k];
    for (; i < n; ++i) sum += x[i] * y[i];
    return sum;
}

void subtract_scaled(double* __restrict y, double a, const double* __restrict x, int n)
{
    int i = 0;
    for (; i + held <= n; i += held) put(y + i, at(y + i) - a * at(x + i));
    for (; i < n; ++i) y[i] -= a * x[i];
}

void reflect(double* head, double* __restrict x, double beta, const double* __restrict v, int n)
{
    const double t = beta * (*head + inner(v, x, n));
    if (t == 0) return;   // what is zero stays so, in its sign
    *head -= t;
    subtract_scaled(x, t, v, n);
}

void subtract_pair(double* __restrict y, double a, const double* __restrict u, double b,
                   const double* __restrict v, int n)
{
    int i = 0;
    for (; i + held <= n; i += held) put(y + i, at(y + i) - (a * at(u + i) + b * at(v + i)));
    for (; i < n; ++i) y[i] -= a * u[i] + b * v[i];
}

void subtract_fours(double* y, const double* a, const double* x, std::ptrdiff_t apart, int rows, int n)
{
    const double *x1 = x + apart, *x2 = x1 + apart, *x3 = x2 + apart;
    for (int r = 0; r < rows; ++r, y += apart, a += apart) {
        const double a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3];
        if (a0 == 0 && a1 == 0 && a2 == 0 && a3 == 0) continue;
        const auto take = [=](int i) __attribute__((always_inline))
        {
            put(y + i, at(y + i) - a0 * at(x + i) - a1 * at(x1 + i) - a2 * at(x2 + i) - a3 * at(x3 + i));
        };
        int i = 0;
        for (; i + 2 * held <= n; i += 2 * held) {
            take(i);
            take(i + held);
        }
        for (; i + held <= n; i += held) take(i);
        for (; i < n; ++i) y[i] = y[i] - a0 * x[i] - a1 * x1[i] - a2 * x2[i] - a3 * x3[i];
    }
}

/// The first R registers of a row.
template <int R>
inline void multiply(double* y, const Terms& of, const double* x)
{
    Held sums[R]{};
    const double* a = of.a;
    for (int k = 0; k < of.n; ++k, a += of.a_apart, x += of.apart) {
        const double s = *a;
        for (int r = 0; r < R; ++r) sums[r] += s * at(x + r * held);
    }
    for (int r = 0; r < R; ++r) put(y + r * held, sums[r]);
}

void product(double* y, const Terms& of, int n)
{
    constexpr int most = 12;   // registers: some are left for a factor
    constexpr decltype(&multiply<1>) by_number[most + 1] = {
        nullptr,     multiply<1>, multiply<2>, multiply<3>,  multiply<4>,  multiply<5>, multiply<6>,
        multiply<7>, multiply<8>, multiply<9>, multiply<10>, multiply<11>, multiply<12>};
    const double* x = of.x;
    for (int left = (n + held - 1) / held; left > 0; left -= most) {
        by_number[left < most ? left : most](y, of, x);
        y += most * held;
        x += most * held;
    }
}

double sum_of(Held v)
{
    double sum = 0;
    for (int k = 0; k < held; ++k) sum += v[k];
    return sum;
}

inline void reflect_by(const Reflection& one, double* x, const double* v, int n)
{
    if (one.beta == 0) return;
    Held sums{};
    for (int k = 0; k < n; k += held) sums += at(v + k) * at(x + 1 + k);
    const double t = one.beta * (*x + sum_of(sums));
    if (t == 0) return;   // what is zero stays so, in its sign
    *x -= t;
    for (int k = 0; k < n; k += held) put(x + 1 + k, at(x + 1 + k) - t * at(v + k));
}

inline void exchange(double* x, int i, int j)
{
    const double kept = x[i];
    x[i] = x[j];
    x[j] = kept;
}

void reflect_all(double* x, const double* columns, std::ptrdiff_t apart, const Reflection* reflections,
                 int first, int last)
{
    for (int i = first; i < last; ++i) {
        exchange(x, i, reflections[i].lead);
        reflect_by(reflections[i], x + i, columns + i * apart + i + 1, reflections[i].end - i - 1);
    }
}

void reflect_back(double* x, const double* columns, std::ptrdiff_t apart, const Reflection* reflections,
                  int n)
{
    for (int i = n - 1; i >= 0; --i) {
        reflect_by(reflections[i], x + i, columns + i * apart + i + 1, reflections[i].end - i - 1);
        exchange(x, i, reflections[i].lead);
    }
}

void make_reflection(double* x, int n, Reflection* made, bool keep_sign)
{
    double* const v = x + 1;
    const double head = *x;
    Held sums{};
    for (int k = 0; k < n; k += held) sums += at(v + k) * at(v + k);
    const double length = __builtin_sqrt(head * head + sum_of(sums));
    // the kept sign would cancel where head has come close to it
    if (!keep_sign || made->sign * head > 0.99 * length) made->sign = head > 0 ? -1 : 1;
    made->beta = 0;
    if (length == 0) return;
    const double r = made->sign * length, v0 = head - r, scale = 1 / v0;
    made->beta = -v0 / r;
    *x = r;
    for (int k = 0; k < n; k += held) put(v + k, scale * at(v + k));
}

typedef double HeldTwo __attribute__((vector_size(16)));

/// Of columns as wide as a register, which stays in use.
template <class Columns>
inline void reflect_columns(double* z, int apart, double beta, const double* v, int rows)
{
    Columns sums{}, row;
    const double* from = z + apart;
    for (int i = 0; i < rows; ++i, from += apart) {
        std::memcpy(&row, from, sizeof(row));
        sums += v[i] * row;
    }
    sums *= beta;
    const Columns head = -sums;
    std::memcpy(z, &head, sizeof(head));
    double* to = z + apart;
    for (int i = 0; i < rows; ++i, to += apart) {
        std::memcpy(&row, to, sizeof(row));
        row -= v[i] * sums;
        std::memcpy(to, &row, sizeof(row));
    }
}

void reflect_rows(double* z, int n, double beta, const double* v, int rows)
{
    int c = 0;
    for (; c + held <= n; c += held) reflect_columns<Held>(z + c, n, beta, v, rows);
    for (; c + 2 <= n; c += 2) reflect_columns<HeldTwo>(z + c, n, beta, v, rows);
    for (; c < n; ++c) reflect_columns<double>(z + c, n, beta, v, rows);
}

/// sums_k = a_k y of four rows a_k of n numbers, so far apart.
inline void multiply_four(const double* a, std::ptrdiff_t apart, const double* y, int n, double* sums)
{
    const double *a1 = a + apart, *a2 = a1 + apart, *a3 = a2 + apart;
    Held s0{}, s1{}, s2{}, s3{};
    int i = 0;
    for (; i + held <= n; i += held) {
        const Held v = at(y + i);
        s0 += at(a + i) * v;
        s1 += at(a1 + i) * v;
        s2 += at(a2 + i) * v;
        s3 += at(a3 + i) * v;
    }
    sums[0] = sum_of(s0);
    sums[1] = sum_of(s1);
    sums[2] = sum_of(s2);
    sums[3] = sum_of(s3);
    for (; i < n; ++i) {
        sums[0] += a[i] * y[i];
        sums[1] += a1[i] * y[i];
        sums[2] += a2[i] * y[i];
        sums[3] += a3[i] * y[i];
    }
}

/// Four rows at a time: x is read once for them, and their sums do not wait for each other. What a row takes
/// off is summed before it is taken off, so that x is rounded once.
void solve_factors(double* x, const double* factors, int n)
{
    double sums[4];
    const int fours = n - n % 4;
    for (int i = 0; i < fours; i += 4) {
        const double *r = factors + std::ptrdiff_t{n} * i, *d = r + i;
        multiply_four(r, n, x, i, sums);
        for (int k = 0; k < 4; ++k) {
            for (int l = 0; l < k; ++l) sums[k] += d[k * n + l] * x[i + l];
            x[i + k] -= sums[k];
        }
    }
    for (int i = fours; i < n; ++i) x[i] -= inner(factors + std::ptrdiff_t{n} * i, x, i);
    for (int i = n - 4; i >= 0; i -= 4) {
        const double* d = factors + std::ptrdiff_t{n} * i + i;
        multiply_four(d + 4, n, x + i + 4, n - i - 4, sums);
        for (int k = 3; k >= 0; --k) {
            for (int l = k + 1; l < 4; ++l) sums[k] += d[k * n + l] * x[i + l];
            x[i + k] = (x[i + k] - sums[k]) / d[k * n + k];
        }
    }
    for (int i = n % 4 - 1; i >= 0; --i) {
        const double* d = factors + std::ptrdiff_t{n} * i + i;
        x[i] = (x[i] - inner(d + 1, x + i + 1, n - i - 1)) / *d;
    }
}

/// A sum is no number where one of its terms is none; infinite ones are the largest themselves.
double largest(const double* x, int n)
{
    const auto larger = [](Held most, Held v) {
        const Held size = v > -v ? v : -v;
        return size > most ? size : most;
    };
    Held most{}, other{}, sum{};
    double found = 0, left = 0;
    int i = 0;
    for (; i + 2 * held <= n; i += 2 * held) {
        const Held v = at(x + i), w = at(x + i + held);
        most = larger(most, v);
        other = larger(other, w);
        sum += v + w;
    }
    most = other > most ? other : most;
    for (; i < n; ++i) {
        const double size = x[i] > -x[i] ? x[i] : -x[i];
        found = size > found ? size : found;
        left += x[i];
    }
    for (int k = 0; k < held; ++k) {
        found = most[k] > found ? most[k] : found;
        left += sum[k];
    }
    return left == left ? found : __builtin_inf();
}

constexpr RowFunctions in_registers{inner,           subtract_scaled, reflect,       subtract_pair,
                                    subtract_fours,  product,         reflect_all,   reflect_back,
                                    make_reflection, reflect_rows,    solve_factors, largest};

}   // namespace
}   // namespace livens::inline solvers_internal
