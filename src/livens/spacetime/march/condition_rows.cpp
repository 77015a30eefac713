// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component": rank is judged in numbers about 1, whatever the units.
#include "livens/spacetime/march/condition_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/solvers/dense.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double far_enough = 0.3;   // lengths and radians, from the guesses to places where rank is judged

}   // namespace

/// Steps go along free motions by scattered shares of `far_enough`, momenta are those of free motions with
/// scattered shares of `rate`. Where the joints do not close, a place half as far away is tried, up to twelve
/// times.
void place_about(const EndPoint& from, const ModelTables& tables, double rate, Scatter& scatter, EndPoint& to)
{
    const int f = tables.freedoms(), n = tables.n_twists;
    std::vector<double> y(static_cast<std::size_t>(n), 0.0), p(y), along(y);
    for (int j = 0; j < f; ++j) {
        const double size = from.size_along(from.basis(), from.maps(), j);
        y[tables.rank + j] = far_enough * scatter.next() / size;
        from.momenta_along(from.basis(), from.maps(), j, along.data());
        const double share = rate * scatter.next() / size;
        for (int i = 0; i < n; ++i) p[i] += share * along[i];
    }
    from.basis().q.apply(y.data());
    for (int halvings = 0; halvings < 12 && !to.place_moved(from, y.data(), p); ++halvings)
        for (double& value : y) value *= 0.5;
}

/// Columns: free motions and the momenta along them at the start, f and f, then likewise at the end, then
/// unknown numbers. Columns are divided by the size of their free motion (momenta by that and the duration),
/// rows by the unit of their quantity.
DenseMatrix rows_at(const std::array<const ModelTables*, 2>& tables, const std::vector<Condition>& conditions,
                    const std::array<const EndPoint*, 2>& points, double duration,
                    const DenseMatrix& by_numbers)
{
    const int m = static_cast<int>(conditions.size()),
              n = 2 * (tables[0]->freedoms() + tables[1]->freedoms());
    DenseMatrix rows(m, n + by_numbers.cols);
    for (int j = 0; j < by_numbers.cols; ++j)
        for (int i = 0; i < std::min(m, by_numbers.rows); ++i) rows(i, n + j) = by_numbers(i, j);
    for (const int end : {0, 1}) {
        const EndPoint& point = *points[end];
        const int f = tables[end]->freedoms(), first = end == 0 ? 0 : 2 * tables[0]->freedoms();
        const DenseMatrix D =
            point.derivatives(quantities_at(conditions, end == 1), point.basis(), 1 / duration);
        for (int i = 0; i < m; ++i) {
            const Condition& one = conditions[i];
            if (one.at == (end == 0 ? Condition::At::end : Condition::At::start)) continue;
            // of both ends it is what the end has less what the start has
            const double sign = end == 0 && one.at == Condition::At::both ? -1 : 1;
            const double unit = sign * unit_of(one.quantity, tables[end]->length, duration);
            for (int j = 0; j < f; ++j) {
                const double size = point.size_along(point.basis(), point.maps(), j) * unit;
                rows(i, first + j) = D(i, j) / size;
                rows(i, first + f + j) = D(i, f + j) / (size * duration);
            }
        }
    }
    return rows;
}

/// Gram and Schmidt, each row twice: what one pass leaves of a row that is nearly dependent is rounding. A
/// row below 1e-3 is compared with that and not with its own norm, or the rounding of a row that is zero
/// would count as new.
std::vector<Remainder> remainders(const DenseMatrix& rows)
{
    std::vector<Remainder> all;
    std::vector<std::vector<double>> basis;     // orthonormal, empty where a row was dependent
    std::vector<std::vector<double>> made_of;   // of rows
    for (int i = 0; i < rows.rows; ++i) {
        std::vector<double> r(static_cast<std::size_t>(rows.cols));
        for (int j = 0; j < rows.cols; ++j) r[j] = rows(i, j);
        Remainder found{0, norm(r), std::vector<double>(static_cast<std::size_t>(i), 0.0)};
        std::vector<double> own(static_cast<std::size_t>(rows.rows), 0.0);
        own[i] = 1;
        for (int round = 0; round < 2; ++round)
            for (std::size_t k = 0; k < basis.size(); ++k) {
                if (basis[k].empty()) continue;
                const double share = dot(r, basis[k]);
                add_scaled(r, -share, basis[k]);
                add_scaled(own, -share, made_of[k]);
            }
        found.norm = norm(r);
        for (int k = 0; k < i; ++k) found.shares[k] = std::abs(own[k]);
        const bool is_new = found.norm > dependent * std::max(found.of, 1e-3);
        for (double& value : r) value /= is_new ? found.norm : 1;
        for (double& value : own) value /= is_new ? found.norm : 1;
        basis.push_back(is_new ? std::move(r) : std::vector<double>{});
        made_of.push_back(std::move(own));
        all.push_back(std::move(found));
    }
    return all;
}

}   // namespace livens::inline spacetime_internal
