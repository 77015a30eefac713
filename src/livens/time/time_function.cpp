// SPDX-License-Identifier: BSD-3-Clause
// Functions of time with two derivatives (`TimeValue`): constants, tables, cubic splines and windows. Drives
// need both derivatives (theory.md, "Drives"); the breaks are instants at which an element has to end, since
// quadrature over a jump loses all order (theory.md, "Why two rules").
#include "livens/time/time_function.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"

namespace livens {
namespace {

[[noreturn]] void refuse_table(const char* code, const std::string& message, const std::string& value,
                               const std::string& bound)
{
    throw InputError({code, "load.table", message, value, bound, "", ""});
}

/// What both kinds of table ask for; `repeats` is the number of rows that may share a time.
void check_table(const std::vector<double>& times, const std::vector<double>& values, std::size_t repeats)
{
    if (times.size() != values.size()) {
        refuse_table("table-size", "a table needs one value for every time",
                     std::to_string(values.size()) + " values", std::to_string(times.size()) + " times");
    }
    if (times.size() < 2) {
        refuse_table("table-size", "a table needs at least two rows", std::to_string(times.size()), ">= 2");
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        const std::string row = "row " + std::to_string(i + 1) + " of a table";
        if (!std::isfinite(times[i]))
            refuse_table("not-finite", row + " has no finite time", to_text(times[i]), "finite");
        if (!std::isfinite(values[i])) {
            refuse_table("not-finite", row + " has no finite value", to_text(values[i]), "finite");
        }
        if (i > 0 && times[i] < times[i - 1]) {
            refuse_table("table-order", row + " goes back in time", to_text(times[i]),
                         ">= " + to_text(times[i - 1]));
        }
        if (i >= repeats && times[i] == times[i - repeats]) {
            refuse_table("table-order",
                         row + (repeats == 1 ? " repeats the time before it" : " is the third of one time"),
                         to_text(times[i]),
                         repeats == 1 ? "times ascend strictly" : "two rows of one time are a jump");
        }
        // Slopes must be numbers too.
        if (i > 0 && times[i] != times[i - 1] &&
            !std::isfinite((values[i] - values[i - 1]) / (times[i] - times[i - 1]))) {
            refuse_table("table-slope", row + " is too steep to compute with", to_text(values[i]),
                         "a finite slope");
        }
    }
}

struct Table {
    std::vector<double> times;
    std::vector<double> values;
    std::vector<double> slopes;   // of the spline at the rows; empty for straight lines
};

/// The number of rows that lie before the instant: 0 before the table, all of them after it.
std::size_t rows_before(const std::vector<double>& times, Instant at)
{
    // A row that stands twice is a jump: seen from the left its first value counts, from the right its
    // second.
    const auto found = at.side == Side::left ? std::lower_bound(times.begin(), times.end(), at.t)
                                             : std::upper_bound(times.begin(), times.end(), at.t);
    return static_cast<std::size_t>(found - times.begin());
}

TimeValue evaluate_linear(const Table& table, Instant at)
{
    const std::size_t i = rows_before(table.times, at);
    if (i == 0) return {table.values.front(), 0, 0};
    if (i == table.times.size()) return {table.values.back(), 0, 0};
    const double length = table.times[i] - table.times[i - 1];
    const double u = (at.t - table.times[i - 1]) / length;
    // This form gives both rows to the bit.
    return {(1 - u) * table.values[i - 1] + u * table.values[i],
            (table.values[i] - table.values[i - 1]) / length, 0};
}

TimeValue evaluate_spline(const Table& table, Instant at)
{
    const std::size_t i = rows_before(table.times, at);
    if (i == 0) return {table.values.front(), 0, 0};
    if (i == table.times.size()) return {table.values.back(), 0, 0};
    const double length = table.times[i] - table.times[i - 1], dt = at.t - table.times[i - 1];
    const double chord = (table.values[i] - table.values[i - 1]) / length;
    const double s0 = table.slopes[i - 1], s1 = table.slopes[i];
    // Hermite's cubic on the piece, by Horner from its left row; slopes at the rows are those of the whole
    // spline.
    const double c2 = (3 * chord - 2 * s0 - s1) / length;
    const double c3 = (s0 + s1 - 2 * chord) / (length * length);
    return {table.values[i - 1] + dt * (s0 + dt * (c2 + dt * c3)), s0 + dt * (2 * c2 + dt * 3 * c3),
            2 * c2 + 6 * dt * c3};
}

/// One row of the tridiagonal system of the slopes: lower s_{i-1} + diagonal s_i + upper s_{i+1} = right.
struct SlopeRow {
    double lower, diagonal, upper, right;
};

/// Continuity of the second derivative at inner rows; at the ends not-a-knot (the third derivative does not
/// jump at the second row) or, below 4 rows, no curvature. Elimination without pivoting is safe: after the
/// first row, which not-a-knot leaves with a small pivot but a known one, every row is dominated by its
/// diagonal, see [de Boor, ch. IV].
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& v)
{
    const std::size_t n = t.size();
    std::vector<double> h(n - 1), chord(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h[i] = t[i + 1] - t[i];
        chord[i] = (v[i + 1] - v[i]) / h[i];
    }
    std::vector<SlopeRow> rows(n);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        rows[i] = {h[i], 2 * (h[i - 1] + h[i]), h[i - 1], 3 * (h[i] * chord[i - 1] + h[i - 1] * chord[i])};
    }
    if (n < 4) {
        rows[0] = {0, 2, 1, 3 * chord[0]};
        rows[n - 1] = {1, 2, 0, 3 * chord[n - 2]};
    } else {
        const auto end_row = [](double h0, double h1, double m0, double m1) {   // [de Boor, IV (6)]
            const double d = h0 + h1;
            return SlopeRow{d, h1, d, ((h0 + 2 * d) * h1 * m0 + h0 * h0 * m1) / d};
        };
        rows[0] = end_row(h[0], h[1], chord[0], chord[1]);
        rows[n - 1] = end_row(h[n - 2], h[n - 3], chord[n - 2], chord[n - 3]);
    }
    for (std::size_t i = 1; i < n; ++i) {
        const double factor = rows[i].lower / rows[i - 1].diagonal;
        rows[i].diagonal -= factor * rows[i - 1].upper;
        rows[i].right -= factor * rows[i - 1].right;
    }
    std::vector<double> slopes(n);
    slopes[n - 1] = rows[n - 1].right / rows[n - 1].diagonal;
    for (std::size_t i = n - 1; i-- > 0;) {
        slopes[i] = (rows[i].right - rows[i].upper * slopes[i + 1]) / rows[i].diagonal;
    }
    return slopes;
}

}   // namespace

TimeFunction::TimeFunction(double constant) : constant_(constant)
{
    if (!std::isfinite(constant)) {
        throw InputError({"not-finite", "load.value", "a function of time must have finite values",
                          to_text(constant), "finite", "", ""});
    }
}

TimeFunction::TimeFunction(std::function<TimeValue(Instant)> evaluate, std::vector<double> breaks)
    : evaluate_(std::move(evaluate)), breaks_(std::move(breaks))
{
    assert(evaluate_);
    assert(std::is_sorted(breaks_.begin(), breaks_.end()));
}

TimeValue TimeFunction::operator()(Instant at) const
{
    // A constant keeps no function: weights and springs are asked at every load point.
    if (!evaluate_) return {constant_, 0, 0};
    // Inside an element no side is meant; the value at an instant itself is that from the right.
    if (at.side == Side::middle) at.side = Side::right;
    return evaluate_(at);
}

TimeFunction window(TimeFunction inner, double from, double until)
{
    if (!(from < until)) {
        throw InputError({"window-order", "load.until", "a window must close after it opens", to_text(until),
                          "> " + to_text(from), "", ""});
    }
    std::vector<double> breaks;
    if (std::isfinite(from)) breaks.push_back(from);
    for (const double t : inner.breaks()) {
        // Where the window is shut the inner function has no effect, and its breaks would only cost elements.
        if (t > from && t < until) breaks.push_back(t);
    }
    if (std::isfinite(until)) breaks.push_back(until);
    const auto evaluate = [inner = std::move(inner), from, until](Instant at) {
        const bool open = at.side == Side::left ? from < at.t && at.t <= until : from <= at.t && at.t < until;
        return open ? inner(at) : TimeValue{};
    };
    return {evaluate, std::move(breaks)};
}

TimeFunction linear_table(std::vector<double> times, std::vector<double> values)
{
    check_table(times, values, 2);
    std::vector<double> breaks = times;
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    // Shared, so that copies of the function do not copy the table.
    const auto table = std::make_shared<const Table>(Table{std::move(times), std::move(values), {}});
    return {[table](Instant at) { return evaluate_linear(*table, at); }, std::move(breaks)};
}

TimeFunction spline_table(std::vector<double> times, std::vector<double> values)
{
    check_table(times, values, 1);
    std::vector<double> slopes = spline_slopes(times, values);
    // The spline has two continuous derivatives at its rows; only its ends bend, where it goes on as a
    // constant.
    std::vector<double> breaks{times.front(), times.back()};
    const auto table =
        std::make_shared<const Table>(Table{std::move(times), std::move(values), std::move(slopes)});
    return {[table](Instant at) { return evaluate_spline(*table, at); }, std::move(breaks)};
}

std::vector<double> knots_of_spline(std::vector<double> rows)
{
    // Not-a-knot: the third derivative does not jump at the second and the last but one row, so these are no
    // knots.
    if (rows.size() < 4) return rows;
    rows.erase(rows.end() - 2);
    rows.erase(rows.begin() + 1);
    return rows;
}

}   // namespace livens
