// SPDX-License-Identifier: BSD-3-Clause
// What the motion decided, and its impacts, for marks on the bar of time and a table.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/io/report/parts.h"

namespace livens::inline io_internal {

namespace {

/// Of an impact the speed with which bodies go apart, as the law of its stop has it; nan: not known.
double speed_behind(const Model& model, const Event& event, double speed, double rests_at)
{
    const EventAction& action = event.action;
    if (!(speed > 0) || action.joint < 0) return std::numeric_limits<double>::quiet_NaN();
    const Joint& joint = model.joints()[static_cast<std::size_t>(action.joint)];
    if (!joint.impact) return std::numeric_limits<double>::quiet_NaN();
    return std::isfinite(rests_at) ? 0 : joint.impact->restitution * speed;
}

}   // namespace

void write_events(ReportData& data, const Scenario& scenario, const Run& run)
{
    const RunEvents& all = run.events;
    const std::vector<Event>& known = scenario.model.events();
    data.json.key("events").begin_array();
    for (std::size_t k = 0; k < all.names.size(); ++k) {
        const auto event = std::ranges::find(known, all.names[k], &Event::name);
        const bool is_known = event != known.end();
        const bool is_angle = is_known && !event->terms.coordinates.empty() &&
                              event->terms.coordinates[0].coordinate.is_angle();
        data.json.begin_object()
            .member("name", all.names[k])
            .member("condition", is_known ? event->text : "")
            .member("t", all.times[k])
            .member("error", all.errors[k])
            .member("impulse", all.impulses[k])
            .member("speed", all.speeds[k])
            .member("behind", is_known ? speed_behind(scenario.model, *event, all.speeds[k], all.rests[k])
                                       : std::numeric_limits<double>::quiet_NaN())
            .member("rests", all.rests[k])
            .member("angle", is_angle)
            .end_object();
    }
    data.json.end_array();
}

}   // namespace livens::inline io_internal
