// SPDX-License-Identifier: BSD-3-Clause
// livens check: everything that can be said about a scenario without solving it.
#include <algorithm>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/dynamics/start/start_coordinates.h"
#include "livens/io/known_state.h"
#include "memory.h"

namespace livens::program {

namespace {

/// Without what stands for controllers.
std::size_t n_bodies(const Model& model)
{
    return static_cast<std::size_t>(std::ranges::count(model.bodies(), false, &Body::holds_states));
}
std::size_t n_loads(const Model& model)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(model.loads(), [](const Load& load) { return load.type != controller_type; }));
}

std::string json_of(const Scenario& scenario, const Model& model, const ConsistentStart& assembly,
                    const std::vector<Diagnostic>& warnings)
{
    JsonWriter json(2);
    json.begin_object();
    json.member("valid", true).member("title", scenario.title);
    json.member("bodies", n_bodies(scenario.model)).member("joints", scenario.model.joints().size());
    json.member("loads", n_loads(scenario.model)).member("rows", scenario.model.n_rows());
    json.member("degrees_of_freedom", assembly.degrees_of_freedom);
    json.member("start", start_of(scenario.time)).member("end", end_of(scenario.time));
    if (const auto* mesh = std::get_if<TimeMesh>(&scenario.time))
        json.member("elements", mesh->n_elements());
    else
        json.member("accuracy", std::get<Span>(scenario.time).accuracy);
    json.member("output_times", scenario.output.size());
    json.member("memory_bytes", static_cast<long long>(memory_needed(scenario).most()));
    json.key("options").raw(scenario.resolved.empty() ? "null" : scenario.resolved);
    json.key("redundant_rows").begin_array();
    for (const int r : assembly.redundant) {
        const Joint& joint = model.joints()[model.row_joint(r)];
        json.value(joint.name + ": " + model.row(r).label);
    }
    json.end_array();
    json.key("notes").begin_array();
    for (const std::string& note : assembly.notes) json.value(note);
    json.end_array();
    json.key("warnings");
    write_diagnostics(json, warnings);
    json.key("errors").begin_array().end_array();
    json.end_object();
    return json.text() + "\n";
}

/// How time is divided, for people.
std::string division_of(const Scenario& scenario)
{
    const std::string times = fmt::format("{} output times", scenario.output.size());
    if (const auto* mesh = std::get_if<TimeMesh>(&scenario.time))
        return fmt::format("in {} elements, {}", mesh->n_elements(), times);
    return fmt::format("to an accuracy of {:.6g}, {}", std::get<Span>(scenario.time).accuracy,
                       scenario.output.empty() ? "output at element ends" : times);
}

constexpr int most_bodies_told = 300;   // beyond, finding what is independent takes seconds

/// Which coordinates tell the configuration, for people who want to state or drive some.
std::string coordinates_of(const Model& model, const ConsistentStart& assembly)
{
    if (assembly.degrees_of_freedom == 0 || model.n_bodies() > most_bodies_told) return {};
    const IndependentCoordinates found = independent_coordinates(model, assembly.start);
    if (found.names.empty()) return {};
    const std::size_t told = std::min<std::size_t>(found.names.size(), 12);
    std::string text = "  independent coordinates: ";
    for (std::size_t i = 0; i < told; ++i) text += (i == 0 ? "" : ", ") + plain(found.names[i]);
    if (told < found.names.size()) text += fmt::format(" and {} more", found.names.size() - told);
    if (found.left_free > 0) text += fmt::format("; {} more degrees of freedom", found.left_free);
    return text + "\n";
}

std::string place_in_words(const Vector3& x)
{
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0] + 0.0, x[1] + 0.0, x[2] + 0.0);
}

/// What a spring or actuator pulls with; empty: no such load.
std::string force_of(const Load& load, const State& start)
{
    if (load.readings.empty()) return {};
    const LoadReading& reading = load.readings[0];
    if (reading.name != "force" && reading.name != "effort") return {};
    const LoadArguments arguments = load_arguments(load, {start.t, Side::right}, start.X, start.V, {});
    return fmt::format("{} {:.4g} {}", reading.name, reading.value(arguments) + 0.0, reading.unit);
}

/// The springs at the limits of a joint, which nobody may have stated.
std::string limits_of(const Load& load)
{
    const auto stiffness = std::ranges::find(load.readings, "limit_stiffness", &LoadReading::name);
    const auto damping = std::ranges::find(load.readings, "limit_damping", &LoadReading::name);
    if (stiffness == load.readings.end() || damping == load.readings.end()) return {};
    return fmt::format(", limits {:.4g} {}, damping {:.4g} {}", stiffness->value(LoadArguments()),
                       stiffness->unit, damping->value(LoadArguments()), damping->unit);
}

/// Where rods and springs end in the world, since their points are stated on the bodies; and forces, which
/// tell what was taken for the place without any.
std::string springs_of(const Model& model, const State& start)
{
    constexpr std::size_t most_told = 12;
    const auto place = [&](int body, const Vector3& p) {
        return body == world ? p : start.X[static_cast<std::size_t>(body)] * point(p);
    };
    const auto line = [&](const std::vector<int>& bodies, const std::vector<Vector3>& points) {
        const Vector3 a = place(bodies[0], points[0]), b = place(bodies[1], points[1]);
        return fmt::format("{:.4g} m, from {} to {}", norm(b - a), place_in_words(a), place_in_words(b));
    };
    const auto rope = [&](const std::vector<BodyPoint>& over) {
        return fmt::format("{:.4g} m, over {} points", rope_length(over, start.X), over.size());
    };
    std::vector<std::string> lines;
    for (const Joint& joint : model.joints())
        if (!joint.over.empty())
            lines.push_back(plain(joint.name) + ": " + rope(joint.over));
        else if (joint.type == "rod")
            lines.push_back(plain(joint.name) + ": " +
                            line({joint.first, joint.second}, {joint.point_first, joint.point_second}));
    for (const Load& load : model.loads()) {
        if (load.sets_length_scale) continue;   // between places that are told already
        const std::string force = force_of(load, start);
        if (!load.over.empty())
            lines.push_back(plain(load.name) + ": " + rope(load.over) + (force.empty() ? "" : ", ") + force);
        else if (load.points.size() == 2)
            lines.push_back(plain(load.name) + ": " + line(load.bodies, load.points) +
                            (force.empty() ? "" : ", ") + force);
        else if (!force.empty())
            lines.push_back(plain(load.name) + ": " + force + limits_of(load));
    }
    std::string text;
    for (std::size_t i = 0; i < std::min(lines.size(), most_told); ++i) text += "    " + lines[i] + "\n";
    if (lines.size() > most_told) text += fmt::format("    and {} more\n", lines.size() - most_told);
    return text.empty() ? text : "  rods, springs and actuators at the start:\n" + text;
}

}   // namespace

int check_command(const std::string& file, const Common& common)
{
    std::vector<Diagnostic> warnings;
    const Scenario scenario = load_scenario(file, common, &warnings);
    const KnownState known = known_state(scenario);   // rank and redundant rows, for people
    const Model model = as_it_starts(scenario).model;
    const ConsistentStart assembly = consistent_start(model, known.state, known.initial);
    check_memory({&scenario});
    if (common.json) {
        print(json_of(scenario, model, assembly, warnings));
        return exit_ok;
    }
    if (common.quiet) return exit_ok;
    const auto counted = [](std::size_t n, const char* one, const char* many) {
        return fmt::format("{} {}", n, n == 1 ? one : many);
    };
    std::string text =
        fmt::format("{}: no errors\n  {}, {} with {}, {}, {} of freedom\n"
                    "  {:.6g} s to {:.6g} s {}\n  at least {} of memory{}\n",
                    plain(file), counted(n_bodies(scenario.model), "body", "bodies"),
                    counted(scenario.model.joints().size(), "joint", "joints"),
                    counted(static_cast<std::size_t>(scenario.model.n_rows()), "constraint", "constraints"),
                    counted(n_loads(scenario.model), "load", "loads"),
                    counted(static_cast<std::size_t>(assembly.degrees_of_freedom), "degree", "degrees"),
                    start_of(scenario.time), end_of(scenario.time), division_of(scenario),
                    bytes_in_words(memory_needed(scenario).most()),
                    std::holds_alternative<Span>(scenario.time) ? ", plus that of the elements" : "");
    text += coordinates_of(model, assembly);
    text += springs_of(model, assembly.start);
    for (const std::string& note : assembly.notes) text += "  note: " + plain(note) + "\n";
    print(text);
    return exit_ok;
}

}   // namespace livens::program
