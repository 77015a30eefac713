// SPDX-License-Identifier: BSD-3-Clause
// Motions over events: joints and drives that act for a part of the time divide it into phases, each with a
// model of its own. theory.md, "Drives", Events, says what goes on and what must meet.
#include "livens/spacetime/phases.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/events.h"
#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_phase_share = 0.3, phase_target = 0.3;   // of the accuracy
constexpr int most_phase_tries = 4;

Time part_of(const Time& time, double first, double last, double accuracy)
{
    const auto inside = [&](const std::vector<double>& all) {
        std::vector<double> some;
        for (const double t : all)
            if (t >= first && t <= last) some.push_back(t);
        return some;
    };
    if (const auto* mesh = std::get_if<TimeMesh>(&time))
        return TimeMesh{inside(mesh->ends), inside(mesh->required)};
    return Span{first, last, accuracy, inside(std::get<Span>(time).output)};
}

class Chain {
public:
    Chain(const Model& model, const Problem& problem, const Time& time, const SolveOptions& options,
          const SolvePhase& solve_phase)
        : model_(model), problem_(problem), time_(time), options_(options), solve_phase_(solve_phase),
          ends_(phase_ends(model, time))
    {
        options_.judge = false;
        options_.growth = false;   // of a part from its own start: it says nothing of the whole
    }

    /// All phases, as far as they go.
    Solution solve(Method method, double accuracy, double tolerance_of_meeting) const
    {
        Solution whole;
        Problem problem = problem_;
        SolveOptions options = options_;
        for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
            const double first = ends_[k], last = ends_[k + 1];
            const ActingModel acting = acting_at(model_, 0.5 * (first + last));
            if (k > 0 && !is_met(model_, whole.motion, whole.motion.n_elements(),
                                 ends_.back() - ends_.front(), tolerance_of_meeting, whole.report))
                return whole;
            Solution next = solve_next(acting, problem, first, last, accuracy, method, options);
            if (k > 0)
                for (std::string& note : next.report.notes)
                    if (std::ranges::find(whole.report.notes, note) == whole.report.notes.end())
                        note = "from " + to_text(first, 6) + " s on: " + note;
            if (next.motion.mesh.ends.empty()) {
                whole.report += std::move(next.report);
                whole.cannot_begin = std::move(next.cannot_begin);
                return whole;
            }
            method = next.method;   // what was open is chosen once
            if (next.report.status == SolveStatus::inaccurate && next.motion.end() == last) {
                next.report.status = SolveStatus::converged;   // the whole is judged, not a part of it
                next.report.message.clear();
            }
            widen(next.motion, model_, acting);
            whole.method = next.method;
            whole.estimate_seconds += next.estimate_seconds;
            whole.report += std::move(next.report);
            join(whole.motion, std::move(next.motion));
            if (!whole.report.converged()) return whole;
            if (k + 2 == ends_.size()) break;
            problem.conditions.start = whole.motion.at_end(whole.motion.n_elements());
            options.initial = StartPolicy::project;   // an end state holds its joints to rounding
        }
        return whole;
    }

private:
    /// A phase that cannot begin leaves what was solved before it.
    Solution solve_next(const ActingModel& acting, const Problem& problem, double first, double last,
                        double accuracy, const Method& method, const SolveOptions& options) const
    {
        const Time part = part_of(time_, first, last, accuracy);
        const auto solve = [&] { return solve_phase_(acting.model, problem, part, method, options); };
        if (first == ends_.front()) return solve();
        try {
            Solution next = solve();
            if (std::exchange(next.cannot_begin, {}))
                next.report.message = "behind the event at " + to_text(first, 6) +
                                      " s the motion cannot begin: " + next.report.message;
            return next;
        } catch (const Stopped&) {
            Solution none;
            none.method = method;
            none.report.failed_at = first;
            none.report.status = SolveStatus::cancelled;
            none.report.message = of_stop(first);
            return none;
        }
    }

    const Model& model_;
    const Problem& problem_;
    const Time& time_;
    SolveOptions options_;
    const SolvePhase& solve_phase_;
    std::vector<double> ends_;
};

/// Phases to a share of the accuracy each, until the whole is within.
class PhasesToAccuracy final : public RepeatedMarch {
public:
    PhasesToAccuracy(const Chain& chain, const Model& model, const Problem& problem, const Span& span,
                     const Method& method, const SolveOptions& options)
        : chain_(chain), model_(model), problem_(problem), method_(method), options_(options),
          accuracy_(span.accuracy), share_(first_phase_share * span.accuracy)
    {
        options_.growth = false;   // of the whole motion once, when it is accepted
    }

    Solution solve() override
    {
        Solution whole = chain_.solve(method_, share_, std::max(options_.meeting, accuracy_));
        if (whole.report.converged()) estimate(model_, problem_, whole.method, options_, whole);
        return whole;
    }

    AfterTry judge(Solution& whole, int tries) override
    {
        const ErrorEstimate& found = whole.estimate;
        if (whole.report.status == SolveStatus::inaccurate)   // a phase, whose message has its own accuracy
            whole.report.message += "; this is the share of a phase in the accuracy " +
                                    to_text(accuracy_, 6) + " that is asked for over events";
        if (!whole.report.converged() || (!found.empty() && found.largest <= accuracy_))
            return AfterTry::accept;
        if (found.empty() || tries == most_phase_tries) return AfterTry::give_up;
        // errors of phases add up and grow by factors that nobody knows beforehand; the measured one tells
        share_ *= std::min(0.3, phase_target * accuracy_ / found.largest);
        return AfterTry::again;
    }

    std::string why_not(const Solution&) const override { return "over events, with ever shorter elements"; }

private:
    const Chain& chain_;
    const Model& model_;
    const Problem& problem_;
    const Method& method_;
    SolveOptions options_;
    double accuracy_, share_;
};

}   // namespace

namespace {

/// Between conditions at both ends all phases are solved at once, by lobatto.
void check_between_ends(const Problem& problem, const Method& method, const SolveOptions& options)
{
    const Conditions& given = problem.conditions;
    const auto refuse = [](bool is_wrong, const char* path, const std::string& value, const char* why,
                           const char* help) {
        if (is_wrong)
            throw InputError({"joint-time-method", path,
                              "joints and drives that act for a part of the time are not solved so", value,
                              "", why, help});
    };
    const bool is_lobatto =
        std::holds_alternative<Lobatto>(method) || std::holds_alternative<AutomaticFamily>(method);
    refuse(!is_nodal(method), "method.family", name_of(method),
           "only lobatto and radau know joints that begin or end to act",
           "use lobatto, or radau from a state");
    refuse(!is_lobatto, "method.family", name_of(method),
           "between conditions at both ends all phases are solved at once, by lobatto alone", "use lobatto");
    refuse(given.at_end == Known::state, "end.given", "state",
           "what a joint did cannot be undone from the end of time", "give the state at the start");
    refuse(given.at_start == Known::momenta || given.at_end == Known::momenta,
           given.at_start == Known::momenta ? "start.given" : "end.given", "momenta",
           "momenta of all bodies are more than joints leave to choose",
           "give positions, or rates by component");
    refuse(given.is_periodic, "time.periodic", "true", "its end has other joints than its start",
           "give conditions at the start and at the end");
    refuse(options.roots > 1, "method.roots", std::to_string(options.roots),
           "one motion is looked for over phases", "leave roots out");
}

}   // namespace

void check_events(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options)
{
    if (!model.has_events()) return;
    const Conditions& given = problem.conditions;
    const bool is_march = !given.has_components() && given.at_start == Known::state;
    if (!is_march || !is_nodal(method)) check_between_ends(problem, method, options);
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr) return;
    const std::vector<double> late = missed(*mesh, events_inside(model, mesh->start(), mesh->end()));
    if (!late.empty())
        throw InputError({"joint-time-mesh", "time.elements",
                          "a joint or drive begins or ends to act inside an element", to_text(late[0]) + " s",
                          "an element end", "elements follow one set of joints each",
                          "let elements end there"});
}

Solution solve_by_phases(const Model& model, const Problem& problem, const Time& time, const Method& method,
                         const SolveOptions& options, const SolvePhase& solve_phase)
{
    const Chain chain(model, problem, time, options, solve_phase);
    Solution solution;
    if (const auto* span = std::get_if<Span>(&time)) {
        PhasesToAccuracy phases(chain, model, problem, *span, method, options);
        solution = until_accurate(phases, model, span->accuracy, span->end);
    } else {
        solution = chain.solve(method, 0, options.meeting);
    }
    if (!std::isinf(options.meeting) && !solution.motion.mesh.ends.empty())
        tell_releases(model, solution.motion, phase_ends(model, time), solution.report);
    return solution;
}

}   // namespace livens::inline spacetime_internal
