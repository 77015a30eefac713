// SPDX-License-Identifier: BSD-3-Clause
// With twists about the centre of mass a body's mass is 1 for y_1 and, for spins w = K y_2 at both nodes,
// sum_ab E_ab (w_A x d_a^A) . (w_B x d_b^B) = y_2^T K_A^T (tr(W) 1 - W) K_B y_2, see BodyTables::spin_mass().
#include "livens/spacetime/nodal/mass_products.h"

#include <algorithm>

#include "livens/solvers/row_functions.h"

namespace livens::inline spacetime_internal {

namespace {

/// y <- sum_k s_k x_k of rows of n numbers, in pairs: they are short.
template <std::size_t terms>
inline void combine(double* __restrict y, const double (&s)[terms], const double* const (&x)[terms], int n)
{
    const auto at = [&](int j) {
        double sum = s[0] * x[0][j];
        for (std::size_t k = 1; k < terms; ++k) sum += s[k] * x[k][j];
        return sum;
    };
    int j = 0;
    for (; j + 1 < n; j += 2) {
        const double first = at(j), second = at(j + 1);
        y[j] = first;
        y[j + 1] = second;
    }
    if (j < n) y[j] = at(j);
}

}   // namespace

MassProducts::MassProducts(const ModelTables& tables, int n_nodes)
    : tables_(tables), f_(tables.freedoms()), n_nodes_(n_nodes),
      stride_(static_cast<std::ptrdiff_t>(n_nodes) * f_ + register_room)
{
    rates_.assign(static_cast<std::size_t>(12 * std::min(most_bodies, tables.n_bodies()) * stride_), 0.0);
    weighed_ = rates_;
    product_.assign(static_cast<std::size_t>(f_ * stride_), 0.0);
    factors_.assign(static_cast<std::size_t>(stride_), 0.0);
}

void MassProducts::place(int part, int a, const double* X, const double* maps, const double* Z)
{
    n_rows_ = 0;
    const int end = std::min((part + 1) * most_bodies, tables_.n_bodies());
    for (int b = part * most_bodies; b < end; ++b) {
        const BodyTable& body = tables_.bodies[b];
        place_body(b, n_rows_ * stride_ + static_cast<std::ptrdiff_t>(a) * f_, X + 12 * b, maps + 12 * b,
                   Z + body.first * f_);
        n_rows_ += body.dofs == 6 ? 12 : 3;
    }
}

/// Columns of Z at this node as rates: three of the centre's velocity, whose scaled mass is 1, and of a rigid
/// body nine of w x d_a; weighed ones are those times E, by its diagonal in principal axes.
void MassProducts::place_body(int b, std::ptrdiff_t place, const double* X, const double* maps,
                              const double* z)
{
    const BodyTable& body = tables_.bodies[b];
    const int f = f_;
    double *rates = rates_.data() + place, *weighed = weighed_.data() + place;
    for (int i = 0; i < 3; ++i) {
        std::copy_n(z + i * f, f, rates + i * stride_);
        std::copy_n(z + i * f, f, weighed + i * stride_);
    }
    if (body.dofs == 3) return;
    rates += 3 * stride_;
    weighed += 3 * stride_;
    const double *z0 = z + 3 * f, *z1 = z + 4 * f, *z2 = z + 5 * f;
    for (int a = 0; a < 3; ++a) {   // w x d_a, w = K z
        const double* d = X + 3 + 3 * a;
        for (int i = 0; i < 3; ++i) {
            const int k = (i + 1) % 3, l = (i + 2) % 3;
            const double s0 = maps[k] * d[l] - maps[l] * d[k], s1 = maps[3 + k] * d[l] - maps[3 + l] * d[k],
                         s2 = maps[6 + k] * d[l] - maps[6 + l] * d[k];
            combine(rates + (3 * a + i) * stride_, {s0, s1, s2}, {z0, z1, z2}, f);
        }
    }
    for (int a = 0; a < 3; ++a) {
        const double* e = body.euler + 3 * a;
        for (int i = 0; i < 3; ++i) {
            const double *of_0 = rates + i * stride_, *of_1 = of_0 + 3 * stride_, *of_2 = of_1 + 3 * stride_;
            const std::ptrdiff_t own = (3 * a + i) * stride_;
            if (body.principal)
                combine(weighed + own, {e[a]}, {rates + own}, f);
            else
                combine(weighed + own, {e[0], e[1], e[2]}, {of_0, of_1, of_2}, f);
        }
    }
}

void MassProducts::multiply(int a)
{
    const RowFunctions& rows = row_functions();
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(a) * f_;
    const int n = (n_nodes_ - a) * f_;
    for (int i = 0; i < f_; ++i)
        rows.product(product_.data() + i * stride_,
                     {rates_.data() + from + i, stride_, weighed_.data() + from, stride_, n_rows_}, n);
}

void MassProducts::spread(const Block& to, const double* factors)
{
    double* each = factors_.data();
    for (int b = to.first; b <= to.last; ++b)
        for (int j = 0; j < f_; ++j) *each++ = factors[b];
}

void MassProducts::put_rows(const Block& to, int a, const double* factors, bool adds)
{
    spread(to, factors);
    const int n = (to.last - to.first + 1) * f_;
    for (int i = 0; i < f_; ++i) {
        const double *from = product_.data() + i * stride_ + (to.first - a) * f_, *each = factors_.data();
        double* __restrict row = to.at + i * to.apart;
        for (int c = 0; c < n && adds; ++c) row[c] += each[c] * from[c];
        for (int c = 0; c < n && !adds; ++c) row[c] = each[c] * from[c];
    }
}

void MassProducts::put_columns(const Block& to, int a, const double* factors, bool adds)
{
    spread(to, factors);
    const int n = (to.last - to.first + 1) * f_;
    for (int i = 0; i < f_; ++i) {
        const double *from = product_.data() + i * stride_ + (to.first - a) * f_, *each = factors_.data();
        double* __restrict number = to.at + i;
        for (int c = 0; c < n && adds; ++c, number += to.apart) *number += each[c] * from[c];
        for (int c = 0; c < n && !adds; ++c, number += to.apart) *number = each[c] * from[c];
    }
}

}   // namespace livens::inline spacetime_internal
