// SPDX-License-Identifier: BSD-3-Clause
// What the motion decides: conditions of its own numbers, and what happens where they come true.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/loads/reaction_law.h"

namespace [[gnu::visibility("default")]] livens {

/// What happens where a condition comes true.
struct EventAction {
    enum class Does {
        note,         ///< it is told
        end_motion,   ///< the motion ends there
        begin,        ///< a joint or load acts from there on
        end,          ///< it acts until there
        set           ///< states become others
    } does = Does::note;
    int joint = -1, load = -1;   ///< of `begin` and `end`: one of them
};

/// Numbers that are positive where what they stand for is true.
struct EventTerms {
    std::vector<LawCoordinate> coordinates{};
    std::vector<ReactionInput> reactions{};
    int n_terms = 0;
    std::function<void(const LawArguments&, std::span<const double> reactions, std::span<double> terms)>
        values = nullptr;
    /// Any of these, of each all terms: the condition.
    std::vector<std::vector<int>> when{};
};

/// What states become at an instant: what a load that does nothing says of itself there.
struct StateChange {
    int load = -1;   ///< one reading for each state
    /// Whose rates the states are.
    std::vector<JointCoordinate> states{};
};

/// A controller that is asked at instants first, first + every, .. up to `last`, and holds what it says until
/// the next one.
struct Sampling {
    std::string name;
    StateChange change;
    double every = 0;   ///< s
    double first = 0;   ///< s
    double last = 0;    ///< s

    /// Ascending.
    std::vector<double> instants() const;
};

/// The states of bodies behind a change. `angles`: of loads, see Turns.
void change_states(const Load& load, const StateChange& change, Instant at, std::span<const Matrix34> X,
                   std::span<const double> angles, std::vector<Matrix34>& V);

/// A condition that comes true as the motion has it, and an action. An element of the motion ends there; the
/// instant is that at which the state at the element's end is on the border (docs/theory.md, "Events").
struct Event {
    std::string name;
    std::string text;   ///< of the condition, for people
    EventTerms terms;
    EventAction action;
    StateChange change{};   ///< of `set`
};

/// Throws InputError: `event-condition` for none, or a joint that is not there, `event-action` for what
/// begins or ends something that does not say so.
void check_event(const Event& event, const std::vector<Joint>& joints, const std::vector<Load>& loads);

/// Whether the condition holds where its terms have these values.
bool holds(const Event& event, std::span<const double> terms);

/// Reactions at an instant, for all bodies of the model in its order: one number for each input.
using ReactionsAt = std::function<void(const LoadArguments& all_bodies, std::span<double> reactions)>;

/// A load that does nothing: its guards are the terms of the event, so that whoever looks where laws bend
/// sees where the condition may change. `reactions`: needed where the event has inputs of that kind; the load
/// then looks at all n bodies, in their order from the first on. X: of all bodies at the start.
Load watching(const Event& event, const ReactionsAt& reactions, int n_bodies, const Configurations& X);

/// The load while it acts, see ActingTimes, and nothing else. What was its potential energy is work of its
/// forces then, since what it stores goes with it.
Load for_its_time(const Load& load);

}   // namespace gnu::visibility("default")]]livens
