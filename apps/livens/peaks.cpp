// SPDX-License-Identifier: BSD-3-Clause
// livens peaks: least and largest values of a run, and when.
#include "livens/io/peaks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/io/json.h"
#include "livens/io/shown_unit.h"
#include "simd.h"

namespace livens::program {

namespace {

std::string json_of(const std::vector<Extremes>& all, const Run& run)
{
    JsonWriter json(2);
    json.begin_object().member("converged", run.report.reached_end()).key("peaks").begin_array();
    const auto extreme = [&](const char* key, const Extreme& e) {
        json.key(key).begin_object().member("value", e.value).member("t", e.t).end_object();
    };
    for (const Extremes& one : all) {
        json.begin_object().member("name", one.name).member("unit", one.unit);
        extreme("peak", one.peak());
        extreme("min", one.least);
        extreme("max", one.largest);
        json.member("lost_at", one.lost_at).end_object();
    }
    json.end_array().end_object();
    return json.text() + "\n";
}

std::string cell(double x) { return std::isfinite(x) ? to_text(x) : ""; }

std::string csv_of(const std::vector<Extremes>& all)
{
    std::string out = "name,unit,peak,t [s],min,t of min [s],max,t of max [s]\r\n";
    for (const Extremes& one : all) {
        std::string name = one.name;
        if (name.find_first_of(",\";\n\r") != std::string::npos) {
            for (std::size_t i = 0; (i = name.find('"', i)) != std::string::npos; i += 2)
                name.insert(i, "\"");
            name = '"' + name + '"';
        }
        out += name + "," + one.unit;
        for (const Extreme& e : {one.peak(), one.least, one.largest})
            out += "," + cell(e.value) + "," + cell(e.t);
        out += "\r\n";
    }
    return out;
}

std::string text_of(const std::vector<Extremes>& all)
{
    std::size_t width = 4;
    for (const Extremes& one : all) width = std::max(width, one.name.size());
    std::string out = fmt::format("  {:<{}} {:>13} {:<8} {:>12}   {:>13} {:>13}\n", "", width, "peak", "",
                                  "at", "min", "max");
    for (const Extremes& one : all) {
        if (std::isnan(one.peak().value)) {
            out += fmt::format("  {:<{}} no number at t = {} s\n", one.name, width, to_text(one.lost_at, 6));
            continue;
        }
        out += fmt::format("  {:<{}} {:>13} {:<8} {:>10} s   {:>13} {:>13}\n", one.name, width,
                           to_text(one.peak().value, 7), one.unit, to_text(one.peak().t, 6),
                           to_text(one.least.value, 7), to_text(one.largest.value, 7));
    }
    return out;
}

/// In the units that are wished.
void show_in(std::vector<Extremes>& all, const std::vector<std::string>& wished)
{
    std::vector<std::string> units;
    for (const Extremes& one : all) units.push_back(one.unit);
    check_shown_units(wished, units);
    for (Extremes& one : all) {
        const ShownUnit shown = shown_unit(one.unit, wished);
        one.unit = shown.unit;
        one.least.value *= shown.factor;
        one.largest.value *= shown.factor;
    }
}

}   // namespace

int peaks_command(const PeaksArguments& arguments, const Common& common)
{
    pin_instructions("");
    const Run run = read_run(arguments.run);
    const Scenario scenario = scenario_of_run(run, arguments.run);
    if (!run.report.converged())
        say_warning(std::string("the run is not converged: ") + to_string(run.report.status));
    std::vector<Extremes> all;
    as_usage([&] {
        all = find_peaks(run, scenario, scenario.method, arguments.names);
        show_in(all, arguments.units);
    });
    print(common.json ? json_of(all, run) : arguments.csv ? csv_of(all) : text_of(all));
    return exit_ok;
}

}   // namespace livens::program
