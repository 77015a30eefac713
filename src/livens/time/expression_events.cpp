// SPDX-License-Identifier: BSD-3-Clause
// Where expressions jump, bend, or come and go so fast that elements could step over it.
// Jumps and bends of time alone become element ends; those that the motion decides become guards (theory.md,
// "Laws that bend"). Pulses and calm stretches are fenced in, since an element that grew long in the calm
// would step over what follows ("Looks at laws" bounds what is left).
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "livens/time/expression.h"

namespace livens {

namespace {

using Operation = Expression::Operation;

constexpr int n_looks = 4096;
constexpr std::size_t most_events = 1000;   // beyond, it is an oscillation, which elements resolve or not

/// What changes its sign where the operation jumps or bends.
double switching(const Expression::Step& step, const std::vector<TimeValue>& values)
{
    switch (step.operation) {
    case Operation::absolute:
    case Operation::sign:
        return values[step.first].value;
    case Operation::floor: {
        // Of the sign of the parity, and nowhere twice the same.
        const double x = values[step.first].value;
        return (std::remainder(std::floor(x), 2) == 0 ? 1 : -1) * (2 + x / (1 + std::abs(x)));
    }
    case Operation::least:
    case Operation::greatest:
        return values[step.first].value - values[step.second].value;
    case Operation::arc_tangent:
        return values[step.first].value;
    case Operation::divided:
        return values[step.second].value;
    default:
        return 1;
    }
}

const char* word_of(Operation operation)
{
    switch (operation) {
    case Operation::absolute:
        return "abs";
    case Operation::least:
        return "min";
    case Operation::greatest:
        return "max";
    case Operation::arc_tangent:
        return "atan2";
    case Operation::sign:
        return "sign";
    case Operation::floor:
        return "floor";
    default:
        return "";
    }
}

/// Whether it jumps or bends where `switching` changes its sign: atan2(y, x) only where x is not positive.
bool happens(const Expression::Step& step, const std::vector<TimeValue>& values)
{
    return step.operation != Operation::arc_tangent || !(values[step.second].value > 0);
}

/// Where a function changes its sign, to the last digit.
double root(const std::function<double(double)>& f, double a, double b)
{
    // Bisection halves the bracket until no number lies between its ends. `b` is returned: the first number
    // that is known to lie on the far side.
    const bool is_positive = f(a) > 0;
    for (int i = 0; i < 200; ++i) {
        const double middle = a + 0.5 * (b - a);
        if (!(middle > a && middle < b)) break;
        ((f(middle) > 0) == is_positive ? a : b) = middle;
    }
    return b;
}

/// Ends and middles of stretches that hold much of all that changes: of a pulse, and beside it, so that no
/// long element ends in its foot.
void add_pulses(const std::vector<double>& looks, double from, double length, std::vector<double>& events)
{
    // A hundredth of the time: a pulse as short as that may fall between the load points of an ordinary
    // element.
    constexpr int width = n_looks / 100;
    std::vector<double> sum{0};
    for (std::size_t i = 1; i < looks.size(); ++i) {
        const double change = std::abs(looks[i] - looks[i - 1]);
        sum.push_back(sum.back() + (std::isfinite(change) ? change : 0));
    }
    const auto at = [&](int i) { return from + length * i / n_looks; };
    for (int i = 0; i + width <= n_looks; i += width / 2) {
        const double inside = sum[static_cast<std::size_t>(i + width)] - sum[static_cast<std::size_t>(i)];
        // A fifth of all change within a hundredth of the time is a pulse; an even oscillation has a
        // hundredth of it.
        if (!(inside > 0.2 * sum.back())) continue;
        const auto first = looks.begin() + i, last = looks.begin() + i + width;
        const auto peak =
            std::max_element(first, last, [](double l, double r) { return std::abs(l) < std::abs(r); });
        const int middle = static_cast<int>(peak - looks.begin());
        for (const int k : {i - 2 * width, i - width, i - width / 2, i, middle - 1, middle, middle + 1,
                            i + width, i + width + width / 2, i + 2 * width, i + 3 * width})
            if (k > 0 && k < n_looks) events.push_back(at(k));
    }
}

/// Where stretches end in which nothing changes: an element that begins there sees what follows, and one that
/// goes on from there, grown long in the calm, would step into the rise of a pulse and see its foot at best.
void add_calm(const std::vector<double>& looks, double from, double length, std::vector<double>& events)
{
    constexpr int shortest = n_looks / 200;
    constexpr double nothing = 1e-13;   // of the largest change between two looks
    const auto change = [&](int i) {
        const double d =
            std::abs(looks[static_cast<std::size_t>(i)] - looks[static_cast<std::size_t>(i - 1)]);
        return std::isfinite(d) ? d : 0;
    };
    double largest = 0;
    for (int i = 1; i <= n_looks; ++i) largest = std::max(largest, change(i));
    for (int i = 1, begin = 0; i <= n_looks + 1; ++i) {
        const bool is_calm = i <= n_looks && change(i) <= nothing * largest;
        if (is_calm) continue;
        for (const int end : {begin, i - 1})
            if (i - 1 - begin >= shortest && end > 0 && end < n_looks)
                events.push_back(from + length * end / n_looks);
        begin = i;
    }
}

/// The largest parts without symbols, numbers and time itself apart.
std::vector<std::size_t> parts_of_time(const std::vector<Expression::Step>& steps,
                                       const std::vector<bool>& has_symbols)
{
    std::vector<bool> is_part(steps.size(), false);
    is_part.back() = !has_symbols.back();
    const auto is_leaf = [&](int k) {
        return steps[static_cast<std::size_t>(k)].operation == Operation::number ||
               steps[static_cast<std::size_t>(k)].operation == Operation::time;
    };
    for (std::size_t k = 0; k < steps.size(); ++k) {
        if (!has_symbols[k] || steps[k].operation == Operation::symbol) continue;
        for (const int of : {steps[k].first, steps[k].second})
            if (of >= 0 && !has_symbols[static_cast<std::size_t>(of)] && !is_leaf(of))
                is_part[static_cast<std::size_t>(of)] = true;
    }
    std::vector<std::size_t> parts;
    for (std::size_t k = 0; k < steps.size(); ++k)
        if (is_part[k]) parts.push_back(k);
    return parts;
}

}   // namespace

std::vector<bool> Expression::steps_with_symbols() const
{
    std::vector<bool> has;
    for (const Step& step : steps_)
        has.push_back(step.operation == Operation::symbol ||
                      (step.operation != Operation::number && step.operation != Operation::time &&
                       (has[step.first] || (step.second >= 0 && has[step.second]))));
    return has;
}

std::vector<double> Expression::events(double from, double until) const
{
    // Without t nothing happens at an instant of its own.
    if (std::ranges::none_of(steps_, [](const Step& step) { return step.operation == Operation::time; }))
        return {};
    const std::vector<bool> has_symbols = steps_with_symbols();
    const std::vector<double> none(most_symbols);
    const double length = until - from;
    std::vector<std::vector<TimeValue>> all;
    for (int i = 0; i <= n_looks; ++i) all.push_back(evaluate(from + length * i / n_looks, none, -1));
    std::vector<double> events;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
        // Operations without a switch, and divisions by a constant, have one number at both looks.
        if (has_symbols[k] || switching(steps_[k], all[0]) == switching(steps_[k], all[n_looks / 3]))
            continue;
        const auto f = [&](double t) { return switching(steps_[k], evaluate(t, none, -1)); };
        for (int i = 0; i < n_looks; ++i) {
            if ((switching(steps_[k], all[i]) > 0) == (switching(steps_[k], all[i + 1]) > 0)) continue;
            const double t = root(f, from + length * i / n_looks, from + length * (i + 1) / n_looks);
            // atan2 is asked on both sides: x may change its sign at the same instant.
            const double before = std::nextafter(t, from);
            if (happens(steps_[k], evaluate(before, none, -1)) || happens(steps_[k], evaluate(t, none, -1)))
                events.push_back(t);
        }
    }
    // of every part that time alone decides: beside the motion it acts as well
    std::vector<double> fences;
    for (const std::size_t k : parts_of_time(steps_, has_symbols)) {
        std::vector<double> looks;
        for (const std::vector<TimeValue>& values : all) looks.push_back(values[k].value);
        add_pulses(looks, from, length, fences);
        add_calm(looks, from, length, fences);
    }
    // the instants of jumps and bends are known to the last digit: no element of a look's length beside them
    std::ranges::sort(events);
    const std::vector<double> exact = events;
    const double look = length / n_looks;
    std::ranges::copy_if(fences, std::back_inserter(events), [&](double t) {
        const auto after = std::ranges::lower_bound(exact, t - look);
        return after == exact.end() || *after > t + look;
    });
    if (events.size() > most_events) return {};
    std::ranges::sort(events);
    const double apart = 1e-9 * length;   // nearer ones are one: no element is so short
    const auto repeated =
        std::unique(events.begin(), events.end(), [apart](double a, double b) { return b - a < apart; });
    events.erase(repeated, events.end());
    return events;
}

void Expression::find_guards()
{
    const std::vector<bool> has_symbols = steps_with_symbols();
    for (std::size_t k = 0; k < steps_.size(); ++k) {
        if (!has_symbols[k] || *word_of(steps_[k].operation) == 0) continue;
        guarded_.push_back(static_cast<int>(k));
        const bool is_angle = steps_[k].operation == Operation::arc_tangent;
        guards_.push_back(is_angle ? Guard{{std::numbers::pi}, 2 * std::numbers::pi}
                          : steps_[k].operation == Operation::floor ? Guard{{0}, 1}
                                                                    : Guard{});
    }
}

void Expression::guarded(double t, std::span<const double> symbols, std::span<double> numbers) const
{
    const std::vector<TimeValue> values = evaluate(t, symbols, -1);
    for (std::size_t k = 0; k < guarded_.size(); ++k) {
        const auto step = static_cast<std::size_t>(guarded_[k]);
        const Operation operation = steps_[step].operation;
        numbers[k] = operation == Operation::arc_tangent ? values[step].value
                     : operation == Operation::floor     ? values[steps_[step].first].value
                                                         : switching(steps_[step], values);
    }
}

std::string Expression::kink_by_symbols() const
{
    const std::vector<bool> has_symbols = steps_with_symbols();
    for (std::size_t k = 0; k < steps_.size(); ++k) {
        const std::string word = word_of(steps_[k].operation);
        if (has_symbols[k] && !word.empty() && word != "atan2")
            return word + " at column " + std::to_string(steps_[k].column);
    }
    return "";
}

}   // namespace livens
