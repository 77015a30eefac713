// SPDX-License-Identifier: BSD-3-Clause
// Sums over rows on registers of LIVENS_ROW_REGISTER doubles. All names are the source's own: no two sources
// may share code through the linker.
#pragma once

#include <cstring>

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

constexpr RowFunctions in_registers{inner, subtract_scaled, reflect, subtract_pair};

}   // namespace
}   // namespace livens::inline solvers_internal
