// SPDX-License-Identifier: BSD-3-Clause
// Functions whose last bits are the same on every processor of a kind. The library's sin, cos, atan2, asin,
// hypot, log, exp and pow are not so: glibc chooses other code where there is FMA or AVX2.
#pragma once

#include <cmath>
#include <limits>

namespace livens::inline base_internal {

struct SineCosine {
    double sine, cosine;
};
using Wide = long double;   // of which there is one code only

/// To a unit in the last place. Beyond 0.8 by the library's long double; beyond 2.3, where that takes a long
/// way, less quarters of a turn by parts of pi / 2 whose products are exact, unless it is no wider.
inline SineCosine sine_cosine(double x)
{
    if (!(std::abs(x) <= 0.8)) {
        const bool is_far = std::abs(x) > 2.3 && std::abs(x) < 1e6 && std::numeric_limits<Wide>::digits >= 64;
        const long n = is_far ? static_cast<long>(x * 0.6366197723675814 + (x < 0 ? -0.5 : 0.5)) : 0;
        const Wide less =
            x - n * 0x1.921fb54442p+0L - n * 0x1.a308d31318p-41L - n * 0x1.8a2e0370734a4408p-81L;
        const auto sine = static_cast<double>(std::sin(less)), cosine = static_cast<double>(std::cos(less));
        const double s = n % 2 == 0 ? sine : cosine, c = n % 2 == 0 ? cosine : sine;
        return {(n & 2) != 0 ? -s : s, ((n + 1) & 2) != 0 ? -c : c};
    }
    // Taylor's series to x^17 and x^16, which leave 3e-18.
    constexpr double inverse_factorials[] = {
        1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880,
        1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800, 1.0 / 87178291200,
        1.0 / 1307674368000, 1.0 / 20922789888000, 1.0 / 355687428096000};
    const double y = x * x;
    double s = inverse_factorials[15], c = inverse_factorials[14];
    for (int i = 13; i > 0; i -= 2) s = inverse_factorials[i] - y * s;
    for (int i = 12; i > 0; i -= 2) c = inverse_factorials[i] - y * c;
    return {x - x * y * s, 1 - (0.5 * y - y * y * c)};
}

inline double arc_tangent(double y, double x) { return static_cast<double>(std::atan2(Wide{y}, Wide{x})); }
inline double arc_sine(double x) { return static_cast<double>(std::asin(Wide{x})); }

/// Of a vector; squares neither overflow nor vanish where long double is wider.
inline double hypotenuse(double x, double y, double z)
{
    const Wide a = x, b = y, c = z;
    return static_cast<double>(std::sqrt(a * a + b * b + c * c));
}
inline double logarithm(double x) { return static_cast<double>(std::log(Wide{x})); }   // natural
inline double exponential(double x) { return static_cast<double>(std::exp(Wide{x})); }
inline double hyperbolic_tangent(double x) { return static_cast<double>(std::tanh(Wide{x})); }
inline double power(double x, double n) { return static_cast<double>(std::pow(Wide{x}, Wide{n})); }

}   // namespace livens::inline base_internal
