// SPDX-License-Identifier: BSD-3-Clause
// Enclosures of numbers: what a function may do between two places where it is known [Moore1966].
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace [[gnu::visibility("default")]] livens {

/// All numbers from low to high. Ends are rounded as they come: what is judged by ranges is far above that.
struct Enclosure {
    double low = 0, high = 0;

    static constexpr double infinite = std::numeric_limits<double>::infinity();
    /// What nothing is known of.
    static Enclosure all() { return {-infinite, infinite}; }
    static Enclosure of(double x) { return {x, x}; }

    bool contains(double x) const { return low <= x && x <= high; }
    /// The largest absolute value.
    double size() const { return std::max(std::abs(low), std::abs(high)); }
    /// The smallest one.
    double least() const { return low > 0 ? low : high < 0 ? -high : 0; }
};

/// An enclosure; everything if an end is not a number.
inline Enclosure checked(double low, double high)
{
    return std::isnan(low) || std::isnan(high) ? Enclosure::all() : Enclosure{low, high};
}
inline Enclosure hull(const Enclosure& a, const Enclosure& b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
inline Enclosure operator-(const Enclosure& a) { return {-a.high, -a.low}; }
inline Enclosure operator+(const Enclosure& a, const Enclosure& b)
{
    return checked(a.low + b.low, a.high + b.high);
}
inline Enclosure operator-(const Enclosure& a, const Enclosure& b)
{
    return checked(a.low - b.high, a.high - b.low);
}
/// Zero times anything is zero.
inline Enclosure operator*(const Enclosure& a, const Enclosure& b)
{
    const auto product = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
    const double ll = product(a.low, b.low), lh = product(a.low, b.high), hl = product(a.high, b.low),
                 hh = product(a.high, b.high);
    return checked(std::min(std::min(ll, lh), std::min(hl, hh)),
                   std::max(std::max(ll, lh), std::max(hl, hh)));
}
inline Enclosure inverse(const Enclosure& a)
{
    return a.low > 0 || a.high < 0 ? Enclosure{1 / a.high, 1 / a.low} : Enclosure::all();
}
inline Enclosure square(const Enclosure& a) { return {a.least() * a.least(), a.size() * a.size()}; }

/// A number on a piece of a way, and its slope by the share of the way.
struct EnclosedValue {
    Enclosure value, slope;
};

}   // namespace gnu::visibility("default")]]livens
