// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "Events": spans of time in which joints and loads act, added to as events come.
#include "livens/spacetime/phases/decisions.h"

#include <cmath>

namespace livens::inline spacetime_internal {

Decisions::Decisions(const Model& model, double start)
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
    times_.joints = begin(model.joints());
    times_.loads = begin(model.loads());
}

std::vector<TimeSpan>& Decisions::spans(const EventAction& of)
{
    return of.joint >= 0 ? times_.joints[of.joint] : times_.loads[of.load];
}

bool Decisions::acts(const EventAction& of, double t) const
{
    const std::vector<TimeSpan>& all = of.joint >= 0 ? times_.joints[of.joint] : times_.loads[of.load];
    return !all.empty() && all.back().from <= t && t < all.back().until;
}

bool Decisions::is_armed(const EventAction& action, double t) const
{
    if (action.does == EventAction::Does::begin) return !acts(action, t);
    return action.does != EventAction::Does::end || acts(action, t);
}

void Decisions::act(const Model& model, const EventAction& action, double t)
{
    if (!is_armed(action, t)) return;
    ++changes_;
    if (action.does == EventAction::Does::end) {
        std::vector<TimeSpan>& all = spans(action);
        all.back().until = t;
        if (all.back().from == t) all.pop_back();   // it has never acted
    }
    if (action.does != EventAction::Does::begin) return;
    const double until =
        action.joint >= 0 ? model.joints()[action.joint].until : model.loads()[action.load].until;
    if (until > t) spans(action).push_back({t, until});
}

const Joint* begun_by_impact(const Model& model, const EventAction& action)
{
    if (action.does != EventAction::Does::begin || action.joint < 0) return nullptr;
    const Joint& joint = model.joints()[action.joint];
    return joint.impact ? &joint : nullptr;
}

}   // namespace livens::inline spacetime_internal

/// In the order in which they came. A stop that was hit and has not closed acts at no time.
livens::Model livens::decided_model(const Model& model, double start, std::span<const SolvedEvent> events)
{
    if (model.events().empty()) return model;
    const Model stated = as_decided(model, {});
    Decisions decisions(stated, start);
    for (const SolvedEvent& one : events) {
        const EventAction& action = stated.events()[static_cast<std::size_t>(one.event)].action;
        const Joint* stop = begun_by_impact(stated, action);
        if (stop != nullptr && stop->impact->open_side != 0 && std::isnan(one.rests_at)) continue;
        decisions.act(stated, action, one.t);
    }
    return as_decided(stated, decisions.times());
}
