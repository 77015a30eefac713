// SPDX-License-Identifier: BSD-3-Clause
// The one loop of tries of whatever is solved to an accuracy.
#pragma once

#include <string>

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// What follows a try.
enum class AfterTry {
    accept,      ///< it is what was asked for, or failed for other reasons than its error
    again,       ///< the next one has shorter elements
    uncounted,   ///< likewise, for this one was broken off before it said anything of its error
    give_up      ///< its error is too large, and shorter elements are not worth a try
};

/// A motion that can be solved as often as it takes, each time for a smaller error: a march, phases behind
/// each other, a family of motions.
class RepeatedMarch {
public:
    virtual ~RepeatedMarch() = default;
    /// One try with its estimate; its report counts this try alone.
    virtual Solution solve() = 0;
    /// `tries` so far, this one counted. Where another one follows, solve() will be more accurate.
    virtual AfterTry judge(Solution& solution, int tries) = 0;
    /// Of the last try, which was given up: "with ever shorter elements, which help no more: ..".
    virtual std::string why_not(const Solution& solution) const = 0;
};

/// The first try that is accepted, with the work of all; or the last one, with SolveStatus::inaccurate and
/// how far it is as accurate. Up to `until`, s.
Solution until_accurate(RepeatedMarch& march, const Model& model, double accuracy, double until);

}   // namespace livens::inline spacetime_internal
