// SPDX-License-Identifier: BSD-3-Clause
// Sensors: named numbers of a motion made of forms of X, of coordinates of joints, or of what loads report.
// They are read when results are written and enter no equation (docs/scenario.md).
#include "livens/multibody/sensors.h"

#include <array>

#include "livens/base/error.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

constexpr std::array<const char*, 9> of_point{"x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"};
constexpr std::array<const char*, 3> per_second{"", " s-1", " s-2"};
constexpr std::array<const char*, 3> of_rates{"", "_rate", "_acceleration"};

/// Three forms, their rates and accelerations.
std::vector<SensorComponent> components_of(const std::vector<ConstraintRow>& rows, const Configurations& X)
{
    std::vector<SensorComponent> all;
    for (std::size_t i = 0; i < of_point.size(); ++i) {
        const PairForm& form = rows[i % 3];
        const NamedCoordinate q{of_point[i % 3], {{form}}, form_value(form, form.body_i, form.body_j, X)};
        all.push_back({of_point[i], std::string("m") + per_second[i / 3], q, static_cast<int>(i / 3)});
    }
    return all;
}

}   // namespace

Sensor point_sensor(const std::string& name, int body, const Vector3& point, const Configurations& X)
{
    return {name, "point",
            components_of(coincidence_rows(world, livens::point({}), body, livens::point(point), 1), X)};
}

/// The second point in axes of the first body, which turn with it: rates are those that are seen from there.
Sensor relative_sensor(const std::string& name, int first, const Vector3& point_first, int second,
                       const Vector3& point_second, const Configurations& X)
{
    if (first == second)
        throw InputError({"sensor-self", "sensor[" + name + "]", "a relative sensor reads two bodies", "", "",
                          "", "name two different ones, or one and the world"});
    std::vector<ConstraintRow> rows;
    for (int k = 0; k < 3; ++k) {
        Vector3 axis{};
        axis[k] = 1;
        rows.push_back(
            plane_row(first, direction(axis), point(point_first), second, point(point_second), 0, 1));
    }
    return {name, "relative", components_of(rows, X)};
}

Sensor joint_sensor(const std::string& name, const Joint& joint)
{
    std::vector<NamedCoordinate> read = joint.coordinates;
    read.insert(read.end(), joint.readings.begin(), joint.readings.end());
    if (read.empty())
        throw InputError({"joint-coordinate", "sensor[" + name + "].joint",
                          "joint '" + joint.name + "' (" + joint.type + ") has no coordinate", "", "", "",
                          ""});
    Sensor sensor{name, "joint", {}};
    for (const NamedCoordinate& q : read)
        for (std::size_t k = 0; k < of_rates.size(); ++k) {
            const std::string unit = std::string(q.coordinate.is_angle() ? "rad" : "m") + per_second[k];
            sensor.components.push_back({q.name + of_rates[k], unit, q, static_cast<int>(k)});
        }
    return sensor;
}

Sensor load_sensor(const std::string& name, int index, const Load& load)
{
    Sensor sensor{name, "load", {}, index};
    for (const LoadReading& reading : load.readings)
        sensor.components.push_back({reading.name, reading.unit});
    if (load.type != controller_type || load.readings.empty()) sensor.components.push_back({"power", "W"});
    return sensor;
}

Sensor energy_sensor(const std::string& name, int body)
{
    return {name, "energy", {{"kinetic", "J"}, {"potential", "J"}}, -1, body};
}

}   // namespace livens
