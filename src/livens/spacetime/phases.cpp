// SPDX-License-Identifier: BSD-3-Clause
// Motions over events: joints and drives that act for a part of the time divide it into phases, each with a
// model of its own. theory.md, "Drives", Events, says what goes on and what must meet.
#include "livens/spacetime/phases.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/event_watch.h"
#include "livens/spacetime/events.h"
#include "livens/spacetime/found.h"
#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_phase_share = 0.3, phase_target = 0.3;   // of the accuracy
constexpr int most_phase_tries = 4;
constexpr double while_open = 1e-2;   // times the share, where the second solution has other events

/// More would be a storm: as many as that in a millionth of the time, or in all.
constexpr int stormy = 200, most_events = 100'000;
constexpr double no_time = 1e-6;
/// Of an element: what is left of one behind an event is no element of its own.
constexpr double least_rest = 1e-3;
constexpr int most_corrections = 6;

/// From an instant on, until another that it may have as an end.
Time part_of(const Time& time, double first, double last, double accuracy)
{
    const double gap = nearest_ends * (end_of(time) - start_of(time));
    const auto inside = [&](const std::vector<double>& all) {
        std::vector<double> some;
        for (const double t : all)
            if (t > first + gap && t <= last) some.push_back(t);
        return some;
    };
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr) return Span{first, last, accuracy, inside(std::get<Span>(time).output)};
    TimeMesh part{{first}, inside(mesh->required), inside(mesh->bends)};
    const std::vector<double> ends = inside(mesh->ends);
    const bool is_end = std::ranges::binary_search(mesh->ends, first);
    for (const double t : ends) {
        // Where an event came before a bend that was expected, that has been this event.
        const std::size_t next =
            static_cast<std::size_t>(std::ranges::upper_bound(mesh->ends, t) - mesh->ends.begin());
        const double length = next < mesh->ends.size() ? mesh->ends[next] - t : t - first;
        const bool is_met = std::ranges::binary_search(mesh->bends, t) && t - first < 0.5 * length;
        const bool is_rest =
            t - first < least_rest * length && t < last && !std::ranges::binary_search(mesh->required, t);
        if (part.ends.size() > 1 || is_end || (!is_met && !is_rest)) part.ends.push_back(t);
    }
    std::erase_if(part.bends, [&](double t) { return !std::ranges::binary_search(part.ends, t); });
    return part;
}

/// What acts, as far as a motion has decided.
struct Decisions {
    DecidedTimes times;

    Decisions(const Model& model, double start)
    {
        const auto begin = [&](const auto& all) {
            std::vector<std::vector<TimeSpan>> spans;
            for (const ActingTimes& one : all) {
                spans.emplace_back();
                // of a motion that was decided before: as it was then, up to there
                for (const TimeSpan& span : one.spans())
                    if (span.from <= start)
                        spans.back().push_back({span.from, span.until > start ? one.until : span.until});
                if (!one.is_from_motion && !one.is_begun_by_event && spans.back().empty())
                    spans.back().push_back({one.from, one.until});
            }
            return spans;
        };
        times.joints = begin(model.joints());
        times.loads = begin(model.loads());
    }

    std::vector<TimeSpan>& spans(const EventAction& of)
    {
        return of.joint >= 0 ? times.joints[of.joint] : times.loads[of.load];
    }
    bool acts(const EventAction& of, double t)
    {
        const std::vector<TimeSpan>& all = spans(of);
        return !all.empty() && all.back().from <= t && t < all.back().until;
    }
    /// Whether anything would happen.
    bool is_armed(const EventAction& action, double t)
    {
        if (action.does == EventAction::Does::begin) return !acts(action, t);
        return action.does != EventAction::Does::end || acts(action, t);
    }
    void act(const Model& model, const EventAction& action, double t)
    {
        if (!is_armed(action, t)) return;
        if (action.does == EventAction::Does::end) spans(action).back().until = t;
        if (action.does != EventAction::Does::begin) return;
        const double until =
            action.joint >= 0 ? model.joints()[action.joint].until : model.loads()[action.load].until;
        if (until > t) spans(action).push_back({t, until});
    }
};

/// One phase after the other: up to what is known beforehand, or what the motion decides.
class Chain {
public:
    Chain(const Model& model, const Problem& problem, const Time& time, const SolveOptions& options,
          const SolvePhase& solve_phase)
        : given_(model), stated_(model.events().empty() ? model : as_decided(model, {})), problem_(problem),
          time_(time), options_(options), solve_phase_(solve_phase), known_(phase_ends(stated_, time))
    {
        options_.judge = false;
        options_.growth = false;   // of a part from its own start: it says nothing of the whole
        problem_.fired = nullptr;
    }

    /// All phases, as far as they go.
    Solution solve(Method method, double accuracy, double tolerance_of_meeting) const
    {
        Solution whole;
        Way at{problem_, options_, Decisions(given_, start_of(time_)), start_of(time_)};
        at.method = std::move(method);
        while (at.first < known_.back()) {
            if (at.first > known_.front() &&
                !is_met(decided(at), whole.motion, whole.motion.n_elements(), known_.back() - known_.front(),
                        tolerance_of_meeting, whole.report))
                break;
            if (!run_phase(at, accuracy, whole)) break;
        }
        if (!stated_.events().empty()) whole.decided = std::make_shared<const Model>(decided(at));
        return whole;
    }

private:
    /// Of a motion over phases.
    struct Way {
        Problem problem;
        SolveOptions options;
        Decisions decisions;
        double first;   // where the phase begins
        Method method{};
    };

    Model decided(const Way& at) const
    {
        return stated_.events().empty() ? stated_ : as_decided(stated_, at.decisions.times);
    }

    /// False: the motion ends, and the report says why, unless an event has ended it.
    bool run_phase(Way& at, double accuracy, Solution& whole) const
    {
        const double last = *std::ranges::upper_bound(known_, at.first);
        ActingModel acting = acting_at(decided(at), 0.5 * (at.first + last));
        std::unique_ptr<EventWatch> watch;
        if (!stated_.events().empty()) {
            watch = watch_of(at, acting);
            at.problem.conditions.start = watch->start();
            at.problem.fired = [&](const Motion& so_far) { return watch->fired(so_far); };
        }
        const Model& model = watch != nullptr ? watch->model() : acting.model;
        Solution next = solve_next(model, at, last, accuracy);
        if (at.first > known_.front())
            for (std::string& note : next.report.notes)
                if (std::ranges::find(whole.report.notes, note) == whole.report.notes.end())
                    note = "from " + to_text(at.first, 6) + " s on: " + note;
        if (next.motion.mesh.ends.empty()) {
            whole.report += std::move(next.report);
            whole.cannot_begin = std::move(next.cannot_begin);
            return false;
        }
        const std::vector<int> fired = std::exchange(next.report.fired, {});
        at.method = next.method;   // what was open is chosen once
        if (watch != nullptr && !fired.empty()) meet(*watch, at, fired, next);
        const double end = next.motion.end();
        if (next.report.status == SolveStatus::inaccurate && (end == last || !fired.empty())) {
            next.report.status = SolveStatus::converged;   // the whole is judged, not a part of it
            next.report.message.clear();
        }
        State reached = next.motion.at_end(next.motion.n_elements());   // with angles that events count
        widen(next.motion, stated_, acting);
        whole.method = next.method;
        whole.estimate_seconds += next.estimate_seconds;
        whole.report += std::move(next.report);
        join(whole.motion, std::move(next.motion));
        if (!whole.report.converged()) return false;
        const bool goes_on = act(at, fired, end, whole);
        at.first = end;
        at.problem.conditions.start = std::move(reached);
        at.options.initial = StartPolicy::project;   // an end state holds its joints to rounding
        return goes_on;
    }

    std::unique_ptr<EventWatch> watch_of(Way& at, const ActingModel& acting) const
    {
        std::vector<bool> armed;
        for (const Event& event : stated_.events()) {
            const bool is_idle =
                event.action.does == EventAction::Does::end_motion && !problem_.ends_by_events;
            armed.push_back(!is_idle && at.decisions.is_armed(event.action, at.first));
        }
        return std::make_unique<EventWatch>(stated_, acting, std::move(armed), at.problem.conditions.start);
    }

    /// A phase that cannot begin leaves what was solved before it.
    Solution solve_next(const Model& model, const Way& at, double last, double accuracy) const
    {
        const Time part = part_of(time_, at.first, last, accuracy);
        const auto solve = [&] { return solve_phase_(model, at.problem, part, at.method, at.options); };
        if (at.first == known_.front()) return solve();
        try {
            Solution next = solve();
            if (std::exchange(next.cannot_begin, {}))
                next.report.message = "behind the event at " + to_text(at.first, 6) +
                                      " s the motion cannot begin: " + next.report.message;
            return next;
        } catch (const Stopped&) {
            Solution none;
            none.method = at.method;
            none.report.failed_at = at.first;
            none.report.status = SolveStatus::cancelled;
            none.report.message = of_stop(at.first);
            return none;
        }
    }

    /// The last element is solved anew until the state at its end is where the event is: the slope of its
    /// polynomial, by which velocities were seen on the way, is of a lower order.
    void meet(const EventWatch& watch, const Way& at, const std::vector<int>& fired, Solution& next) const
    {
        for (int i = 0; i < most_corrections; ++i) {
            const int n = next.motion.n_elements();
            const double start = next.motion.mesh.ends[n - 1], end = next.motion.end(),
                         late = watch.lateness(next.motion, fired);
            const double seen = std::max(1e-13 * (end - start), 4e-16 * std::abs(end));
            if (std::abs(late) <= seen || !(end - late > start)) return;
            Problem problem = at.problem;
            problem.fired = nullptr;
            problem.conditions.start = next.motion.at_end(n - 1);
            SolveOptions options = at.options;
            options.initial = StartPolicy::project;
            options.end_at_bends = false;
            Solution last =
                solve_phase_(watch.model(), problem, TimeMesh{{start, end - late}}, next.method, options);
            if (!last.report.converged() || last.motion.n_elements() == 0) return;
            drop_last(next.motion);
            if (next.motion.n_elements() == 0)
                next.motion = std::move(last.motion);
            else
                join(next.motion, std::move(last.motion));
            next.motion.mesh.bends.push_back(next.motion.end());
        }
    }

    /// What events do. False: the motion ends there.
    bool act(Way& at, const std::vector<int>& fired, double t, Solution& whole) const
    {
        bool goes_on = true;
        for (const int e : fired) {
            const EventAction& action = stated_.events()[static_cast<std::size_t>(e)].action;
            if (!at.decisions.is_armed(action, t)) continue;   // another one did it
            at.decisions.act(stated_, action, t);
            whole.events.push_back({e, t});
            goes_on = goes_on && action.does != EventAction::Does::end_motion;
        }
        return goes_on && !is_storm(whole);
    }

    bool is_storm(Solution& whole) const
    {
        const std::size_t n = whole.events.size();
        if (n < stormy) return false;
        const double since = whole.events[n - stormy].t, time = known_.back() - known_.front();
        if (n < most_events && whole.events.back().t - since > no_time * time) return false;
        SolveReport& report = whole.report;
        report.status = SolveStatus::not_converged;
        report.failed_at = whole.events.back().t;
        report.message = "events follow each other without an end: " + std::to_string(n) +
                         " so far, the last of them '" +
                         stated_.events()[static_cast<std::size_t>(whole.events.back().event)].name +
                         "' at " + to_text(report.failed_at, 9) +
                         " s; try: conditions that leave some way between what begins and what ends";
        return true;
    }

    const Model& given_;
    Model stated_;   // as it is before any event
    Problem problem_;
    const Time& time_;
    SolveOptions options_;
    const SolvePhase& solve_phase_;
    std::vector<double> known_;   // ends of phases, but for events that the motion decides
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
        if (whole.report.converged())
            estimate(found_model(model_, whole), problem_, whole.method, options_, whole);
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

namespace {

/// Events that the motion decides are for marches forwards, one element after the other.
void check_decided(const Model& model, const Problem& problem, const Method& method,
                   const SolveOptions& options)
{
    const std::string path = "event[" + model.events().front().name + "]";
    const auto refuse = [&](bool is_wrong, const std::string& value, const char* why, const char* help) {
        if (is_wrong)
            throw InputError(
                {"event-method", path, "what the motion decides cannot be found so", value, "", why, help});
    };
    const Conditions& given = problem.conditions;
    refuse(!is_nodal(method), name_of(method), "only elements of lobatto and radau end where events are",
           "use the family lobatto or radau");
    refuse(!given.has_state() || given.at_start != Known::state || !problem.unknowns.is_empty(), "",
           "it is decided on the way from a state at the start",
           "give the state at the start, and no unknowns");
    const auto* lobatto = std::get_if<Lobatto>(&method);
    refuse(lobatto != nullptr && lobatto->window != 1, "a window of more than one element",
           "elements that are solved together do not end where an event is", "leave 'window' out");
    refuse(!options.end_at_bends, "breaks = \"ignore\"", "elements have to end where events are",
           "leave 'breaks' out");
    // Reactions that are not unique are refused before anything is solved.
    if (model.events().end() != std::ranges::find_if(model.events(), [](const Event& event) {
            return !event.terms.reactions.empty();
        })) {
        std::vector<bool> none(model.events().size(), false);
        const EventWatch watch(model, acting_at(model, given.start.t), std::move(none), given.start);
    }
    refuse(options.estimate == SolveOptions::Estimate::local, "estimate = \"local\"",
           "a second solution with events of its own tells their errors", "use \"second\" or \"none\"");
}

}   // namespace

void check_events(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options)
{
    if (!model.has_events()) return;
    const Conditions& given = problem.conditions;
    if (!model.events().empty()) check_decided(model, problem, method, options);
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
    if (!std::isinf(options.meeting) && !solution.motion.mesh.ends.empty()) {
        const Model& found = found_model(model, solution);
        tell_releases(found, solution.motion, phase_ends(found, time), solution.report);
    }
    return solution;
}

}   // namespace livens::inline spacetime_internal

livens::Model livens::decided_model(const Model& model, double start, std::span<const SolvedEvent> events)
{
    if (model.events().empty()) return model;
    const Model stated = as_decided(model, {});
    Decisions decisions(stated, start);
    for (const SolvedEvent& one : events)
        decisions.act(stated, stated.events()[static_cast<std::size_t>(one.event)].action, one.t);
    return as_decided(stated, decisions.times);
}
