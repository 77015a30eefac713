// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "livens/spacetime/phases/decisions.h"
#include "livens/spacetime/phases/event_watch.h"

namespace livens::inline spacetime_internal {

/// What acts in a phase and watches for events there, made anew only where that has changed: of a ball that
/// bounces there is one, and what is found of a model by its version serves all its phases.
class PhaseModel {
public:
    /// `stated`: as it is before any event. It must outlive this.
    PhaseModel(const Model& stated, bool ends_by_events) : stated_(stated), ends_by_events_(ends_by_events) {}

    /// As far as it is decided.
    const Model& decided(const Decisions& decisions);
    /// For a phase. `slack`: as EventWatch has it, which may refuse; then none has begun.
    std::optional<Complaint> begin(const Decisions& decisions, double first, double last, const State& start,
                                   const std::vector<double>& slack);
    /// Null: the model has no events.
    EventWatch* watch() { return watch_.get(); }
    /// With the loads that watch.
    const ActingModel& acting() const { return watch_ != nullptr ? watch_->acting() : acting_; }

private:
    const Model& stated_;
    bool ends_by_events_;
    std::optional<Model> decided_;   // none: nothing decides
    int decided_by_ = -1;            // see Decisions::changes()
    ActingModel acting_;
    int acting_by_ = -1;
    std::vector<int> joints_;        // that act
    bool reads_reactions_ = false;   // an armed event
    std::unique_ptr<EventWatch> watch_;
};

}   // namespace livens::inline spacetime_internal
