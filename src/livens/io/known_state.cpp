// SPDX-License-Identifier: BSD-3-Clause
// The state of a scenario at which its mechanism is looked at without being solved: that of the start, else
// that of the end. Where only positions are known the bodies are taken at rest (docs/program.md).
#include "livens/io/known_state.h"

namespace livens {

Scenario as_it_starts(Scenario scenario)
{
    if (!scenario.model.has_events()) return scenario;
    Model now = acting_at(scenario.model, start_of(scenario.time)).model;
    for (const Sampling& sampling : scenario.model.samplings()) now.add_sampling(sampling);
    scenario.model = std::move(now);
    return scenario;
}

Scenario as_it_rests(Scenario scenario)
{
    const Model whole = scenario.model;
    if (!whole.has_events()) return scenario;
    scenario = as_it_starts(std::move(scenario));
    for (int j = 0; j < static_cast<int>(whole.joints().size()); ++j) {
        const Joint& joint = whole.joints()[static_cast<std::size_t>(j)];
        if (!joint.impact || joint.impact->open_side == 0) continue;
        const int now = scenario.model.add_joint(joint);
        for (Event event : whole.events()) {
            if (event.action.joint != j || event.action.does != EventAction::Does::begin) continue;
            event.action.joint = now;
            scenario.model.add_event(std::move(event));
        }
    }
    return scenario;
}

KnownState known_state(const Scenario& scenario)
{
    const Conditions& b = scenario.conditions;
    const bool at_start = b.at_start == Known::state || b.at_start == Known::positions;
    const bool at_end = !at_start && (b.at_end == Known::state || b.at_end == Known::positions);
    KnownState known{at_end ? b.end : b.start, scenario.options.initial};
    if (b.at_start == Known::state || b.at_end == Known::state) return known;
    for (Matrix34& V : known.state.V) V = {};
    // Nothing is known of places: the stated ones are a guess, which is projected instead of refused.
    if (!at_start && !at_end) known.initial = StartPolicy::project;
    return known;
}

}   // namespace livens
