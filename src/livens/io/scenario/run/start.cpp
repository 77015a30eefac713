// SPDX-License-Identifier: BSD-3-Clause
// [body.start], `coordinates` of [start], and `rate` of joints: the bodies are led there, with the joints
// that they have where they are stated, before anything else refers to them.
// The method is that of theory.md, Starting, "By coordinates".
#include <algorithm>
#include <cmath>

#include "livens/dynamics/start/start_coordinates.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/run/run.h"

namespace livens::inline io_internal {

namespace {

/// A number in the unit of the coordinate; one without a unit is.
std::optional<double> read_number(const Section& section, const std::string& path, std::string_view key,
                                  bool is_angle)
{
    const Value* v = section.find(key);
    if (v == nullptr) return {};
    if (is_angle ? v->has_other_unit : v->has_unit)
        throw InputError({"start-coordinate", path + "." + std::string(key),
                          "the coordinate is " + std::string(is_angle ? "an angle" : "a displacement"), "",
                          "", "", "give it in " + std::string(is_angle ? v->key->unit : v->key->other_unit)});
    return v->numbers.front();
}

StartCoordinate read_coordinate(const Builder& builder, const Section& section, const std::string& path)
{
    // Joint and coordinate are kept as indices: the model is copied while bodies are led.
    const JointReference of = find_coordinate(builder, section, path);
    if (of.coordinate->coordinate.kind == CoordinateKind::rotation_component)
        throw InputError({"start-coordinate", path + ".coordinate",
                          "a rotation vector is no coordinate that a joint is led along", "", "", "",
                          "turn the body itself, by 'rotation_vector' of its [[body]], or give the joint "
                          "'angles' and state these"});
    StartCoordinate wanted;
    wanted.path = path;
    wanted.joint = builder.model().find_joint(of.joint->name);
    wanted.coordinate = static_cast<int>(of.coordinate - of.joint->coordinates.data());
    const bool is_angle = of.coordinate->coordinate.is_angle();
    wanted.value = read_number(section, path, "value", is_angle);
    wanted.rate = read_number(section, path, "rate", is_angle);
    if (!wanted.value && !wanted.rate)
        throw InputError({"start-coordinate", path, "neither 'value' nor 'rate' is given", "", "", "",
                          "give one of them, or both"});
    return wanted;
}

/// What [start] wants, place by place; false after an error.
bool read_wanted(Builder& builder, std::vector<StartCoordinate>& wanted)
{
    const int before = builder.findings().n_errors();
    const Section* start = only_section(builder.run(), "start");
    if (start == nullptr) return true;
    int n = 0;
    for (const Section& section : start->sections("coordinates")) {
        const std::string path = "start.coordinates[" + std::to_string(n++) + "]";
        builder.remember(path, section);
        if (section.is_valid())
            builder.guard(path, [&] { wanted.push_back(read_coordinate(builder, section, path)); });
    }
    return builder.findings().n_errors() == before;
}

/// Bodies where [body.start] has them. Of `wanted` goes what tells turns alone.
void restate_bodies(Builder& builder, const State& state, std::vector<StartCoordinate>& wanted)
{
    // Joints keep their frames, which refer to the bodies as stated; the bodies move.
    builder.model() = restated(builder.model(), state, wanted);
    std::erase_if(wanted, [&](const StartCoordinate& one) {
        const Joint& joint = builder.model().joints()[static_cast<std::size_t>(one.joint)];
        const double now = joint.coordinates[static_cast<std::size_t>(one.coordinate)].at_stated;
        // Where the joint stands there already, the value has told its turns, and nothing is left to lead to.
        return !one.rate && std::abs(*one.value - now) <= same_angle;
    });
}

}   // namespace

namespace {

/// A section of a body that gives its angular velocity.
bool turns(const Section& body)
{
    return body.has("angular_velocity") || body.has("angular_velocity_body") || body.has("director_rates");
}

}   // namespace

/// `rate` is a key of joints that have one coordinate alone, number 0.
StatedStart stated_start(Builder& builder)
{
    StatedStart stated{{}, builder.model().start()};
    for (const Section& joint : builder.top().sections("joint")) {
        if (joint.find("rate") == nullptr) continue;
        const std::string name = joint.has("name") ? joint.text("name") : default_name(joint);
        stated.rates.push_back(
            {builder.model().find_joint(name), 0, {}, joint.number("rate"), "joint[" + name + "].rate"});
    }
    for (const Section& body : builder.top().sections("body")) {
        StatedVelocity said{builder.model().find_body(body.text("name")), body.has("velocity"), turns(body)};
        for (const Section& start : body.sections("start")) {
            read_pose_of(builder, body.text("name"), start, "start", stated.state);
            stated.is_other = true;
            said.of_place |= start.has("velocity");
            said.of_turn |= turns(start);
        }
        if (said.of_place || said.of_turn) stated.velocities.push_back(said);
    }
    return stated;
}

bool states_velocity(const Builder& builder)
{
    const auto moves = [](const Section& section) {
        return section.has("velocity") || section.has("rate") || turns(section);
    };
    const Section& top = builder.top();
    const Section* start = only_section(builder.run(), "start");
    return std::ranges::any_of(top.sections("joint"), moves) ||
           std::ranges::any_of(top.sections("body"),
                               [&](const Section& body) {
                                   return moves(body) || std::ranges::any_of(body.sections("start"), moves);
                               }) ||
           (start != nullptr && std::ranges::any_of(start->sections("coordinates"), moves));
}

/// First to where [body.start] has the bodies, then from there along the joints.
void move_bodies(Builder& builder, const StatedStart& stated)
{
    if (builder.findings().n_errors() > 0) return;
    std::vector<StartCoordinate> wanted = stated.rates;
    if (!read_wanted(builder, wanted)) return;
    if (stated.is_other) restate_bodies(builder, stated.state, wanted);
    if (wanted.empty()) return;
    const Section* start = only_section(builder.run(), "start");
    const Section* time = only_section(builder.run(), "time");
    const bool projects = start != nullptr && start->text("initial") == "project";
    builder.guard("start", [&] {
        MovedStart moved =
            move_start(builder.model(), wanted, projects ? StartPolicy::project : StartPolicy::check,
                       time == nullptr ? 0 : time->number("start"), stated.velocities);
        builder.model() = std::move(moved.model);
        for (const std::string& change : moved.changed)
            builder.findings().warning(start == nullptr ? SourceLocation{} : start->place(), "start-changed",
                                       change, {"", "leave these velocities out, or give ones that fit"});
    });
}

}   // namespace livens::inline io_internal
