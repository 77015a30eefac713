// SPDX-License-Identifier: BSD-3-Clause
// The events that may come in a phase of a motion, and whether they have come.  (docs/theory.md, "Events")
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "livens/dynamics/instant/settled_instant.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline spacetime_internal {

/// The model of a phase with a load for each event that watches for it: elements end where conditions may
/// change, as they do where laws bend. After each element the state at its end tells what has come true.
class EventWatch {
public:
    /// `armed`: of each event of the model, whether something would happen. `start`: of the phase; what its
    /// angles lack of those that events count has not turned yet. Throws InputError `event-reaction` for a
    /// reaction that is not unique there.
    EventWatch(const Model& model, ActingModel acting, std::vector<bool> armed, const State& start);

    /// With the loads that watch, which come last.
    const Model& model() const { return acting_.model; }
    const ActingModel& acting() const { return acting_; }
    /// With all its angles.
    const State& start() const { return start_; }

    /// Armed events that came true with the last element of a motion that grows by one at a time.
    std::vector<int> fired(const Motion& so_far);
    /// By how much the end of the motion is too late (s), as states at element ends have it, for what fired
    /// there first; 0: it is met, or nothing tells.
    double lateness(const Motion& motion, const std::vector<int>& fired) const;
    /// Whether the condition of an event holds where the motion has just begun.
    bool holds_at_start(const Motion& motion, int event) const;

private:
    std::function<void(const LoadArguments&, std::span<double>)> reactions_of(const Event& event);
    State beside(const Motion& motion, int end, double share) const;
    std::vector<double> terms_at(int event, const State& state) const;
    bool holds_at(int event, const State& state) const;

    const Model& whole_;
    ActingModel acting_;
    std::vector<bool> armed_;
    State start_;
    int first_watch_;   // among the loads
    std::shared_ptr<const Model> mechanism_model_;
    std::shared_ptr<SettledInstant> mechanism_;   // null: nothing asks for reactions
    std::unique_ptr<LoadTables> loads_;
    std::vector<bool> held_;   // of each event, at the last end
};

}   // namespace livens::inline spacetime_internal
