// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/phases/phase_model.h"

#include <utility>

namespace livens::inline spacetime_internal {

const Model& PhaseModel::decided(const Decisions& decisions)
{
    if (stated_.events().empty()) return stated_;
    if (std::exchange(decided_by_, decisions.changes()) != decisions.changes())
        decided_.emplace(as_decided(stated_, decisions.times()));
    return *decided_;
}

/// What watches is kept while the same joints act and nothing was decided: bounces change neither.
std::optional<Complaint> PhaseModel::begin(const Decisions& decisions, double first, double last,
                                           const State& start, const std::vector<double>& slack)
{
    const Model& model = decided(decisions);
    const double middle = 0.5 * (first + last);
    std::vector<int> joints;
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
        if (model.joints()[j].acts_at(middle)) joints.push_back(j);
    // Which reactions are unique is asked for where a phase begins.
    if (acting_by_ == decisions.changes() && joints == joints_ && !reads_reactions_) {
        if (watch_ != nullptr) watch_->begin_again(start, slack);
        return {};
    }
    watch_.reset();
    acting_by_ = -1;   // until all of it is there
    reads_reactions_ = false;
    acting_ = acting_at(model, middle);
    if (!stated_.events().empty()) {
        std::vector<bool> armed;
        for (const Event& event : stated_.events()) {
            const bool is_idle = event.action.does == EventAction::Does::end_motion && !ends_by_events_;
            armed.push_back(!is_idle && decisions.is_armed(event.action, first));
            reads_reactions_ = reads_reactions_ || (armed.back() && !event.terms.reactions.empty());
        }
        watch_ =
            std::make_unique<EventWatch>(stated_, std::move(acting_), std::move(armed), start, last, slack);
        if (watch_->refusal()) return watch_->refusal();
    }
    joints_ = std::move(joints);
    acting_by_ = decisions.changes();
    return {};
}

}   // namespace livens::inline spacetime_internal
