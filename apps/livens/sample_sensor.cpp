// SPDX-License-Identifier: BSD-3-Clause
// livens sample --sensor: what a sensor reads at any instant.
#include <cmath>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "exact.h"
#include "failure.h"
#include "livens/base/text.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/json.h"
#include "livens/io/shown_unit.h"
#include "sample_query.h"

namespace livens::program {

namespace {

/// The sensor's place, and where its components begin among those of all.
struct Found {
    const Sensor* sensor = nullptr;
    std::size_t first = 0;
};

Found find_sensor(const Model& model, const std::string& name)
{
    Found found;
    for (const Sensor& sensor : model.sensors()) {
        if (sensor.name == name) return found.sensor = &sensor, found;
        found.first += sensor.components.size();
    }
    throw no_such("sensor", name, model);
}

/// In the units that are wished.
std::vector<ShownUnit> units_of(const Sensor& sensor, const std::vector<std::string>& wished)
{
    std::vector<std::string> units;
    for (const SensorComponent& component : sensor.components) units.push_back(component.unit);
    as_usage([&] { check_shown_units(wished, units); });
    std::vector<ShownUnit> shown;
    for (const std::string& unit : units) shown.push_back(shown_unit(unit, wished));
    return shown;
}

std::string csv_of(const Sensor& sensor, const std::vector<ShownUnit>& units,
                   const std::vector<double>& times, const std::vector<std::vector<double>>& rows)
{
    std::string out = "t [s]";
    for (std::size_t i = 0; i < units.size(); ++i)
        out += fmt::format(",{} [{}]", sensor.components[i].name, units[i].unit);
    out += "\r\n";
    for (std::size_t i = 0; i < times.size(); ++i) {
        out += to_text(times[i]);
        for (std::size_t k = 0; k < units.size(); ++k)
            out += "," + (std::isfinite(rows[i][k]) ? to_text(units[k].factor * rows[i][k]) : "");
        out += "\r\n";
    }
    return out;
}

std::string json_of(const Sensor& sensor, const std::vector<double>& times,
                    const std::vector<std::vector<double>>& rows)
{
    JsonWriter json(2);
    json.begin_object().member("sensor", sensor.name).member("type", sensor.type);
    json.key("components").begin_array();
    for (const SensorComponent& component : sensor.components) json.value(component.name);
    json.end_array().key("units").begin_array();
    for (const SensorComponent& component : sensor.components) json.value(component.unit);
    json.end_array().key("samples").begin_array();
    for (std::size_t i = 0; i < times.size(); ++i) {
        json.begin_object().member("t", times[i]);
        json.key("values").value(std::span<const double>(rows[i])).end_object();
    }
    json.end_array().end_object();
    return json.text() + "\n";
}

std::string text_of(const Sensor& sensor, const std::vector<ShownUnit>& units, double t,
                    const std::vector<double>& row)
{
    std::string out = fmt::format("t = {} s\n", to_text(t));
    for (std::size_t i = 0; i < row.size(); ++i)
        out += fmt::format("  {:<22} {:>24}  {}\n", sensor.components[i].name,
                           to_text(units[i].factor * row[i]), units[i].unit);
    return out;
}

}   // namespace

std::string sample_sensor(const SampleArguments& arguments, const Common& common, const Run& run,
                          const Scenario& scenario, const std::vector<double>& times)
{
    const Model model = with_all_readings(scenario.model);
    const Found found = find_sensor(model, arguments.sensor);
    const SensorReadings readings(model, run.motion);
    std::vector<std::vector<double>> rows;
    for (const double t : times) {
        const std::vector<double> all =
            arguments.exact ? readings.at(exact_sample(run, scenario, t).state) : readings.at(t);
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(found.first);
        rows.emplace_back(first, first + static_cast<std::ptrdiff_t>(found.sensor->components.size()));
    }
    if (common.json) return json_of(*found.sensor, times, rows);
    const std::vector<ShownUnit> units = units_of(*found.sensor, arguments.units);
    if (arguments.csv) return csv_of(*found.sensor, units, times, rows);
    std::string text;
    for (std::size_t i = 0; i < times.size(); ++i) text += text_of(*found.sensor, units, times[i], rows[i]);
    return text;
}

}   // namespace livens::program
