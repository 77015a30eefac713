// SPDX-License-Identifier: BSD-3-Clause
// Motions over events to an accuracy: phases to a share of it each, until the whole is within.
#include "livens/spacetime/phases/phases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/phases/phase_chain.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_phase_share = 0.3, phase_target = 0.3;   // of the accuracy
constexpr int most_phase_tries = 4;
constexpr double judged_as_whole = 1e-8;   // below, rounding counts, and chance
constexpr double while_open = 1e-2;        // times the share, where the second solution has other events
constexpr double hop_of_accuracy = 1e-3, least_hop = 1e-13;   // of the scale of a stop's row

/// Phases to a share of the accuracy each, until the whole is within. At first the second solution of the
/// whole judges alone, as it does in the end: those of phases say where one is to be finer, if it is not.
class PhasesToAccuracy final : public RepeatedMarch {
public:
    PhasesToAccuracy(const PhasedProblem& given, const Span& span, const Method& method)
        : given_(given), method_(method), options_(given.options), accuracy_(span.accuracy),
          share_(first_phase_share * span.accuracy)
    {
        options_.growth = false;   // of the whole motion once, when it is accepted
        problem_.is_followed = accuracy_ < judged_as_whole;
    }

    Solution solve() override
    {
        const PhasedProblem now{given_.model, problem_, given_.time, given_.options, given_.solve_phase};
        Solution whole = solve_chain(now, method_, share_, std::max(options_.meeting, accuracy_));
        if (whole.report.converged())
            estimate(found_model(given_.model, whole), given_.problem, whole.method, options_, whole);
        SolveReport& report = whole.report;
        if (report.converged() && whole.estimate.empty() && report.estimate_failed.empty()) {
            report.status = SolveStatus::cancelled;
            report.failed_at = whole.motion.end();
            report.message = "stopped as asked before the error was estimated";
        }
        return whole;
    }

    AfterTry judge(Solution& whole, int tries) override
    {
        const ErrorEstimate& found = whole.estimate;
        if (!std::exchange(problem_.is_followed, true) && whole.report.status != SolveStatus::cancelled) {
            const bool is_good = whole.report.converged() && !found.empty() && found.largest <= accuracy_;
            return is_good ? AfterTry::accept : AfterTry::uncounted;
        }
        if (whole.report.status == SolveStatus::inaccurate)   // a phase, whose message has its own accuracy
            whole.report.message += "; this is the share of a phase in the accuracy " +
                                    to_text(accuracy_, 6) + " that is asked for over events";
        if (!whole.report.converged() || (!found.empty() && found.largest <= accuracy_))
            return AfterTry::accept;
        const bool is_open = std::isfinite(whole.undecided_from);   // what happens is not known yet
        if ((found.empty() && !is_open) || tries == most_phase_tries) return AfterTry::give_up;
        if (is_open) {
            share_ *= while_open;
            return AfterTry::again;
        }
        // errors of phases add up and grow by factors that nobody knows beforehand; the measured one tells
        share_ *= std::min(0.3, phase_target * accuracy_ / found.largest);
        return AfterTry::again;
    }

    std::string why_not(const Solution&) const override { return "over events, with ever shorter elements"; }

private:
    PhasedProblem given_;
    Problem problem_ = given_.problem;
    const Method& method_;
    SolveOptions options_;
    double accuracy_, share_;
};

}   // namespace

Solution solve_by_phases(const Model& model, const Problem& problem, const Time& time, const Method& method,
                         const SolveOptions& stated, const SolvePhase& solve_phase)
{
    const auto* span = std::get_if<Span>(&time);
    SolveOptions options = stated;
    if (span != nullptr) options.lowest_hop = std::max(hop_of_accuracy * span->accuracy, least_hop);
    const PhasedProblem given{model, problem, time, options, solve_phase};
    Solution solution;
    if (span != nullptr) {
        PhasesToAccuracy phases(given, *span, method);
        solution = until_accurate(phases, model, span->accuracy, span->end);
    } else {
        solution = solve_chain(given, method, 0, options.meeting);
    }
    if (!std::isinf(options.meeting) && !solution.motion.mesh.ends.empty()) {
        const Model& found = found_model(model, solution);
        tell_releases(found, solution.motion, phase_ends(found, time), solution.report);
    }
    return solution;
}

}   // namespace livens::inline spacetime_internal
