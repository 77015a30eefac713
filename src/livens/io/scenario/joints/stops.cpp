// SPDX-License-Identifier: BSD-3-Clause
// [[stop]], and `limits` of a joint: those of its coordinate, or of the distance of two points, that let
// nothing beyond them.
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

StopLaw law_of(const Section& section)
{
    return {0, true, section.number("restitution"), section.text("impact") == "together"};
}

/// Those that are numbers.
template <class Add>
void add_each(const Limits& limits, StopLaw law, const Add& add)
{
    for (const bool is_lowest : {true, false}) {
        law.limit = is_lowest ? limits.low : limits.high;
        law.is_lowest = is_lowest;
        if (std::isfinite(law.limit)) add(law);
    }
}

/// Of a [[stop]], which has one limit or two.
std::string name_of_side(const std::string& name, const Limits& limits, const StopLaw& law)
{
    const bool has_two = std::isfinite(limits.low) && std::isfinite(limits.high);
    return has_two ? name + (law.is_lowest ? ".low" : ".high") : name;
}

void add_one(Builder& builder, const std::string& name, const JointReference& of, const StopLaw& law,
             const std::string& path)
{
    const Joint joint = *of.joint;   // a copy, as joints are added
    const NamedCoordinate coordinate = *of.coordinate;
    // A closed stop is the row of a drive that stands still, and has no other angles than that.
    if (coordinate.coordinate.is_angle())
        check_driven_angle({&joint, &coordinate},
                           {[&](Instant) {
                                return TimeValue{law.limit, 0, 0};
                            },
                            {}},
                           {0, 0}, path);
    const std::vector<Matrix34> X = builder.start_configurations();
    add_coordinate_stop(builder.model(), name, joint, coordinate, law, Configurations(X));
}

/// The coordinate of a joint that has let go is none that anything limits.
void refuse_released(const Joint& joint, const std::string& name, const std::string& path)
{
    if (!joint.is_ended_by_event && std::isinf(joint.until)) return;
    throw InputError(
        {"stop-released", path + ".joint",
         "joint '" + joint.name + "' is released, but its stop '" + name + "' would continue to act", "", "",
         "a stop has no end",
         "leave out 'until' of the joint, or limit the distance of two points with 'between'"});
}

void add_of_joint(Builder& builder, const Section& section, const std::string& name, const std::string& path)
{
    refuse_released(*find_coordinate(builder, section, path).joint, name, path);
    check_units(section, find_coordinate(builder, section, path).coordinate->coordinate.is_angle(), path);
    const Limits limits = read_stop_limits(section, path);
    // The coordinate is looked up for each: references end where a joint is added.
    add_each(limits, law_of(section), [&](const StopLaw& law) {
        add_one(builder, name_of_side(name, limits, law), find_coordinate(builder, section, path), law, path);
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
    add_each(limits, law_of(section), [&](const StopLaw& law) {
        add_distance_stop(builder.model(), name_of_side(name, limits, law), a, b, law, Configurations(X));
    });
}

void remember_stop(Builder& builder, const std::string& name, const Section& section)
{
    builder.remember("joint[" + name + "]", section);
    builder.remember("event[" + name + "]", section);
    builder.remember("event[" + name + " opens]", section);
}

/// What a joint, or its table for one coordinate of two, states of a coordinate.
struct LimitedCoordinate {
    const Section* keys;
    std::string name;         ///< of its stops, but for .low and .high
    std::string_view which;   ///< empty: the joint has but one
};

std::vector<LimitedCoordinate> limited_coordinates(const Section& joint)
{
    if (joint.kind() == any_kind || !joint.is_valid()) return {};
    const std::string name = joint.has("name") ? joint.text("name") : default_name(joint);
    if (joint.takes("limits")) return {{&joint, name, ""}};
    std::vector<LimitedCoordinate> all;
    for (const std::string_view which : {"angle", "displacement", "angle_1", "angle_2", "angle_3"})
        for (const Section& table : joint.sections(which))
            all.push_back({&table, name + " " + std::string(which), which});
    return all;
}

void add_limits(Builder& builder, const LimitedCoordinate& of, int joint, const std::string& path)
{
    const Section& keys = *of.keys;
    const Value& both = *keys.find("limits");
    const Limits limits{both.numbers[0], both.numbers[1]};
    if (!(limits.low < limits.high))
        throw InputError({"joint-limits", path + ".limits",
                          "the limits of '" + of.name + "' are not in order",
                          to_text(limits.low) + ", " + to_text(limits.high), "the lower one first", "", ""});
    const auto coordinate_of = [&](const Joint& one) {
        return of.which.empty() ? &one.coordinates.front() : find_coordinate(one, of.which);
    };
    add_each(limits, {0, true, keys.number("limit_restitution"), false}, [&](const StopLaw& law) {
        const Joint& one = builder.model().joints()[static_cast<std::size_t>(joint)];
        if (coordinate_of(one) == nullptr) return;   // it is told with its loads
        add_one(builder, of.name + (law.is_lowest ? ".low" : ".high"), {&one, coordinate_of(one)}, law, path);
    });
}

void read_limits_of_joints(Builder& builder, std::unordered_set<std::string>& taken)
{
    for (const Section& joint : builder.top().sections("joint"))
        for (const LimitedCoordinate& one : limited_coordinates(joint)) {
            if (!are_rigid_limits(*one.keys)) continue;
            const std::string name = joint.has("name") ? joint.text("name") : default_name(joint);
            const int index = builder.model().find_joint(name);
            if (index < 0) continue;   // told already
            for (const char* side : {".low", ".high"}) {
                remember_stop(builder, one.name + side, *one.keys);
                claim_name(joint, "joint, drive or stop", one.name + side, taken,
                           {"limits of a joint are stops of these names", "give the other one another name"});
            }
            const std::string path = "joint[" + one.name + "]";
            builder.remember(path, *one.keys);
            builder.guard(path, [&] { add_limits(builder, one, index, path); });
        }
}

}   // namespace

/// What `limit_law` says. Without it numbers that springs alone have make them springs.
bool are_rigid_limits(const Section& keys)
{
    if (!keys.takes("limits") || !keys.has("limits")) return false;
    if (keys.has("limit_law")) return keys.text("limit_law") == "rigid";
    return !keys.has("limit_stiffness") && !keys.has("limit_damping");
}

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
    read_limits_of_joints(builder, taken);
    for (const Section& section : builder.top().sections("stop")) {
        const std::string name = section.text("name"), path = "stop[" + name + "]";
        builder.remember(path, section);
        // How many limits there are is not known yet, and thus not which of these names the model will have.
        for (const char* part : {"", ".low", ".high"}) remember_stop(builder, name + part, section);
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
