// SPDX-License-Identifier: BSD-3-Clause
// Expressions as lists of operations, evaluated with two derivatives along one direction at a time: forward
// differentiation in Taylor form, exact up to rounding. Loads take slopes by symbols (theory.md, "Joints are
// quadratic forms", Laws), drives two derivatives by time.
#include "livens/time/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/detail/expression_reader.h"

namespace livens {

namespace {

using Operation = Expression::Operation;

/// f(u) along u(s): f', f'' are derivatives of f.
TimeValue chain(const TimeValue& u, double f, double f_first, double f_second)
{
    // Where u does not move, neither does f, also where its derivative is infinite.
    if (u.first == 0 && u.second == 0) return {f, 0, 0};
    return {f, f_first * u.first, f_second * u.first * u.first + f_first * u.second};
}

TimeValue times(const TimeValue& a, const TimeValue& b)
{
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}

TimeValue inverse_of(const TimeValue& b)
{
    // Differentiation by the chain rule on 1/b; the value of a quotient itself is divided once, so that 6/3
    // is 2.
    const double i = 1 / b.value;
    return chain(b, i, -i * i, 2 * i * i * i);
}

TimeValue quotient_of(const TimeValue& a, const TimeValue& b)
{
    TimeValue q = times(a, inverse_of(b));
    q.value = a.value / b.value;
    return q;
}

TimeValue log_of(const TimeValue& a)
{
    return chain(a, logarithm(a.value), 1 / a.value, -1 / (a.value * a.value));
}

TimeValue power_of(const TimeValue& a, const TimeValue& b)
{
    // A constant exponent must not pass through log(a), which has no value for negative a. x^2 is such a
    // case.
    if (b.first == 0 && b.second == 0) {
        const double n = b.value;
        const auto term = [&](double factor, double exponent) {
            return factor == 0 ? 0 : factor * power(a.value, exponent);   // 0 times infinity is no slope
        };
        return chain(a, power(a.value, n), term(n, n - 1), term(n * (n - 1), n - 2));
    }
    const double value = power(a.value, b.value);
    return chain(times(b, log_of(a)), value, value, value);
}

TimeValue arc_tangent_of(const TimeValue& y, const TimeValue& x)
{
    // The angle turns by (x dy - y dx) / r^2, whatever its branch; the second derivative differentiates this
    // quotient.
    const double r2 = x.value * x.value + y.value * y.value;
    const double first = (x.value * y.first - y.value * x.first) / r2;
    const double r2_first = 2 * (x.value * x.first + y.value * y.first);
    return {arc_tangent(y.value, x.value), first,
            (x.value * y.second - y.value * x.second) / r2 - first * r2_first / r2};
}

TimeValue apply(Operation operation, const TimeValue& a, const TimeValue& b)
{
    switch (operation) {
    case Operation::negative:
        return {-a.value, -a.first, -a.second};
    case Operation::plus:
        return {a.value + b.value, a.first + b.first, a.second + b.second};
    case Operation::minus:
        return {a.value - b.value, a.first - b.first, a.second - b.second};
    case Operation::times:
        return times(a, b);
    case Operation::divided:
        return quotient_of(a, b);
    case Operation::power:
        return power_of(a, b);
    case Operation::sine: {
        const auto [s, c] = sine_cosine(a.value);
        return chain(a, s, c, -s);
    }
    case Operation::cosine: {
        const auto [s, c] = sine_cosine(a.value);
        return chain(a, c, -s, -c);
    }
    case Operation::tangent: {
        const auto [s, c] = sine_cosine(a.value);
        const double f = s / c;
        return chain(a, f, 1 + f * f, 2 * f * (1 + f * f));
    }
    case Operation::hyperbolic_tangent: {
        const double f = hyperbolic_tangent(a.value);
        return chain(a, f, 1 - f * f, -2 * f * (1 - f * f));
    }
    case Operation::exponential: {
        const double f = exponential(a.value);
        return chain(a, f, f, f);
    }
    case Operation::logarithm:
        return log_of(a);
    case Operation::root: {
        const double f = std::sqrt(a.value);
        return chain(a, f, 0.5 / f, -0.25 / (f * a.value));
    }
    case Operation::absolute:
        return a.value < 0 ? apply(Operation::negative, a, b) : a;
    case Operation::arc_tangent:
        return arc_tangent_of(a, b);
    case Operation::least:
        return b.value < a.value ? b : a;
    case Operation::greatest:
        return b.value > a.value ? b : a;
    case Operation::sign:   // nan stays nan
        return {a.value > 0 ? 1.0 : a.value < 0 ? -1.0 : 0 * a.value, 0, 0};
    case Operation::floor:
        return {std::floor(a.value), 0, 0};
    default:
        return {};
    }
}

/// What has no value, in words.
std::string describe(const Expression::Step& step, const TimeValue& a, const TimeValue& b)
{
    const std::string argument = to_text(a.value, 6);
    switch (step.operation) {
    case Operation::divided:
        return b.value == 0 ? "division by 0" : "a quotient that is too large";
    case Operation::logarithm:
        return "log(" + argument + ")";
    case Operation::root:
        return "sqrt(" + argument + ")";
    case Operation::power:
        return argument + " ^ " + to_text(b.value, 6);
    default:
        return "a number that is too large";
    }
}

}   // namespace

Expression::Expression(std::string_view text, std::vector<std::string> symbols, const ExpressionWords& words)
    : text_(text), steps_(read_expression(text, symbols, words))
{
    find_guards();
    // What depends on nothing has its value now, or never.
    std::vector<bool> is_constant;
    const std::vector<double> none(symbols.size());
    const std::vector<TimeValue> values = evaluate(0, none, -1);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        const bool is_leaf = step.operation == Operation::time || step.operation == Operation::symbol;
        is_constant.push_back(!is_leaf &&
                              (step.operation == Operation::number ||
                               (is_constant[step.first] && (step.second < 0 || is_constant[step.second]))));
        // A division by a constant zero is refused also where its numerator depends on time or a symbol.
        const bool is_by_zero = step.operation == Operation::divided && is_constant[step.second] &&
                                values[step.second].value == 0;
        if (!is_by_zero && (!is_constant.back() || std::isfinite(values[i].value))) continue;
        throw InputError(
            {"expression-value", "expression", "an expression has no value",
             is_by_zero ? "division by 0 at column " + std::to_string(step.column) : without_value(0, none),
             "", "", "in '" + text_ + "'"});
    }
}

Expression Expression::renumbered(std::span<const int> places) const
{
    Expression other = *this;
    for (Step& step : other.steps_)
        if (step.operation == Operation::symbol) step.first = places[static_cast<std::size_t>(step.first)];
    return other;
}

bool Expression::depends_on(std::size_t symbol) const
{
    return std::ranges::any_of(steps_, [&](const Step& step) {
        return step.operation == Operation::symbol && step.first == static_cast<int>(symbol);
    });
}

/// Of all steps, along a direction: a symbol, or time for -1.
std::vector<TimeValue> Expression::evaluate(double t, std::span<const double> symbols, int direction) const
{
    std::vector<TimeValue> values(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        switch (step.operation) {
        case Operation::number:
            values[i] = {step.number, 0, 0};
            break;
        case Operation::time:
            values[i] = {t, direction < 0 ? 1.0 : 0.0, 0};
            break;
        case Operation::symbol:
            values[i] = {symbols[step.first], step.first == direction ? 1.0 : 0.0, 0};
            break;
        default:
            values[i] = apply(step.operation, values[step.first],
                              step.second < 0 ? TimeValue{} : values[step.second]);
        }
    }
    return values;
}

double Expression::operator()(double t, std::span<const double> symbols, std::span<double> slopes) const
{
    if (slopes.empty()) return evaluate(t, symbols, -1).back().value;
    for (std::size_t k = 0; k < slopes.size(); ++k)
        // One pass for each symbol: expressions are short, and symbols few (`most_symbols`).
        slopes[k] = depends_on(k) ? evaluate(t, symbols, static_cast<int>(k)).back().first : 0;
    return evaluate(t, symbols, -1).back().value;
}

std::vector<double> Expression::values(double t, std::span<const double> symbols) const
{
    std::vector<double> all;
    for (const TimeValue& value : evaluate(t, symbols, -1)) all.push_back(value.value);
    return all;
}

TimeValue Expression::by_symbol(double symbol) const { return evaluate(0, {&symbol, 1}, 0).back(); }

TimeValue Expression::by_time(double t, std::span<const double> symbols) const
{
    return evaluate(t, symbols, -1).back();
}

std::string Expression::without_value(double t, std::span<const double> symbols) const
{
    const std::vector<TimeValue> values = evaluate(t, symbols, -1);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        // Steps stand in the order of evaluation, so the first value that is no number is the cause of all
        // later ones.
        if (std::isfinite(values[i].value)) continue;
        const Step& step = steps_[i];
        const TimeValue a =
            step.operation == Operation::symbol || step.first < 0 ? TimeValue{} : values[step.first];
        return describe(step, a, step.second < 0 ? TimeValue{} : values[step.second]) + " at column " +
               std::to_string(step.column);
    }
    return "";
}

TimeFunction expression_of_time(const Expression& expression, std::vector<double> breaks)
{
    std::ranges::sort(breaks);
    return {[expression, breaks](Instant at) { return expression.by_time(beside_breaks(at, breaks)); },
            breaks};
}

double beside_breaks(Instant at, const std::vector<double>& breaks)
{
    if (!std::ranges::binary_search(breaks, at.t)) return at.t;
    // a few digits off: where an argument is zero itself, it is on one side only
    const double off = 1e-15 * std::abs(at.t) + std::numeric_limits<double>::min();
    return at.side == Side::left ? at.t - off : at.t + off;
}

}   // namespace livens
