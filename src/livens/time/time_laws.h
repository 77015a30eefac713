// SPDX-License-Identifier: BSD-3-Clause
// Laws of motion over time with continuous rates, for drives.
#pragma once

#include <vector>

#include "livens/time/time_function.h"

namespace [[gnu::visibility("default")]] livens {

// All throw InputError (`not-finite`, `law-order`) for what is no finite number or out of order.

/// value + rate (t - from).
TimeFunction ramp(double value, double rate, double from);
/// amplitude sin(2 pi frequency t + phase); frequency in Hz.
TimeFunction harmonic(double amplitude, double frequency, double phase);
/// 0 before `from`, `rise` after `until`, and between them rise (10 u^3 - 15 u^4 + 6 u^5), which has two
/// continuous derivatives.
TimeFunction smooth_step(double from, double until, double rise);
/// sum_k coefficients[k] t^k.
TimeFunction polynomial(std::vector<double> coefficients);

/// value + law.
TimeFunction shifted(const TimeFunction& law, double value);

/// sum_k factors[k] laws[k].
TimeFunction combination(const std::vector<double>& factors, const std::vector<TimeFunction>& laws);

/// `law` from `first` to `last`, and straight on with its slopes there before and after.
TimeFunction straight_on(const TimeFunction& law, double first, double last);

}   // namespace livens
