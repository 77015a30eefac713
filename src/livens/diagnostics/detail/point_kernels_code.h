// SPDX-License-Identifier: BSD-3-Clause
// The functions of PointKernels on the registers of a source's instructions. Forces of all rows are summed up
// for each body before their moments are taken; sizes are those of single rows, as rounding is.
#pragma once

#include "livens/diagnostics/detail/point_kernels.h"
#include "livens/dynamics/lanes/lane_arithmetic.h"
#include "livens/dynamics/lanes/lane_loads.h"

namespace livens::inline diagnostics_internal {
namespace {

constexpr int W = OfPoints::width;
using Numbers = lanes::Lanes<W>;
using Vector = lanes::Three<W>;

LIVENS_INLINE Numbers get(const double* from, int i)
{
    return lanes::load<W>(from + static_cast<long>(i) * W);
}
LIVENS_INLINE void set(double* to, int i, const Numbers& x)
{
    lanes::store(to + static_cast<long>(i) * W, x);
}
LIVENS_INLINE Numbers zero() { return lanes::all<W>(0); }
LIVENS_INLINE Vector zeros() { return {{zero(), zero(), zero()}}; }
LIVENS_INLINE Vector vector(const double* x)
{
    return {{lanes::all<W>(x[0]), lanes::all<W>(x[1]), lanes::all<W>(x[2])}};
}
LIVENS_INLINE Vector column(const double* from, int number)
{
    return {{get(from, number), get(from, number + 1), get(from, number + 2)}};
}
LIVENS_INLINE void add(Vector& to, const Vector& x)
{
    for (int i = 0; i < 3; ++i) to.x[i] += x.x[i];
}
LIVENS_INLINE Vector cross(const Vector& a, const Vector& b)
{
    return {{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
             a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}
LIVENS_INLINE Numbers size_of(const Numbers& x)
{
    Numbers size = zero();
    lanes::raise_to_size(size, x);
    return size;
}

void sizes(const PointLists& lists, const PointArrays& at)
{
    for (int number = 0; number < lists.n_numbers; number += 3) {
        const Vector x = column(at.X, number);
        set(at.sizes, number / 3, lanes::root(lanes::dot(x, x)));
    }
}

void weights(const PointLists& lists, const PointArrays& at, SupplyOfPoints& supply)
{
    Vector moment = zeros();
    Numbers size = zero();
    double linear[3] = {}, gross = 0;
    for (int k = 0; k < lists.n_weights; ++k) {
        const PointWeight& weight = lists.weights[k];
        add(moment, cross(column(at.X, weight.number), vector(weight.force)));
        size += weight.size * get(at.sizes, weight.number / 3);
        if (weight.number % 12 != 0) continue;
        for (int i = 0; i < 3; ++i) linear[i] += weight.force[i];
        gross += weight.size;
    }
    for (int i = 0; i < 3; ++i) {
        lanes::store(supply.linear[i].at, lanes::all<W>(linear[i]));
        lanes::store(supply.angular[i].at, moment.x[i]);
    }
    lanes::store(supply.gross.at, lanes::all<W>(gross));
    lanes::store(supply.gross_moment.at, size + lanes::all<W>(gross * lists.length));
}

void potential(const PointLists& lists, const PointArrays& at, OfPoints& energy)
{
    Numbers sum = zero();
    for (int k = 0; k < lists.n_weights; ++k)
        sum -= lanes::dot(vector(lists.weights[k].force), column(at.X, lists.weights[k].number));
    lanes::store(energy.at, sum);
}

/// Column c of V m.
LIVENS_INLINE Vector momentum(const PointLists& lists, int c, const double* V)
{
    Vector p = zeros();
    for (int k = lists.first_mass[c]; k < lists.first_mass[c + 1]; ++k)
        for (int i = 0; i < 3; ++i) p.x[i] += lists.mass[k].value * get(V, lists.mass[k].number + i);
    return p;
}

void kinetic(const PointLists& lists, const PointArrays& at, OfPoints& energy)
{
    Numbers twice = zero();
    for (int c = 0; c < lists.n_numbers / 3; ++c)
        if (lists.first_mass[c] < lists.first_mass[c + 1])
            twice += lanes::dot(momentum(lists, c, at.V), column(at.V, 3 * c));
    lanes::store(energy.at, 0.5 * twice);
}

void moments(const PointLists& lists, const PointArrays& at, OfPoints* moment)
{
    Vector sum = zeros();
    for (int c = 0; c < lists.n_numbers / 3; ++c)
        if (lists.first_mass[c] < lists.first_mass[c + 1])
            add(sum, cross(column(at.X, 3 * c), momentum(lists, c, at.V)));
    for (int i = 0; i < 3; ++i) lanes::store(moment[i].at, sum.x[i]);
}

/// Gradient of a row by a column of X.
LIVENS_INLINE Vector gradient(const PointLists& lists, const PointColumn& of, const double* X)
{
    Vector g = vector(of.B);
    const PointColumn& behind = (&of)[1];
    for (int k = of.first_term; k < behind.first_term; ++k)
        for (int i = 0; i < 3; ++i) g.x[i] += lists.terms[k].value * get(X, lists.terms[k].number + i);
    return g;
}

/// A form that is linear: sum of B over the numbers that it touches.
LIVENS_INLINE Numbers linear_value(const PointLists& lists, const PointRow& row, const double* X)
{
    Numbers sum = lanes::all<W>(row.c);
    for (int k = row.first_entry; k < (&row)[1].first_entry; ++k)
        sum += lists.entries[k].value * get(X, lists.entries[k].number);
    return sum;
}

/// 1/2 (g + B) . X of a column.
LIVENS_INLINE Numbers quadratic_part(const PointColumn& of, const Vector& g, const double* X)
{
    Vector both = vector(of.B);
    add(both, g);
    return 0.5 * lanes::dot(both, column(X, of.number));
}

/// Sums over rows: of forces' sizes, and of these by the sizes of columns.
struct Sizes {
    Numbers gross = zero(), moments = zero();

    LIVENS_INLINE void add_size(const PointColumn& of, const double* sizes, const Numbers& size)
    {
        moments += size * get(sizes, of.number / 3);
        if (of.number % 12 == 0) gross += size;
    }
};

LIVENS_INLINE Numbers joint_row(const PointLists& lists, const PointArrays& at, const PointRow& row,
                                const Numbers& lambda, Sizes& sums)
{
    const Numbers of_one = size_of(lambda);
    const int last = (&row)[1].first_column;
    if (row.is_linear) {
        for (int k = row.first_entry; k < (&row)[1].first_entry; ++k) {
            const PointTerm& entry = lists.entries[k];
            set(at.forces, entry.number, get(at.forces, entry.number) - entry.value * lambda);
        }
        for (int k = row.first_column; k < last; ++k)
            sums.add_size(lists.columns[k], at.sizes, lists.columns[k].size * of_one);
        return linear_value(lists, row, at.X);
    }
    Numbers phi = lanes::all<W>(row.c);
    for (int k = row.first_column; k < last; ++k) {
        const PointColumn& of = lists.columns[k];
        const Vector g = gradient(lists, of, at.X);
        phi += quadratic_part(of, g, at.X);
        for (int i = 0; i < 3; ++i)
            set(at.forces, of.number + i, get(at.forces, of.number + i) - lambda * g.x[i]);
        sums.add_size(of, at.sizes, of_one * lanes::root(lanes::dot(g, g)));
    }
    return phi;
}

void joints(const PointLists& lists, const PointArrays& at, SupplyOfPoints& supply)
{
    for (int i = 0; i < lists.n_numbers; ++i) set(at.forces, i, zero());
    Sizes sums;
    for (int r = 0; r < lists.n_rows; ++r) {
        const PointRow& row = lists.rows[r];
        if (row.first_column == (&row)[1].first_column) continue;
        set(at.violations, r, row.inverse_scale * joint_row(lists, at, row, get(at.multipliers, r), sums));
    }
    lanes::store(supply.gross.at, sums.gross);
    lanes::store(supply.gross_moment.at, sums.moments + lists.length * sums.gross);
    Vector linear = zeros(), angular = zeros();
    for (int number = 0; number < lists.n_numbers; number += 3) {
        const Vector force = column(at.forces, number);
        add(angular, cross(column(at.X, number), force));
        if (number % 12 == 0) add(linear, force);
    }
    for (int i = 0; i < 3; ++i) {
        lanes::store(supply.linear[i].at, linear.x[i]);
        lanes::store(supply.angular[i].at, angular.x[i]);
    }
}

void violations(const PointLists& lists, const PointArrays& at)
{
    for (int r = 0; r < lists.n_rows; ++r) {
        const PointRow& row = lists.rows[r];
        if (row.first_column == (&row)[1].first_column) continue;
        Numbers phi = row.is_linear ? linear_value(lists, row, at.X) : lanes::all<W>(row.c);
        for (int k = row.first_column; !row.is_linear && k < (&row)[1].first_column; ++k)
            phi += quadratic_part(lists.columns[k], gradient(lists, lists.columns[k], at.X), at.X);
        set(at.violations, r, row.inverse_scale * phi);
    }
}

void rates(const PointLists& lists, const PointArrays& at)
{
    for (int r = 0; r < lists.n_rows; ++r) {
        const PointRow& row = lists.rows[r];
        if (row.first_column == (&row)[1].first_column) continue;
        Numbers rate = zero();
        for (int k = row.first_column; k < (&row)[1].first_column; ++k)
            rate +=
                lanes::dot(gradient(lists, lists.columns[k], at.X), column(at.V, lists.columns[k].number));
        set(at.violations, r, row.inverse_scale * rate);
    }
}

/// The running maximum of sizes, which tells where a number is none.
struct LargestSize {
    Numbers largest = zero(), spoilt = zero();

    LIVENS_INLINE void raise_to(const Numbers& x)
    {
        lanes::raise_to_size(largest, x);
        spoilt += x - x;   // 0, unless x is no finite number
    }
    LIVENS_INLINE void put(LargestOfPoints& to) const
    {
        lanes::store(to.largest.at, largest);
        lanes::store(to.spoilt.at, spoilt);
    }
};

void largest_violation(const PointLists& lists, const PointArrays& at, LargestOfPoints& to)
{
    LargestSize found;
    for (int r = 0; r < lists.n_rows; ++r) found.raise_to(get(at.violations, r));
    found.put(to);
}

void largest_of_rigidity(const PointLists& lists, const PointArrays& at, LargestOfPoints& to)
{
    LargestSize found;
    const Numbers one = lanes::all<W>(1);
    for (const int* n = lists.rigid; n != lists.rigid + lists.n_rigid; ++n) {
        const Vector d[3] = {column(at.X, *n + 3), column(at.X, *n + 6), column(at.X, *n + 9)};
        for (int a = 0; a < 3; ++a) {
            found.raise_to(0.5 * (lanes::dot(d[a], d[a]) - one));
            for (int b = a + 1; b < 3; ++b) found.raise_to(0.5 * lanes::dot(d[a], d[b]));
        }
    }
    found.put(to);
}

/// n numbers of each column, of which `width` are the next.
template <int width>
LIVENS_INLINE void multiply_some(const double* M, int n_rows, int n_columns, int stride, const double* d,
                                 int n, double* out)
{
    using Some = lanes::Lanes<width>;
    using Part = typename Some::Part;
    for (int k = 0; k < n_rows; ++k, M += stride, out += n) {
        Part sum[Some::count] = {};
        const double* from = d;
        for (int A = 0; A < n_columns; ++A, from += n) {
            const Part factor = lanes::spread<width>(M[A]);
            for (int i = 0; i < Some::count; ++i) {
                Part x;   // part by part, or it goes through memory
                __builtin_memcpy(&x, from + i * Some::size, sizeof x);
                sum[i] += factor * x;
            }
        }
        for (int i = 0; i < Some::count; ++i) __builtin_memcpy(out + i * Some::size, &sum[i], sizeof sum[i]);
    }
}

void multiply(const double* M, int n_rows, int n_columns, int stride, const double* d, int n, double* out)
{
    int i = 0;
    for (; i + 12 <= n; i += 12) multiply_some<12>(M, n_rows, n_columns, stride, d + i, n, out + i);
    for (; i + 2 <= n; i += 2) multiply_some<2>(M, n_rows, n_columns, stride, d + i, n, out + i);
    for (; i < n; ++i) multiply_some<1>(M, n_rows, n_columns, stride, d + i, n, out + i);
}

constexpr auto loads = &lanes::run_loads<W>;
const PointKernels functions{&sizes,  &weights,    &potential, &kinetic,           &moments,
                             &joints, &violations, &rates,     &largest_violation, &largest_of_rigidity,
                             loads,   &multiply};

}   // namespace
}   // namespace livens::inline diagnostics_internal
