// SPDX-License-Identifier: BSD-3-Clause
// The parts of a page's data, each of which puts numbers into the payload and says in JSON what they are.
#pragma once

#include "livens/io/report.h"
#include "livens/io/report/payload.h"

namespace livens::inline io_internal {

/// Where numbers of a run go.
struct ReportData {
    JsonWriter& json;
    Payload& payload;
};

/// "pose": how positions and orientations lie in the payload, and how exact they are.
void write_poses(ReportData& data, const Run& run, double most_bytes);

/// "shapes", "bodies", "joints", "loads", "sensors": what is drawn.
void write_scene(ReportData& data, const Scenario& scenario, const Run& run);

/// "curves", "channels": what is plotted over time beside the bodies.
void write_curves(ReportData& data, const Scenario& scenario, const Run& run, double most_bytes);

/// "events": what the motion decided, in its order.
void write_events(ReportData& data, const Scenario& scenario, const Run& run);

/// "quality": series that tell how right the run is, and the bounds of its acceptance.
void write_quality(ReportData& data, const Scenario& scenario, const Run& run);

}   // namespace livens::inline io_internal
