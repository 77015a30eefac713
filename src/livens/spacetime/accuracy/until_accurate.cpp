// SPDX-License-Identifier: BSD-3-Clause
// Tries until the global estimate is within the accuracy.  (docs/theory.md, "To an accuracy")
#include "livens/spacetime/accuracy/until_accurate.h"

#include "livens/base/text.h"
#include "livens/multibody/model.h"

namespace livens::inline spacetime_internal {

namespace {

/// The status and message of a motion whose estimate passes the accuracy.
void say_how_far(const Model& model, double accuracy, double until, const std::string& why, Solution& last)
{
    const ErrorEstimate& found = last.estimate;
    const Motion& motion = last.motion;
    SolveReport& report = last.report;
    int good = 0;
    while (!found.empty() && good < motion.n_elements() && found.error(good + 1) <= accuracy) ++good;
    report.status = SolveStatus::inaccurate;
    report.failed_at = motion.mesh.ends[good];
    report.message =
        "the accuracy " + to_text(accuracy, 6) + " holds up to t = " + to_text(report.failed_at, 6) + " s";
    if (motion.end() >= until) report.message += ", the motion is complete up to " + to_text(until, 6) + " s";
    report.message += "; ";
    if (found.largest > accuracy)
        report.message += "the error of body '" + model.body_name(found.body) + "' is about " +
                          to_text(found.largest, 3) + " at " + to_text(found.time, 6) + " s";
    else
        report.message += "behind, the error is not known, since " + report.estimate_failed;
    report.message += " (" + why + "); try: an earlier end of time, or a larger error in accuracy";
}

/// Likewise of a motion that has conditions at both ends: there is no part of it that is as accurate.
void say_how_far_between(const Model& model, double accuracy, const RepeatedMarch& march, Solution& last)
{
    const ErrorEstimate& found = last.estimate;
    SolveReport& report = last.report;
    report.status = SolveStatus::inaccurate;
    report.failed_at = found.empty() ? last.motion.start() : found.time;
    report.message = "the accuracy " + to_text(accuracy, 6) + " is not reached between the two ends; ";
    report.message += found.empty() ? "the error is not known, since " + report.estimate_failed
                                    : march.error_in_words(model, last);
    report.message += " (" + march.why_not(last) + "); try: a larger error in accuracy, or another duration";
}

}   // namespace

std::string RepeatedMarch::error_in_words(const Model& model, const Solution& solution) const
{
    const ErrorEstimate& found = solution.estimate;
    return "the error of body '" + model.body_name(found.body) + "' is about " + to_text(found.largest, 3) +
           " at " + to_text(found.time, 6) + " s";
}

Solution until_accurate(RepeatedMarch& march, const Model& model, double accuracy, double until)
{
    long long evaluations = 0;
    double seconds = 0;
    for (int tries = 1;; ++tries) {
        Solution solution = march.solve();
        solution.report.evaluations_in_all = evaluations += solution.report.evaluations_in_all;
        solution.estimate_seconds = seconds += solution.estimate_seconds;
        solution.report.accuracy = accuracy;
        const AfterTry next = march.judge(solution, tries);
        if (next == AfterTry::give_up && march.is_march())
            say_how_far(model, accuracy, until, march.why_not(solution), solution);
        else if (next == AfterTry::give_up)
            say_how_far_between(model, accuracy, march, solution);
        if (next == AfterTry::accept || next == AfterTry::give_up) return solution;
        if (next == AfterTry::uncounted) --tries;
    }
}

}   // namespace livens::inline spacetime_internal
