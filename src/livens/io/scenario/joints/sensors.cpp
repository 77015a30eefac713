// SPDX-License-Identifier: BSD-3-Clause
// [[sensor]]: one table of kinds.
// Sensors of points, joints and energies come before loads, whose expressions may read some of them; sensors
// of loads come after.
#include <algorithm>

#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

namespace {

/// All that a sensor can be made of.
struct SensorSources {
    const Section& section;
    std::string name;
    int first, second;
    const Builder& builder;
    const Configurations& X;
};

struct SensorKind : Kind {
    Sensor (*make)(const SensorSources&);
};

Sensor make_point(const SensorSources& s)
{
    return point_sensor(s.name, s.first, s.builder.in_axes(s.first, s.section.vector("point")), s.X);
}

Sensor make_relative(const SensorSources& s)
{
    return relative_sensor(s.name, s.first, s.builder.in_axes(s.first, s.section.row("points", 0)), s.second,
                           s.builder.in_axes(s.second, s.section.row("points", 1)), s.X);
}

/// An item of a list by the name that a key says. Throws InputError.
template <class Item>
std::size_t find_named(const std::vector<Item>& items, const SensorSources& s, const char* key)
{
    const std::string wanted = s.section.text(key);
    std::vector<std::string_view> known;
    for (const Item& item : items) known.push_back(item.name);
    const auto found = std::ranges::find(known, wanted);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    throw s.builder.unknown_name(key, wanted, "sensor[" + s.name + "]", known);
}

Sensor make_joint_sensor(const SensorSources& s)
{
    const std::vector<Joint>& joints = s.builder.model().joints();
    return joint_sensor(s.name, joints[find_named(joints, s, "joint")]);
}

Sensor make_load_sensor(const SensorSources& s)
{
    const std::vector<Load>& loads = s.builder.model().loads();
    const std::size_t load = find_named(loads, s, "load");
    return load_sensor(s.name, static_cast<int>(load), loads[load]);
}

Sensor make_energy(const SensorSources& s) { return energy_sensor(s.name, s.first); }

const std::vector<SensorKind>& sensor_kinds()
{
    const Key body = Key{"body", types::text, "Name of the body."}.needed();
    static const std::vector<SensorKind> all{
        {{"point",
          "position, velocity and acceleration of a point of a body, world axes: x, y, z in m, vx, vy, vz in "
          "m/s, ax, ay, az in m/s^2",
          {Key{"body", types::text, body_or_point}.needed_without("point"),
           Key{"point", types::point, "Position of the point in body coordinates.", "m", "[0, 0, 0]"}}},
         make_point},
        {{"joint",
          "coordinates of a joint with rates and accelerations: angle, angle_rate, angle_acceleration, "
          "displacement, displacement_rate, displacement_acceleration",
          {Key{"joint", types::text, "Name of the joint."}.needed()}},
         make_joint_sensor},
        {{"relative",
          "position of a point of the second body relative to a point of the first, in axes of the first: x, "
          "y, z, their rates vx, vy, vz and second derivatives ax, ay, az",
          {Key{"between", types::names, two_bodies_or_points}.needed_without("points"),
           Key{"points", types::two_points,
               "One point per body, in that body's coordinates. Default: the reference points (for the "
               "world: its origin).",
               "m"}}},
         make_relative},
        {{"load",
          "forces and power of a load: for a spring between points its `force` (positive in tension) and "
          "`length`; for springs and actuators on joints their `effort` along the coordinate (N, N m); for a "
          "bushing "
          "`force_x` .. `torque_z`, and u as `displacement_x` .. `rotation_z`; for other loads `x`, `y`, "
          "`z`; for all the `power` supplied to the bodies, W",
          {Key{"load", types::text, "Name of the load."}.needed()}},
         make_load_sensor},
        {{"energy", "kinetic energy of a body and potential energy of its weight, in J", {body}},
         make_energy}};
    return all;
}

bool reads_load(const Section& sensor) { return sensor.takes("load"); }

void read_sensor(Builder& builder, const Section& section, std::unordered_set<std::string>& taken)
{
    Findings& findings = builder.findings();
    const int before = findings.n_errors();
    const std::string name = section.text("name"), path = "sensor[" + name + "]";
    check_name(section);
    if (!name.empty())
        claim_name(section, "sensor or joint", name, taken,
                   {"expressions refer to sensors as to joints", "give it another 'name'"});
    builder.remember(path, section);
    // An unknown type has been told of, and its keys cannot be judged.
    if (section.kind() == any_kind) return;
    BodyReference first, second;
    if (section.takes("between")) {
        if (!builder.find_pair(section, "sensor-self", first, second)) return;
    } else if (const Value* named = section.find("body")) {
        first = builder.find_body(named->text, named->node->place, section);
        if (named->text == "world")
            section.error("body", "sensor-self", section.label() + " reads the world, which does not move");
        if (!first.is_usable) return;
    }
    if (findings.n_errors() > before || !section.is_valid()) return;
    const std::vector<Matrix34> X = builder.start_configurations();
    const auto make = sensor_kinds()[static_cast<std::size_t>(section.kind())].make;
    builder.guard(path, [&] {
        builder.model().add_sensor(make({section, name, first.index, second.index, builder, X}));
    });
}

}   // namespace

Table sensor_table()
{
    return Table{
        "[[sensor]]",
        "A quantity to record. Readings are stored in the result file as `sensor_value` and printed by "
        "`livens sample --sensor`. Expressions can use them, as in `\"tip.x\"`, except readings of loads and "
        "energies.",
        {Key{"name", types::text, "Name by which results and expressions refer to the sensor."}.needed(),
         Key{"type", types::choice, ""}.needed()}}
        .with_kinds("type", {sensor_kinds().begin(), sensor_kinds().end()});
}

void read_sensors(Builder& builder, bool of_loads)
{
    std::unordered_set<std::string> taken;
    // Expressions write `name.quantity` for joints and sensors alike, so the names are one set.
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    for (const Sensor& sensor : builder.model().sensors()) taken.insert(sensor.name);
    for (const ReadController& one : builder.controllers()) taken.insert(one.name);
    for (const Section& section : builder.top().sections("sensor"))
        if (reads_load(section) == of_loads) read_sensor(builder, section, taken);
}

}   // namespace livens::inline io_internal
