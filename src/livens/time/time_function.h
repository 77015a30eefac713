// SPDX-License-Identifier: BSD-3-Clause
// Scalar functions of time with two derivatives, for loads and, later, drives.
#pragma once

#include <functional>
#include <vector>

#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

struct TimeValue {
    double value = 0;
    double first = 0;    ///< 1/s times the unit of value
    double second = 0;   ///< 1/s^2 times the unit of value
};

/// A function of time, smooth between its `breaks`. At a break the side of the instant decides; Side::middle
/// is the right-hand one.
class TimeFunction {
public:
    /// The constant function; throws InputError if it is not finite.
    TimeFunction(double constant = 0);   // NOLINT: a number is the constant function

    /// `evaluate` is called with t and the side; breaks ascend.
    TimeFunction(std::function<TimeValue(Instant)> evaluate, std::vector<double> breaks);

    TimeValue operator()(Instant at) const;
    const std::vector<double>& breaks() const { return breaks_; }
    bool is_constant() const { return !evaluate_; }

private:
    double constant_ = 0;
    std::function<TimeValue(Instant)> evaluate_;
    std::vector<double> breaks_;
};

/// `inner` for from <= t < until and 0 elsewhere; infinite ends are no breaks. Throws InputError if until <=
/// from.
TimeFunction window(TimeFunction inner, double from, double until);

/// Straight lines between the rows, constant before the first and after the last; a break at every row.
/// Two rows of one time are a jump. Throws InputError: fewer than 2 rows, sizes differ, times descend, three
/// rows of one time, not finite.
TimeFunction linear_table(std::vector<double> times, std::vector<double> values);

/// Cubic spline, twice continuously differentiable, not-a-knot ends (natural below 4 rows), constant outside;
/// breaks at the first and last row. Times must ascend strictly. Throws InputError as above.
TimeFunction spline_table(std::vector<double> times, std::vector<double> values);
/// Where a higher derivative of it jumps, if it goes straight on outside: at all rows but the second from
/// either end, which are no knots from 4 rows on.
std::vector<double> knots_of_spline(std::vector<double> rows);

}   // namespace gnu::visibility("default")]]livens
