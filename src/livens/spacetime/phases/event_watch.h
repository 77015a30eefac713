// SPDX-License-Identifier: BSD-3-Clause
// The events that may come in a phase of a motion, and whether they have come.  (docs/theory.md, "Events")
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "livens/base/error.h"
#include "livens/dynamics/instant/settled_instant.h"
#include "livens/dynamics/rows/load_tables.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline spacetime_internal {

/// How far what leaves a stop, or slides along it, is beyond it by rounding, in units of the event's
/// coordinate.
double rounding_of_stop(const Model& model, const Event& event);

/// Where a phase ends at the latest, and how long elements before it were, s.
struct PhaseTimes {
    double last, length = 0;
};

/// Whether each event is true at the last end; empty: at the start, where these are in any case.
struct HeldEvents {
    std::vector<bool> at_end{};
    std::vector<int> at_start{};
};

/// The model of a phase with a load for each event that watches for it: elements end where conditions may
/// change, as they do where laws bend. After each element the state at its end tells what has come true.
class EventWatch {
public:
    /// `armed`: of each event of the model, whether something would happen. `start`: of the phase; what its
    /// angles lack of those that events count has not turned yet. `last`: where it ends at the latest; forces
    /// of loads that begin or end there are no part of it. `slacks`: of open stops, how many times what
    /// rounding has beyond them is not looked at; empty: once.
    EventWatch(const Model& model, ActingModel acting, std::vector<bool> armed, const State& start,
               double last = std::numeric_limits<double>::infinity(), const std::vector<double>& slacks = {});

    /// For another phase with the same joints and armed events, which ask for no reactions.
    void begin_again(const State& start, const std::vector<double>& slacks);

    /// `event-reaction`: one asks for a reaction that is not unique there, and nothing may be watched.
    const std::optional<Complaint>& refusal() const { return refusal_; }

    /// With the loads that watch, which come last.
    const Model& model() const { return acting_.model; }
    const ActingModel& acting() const { return acting_; }
    /// With all its angles.
    const State& start() const { return start_; }

    /// Armed events that came true with the last element of a motion that grows by one at a time.
    std::vector<int> fired(const Motion& so_far);
    /// Of fired(): an event whose formulas are no numbers somewhere in the last element; -1: none.
    int lost() const { return lost_; }
    std::string lost_in_words(const Motion& so_far) const;
    /// Whether all formulas of a condition are numbers in a state.
    bool is_number_at(int event, const State& state) const;
    /// How far the first of some conditions is from becoming true at the end of a motion, as states at
    /// element ends have it, and how that goes on behind it (per s).
    struct Border {
        double margin, rate;
    };
    Border border_of(const Motion& motion, std::span<const int> events) const;
    /// Whether one of them was beyond its border where the last element began, within its slack.
    bool was_beyond(const Motion& motion, std::span<const int> events) const;
    /// Whether they have come true with forces of loads that jump at the end of a motion, and not before.
    bool have_jumped(const Motion& motion, std::span<const int> events) const;
    /// What rounding of the state at the end of a motion makes of the instant of a condition, s.
    double rounding_at_end(const Motion& motion, int event) const;
    /// How far conditions are from changing in a state; infinite for stops, which are told when they are met
    /// or have to pull, and for those that are not armed.
    std::vector<double> margins(const State& state) const;
    /// Those that a jump has made true where the phase begins, whose margins were these before it.
    std::vector<int> come_by_jump(const std::vector<double>& before) const;
    /// Of those that have ended the phase before with these margins: what no jump has taken back is true
    /// where this one begins, on whichever side of its border rounding has it.
    void keep(const std::vector<int>& events, const std::vector<double>& before);
    /// Elements before the phase were so long, s.
    void follow_elements_of(double length) { times_.length = length; }
    /// Those of them that are true just behind the end; the nearest, if none is.
    std::vector<int> holding(const Motion& motion, std::span<const int> events) const;
    /// Whether the condition of an event holds in the state where the phase begins.
    bool holds_now(int event) const { return holds_at(event, start_); }
    /// How far a condition is from changing in a state, in units of its formulas: positive where it is true.
    double margin(int event, const State& state, Side side = Side::middle) const;
    /// What of the margin of an open stop is rounding; 0 for all else.
    double slack(int event) const { return (*slack_)[static_cast<std::size_t>(event)]; }
    /// Angles on the way to a configuration.
    void follow(const std::vector<Matrix34>& X, std::vector<double>& angles) const;

private:
    std::function<void(const LoadArguments&, std::span<double>)> reactions_of(const Event& event);
    void take(const std::vector<double>& slacks);
    bool is_open_stop(int event) const;
    bool is_number_along(const Motion& motion, int event) const;
    State beside(const Motion& motion, int end, double share, bool by_slope) const;
    State just_behind(const Motion& motion, int end) const;
    bool comes_at_once(const Motion& motion, int event) const;
    double rounding_in(const State& state, int event) const;
    std::vector<double> terms_at(int event, const State& state, Side side = Side::middle) const;
    bool holds_at(int event, const State& state) const;

    const Model& whole_;
    ActingModel acting_;
    std::vector<bool> armed_;
    State start_;
    PhaseTimes times_;
    int first_watch_;   // among the loads
    std::shared_ptr<const Model> mechanism_model_;
    std::shared_ptr<SettledInstant> mechanism_;   // null: nothing asks for reactions
    std::optional<Complaint> refusal_;
    std::unique_ptr<LoadTables> loads_;
    std::shared_ptr<std::vector<double>> slack_;   // of each event: it is looked for so far behind its border
    int lost_ = -1;
    HeldEvents held_;
};

}   // namespace livens::inline spacetime_internal
