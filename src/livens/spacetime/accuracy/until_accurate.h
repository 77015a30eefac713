// SPDX-License-Identifier: BSD-3-Clause
// The one loop of tries of whatever is solved to an accuracy, and what those have in common.
#pragma once

#include <limits>
#include <string>

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Degrees of lobatto that are not stated, the high one for accuracies below.
constexpr int preferred_degree = 7, high_degree = 12, lowest_degree = 3;
constexpr double high_accuracy = 1e-9;
constexpr double target = 0.2;        // of the accuracy: what the next try aims at
constexpr double well_helped = 0.5;   // error by the least before
constexpr double far_off = 3;   // accuracies of a try in vain, after which another may be good by chance
constexpr double blind_share = 0.01;   // of what elements may lose, where the second solution did not tell
constexpr double fit = 1.5;            // times the time between stops: longer elements are of no use
/// Of what elements may lose: what those of a fitting degree would lose. It costs little where they are as
/// long as stops are apart, and as much as another try where it is too low.
constexpr double aimed_lower = 0.01;

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
    /// What is off: "the error of body 'bob' is about 3e-8 at 2 s".
    virtual std::string error_in_words(const Model& model, const Solution& solution) const;
    /// Errors begin at an end of time and grow; false: they are everywhere between two ends.
    virtual bool is_march() const { return true; }
};

/// The first try that is accepted, with the work of all; or the last one, with SolveStatus::inaccurate and
/// how far it is as accurate. Up to `until`, s.
Solution until_accurate(RepeatedMarch& march, const Model& model, double accuracy, double until);

}   // namespace livens::inline spacetime_internal
