// SPDX-License-Identifier: BSD-3-Clause
// A running maximum that does not lose a NaN.
#pragma once

#include <cmath>

namespace livens::inline diagnostics_internal {

/// largest = max(largest, value), and NaN once either is: a motion that is not a number must not look
/// perfect. Returns whether it was raised.
inline bool raise_to(double& largest, double value)
{
    if (value <= largest || std::isnan(largest)) return false;
    largest = value;
    return true;
}

}   // namespace livens::inline diagnostics_internal
