// SPDX-License-Identifier: BSD-3-Clause
// [[stop]]: limits of a joint's coordinate, or of the distance of two points, that let nothing beyond them.
#include <cmath>
#include <limits>
#include <unordered_set>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/joints/stops.h"

namespace livens::inline io_internal {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

struct Limits {
    double low = -never, high = never;
};

Limits read_stop_limits(const Section& section, const std::string& path)
{
    const Value& both = *section.find("limits");
    const Limits limits{both.numbers[0], both.numbers[1]};
    const bool is_none = std::isinf(limits.low) && std::isinf(limits.high);
    if (is_none || !(limits.low < limits.high))
        throw InputError({"stop-limits", path + ".limits",
                          is_none ? "a stop without limits" : "there is nothing between the limits of a stop",
                          to_text(limits.low) + ", " + to_text(limits.high), "the lower one first", "",
                          "as in limits = [\"-30 deg\", \"60 deg\"]; inf and -inf mean no limit"});
    return limits;
}

/// With its names: one stop, or one for each limit.
template <class Add>
void add_both(const Section& section, const std::string& name, const Limits& limits, const Add& add)
{
    const bool has_two = std::isfinite(limits.low) && std::isfinite(limits.high);
    StopLaw law{0, true, section.number("restitution"), section.text("impact") == "together"};
    for (const bool is_lowest : {true, false}) {
        law.limit = is_lowest ? limits.low : limits.high;
        law.is_lowest = is_lowest;
        if (std::isfinite(law.limit)) add(has_two ? name + (is_lowest ? ".low" : ".high") : name, law);
    }
}

void add_of_joint(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    const JointReference of = find_coordinate(builder, section, path);
    check_units(section, of.coordinate->coordinate.is_angle(), path);
    const std::vector<Matrix34> X = builder.start_configurations();
    const Joint joint = *of.joint;   // a copy, as joints are added
    const NamedCoordinate coordinate = *of.coordinate;
    add_both(section, name, read_stop_limits(section, path), [&](const std::string& one, const StopLaw& law) {
        if (coordinate.coordinate.is_angle())
            check_driven_angle({&joint, &coordinate},
                               {[&](Instant) {
                                    return TimeValue{law.limit, 0, 0};
                                },
                                {}},
                               {0, 0}, path);
        add_coordinate_stop(builder.model(), one, joint, coordinate, law, Configurations(X));
    });
}

void add_of_points(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    BodyReference first, second;
    if (!builder.find_pair(section, "stop-self", first, second)) return;
    check_units(section, false, path);
    Limits limits = read_stop_limits(section, path);
    if (!(limits.low > 0)) limits.low = -never;   // no distance is lower
    if (!(limits.high > 0))
        throw InputError({"stop-limits", path + ".limits", "a distance is not negative", to_text(limits.high),
                          "> 0", "", ""});
    const std::vector<Matrix34> X = builder.start_configurations();
    const BodyPoint a{first.index, builder.in_axes(first.index, section.row("points", 0))},
        b{second.index, builder.in_axes(second.index, section.row("points", 1))};
    add_both(section, name, limits, [&](const std::string& one, const StopLaw& law) {
        add_distance_stop(builder.model(), one, a, b, law, Configurations(X));
    });
}

}   // namespace

Table stop_table()
{
    return {
        "[[stop]]",
        "A limit that nothing passes: of a coordinate of a joint, or of the distance of two points, as a "
        "rope "
        "that only pulls. It is met with an impact that changes velocities at once, closes where bodies stay "
        "at "
        "it, and opens where it would have to pull. Beside the joints it stands in results, with the "
        "reaction "
        "that acts on its second body. See [stops](howto/stops.md). For the families lobatto and radau with "
        "the "
        "state at the initial time.",
        {Key{"name", types::text, "Name of the stop. With two limits `NAME.low` and `NAME.high`."}.needed(),
         Key{"joint", types::text, "The joint whose coordinate has limits."}.needed_without("between"),
         coordinate_key(),
         Key{"between", types::names, "Two bodies, or two named points, whose distance has limits."},
         Key{"points", types::two_points,
             "One point per body, in that body's coordinates. Default: the reference points (for the world: "
             "its origin).",
             "m"},
         Key{"limits", types::interval, "Smallest and largest value; `-inf` or `inf` means no limit.", "m"}
             .or_in("rad")
             .or_infinite()
             .needed(),
         Key{"restitution", types::number, "Speed with which bodies go apart, over that with which they met.",
             "", "0"}
             .within({0, 1}),
         choice("impact", {"alone", "together"},
                "What happens where several stops are hit at the same instant. alone: the run ends there; "
                "together: all at once by Moreau's law, if all of them say so.")}};
}

void read_stops(Builder& builder)
{
    std::unordered_set<std::string> taken;
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    for (const Section& section : builder.top().sections("stop")) {
        const std::string name = section.text("name"), path = "stop[" + name + "]";
        builder.remember(path, section);
        for (const char* part : {"", ".low", ".high"}) {
            builder.remember("joint[" + name + part + "]", section);
            builder.remember("event[" + name + part + "]", section);
            builder.remember("event[" + name + part + " opens]", section);
        }
        if (!section.is_valid()) continue;
        claim_name(section, "joint, drive or stop", name, taken,
                   {"results refer to stops as to joints", "give it another 'name'"});
        if (section.has("joint") == section.has("between")) {
            section.at_most_one({"joint", "between"}, "stop-of");
            continue;
        }
        builder.guard(path, [&] {
            if (section.has("joint"))
                add_of_joint(builder, section, name, path);
            else
                add_of_points(builder, section, name, path);
        });
    }
}

}   // namespace livens::inline io_internal
