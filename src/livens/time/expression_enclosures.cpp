// SPDX-License-Identifier: BSD-3-Clause
// Expressions over ranges: how steep they may be on a piece of a way.
// Interval arithmetic [Moore1966] on the steps of an expression: value and slope together, for theory.md,
// "Looks at laws". Ends are not rounded outwards: what is judged by them is far above a rounding error.
// Enclosures may be too wide, never too narrow beyond that.
#include <cmath>
#include <numbers>
#include <vector>

#include "livens/base/elementary.h"
#include "livens/time/expression.h"

namespace livens {

namespace {

using Operation = Expression::Operation;

constexpr double pi = std::numbers::pi;

/// cos of a range of angles.
Enclosure cosine_of(const Enclosure& a)
{
    // The comparison also takes infinite and undefined ranges for a whole turn.
    if (!(a.high - a.low < 2 * pi)) return {-1, 1};
    const double first = sine_cosine(a.low).cosine, last = sine_cosine(a.high).cosine;
    Enclosure c{std::min(first, last), std::max(first, last)};
    // A multiple of 2 pi inside the range is a top; an odd multiple of pi is a bottom.
    if (2 * pi * std::ceil(a.low / (2 * pi)) <= a.high) c.high = 1;
    if (2 * pi * std::ceil(a.low / (2 * pi) - 0.5) + pi <= a.high) c.low = -1;
    return c;
}
Enclosure sine_of(const Enclosure& a) { return cosine_of({a.low - 0.5 * pi, a.high - 0.5 * pi}); }

template <class Function>
Enclosure rising(const Enclosure& a, const Function& f)
{
    return checked(f(a.low), f(a.high));
}

/// a^n with a whole number n > 0.
Enclosure whole_power(const Enclosure& a, double n)
{
    const bool is_even = std::remainder(n, 2) == 0;
    if (!is_even) return rising(a, [n](double x) { return power(x, n); });
    return checked(power(a.least(), n), power(a.size(), n));
}

/// a^n with any number n, of what is not negative unless n is whole.
Enclosure power_of(const Enclosure& a, double n)
{
    if (n == 0) return Enclosure::of(1);
    if (n < 0) return inverse(power_of(a, -n));
    if (n == std::round(n)) return whole_power(a, n);
    if (!(a.high >= 0)) return Enclosure::all();
    return rising({std::max(a.low, 0.0), a.high}, [n](double x) { return x == 0 ? 0 : power(x, n); });
}

Enclosure exponential_of(const Enclosure& a)
{
    return rising(a, [](double x) { return exponential(x); });
}
Enclosure logarithm_of(const Enclosure& a)
{
    if (!(a.high > 0)) return Enclosure::all();
    return {a.low > 0 ? logarithm(a.low) : -Enclosure::infinite, logarithm(a.high)};
}

EnclosedValue times(const EnclosedValue& a, const EnclosedValue& b)
{
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

bool is_constant(const EnclosedValue& a)
{
    return a.value.low == a.value.high && a.slope.low == 0 && a.slope.high == 0;
}

EnclosedValue power_of(const EnclosedValue& a, const EnclosedValue& b)
{
    if (is_constant(b)) {
        const double n = b.value.low;
        const Enclosure slope = n == 0 ? Enclosure{} : Enclosure::of(n) * power_of(a.value, n - 1) * a.slope;
        return {power_of(a.value, n), slope};
    }
    const EnclosedValue exponent =
        times(b, {logarithm_of(a.value), inverse(a.value) * a.slope});   // of what is positive
    const Enclosure value = exponential_of(exponent.value);
    return {value, value * exponent.slope};
}

EnclosedValue arc_tangent_of(const EnclosedValue& y, const EnclosedValue& x)
{
    const Enclosure r2 = square(x.value) + square(y.value);
    const Enclosure slope = (x.value * y.slope - y.value * x.slope) * inverse(r2);
    // The origin, or the cut along the negative axis, may lie in the box: then any angle is possible.
    if (!(r2.low > 0) || (y.value.contains(0) && x.value.low < 0)) return {{-pi, pi}, slope};
    Enclosure angle{pi, -pi};
    for (const double v : {y.value.low, y.value.high})
        for (const double u : {x.value.low, x.value.high}) {
            // Off the cut the angle is monotonic along every edge of the box, so its extremes are at corners.
            const double corner = arc_tangent(v, u);
            angle = hull(angle, {corner, corner});
        }
    return {angle, slope};
}

EnclosedValue absolute_of(const EnclosedValue& a)
{
    if (a.value.low >= 0) return a;
    if (a.value.high <= 0) return {-a.value, -a.slope};
    // Both signs are possible, and so are both slopes; the kink itself has no slope of its own.
    return {{0, a.value.size()}, hull(a.slope, -a.slope)};
}

/// Of the smaller; the greater is the smaller of what is negative.
EnclosedValue least_of(const EnclosedValue& a, const EnclosedValue& b)
{
    if (a.value.high <= b.value.low) return a;
    if (b.value.high <= a.value.low) return b;
    return {{std::min(a.value.low, b.value.low), std::min(a.value.high, b.value.high)},
            hull(a.slope, b.slope)};
}

EnclosedValue negative(const EnclosedValue& a) { return {-a.value, -a.slope}; }

EnclosedValue tangent_of(const EnclosedValue& a)
{
    const Enclosure c = cosine_of(a.value), s = sine_of(a.value);
    // The tangent has a pole in the range.
    if (c.contains(0)) return {Enclosure::all(), Enclosure::all()};
    const Enclosure f = rising(a.value, [](double x) {
        const SineCosine of = sine_cosine(x);
        return of.sine / of.cosine;
    });
    return {f.low <= f.high ? f : s * inverse(c), inverse(square(c)) * a.slope};
}

EnclosedValue apply(Operation operation, const EnclosedValue& a, const EnclosedValue& b)
{
    switch (operation) {
    case Operation::negative:
        return negative(a);
    case Operation::plus:
        return {a.value + b.value, a.slope + b.slope};
    case Operation::minus:
        return {a.value - b.value, a.slope - b.slope};
    case Operation::times:
        return times(a, b);
    case Operation::divided: {
        const Enclosure i = inverse(b.value);
        return times(a, {i, -(i * i * b.slope)});
    }
    case Operation::power:
        return power_of(a, b);
    case Operation::sine:
        return {sine_of(a.value), cosine_of(a.value) * a.slope};
    case Operation::cosine:
        return {cosine_of(a.value), -(sine_of(a.value) * a.slope)};
    case Operation::tangent:
        return tangent_of(a);
    case Operation::hyperbolic_tangent: {
        const Enclosure f = rising(a.value, [](double x) { return hyperbolic_tangent(x); });
        return {f, (Enclosure::of(1) - square(f)) * a.slope};
    }
    case Operation::exponential: {
        const Enclosure f = exponential_of(a.value);
        return {f, f * a.slope};
    }
    case Operation::logarithm:
        return {logarithm_of(a.value), inverse(a.value) * a.slope};
    case Operation::root: {
        const Enclosure f = power_of(a.value, 0.5);
        return {f, Enclosure::of(0.5) * inverse(f) * a.slope};
    }
    case Operation::absolute:
        return absolute_of(a);
    case Operation::arc_tangent:
        return arc_tangent_of(a, b);
    case Operation::least:
        return least_of(a, b);
    case Operation::greatest:
        return negative(least_of(negative(a), negative(b)));
    case Operation::sign:   // slopes are those beside jumps, which are guards
        return {rising(a.value, [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }), {}};
    case Operation::floor:
        return {rising(a.value, [](double x) { return std::floor(x); }), {}};
    default:
        return {Enclosure::all(), Enclosure::all()};
    }
}

}   // namespace

EnclosedValue Expression::over(const EnclosedValue& t, std::span<const EnclosedValue> symbols) const
{
    std::vector<EnclosedValue> values(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        if (step.operation == Operation::number)
            values[i] = {Enclosure::of(step.number), {}};
        else if (step.operation == Operation::time)
            values[i] = t;
        else if (step.operation == Operation::symbol)
            values[i] = symbols[static_cast<std::size_t>(step.first)];
        else
            values[i] =
                apply(step.operation, values[static_cast<std::size_t>(step.first)],
                      step.second < 0 ? EnclosedValue{} : values[static_cast<std::size_t>(step.second)]);
    }
    return values.back();
}

bool Expression::is_affine() const
{
    // The kinds ascend, so that max() is the kind of a sum. What time alone decides may be multiplied as it
    // likes; a symbol may be multiplied by numbers alone.
    enum class Kind { number, of_time, affine, other };
    std::vector<Kind> kinds;
    for (const Step& step : steps_) {
        const bool is_leaf = step.operation == Operation::number || step.operation == Operation::time ||
                             step.operation == Operation::symbol;
        const Kind a = is_leaf ? Kind::number : kinds[static_cast<std::size_t>(step.first)];
        const Kind b =
            is_leaf || step.second < 0 ? Kind::number : kinds[static_cast<std::size_t>(step.second)];
        const Kind more = std::max(a, b);
        switch (step.operation) {
        case Operation::number:
            kinds.push_back(Kind::number);
            break;
        case Operation::time:
            kinds.push_back(Kind::of_time);
            break;
        case Operation::symbol:
            kinds.push_back(Kind::affine);
            break;
        case Operation::negative:
        case Operation::plus:
        case Operation::minus:
            kinds.push_back(more);
            break;
        case Operation::times:
            kinds.push_back(more < Kind::affine || std::min(a, b) == Kind::number ? more : Kind::other);
            break;
        case Operation::divided:
            kinds.push_back(more < Kind::affine || b == Kind::number ? more : Kind::other);
            break;
        default:
            kinds.push_back(more < Kind::affine ? more : Kind::other);
        }
    }
    return kinds.back() != Kind::other;
}

}   // namespace livens
