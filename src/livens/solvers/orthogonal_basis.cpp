// SPDX-License-Identifier: BSD-3-Clause
// Householder QR of the columns that joints have at one place: [Y Z][R; 0] of theory.md, "Eliminating the
// joint multipliers". Columns touch few bodies: what is zero is left out.
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/solvers/dense.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"

namespace livens {

namespace {

/// A column of so many numbers is gone through by the places of those that are not zero, if they are few.
bool goes_by_places(int used, int numbers) { return (numbers < 16 ? 2 : 4) * used <= numbers; }

/// Columns of so few numbers are gone through whole.
constexpr int most_short = 32;
constexpr bool is_short(int numbers) { return numbers <= most_short; }

}   // namespace

void OrthogonalBasis::resize(int n, int most)
{
    n_ = n;
    most_ = most;
    k_ = 0;
    stride_ = n + register_room;
    g_.assign(static_cast<std::size_t>(most) * static_cast<std::size_t>(stride_), 0.0);
    Reflection of_whole_column;
    of_whole_column.filled_end = n;
    reflections_.assign(static_cast<std::size_t>(most), of_whole_column);
    places_.assign(count(n, most), 0);
}

/// Brings the largest of the entries j..end - 1 of column j to place j; the others are zero.
void OrthogonalBasis::lead(int j, bool keep, int end)
{
    double* v = column(j);
    if (!keep) {
        int best = j;
        double largest = std::abs(v[j]);
        for (int i = j + 1; i < end; ++i) {
            if (!(std::abs(v[i]) > largest)) continue;
            best = i;
            largest = std::abs(v[i]);
        }
        reflections_[j].lead = best;
    }
    std::swap(v[j], v[reflections_[j].lead]);
}

/// Makes the reflector of column j from its entries j..behind - 1 and puts R_jj in place; the others are
/// zero.
void OrthogonalBasis::reflect(int j, bool keep_sign, int behind)
{
    double* v = column(j);
    int* places = places_.data() + count(n_, j);
    int used = 0, end = j + 1;
    double tail = 0;
    for (int i = j + 1; i < behind; ++i) {
        if (v[i] == 0) continue;
        tail += v[i] * v[i];
        places[used++] = i;
        end = i + 1;
    }
    reflections_[j].end = end;
    reflections_[j].reach = std::max(end, reflections_[j].lead + 1);
    reflections_[j].all_reach = std::max(reflections_[j].reach, j > 0 ? reflections_[j - 1].all_reach : 0);
    reflections_[j].used = goes_by_places(used, end - j) ? used : -1;
    const double head = v[j];
    const double length = std::sqrt(head * head + tail);
    // the kept sign would cancel where head has come close to it
    if (!keep_sign || reflections_[j].sign * head > 0.99 * length) reflections_[j].sign = head > 0 ? -1 : 1;
    const double r = reflections_[j].sign * length;
    const double v0 = head - r;
    if (length == 0) {
        reflections_[j].beta = 0;
        return;
    }
    const double scale = 1 / v0;
    for (int i = 0; i < used; ++i) v[places[i]] *= scale;
    reflections_[j].beta = -v0 / r;
    v[j] = r;
}

/// Exchange j, then reflection j.
void OrthogonalBasis::reflect_column(int j, double* x, const RowFunctions& rows) const
{
    std::swap(x[j], x[reflections_[j].lead]);
    reflect_only(j, x, rows);
}

inline void OrthogonalBasis::reflect_only(int j, double* x, const RowFunctions& rows) const
{
    if (reflections_[j].beta == 0) return;
    const double* v = column(j);
    const int used = reflections_[j].used;
    if (used < 0) {
        const int m = reflections_[j].end - j - 1;
        if (m >= few) return rows.reflect(x + j, x + j + 1, reflections_[j].beta, v + j + 1, m);
        const double t = reflections_[j].beta * (x[j] + inner(v + j + 1, x + j + 1, m));
        if (t == 0) return;
        x[j] -= t;
        subtract_scaled(x + j + 1, t, v + j + 1, m);
        return;
    }
    const int* places = places_.data() + count(n_, j);
    double t = x[j];
    for (int i = 0; i < used; ++i) t += v[places[i]] * x[places[i]];
    t *= reflections_[j].beta;
    x[j] -= t;
    for (int i = 0; i < used; ++i) x[places[i]] -= t * v[places[i]];
}

/// Column j by reflections 0..j - 1, of which those change nothing on whose rows it is zero: of a chain of
/// bodies all but the last few. Entries from what is returned on are zero.
int OrthogonalBasis::reflect_by_those_before(int j, const RowFunctions& rows)
{
    double* x = column(j);
    int first = reflections_[j].filled_first, end = reflections_[j].filled_end;   // what is not zero
    while (end > 0 && x[end - 1] == 0) --end;
    while (first < end && x[first] == 0) ++first;
    // Up to which row the reflections 0..i reach together goes up with i.
    int i = 0;
    for (int above = j; i < above;) {
        const int middle = (i + above) / 2;
        if (reflections_[static_cast<std::size_t>(middle)].all_reach <= first)
            i = middle + 1;
        else
            above = middle;
    }
    for (; i < j; ++i) {
        const Reflection& one = reflections_[static_cast<std::size_t>(i)];
        if (one.reach <= first || end <= i) continue;
        reflect_column(i, x, rows);
        first = std::min(first, i + 1);   // row i is done with
        end = std::max(end, one.reach);
    }
    return std::max(end, j + 1);
}

/// The same of short columns, which are not looked through.
int OrthogonalBasis::reflect_by_all_before(int j, const RowFunctions& rows)
{
    double* x = column(j);
    int first = reflections_[j].filled_first, end = reflections_[j].filled_end;
    int i = 0;
    while (i < j && reflections_[i].all_reach <= first) ++i;   // which reach no row
    if (i < j) {
        rows.reflect_all(x, g_.data(), stride_, reflections_.data(), i, j);
        end = std::max(end, reflections_[j - 1].all_reach);
    }
    while (end > j + 1 && x[end - 1] == 0) --end;
    return std::max(end, j + 1);
}

double OrthogonalBasis::factorise(int k, bool keep_choices)
{
    k_ = k;
    const RowFunctions& rows = row_functions();
    double smallest = 1;
    for (int j = 0; j < k; ++j) {
        double* x = column(j);
        if (is_short(n_)) {
            std::fill_n(x + n_, register_room, 0.0);
            const int end = reflect_by_all_before(j, rows);
            lead(j, keep_choices, end);
            Reflection& one = reflections_[j];
            one.end = one.reach = std::max(end, one.lead + 1);
            one.all_reach = std::max(one.reach, j > 0 ? reflections_[j - 1].all_reach : 0);
            one.used = -1;
            rows.make_reflection(x + j, one.end - j - 1, &one, keep_choices);
        } else {
            if (n_ >= large) Patience::ask();
            const int end = reflect_by_those_before(j, rows);
            lead(j, keep_choices, end);
            reflect(j, keep_choices, std::max(end, reflections_[static_cast<std::size_t>(j)].lead + 1));
        }
        smallest = std::min(smallest, std::abs(x[j]));
    }
    return smallest;
}

double OrthogonalBasis::factorise_pivoted(int k, std::span<int> order)
{
    k_ = k;
    const RowFunctions& rows = row_functions();
    for (int j = 0; j < most_; ++j) {
        order[j] = j;
        std::fill_n(column(j) + n_, register_room, 0.0);
        reflections_[j].norm = inner(column(j), column(j), n_);
    }
    double smallest = 1;
    for (int j = 0; j < k; ++j) {
        if (n_ >= large) Patience::ask();
        // ties go to the earlier row, so that the choice does not hang on rounding
        int best = j;
        for (int c = j + 1; c < most_; ++c) {
            if (reflections_[c].norm > reflections_[best].norm * (1 + 1e-10)) best = c;
        }
        if (best != j) {
            std::swap_ranges(column(j), column(j) + n_, column(best));
            std::swap(reflections_[j].norm, reflections_[best].norm);
            std::swap(order[j], order[best]);
        }
        lead(j, false, n_);
        reflect(j, false, n_);
        smallest = std::min(smallest, std::abs(column(j)[j]));
        for (int c = j + 1; c < most_; ++c) {
            reflect_column(j, column(c), rows);
            // Norms are taken anew instead of reduced: a reduced norm has no digits left where a column
            // depends on others.
            reflections_[c].norm = inner(column(c) + j + 1, column(c) + j + 1, n_ - j - 1);
        }
    }
    return smallest;
}

void OrthogonalBasis::apply_transposed(double* x) const
{
    const RowFunctions& rows = row_functions();
    if (is_short(n_)) {
        double y[most_short + register_room];
        std::fill_n(std::copy_n(x, n_, y), register_room, 0.0);
        rows.reflect_all(y, g_.data(), stride_, reflections_.data(), 0, k_);
        std::copy_n(y, n_, x);
        return;
    }
    for (int j = 0; j < k_; ++j) {
        std::swap(x[j], x[reflections_[j].lead]);
        reflect_only(j, x, rows);
    }
}

void OrthogonalBasis::apply(double* x) const
{
    const RowFunctions& rows = row_functions();
    if (is_short(n_)) {
        double y[most_short + register_room];
        std::fill_n(std::copy_n(x, n_, y), register_room, 0.0);
        rows.reflect_back(y, g_.data(), stride_, reflections_.data(), k_);
        std::copy_n(y, n_, x);
        return;
    }
    for (int j = k_ - 1; j >= 0; --j) {
        reflect_only(j, x, rows);
        std::swap(x[j], x[reflections_[j].lead]);
    }
}

void OrthogonalBasis::solve_R(double* y) const
{
    const RowFunctions& rows = row_functions();
    for (int j = k_ - 1; j >= 0; --j) {
        const double* c = column(j);
        y[j] /= c[j];
        subtract_scaled(rows, y, y[j], c, j);
    }
}

void OrthogonalBasis::solve_R_transposed(double* y) const
{
    const RowFunctions& rows = row_functions();
    for (int j = 0; j < k_; ++j) {
        const double* c = column(j);
        y[j] = (y[j] - inner(rows, c, y, j)) / c[j];
    }
}

/// Q times the last n - k columns of the identity, by reflections in the opposite order. Row j of z is zero
/// until reflection j, so that one product is enough for it.
void OrthogonalBasis::null_space(double* z) const
{
    const int f = n_ - k_;
    const RowFunctions& rows = row_functions();
    std::fill(z, z + count(n_, f), 0.0);
    for (int i = 0; i < f; ++i) z[count(k_ + i, f) + static_cast<std::size_t>(i)] = 1;
    for (int j = k_ - 1; j >= 0; --j) {
        const Reflection& one = reflections_[j];
        if (one.beta != 0 && is_short(n_))
            rows.reflect_rows(z + count(j, f), f, one.beta, column(j) + j + 1, one.end - j - 1);
        else if (one.beta != 0)
            reflect_rows(j, z, rows);
        if (reflections_[j].lead != j)
            std::swap_ranges(z + count(j, f), z + count(j + 1, f), z + count(reflections_[j].lead, f));
    }
}

/// Reflection j of the rows of z, whose row j is zero and becomes what the others get of it.
void OrthogonalBasis::reflect_rows(int j, double* z, const RowFunctions& rows) const
{
    const int f = n_ - k_;
    const double* v = column(j);
    double* zj = z + count(j, f);
    for (int i = j + 1; i < reflections_[j].end; ++i)
        if (v[i] != 0) subtract_scaled(rows, zj, v[i], z + count(i, f), f);
    for (int c = 0; c < f; ++c) zj[c] *= reflections_[j].beta;
    for (int i = j + 1; i < reflections_[j].end; ++i)
        if (v[i] != 0) subtract_scaled(rows, z + count(i, f), -v[i], zj, f);
}

}   // namespace livens
