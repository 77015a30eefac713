// SPDX-License-Identifier: BSD-3-Clause
// Every phase has a model of its own. theory.md, "Drives", Events, says what goes on and what must meet;
// "Events" and "Impacts" what the motion decides.
#include "livens/spacetime/phases/phase_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/phases/contacts.h"
#include "livens/spacetime/phases/event_end.h"
#include "livens/spacetime/phases/event_watch.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/phases/phase_model.h"
#include "livens/spacetime/phases/samplings.h"

namespace livens::inline spacetime_internal {

namespace {

/// More would be a storm: as many as that in a millionth of the time, or in all.
constexpr int stormy = 200, most_events = 100'000, most_beside = 500;   // of a neighbour in a window
constexpr double no_time = 1e-6;
/// Of the length of elements before a phase, where all of its own are shorter: events may come seldom again.
constexpr double still_long = 0.125;

/// One phase after the other: up to what is known beforehand, or what the motion decides.
class Chain {
public:
    explicit Chain(const PhasedProblem& given)
        : given_(given.model), stated_(given_.events().empty() ? given_ : as_decided(given_, {})),
          problem_(given.problem), time_(given.time), options_(given.options),
          solve_phase_(given.solve_phase), known_(phase_ends(stated_, time_))
    {
        options_.judge = false;
        options_.growth = false;   // of a part from its own start: it says nothing of the whole
        problem_.fired = nullptr;
    }

    /// All phases, as far as they go.
    Solution solve(Method method, double accuracy, double tolerance_of_meeting) const
    {
        Solution whole;
        Way at{problem_, options_, Decisions(given_, start_of(time_)), start_of(time_),
               PhaseModel(stated_, problem_.ends_by_events)};
        at.method = std::move(method);
        at.slack.assign(stated_.events().size(), 1.0);
        begin_at_stops(at, whole);
        if (State& start = at.problem.conditions.start; !start.is_of_motion)
            ask_controllers(stated_, nearest(), start);
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
        PhaseModel model;
        Method method{};
        bool jumps = false;               // behind an impact
        double length = 0;                // of elements to begin with
        std::vector<double> ends{};       // where events have ended phases
        std::vector<double> slack{};      // of each event, see EventWatch
        std::vector<double> rounding{};   // of instants of events, where the phase has ended with them
        // Where it has ended, before anything jumped: what came true, and margins of all conditions.
        std::vector<int> fired{};
        std::vector<double> margins{};
    };

    double nearest() const { return nearest_ends * (known_.back() - known_.front()); }
    /// Where a phase ends at the latest: what is known to happen where it begins has happened.
    double next_known(double first) const
    {
        const auto next = std::ranges::upper_bound(known_, first + nearest());
        return next != known_.end() ? *next : known_.back();
    }
    const Model& decided(Way& at) const { return at.model.decided(at.decisions); }
    /// What formulas say at an instant: those that read reactions see the joints that act by then.
    template <class Question>
    auto ask(Way& at, const Question& question) const
    {
        return reads_reactions(stated_) ? question(decided(at)) : question(stated_);
    }

    /// What a jump makes true where a phase begins, a sample, an impact or what begins to act, happens there,
    /// and may make more true. False: the motion ends.
    bool follow_jump(Way& at, double last, Solution& whole) const
    {
        const std::vector<int> came = std::exchange(at.fired, {});
        const std::vector<double> before = at.margins;
        for (const int e : came)   // has come true
            at.margins[static_cast<std::size_t>(e)] = std::numeric_limits<double>::infinity();
        while (at.model.watch() != nullptr && at.first > known_.front()) {
            const EventWatch& watch = *at.model.watch();
            const std::vector<int> fired = watch.come_by_jump(at.margins);
            if (fired.empty()) break;
            State& start = at.problem.conditions.start;
            at.margins = watch.margins(start);
            if (!act(at, fired, start, whole)) {
                if (at.jumps) jump_at_end(whole.motion, stated_, start.V);
                return false;
            }
            if (!begin(at, last, whole)) return false;
        }
        if (at.model.watch() == nullptr) return true;
        at.model.watch()->keep(came, before);
        at.model.watch()->follow_elements_of(at.length);
        return true;
    }

    /// False: the motion ends, and the report says why, unless an event has ended it.
    bool run_phase(Way& at, double accuracy, Solution& whole) const
    {
        const double last = next_known(at.first);
        if (!begin(at, last, whole) || !follow_jump(at, last, whole)) return false;
        EventWatch* const watch = at.model.watch();
        if (watch != nullptr) {
            at.problem.conditions.start = watch->start();
            at.problem.fired = [&](const Motion& so_far) { return watch->fired(so_far); };
        }
        const ActingModel& acting = at.model.acting();
        Solution next = solve_next(acting.model, at, last, accuracy);
        if (at.first > known_.front()) date_notes(whole.report.notes, at.first, next.report.notes);
        if (next.motion.mesh.ends.empty()) {
            whole.report += std::move(next.report);
            whole.cannot_begin = std::move(next.cannot_begin);
            return false;
        }
        std::vector<int> fired = std::exchange(next.report.fired, {});
        at.method = next.method;   // what was open is chosen once
        const bool is_lost = watch != nullptr && watch->lost() >= 0;
        if (watch != nullptr && !fired.empty() &&
            (is_lost || !end_at_event({*watch, at.problem, at.options, solve_phase_}, fired, next)))
            fired.clear();
        at.rounding.assign(stated_.events().size(), 0.0);
        for (const int e : fired)
            at.rounding[static_cast<std::size_t>(e)] = watch->rounding_at_end(next.motion, e);
        const double end = next.motion.end();
        if (next.report.status == SolveStatus::inaccurate && (end == last || !fired.empty())) {
            next.report.status = SolveStatus::converged;   // the whole is judged, not a part of it
            next.report.message.clear();
        }
        at.length *= still_long;
        for (int e = 0; e < next.motion.n_elements(); ++e) raise_to(at.length, next.motion.mesh.length(e));
        if (is_lost) {
            next.report.status = SolveStatus::not_converged;
            next.report.failed_at = next.motion.mesh.ends[next.motion.n_elements() - 1];
            next.report.message = watch->lost_in_words(next.motion);
        }
        State reached = next.motion.at_end(next.motion.n_elements());   // with angles that events count
        at.fired = fired;
        if (watch != nullptr) at.margins = watch->margins(reached);
        widen(next.motion, stated_, acting);
        whole.method = next.method;
        whole.estimate_seconds += next.estimate_seconds;
        whole.report += std::move(next.report);
        join(whole.motion, std::move(next.motion), std::exchange(at.jumps, false));
        if (!whole.report.converged()) return false;
        at.first = end;
        const bool goes_on = act(at, fired, reached, whole);
        const bool is_asked = goes_on && ask(at, [&](const Model& by_then) {
                                  return ask_controllers(by_then, nearest(), reached);
                              });
        if (is_asked) {
            at.jumps = true;
            if (at.first >= known_.back()) jump_at_end(whole.motion, stated_, reached.V);
        }
        at.problem.conditions.start = std::move(reached);
        at.options.initial = StartPolicy::project;   // an end state holds its joints to rounding
        return goes_on;
    }

    /// False: reactions are not unique any more, and the report says so.
    bool begin(Way& at, double last, Solution& whole) const
    {
        std::optional<Complaint> why;
        do why = at.model.begin(at.decisions, at.first, last, at.problem.conditions.start, at.slack);
        while (!why && at.model.watch() != nullptr && release_stops(at, *at.model.watch(), whole));
        if (!why) return true;
        if (at.first == known_.front()) throw InputError(std::move(*why));
        whole.report.status = SolveStatus::not_converged;
        whole.report.failed_at = at.first;
        whole.report.message = "at " + to_text(at.first, 6) + " s " + why->message + "; try: " + why->help;
        return false;
    }

    /// Stops that would have to pull where a phase begins: false, there is none.
    bool release_stops(Way& at, const EventWatch& watch, Solution& whole) const
    {
        bool is_any = false;
        for (std::size_t e = 0; e < stated_.events().size(); ++e) {
            const EventAction& action = stated_.events()[e].action;
            const bool is_stop = action.does == EventAction::Does::end && action.joint >= 0 &&
                                 stated_.joints()[action.joint].impact &&
                                 stated_.joints()[action.joint].impact->open_side != 0;
            if (!is_stop || !at.decisions.is_armed(action, at.first) || !watch.holds_now(static_cast<int>(e)))
                continue;
            at.decisions.act(stated_, action, at.first);
            whole.events.push_back({static_cast<int>(e), at.first});
            is_any = true;
        }
        return is_any;
    }

    /// A phase that cannot begin leaves what was solved before it.
    Solution solve_next(const Model& model, const Way& at, double last, double accuracy) const
    {
        const Time part = part_of(time_, at.first, last, accuracy, at.length);
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

    /// What events do to a state. False: the motion ends there.
    bool act(Way& at, const std::vector<int>& fired, State& reached, Solution& whole) const
    {
        bool goes_on = true;
        std::vector<int> met;   // joints that begin with an impact, and their events
        for (const int e : fired) {
            const EventAction& action = stated_.events()[static_cast<std::size_t>(e)].action;
            if (!at.decisions.is_armed(action, at.first)) continue;   // another one did it
            if (begun_by_impact(stated_, action) != nullptr) {
                met.push_back(e);
                continue;
            }
            at.decisions.act(stated_, action, at.first);
            whole.events.push_back({e, at.first});
            whole.events.back().rounding = at.rounding[static_cast<std::size_t>(e)];
            if (action.does == EventAction::Does::set) {
                ask(at, [&](const Model& model) {
                    change_states(model, model.events()[static_cast<std::size_t>(e)].change, reached);
                });
                at.jumps = at.first > known_.front();
            }
            goes_on = goes_on && action.does != EventAction::Does::end_motion;
        }
        if (!goes_on) return false;
        return meet(at, met, reached, whole) && !is_storm(at, whole);
    }

    /// Impacts of joints that these events begin, and of those that begin there as stated.
    bool meet(Way& at, std::vector<int> events, State& reached, Solution& whole) const
    {
        std::vector<int> begins;
        if (at.first > known_.front()) {   // at the start all are known
            const std::vector<int> beside = stops_beside(stated_, at.decisions, events, reached);
            events.insert(events.end(), beside.begin(), beside.end());
        }
        for (const int e : events)
            if (const int joint = stated_.events()[static_cast<std::size_t>(e)].action.joint;
                std::ranges::find(begins, joint) == begins.end())   // by several conditions
                begins.push_back(joint);
        const double gap = nearest();
        for (int j = 0; j < static_cast<int>(stated_.joints().size()); ++j) {
            const Joint& joint = stated_.joints()[j];
            if (joint.impact && !joint.is_begun_by_event && std::abs(joint.from - at.first) <= gap)
                begins.push_back(j);
        }
        if (begins.empty()) return true;
        ContactOutcome outcome = meet_joints(stated_, at.decisions, reached, begins, options_.lowest_hop);
        if (!outcome.refused.empty()) {
            whole.report.status = SolveStatus::not_converged;
            whole.report.failed_at = at.first;
            whole.report.message = outcome.refused;
            return false;
        }
        for (std::size_t k = 0; k < events.size(); ++k) tell_contact(at, events[k], outcome, reached, whole);
        for (const int j : outcome.opens)
            for (std::size_t e = 0; e < stated_.events().size(); ++e) {
                const EventAction& action = stated_.events()[e].action;
                if (action.does != EventAction::Does::end || action.joint != j) continue;
                at.decisions.act(stated_, action, at.first);
                whole.events.push_back({static_cast<int>(e), at.first});
            }
        reached.V = std::move(outcome.V);
        at.jumps = at.jumps || (outcome.jumps && at.first > known_.front());
        return true;
    }

    /// The row of a stop is a function of its coordinate with the slope `unit`: speeds by the coordinate are
    /// those of the row over it, impulses along it those of the row times it.
    void tell_contact(Way& at, int event, const ContactOutcome& outcome, const State& reached,
                      Solution& whole) const
    {
        const EventAction& action = stated_.events()[static_cast<std::size_t>(event)].action;
        const auto of = std::ranges::find(outcome.begun, action.joint, &Contact::joint);
        if (of == outcome.begun.end()) return;
        const Event& stated = stated_.events()[static_cast<std::size_t>(event)];
        double& slack = at.slack[static_cast<std::size_t>(event)];
        const bool is_met = of->is_hit || of->closes;
        slack = slack_behind(stated_, stated, reached, is_met ? 0 : slack);
        if (!is_met) return;
        SolvedEvent one{event, at.first};
        const double unit = slope_of_row(stated, reached);
        one.impulse = of->impulse * unit;
        if (!at.rounding.empty()) one.rounding = at.rounding[static_cast<std::size_t>(event)];
        one.speed = of->approach / unit;
        if (of->closes) {
            at.decisions.act(stated_, action, at.first);
            if (stated_.joints()[action.joint].impact->open_side != 0) one.rests_at = of->rests_at;
        }
        whole.events.push_back(one);
    }

    /// Stops that are touched where the motion begins.
    void begin_at_stops(Way& at, Solution& whole) const
    {
        State& start = at.problem.conditions.start;
        std::vector<int> touched;
        for (const StopDepth& one : depths_of_stops(stated_, start))
            if (one.depth >= -touching_stop) touched.push_back(one.event);
        if (touched.empty() || meet(at, touched, start, whole)) return;
        throw InputError({"impact-simultaneous", "start", "stops are hit at once where the motion begins", "",
                          "", whole.report.message, "begin apart from them"});
    }

    bool is_storm(Way& at, Solution& whole) const
    {
        at.ends.push_back(at.first);   // stops that are but touched are no events
        const std::size_t n = at.ends.size();
        if (n < stormy) return false;
        const double since = at.ends[n - stormy], time = known_.back() - known_.front();
        const std::size_t most = problem_.ends_by_events ? most_events : most_beside;
        if (n < most && at.first - since > no_time * time) return false;
        whole.report.status = SolveStatus::not_converged;
        whole.report.failed_at = at.first;
        whole.report.message = of_storm(stated_, whole.events, n, at.first);
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

}   // namespace

Solution solve_chain(const PhasedProblem& given, const Method& method, double accuracy, double meeting)
{
    return Chain(given).solve(method, accuracy, meeting);
}

}   // namespace livens::inline spacetime_internal
