// SPDX-License-Identifier: BSD-3-Clause
// When joints and drives act.
#include <limits>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

/// Its instants divide time into phases with models of their own (theory.md, "Drives", Events). Those that
/// are conditions become events in read_events().
void read_times(Builder& builder, const Section& section, Joint& joint)
{
    const Section* time = only_section(builder.run(), "time");
    if (has_number(section, "from")) joint.from = section.number("from");
    if (has_number(section, "until")) joint.until = section.number("until");
    joint.is_begun_by_event = !condition_of(section, "from").empty();
    if (section.takes("restitution") && section.has("restitution")) {
        joint.impact = ImpactLaw{};
        if (section.number("restitution") != 0)
            throw InputError({"stop-restitution", "joint[" + joint.name + "].restitution",
                              "a joint that holds both ways catches", to_text(section.number("restitution")),
                              "0", "what it forbids is zero behind the impact",
                              "bodies that bounce do so at a [[stop]]"});
    }
    joint.is_ended_by_event = !condition_of(section, "until").empty();
    if (joint.is_decided_by_events()) builder.conditions().push_back({false, joint.name, &section});
    if (time == nullptr) return;
    const double start = time->number("start"), end = time->number("end");
    const double gap = 1e-8 * (end - start);   // nothing happens in so short a time
    const bool is_over = joint.until <= start + gap;
    if (is_over || joint.from >= end - gap)
        throw InputError({"joint-time", "joint[" + joint.name + "]." + (is_over ? "until" : "from"),
                          "'" + joint.name + "' never acts",
                          to_text(is_over ? joint.until : joint.from) + " s",
                          to_text(start) + " s to " + to_text(end) + " s", "", "leave it out"});
    // An interval that covers the motion is no event: without a phase of its own it costs nothing.
    if (joint.from <= start + gap) joint.from = -std::numeric_limits<double>::infinity();
    if (joint.until >= end - gap) joint.until = std::numeric_limits<double>::infinity();
}

}   // namespace livens::inline io_internal
