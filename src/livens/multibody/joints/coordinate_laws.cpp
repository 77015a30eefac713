// SPDX-License-Identifier: BSD-3-Clause
// Laws of couplings: splines through tables, and formulas with exact derivatives. Where a third derivative
// jumps an element ends, as at the knots of slots (theory.md, "Laws that bend").
#include "livens/multibody/joints/coordinate_laws.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/time_laws.h"

namespace livens {

namespace {

constexpr int rows_beyond = 30;   // rows, by which what a spline does at its ends has died away
constexpr double same = 1e-12;    // of the largest value: the same but for rounding

[[noreturn]] void refuse_law(const std::string& message, const std::string& value, const std::string& help)
{
    throw InputError({"coupling-law", "joint.law", message, value, "", "", help});
}

/// As tables of time are checked, but of coordinates.
void check_rows(const std::vector<double>& coordinates, const std::vector<double>& values)
{
    const auto refuse = [](const char* code, const std::string& message, double value, const char* bound) {
        throw InputError({code, "joint.law", message, to_text(value), bound, "", ""});
    };
    if (coordinates.size() != values.size())
        throw InputError({"table-size", "joint.law",
                          "the table of a law needs one value for every coordinate",
                          std::to_string(values.size()) + " values",
                          std::to_string(coordinates.size()) + " coordinates", "", ""});
    if (coordinates.size() < 2)
        refuse("table-size", "the table of a law needs at least two rows",
               static_cast<double>(coordinates.size()), ">= 2");
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const std::string row = "row " + std::to_string(i + 1) + " of the table of a law";
        if (!std::isfinite(coordinates[i]))
            refuse("not-finite", row + " has no finite coordinate", coordinates[i], "finite");
        if (!std::isfinite(values[i]))
            refuse("not-finite", row + " has no finite value", values[i], "finite");
        if (i > 0 && !(coordinates[i] > coordinates[i - 1]))
            refuse("table-order", row + " has no larger coordinate than the row before it", coordinates[i],
                   "coordinates ascend");
    }
}

/// One round with as many rows before and behind as it takes to forget the ends.
/// Row k of a round of n rows is row k - n floor(k / n), as many periods and rises on.
TimeFunction periodic_spline(const std::vector<double>& at, const std::vector<double>& values, double period,
                             double rise)
{
    const int n = static_cast<int>(at.size()) - 1;
    std::vector<double> rows, there;
    for (int k = -rows_beyond; k <= n + rows_beyond; ++k) {
        const int round = k >= 0 ? k / n : -((n - 1 - k) / n);
        const auto row = static_cast<std::size_t>(k - round * n);
        rows.push_back(at[row] + round * period);
        there.push_back(values[row] + round * rise);
    }
    return spline_table(rows, there);
}

/// Whether f(q + turn) is f(q) and a number, which is `rise` then.
bool repeats(const TimeFunction& f, double turn, double& rise)
{
    constexpr int looks = 64;
    double size = 0, steepest = 0, apart = 0, steps_apart = 0;
    rise = f({turn}).value - f({0}).value;
    for (int k = 0; k < looks; ++k) {
        const double q = turn * k / looks;
        const TimeValue here = f({q}), there = f({q + turn});
        size = std::max({size, std::abs(here.value), std::abs(there.value)});
        steepest = std::max(steepest, std::abs(here.first));
        apart = std::max(apart, std::abs(there.value - here.value - rise));
        steps_apart = std::max(steps_apart, std::abs(there.first - here.first));
    }
    if (!std::isfinite(rise + size)) return false;   // as a logarithm at 0
    if (std::abs(rise) <= same * size) rise = 0;
    return apart <= same * size && steps_apart <= same * std::max(steepest, size);
}

}   // namespace

CoordinateLaw tabulated_law(const std::vector<double>& coordinates, const std::vector<double>& values,
                            bool is_periodic)
{
    CoordinateLaw law;
    check_rows(coordinates, values);
    law.at = spline_table(coordinates, values);   // throws for slopes beyond numbers
    law.low = coordinates.front();
    law.high = coordinates.back();
    if (!is_periodic) {
        // hairs beyond the ends are those of rounding
        law.at = straight_on(law.at, law.low, law.high);
        law.knots = knots_of_spline(coordinates);
        law.knots.erase(law.knots.begin());
        law.knots.pop_back();
        return law;
    }
    if (coordinates.size() < 4)
        throw InputError({"table-size", "joint.law", "a periodic table needs at least four rows",
                          std::to_string(coordinates.size()), ">= 4", "its last row is its first again", ""});
    law.period = law.high - law.low;
    law.rise = values.back() - values.front();
    double size = 0;
    for (const double value : values) size = std::max(size, std::abs(value));
    if (std::abs(law.rise) <= same * size) law.rise = 0;
    law.at = periodic_spline(coordinates, values, law.period, law.rise);
    law.knots.assign(coordinates.begin(), coordinates.end() - 1);
    return law;
}

CoordinateLaw formula_law(const Expression& expression, bool is_angle)
{
    const std::string in = "in '" + expression.text() + "'";
    if (const std::string kink = expression.kink_by_symbols(); !kink.empty())
        refuse_law("the law of a coupling must be smooth", kink + " " + in,
                   "a kink would need infinite forces; take a smooth formula, or a table");
    for (const Expression::Step& step : expression.steps())
        if (step.operation == Expression::Operation::time)
            refuse_law("the law of a coupling depends on the coordinate alone", "t " + in,
                       "what follows time is a drive");
    if (!expression.depends_on(0))
        refuse_law("the law of a coupling does not depend on its coordinate", in,
                   "what is constant is held by a drive");
    CoordinateLaw law;
    law.at = {[expression](Instant at) { return expression.by_symbol(at.t); }, {}};
    constexpr double turn = 2 * std::numbers::pi;
    double rise = 0;
    if (!is_angle || !repeats(law.at, turn, rise)) return law;
    law.low = 0;
    law.high = law.period = turn;
    law.rise = rise;
    return law;
}

}   // namespace livens
