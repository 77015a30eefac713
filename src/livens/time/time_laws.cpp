// SPDX-License-Identifier: BSD-3-Clause
// Laws of drives in closed form: ramp, harmonic, smooth step, polynomial, and what is made of other laws.
// Each gives value, rate and second derivative, which the rows of drives and their accelerations take
// (theory.md, "Drives").
#include "livens/time/time_laws.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"

namespace livens {

namespace {

void require_finite(std::initializer_list<double> numbers)
{
    for (const double x : numbers)
        if (!std::isfinite(x))
            throw InputError({"not-finite", "drive", "a law of motion needs finite numbers", to_text(x),
                              "finite numbers", "", ""});
}

}   // namespace

TimeFunction ramp(double value, double rate, double from)
{
    require_finite({value, rate, from});
    return {[=](Instant at) { return TimeValue{value + rate * (at.t - from), rate, 0}; }, {}};
}

TimeFunction harmonic(double amplitude, double frequency, double phase)
{
    require_finite({amplitude, frequency, phase});
    const double w = 2 * std::numbers::pi * frequency;
    // The second derivative may overflow although amplitude and frequency are finite.
    require_finite({amplitude * w * w});   // its acceleration
    return {[=](Instant at) {
                const auto [s, c] = sine_cosine(w * at.t + phase);
                return TimeValue{amplitude * s, amplitude * w * c, -amplitude * w * w * s};
            },
            {}};
}

TimeFunction smooth_step(double from, double until, double rise)
{
    require_finite({from, until, rise});
    const double length = until - from;
    if (!(length > 0))
        throw InputError({"law-order", "drive.step", "a step must end later than it begins", to_text(until),
                          "> " + to_text(from), "", ""});
    return {[=](Instant at) -> TimeValue {
                // The quintic 10 u^3 - 15 u^4 + 6 u^5 has zero rate and second derivative at both ends: no
                // force jumps there. Its third derivative does, hence the two breaks.
                const double u = (at.t - from) / length;
                if (u <= 0) return {};
                if (u >= 1) return {rise, 0, 0};
                const double v = 1 - u;
                return {rise * u * u * u * (10 + u * (6 * u - 15)), 30 * rise * u * u * v * v / length,
                        60 * rise * u * v * (v - u) / (length * length)};
            },
            {from, until}};
}

TimeFunction polynomial(std::vector<double> coefficients)
{
    for (const double c : coefficients) require_finite({c});
    return {[c = std::move(coefficients)](Instant at) {
                TimeValue p;
                for (auto k = c.rbegin(); k != c.rend(); ++k)
                    // Horner's scheme for the polynomial and its two derivatives at once; values of the step
                    // before are used on the right.
                    p = {p.value * at.t + *k, p.first * at.t + p.value, p.second * at.t + 2 * p.first};
                return p;
            },
            {}};
}

TimeFunction shifted(const TimeFunction& law, double value)
{
    require_finite({value});
    return {[=](Instant at) {
                TimeValue p = law(at);
                p.value += value;
                return p;
            },
            law.breaks()};
}

TimeFunction combination(const std::vector<double>& factors, const std::vector<TimeFunction>& laws)
{
    std::vector<double> breaks;
    bool is_constant = true;
    for (std::size_t k = 0; k < laws.size(); ++k) {
        if (factors[k] == 0) continue;
        is_constant = is_constant && laws[k].is_constant();
        breaks.insert(breaks.end(), laws[k].breaks().begin(), laws[k].breaks().end());
    }
    const auto sum = [factors, laws](Instant at) {
        TimeValue total;
        for (std::size_t k = 0; k < laws.size(); ++k) {
            if (factors[k] == 0) continue;
            const TimeValue one = laws[k](at);
            total.value += factors[k] * one.value;
            total.first += factors[k] * one.first;
            total.second += factors[k] * one.second;
        }
        return total;
    };
    if (is_constant) return sum({}).value;
    std::ranges::sort(breaks);
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    return TimeFunction(sum, std::move(breaks));
}

TimeFunction straight_on(const TimeFunction& law, double first, double last)
{
    // Beyond the first and last instant the law goes on straight: value and rate are continuous, the second
    // derivative is zero. A search beyond the ends of time then meets no jump.
    const TimeValue begin = law({first, Side::right}), end = law({last, Side::left});
    return {[=](Instant at) -> TimeValue {
                if (at.t < first || (at.t == first && at.side == Side::left))
                    return {begin.value + begin.first * (at.t - first), begin.first, 0};
                if (at.t > last || (at.t == last && at.side != Side::left))
                    return {end.value + end.first * (at.t - last), end.first, 0};
                return law(at);
            },
            law.breaks()};
}

}   // namespace livens
