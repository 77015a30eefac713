// SPDX-License-Identifier: BSD-3-Clause
// Functions whose last bits are the same on every processor of a kind. The library's sin, cos, atan2, asin,
// hypot, log, exp and pow are not so: glibc chooses other code where there is FMA or AVX2.
#pragma once

#include <cmath>

namespace livens::inline base_internal {

struct SineCosine {
    double sine, cosine;
};

/// To a unit in the last place. Beyond 0.8 by the library's long double, of which there is one code only;
/// where that is no wider than double, bits are those of the library.
inline SineCosine sine_cosine(double x)
{
    if (!(std::abs(x) <= 0.8)) {
        const long double wide = x;
        return {static_cast<double>(std::sin(wide)), static_cast<double>(std::cos(wide))};
    }
    // Taylor's series to x^17 and x^16, which leave 3e-18.
    constexpr double inverse_factorials[] = {
        1.0 / 2,        1.0 / 6,         1.0 / 24,          1.0 / 120,
        1.0 / 720,      1.0 / 5040,      1.0 / 40320,       1.0 / 362880,
        1.0 / 3628800,  1.0 / 39916800,  1.0 / 479001600,   1.0 / 6227020800,
        1.0 / 87178291200, 1.0 / 1307674368000, 1.0 / 20922789888000, 1.0 / 355687428096000};
    const double y = x * x;
    double s = inverse_factorials[15], c = inverse_factorials[14];
    for (int i = 13; i > 0; i -= 2) s = inverse_factorials[i] - y * s;
    for (int i = 12; i > 0; i -= 2) c = inverse_factorials[i] - y * c;
    return {x - x * y * s, 1 - (0.5 * y - y * y * c)};
}

using Wide = long double;   // of the following

inline double arc_tangent(double y, double x) { return static_cast<double>(std::atan2(Wide{y}, Wide{x})); }

inline double arc_sine(double x) { return static_cast<double>(std::asin(Wide{x})); }

/// Of a vector; squares neither overflow nor vanish where long double is wider.
inline double hypotenuse(double x, double y, double z)
{
    const Wide a = x, b = y, c = z;
    return static_cast<double>(std::sqrt(a * a + b * b + c * c));
}

/// Natural.
inline double logarithm(double x) { return static_cast<double>(std::log(Wide{x})); }

inline double exponential(double x) { return static_cast<double>(std::exp(Wide{x})); }

inline double hyperbolic_tangent(double x) { return static_cast<double>(std::tanh(Wide{x})); }

inline double power(double x, double n) { return static_cast<double>(std::pow(Wide{x}, Wide{n})); }

}   // namespace livens::inline base_internal
