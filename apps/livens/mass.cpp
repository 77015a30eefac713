// SPDX-License-Identifier: BSD-3-Clause
// livens mass: what bodies weigh and how they resist turning, of a mesh or of a scenario.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"
#include "console.h"
#include "failure.h"
#include "finite_number.h"
#include "livens/base/text.h"
#include "livens/geometry/soundness.h"
#include "livens/multibody/solid.h"
#include "rest.h"
#include "summary.h"

namespace livens::program {

namespace {

/// One body, or the solid of a mesh.
struct Weighed {
    std::string name;
    MassProperties properties;
    Matrix4 mass_matrix;   ///< about the reference point
    bool is_point = false;
    bool is_skew = false;                ///< stated along other directors than all here is
    std::vector<ShapePart> parts = {};   ///< of a union
};

/// Largest principal moment over the sum of the others: at most 1 for any distribution of mass.
double triangle_ratio(const Vector3& moments)
{
    const double others = moments[0] + moments[1];
    return others > 0 ? moments[2] / others : 1;
}

/// Whether all figures are numbers: none overflows, and there is a mass to divide by.
bool is_told(const Weighed& w)
{
    const MassProperties& p = w.properties;
    const auto is_finite = [](double x) { return std::isfinite(x); };
    return p.mass > 0 && std::ranges::all_of(p.inertia.a, is_finite) &&
           std::ranges::all_of(w.mass_matrix.a, is_finite) &&
           std::ranges::all_of(p.center_of_mass.a, is_finite) && std::isfinite(trace(p.inertia) / p.mass) &&
           std::isfinite(triangle_ratio(principal_axes(p.inertia).moments));
}

void add_rows(JsonWriter& json, const char* key, const Matrix3& m)
{
    json.key(key).begin_array();
    for (int i = 0; i < 3; ++i) {
        const double row[] = {m(i, 0), m(i, 1), m(i, 2)};
        json.value(std::span<const double>(row));
    }
    json.end_array();
}

Matrix3 second_moment(const Weighed& w)
{
    Matrix3 E;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) E(i, j) = w.mass_matrix(i + 1, j + 1);
    return E;
}

Vector3 first_moment(const Weighed& w)
{
    return {w.mass_matrix(1, 0), w.mass_matrix(2, 0), w.mass_matrix(3, 0)};
}

void add_members(JsonWriter& json, const Weighed& w)
{
    const MassProperties& p = w.properties;
    const PrincipalAxes principal = principal_axes(p.inertia);
    json.member("mass", p.mass);
    json.key("center_of_mass").value(numbers(p.center_of_mass));
    if (w.is_point) return;
    add_rows(json, "inertia", p.inertia);
    const Vector3 S = first_moment(w);
    json.key("first_moment").value(numbers(S));
    add_rows(json, "second_moment", second_moment(w));
    json.key("principal_moments").value(numbers(principal.moments));
    add_rows(json, "principal_axes", transpose(principal.axes));   // one axis a row
    json.member("triangle_ratio", triangle_ratio(principal.moments));
}

/// For people: products that are rounding of the whole are 0.
std::string rows(const Matrix3& m)
{
    const double size = norm(m);
    std::string text;
    for (int i = 0; i < 3; ++i) text += (i > 0 ? ", " : "") + shown({m(i, 0), m(i, 1), m(i, 2)}, size);
    return text;
}

void add_figures(Summary& summary, const Weighed& w)
{
    const MassProperties& p = w.properties;
    const PrincipalAxes principal = principal_axes(p.inertia);
    const double length = std::sqrt(trace(p.inertia) / p.mass) + norm(p.center_of_mass);
    summary.figure("mass", fmt::format("{:.6g} kg", p.mass));
    summary.figure("centre of mass", shown(p.center_of_mass, length) + " m");
    if (w.is_point) return;
    summary.figure("inertia", rows(p.inertia) + " kg m^2, about the centre of mass");
    summary.figure("first moment S", shown(first_moment(w), p.mass * length) + " kg m, about the origin");
    summary.figure("second moment E", rows(second_moment(w)) + " kg m^2, about the origin");
    summary.figure("principal moments", shown(principal.moments, principal.moments[2]) + " kg m^2");
    summary.figure("principal axes", rows(transpose(principal.axes)));
    summary.figure("largest moment",
                   fmt::format("{:.6g} of the sum of the others", triangle_ratio(principal.moments)));
}

// Meshes.

struct MeshReport {
    Mesh mesh;
    Moments moments;                                       ///< m
    std::vector<std::pair<std::string, double>> regions;   ///< of volume: name, m^3
    int n_pieces = 0;
};

Diagnostic diagnostic_of(const Complaint& c)
{
    Diagnostic d;
    d.code = c.code;
    d.message = c.message;
    d.note = c.note;
    d.help = c.help;
    return d;
}

/// What cannot be read is no fault of a mesh.
Mesh read(const std::string& file)
{
    try {
        return read_mesh_file(file);
    } catch (const InputError& error) {
        if (error.complaint().code != "mesh-file") throw;
        throw Failure{exit_input_output, "input or output failed", {diagnostic_of(error.complaint())}};
    }
}

void require_none(const std::vector<Complaint>& faults)
{
    if (faults.empty()) return;
    Failure f{exit_scenario, "mesh refused", {}};
    for (const Complaint& c : faults) f.diagnostics.push_back(diagnostic_of(c));
    throw f;
}

MeshReport report_on(const MassArguments& arguments, double unit)
{
    MeshReport r;
    r.mesh = read(arguments.file);
    if (arguments.turn) turn_outwards(r.mesh);
    require_none(faults_of(r.mesh));
    r.moments = scaled(moments(r.mesh), unit);
    r.n_pieces = n_pieces(r.mesh);
    if (!r.mesh.is_volume()) return r;
    const std::vector<Moments> of = region_moments(r.mesh);
    for (std::size_t k = 0; k < of.size(); ++k)
        if (of[k].volume > 0)
            r.regions.emplace_back(r.mesh.regions[k].names.empty() ? "" : r.mesh.regions[k].names.front(),
                                   scaled(of[k], unit).volume);
    return r;
}

std::string json_of(const MassArguments& a, const MeshReport& r, const Weighed& w, double density)
{
    JsonWriter json(2);
    json.begin_object().member("file", a.file).member("exit_code", static_cast<int>(exit_ok));
    json.member("format", r.mesh.format).member("unit", a.unit).member("density", density);
    json.member("points", r.mesh.points.size()).member("faces", r.mesh.n_elements(2));
    json.member("elements", r.mesh.n_elements(3)).member("pieces", r.n_pieces);
    json.member("volume", r.moments.volume);
    add_members(json, w);
    json.key("regions").begin_array();
    for (const auto& [name, volume] : r.regions)
        json.begin_object().member("name", name).member("volume", volume).end_object();
    json.end_array().key("warnings").begin_array().end_array();
    json.key("errors").begin_array().end_array().end_object();
    return json.text() + "\n";
}

std::string text_of(const MassArguments& a, const MeshReport& r, const Weighed& w, double density)
{
    Summary summary(terminal_of(STDOUT_FILENO));
    summary.headline(Ink::good, "Sound",
                     r.mesh.is_volume() ? "elements that fill a solid" : "a closed surface");
    summary.figure("mesh", fmt::format("{}, {}: {} points, {} faces, {} elements, {} piece{}", plain(a.file),
                                       r.mesh.format, r.mesh.points.size(), r.mesh.n_elements(2),
                                       r.mesh.n_elements(3), r.n_pieces, r.n_pieces == 1 ? "" : "s"));
    summary.figure("volume",
                   fmt::format("{:.6g} m^3, numbers of the file in {}", r.moments.volume, plain(a.unit)));
    for (const auto& [name, volume] : r.regions)
        summary.figure("region",
                       (name.empty() ? "without a name" : plain(name)) + fmt::format(": {:.6g} m^3", volume));
    summary.figure("density", fmt::format("{:.6g} kg/m^3", density));
    add_figures(summary, w);
    return summary.text();
}

int mass_of_mesh(const MassArguments& arguments, const Common& common)
{
    const double density = finite_number(arguments.density, "--density", "a number"),
                 unit = unit_of_length(arguments.unit);
    if (!(density > 0)) throw failure(exit_usage, "--density must be > 0");
    if (!(unit > 0)) throw failure(exit_usage, "--unit must be a unit of length, such as mm");
    const MeshReport r = report_on(arguments, unit);
    const MassProperties p = solid(density, r.moments);
    const Weighed w{arguments.file, p, mass_matrix(p)};
    if (!is_told(w) || !std::isfinite(r.moments.volume))
        throw failure(exit_usage, "with this --density and --unit the mass of the mesh or its moments "
                                  "overflow; are lengths in m and densities in kg/m^3?");
    if (common.json)
        print(json_of(arguments, r, w, density));
    else if (!common.quiet)
        print(text_of(arguments, r, w, density));
    return exit_ok;
}

// Scenarios.

void add_parts(JsonWriter& json, const std::vector<ShapePart>& parts)
{
    json.key("parts").begin_array();
    for (const ShapePart& part : parts) {
        json.begin_object().member("name", part.name).member("mass", part.mass);
        json.key("center_of_mass").value(numbers(part.center)).end_object();
    }
    json.end_array();
}

void add_parts(Summary& summary, const Weighed& w)
{
    const double length =
        std::sqrt(trace(w.properties.inertia) / w.properties.mass) + norm(w.properties.center_of_mass);
    for (std::size_t k = 0; k < w.parts.size(); ++k) {
        const ShapePart& part = w.parts[k];
        summary.figure(
            "part", (part.name.empty() ? fmt::format("{} of {}", k + 1, w.parts.size()) : plain(part.name)) +
                        fmt::format(": {:.6g} kg, its centre of mass at {} m", part.mass,
                                    shown(part.center, length)));
    }
}

int mass_of_scenario(const MassArguments& arguments, const Common& common)
{
    std::vector<Diagnostic> warnings;
    const Scenario scenario = load_scenario(arguments.file, common, &warnings);
    std::vector<Weighed> all;
    double total = 0;
    for (const Body& body : scenario.model.bodies()) {
        Weighed w{body.name, mass_properties(body.mass), body.mass, body.is_point, is_skew(body)};
        if (body.is_point) w.properties = {body.mass(0, 0), {}, {}};
        w.parts = scenario.parts[all.size()];
        total += w.properties.mass;
        all.push_back(w);
    }
    if (common.json) {
        JsonWriter json(2);
        json.begin_object().member("file", arguments.file).member("exit_code", static_cast<int>(exit_ok));
        json.member("title", scenario.title).member("mass", total).key("bodies").begin_array();
        for (const Weighed& w : all) {
            json.begin_object().member("name", w.name).member("point", w.is_point);
            if (w.is_skew) json.member("axes", "perpendicular unit vectors nearest to the directors");
            add_members(json, w);
            if (!w.parts.empty()) add_parts(json, w.parts);
            json.end_object();
        }
        json.end_array().key("warnings");
        write_diagnostics(json, warnings);
        json.key("errors").begin_array().end_array().end_object();
        print(json.text() + "\n");
        return exit_ok;
    }
    if (common.quiet) return exit_ok;
    Summary summary(terminal_of(STDOUT_FILENO));
    summary.headline(Ink::good, "Mass",
                     fmt::format("{:.6g} kg in {} bod{}", total, all.size(), all.size() == 1 ? "y" : "ies"));
    for (const Weighed& w : all) {
        summary.figure("body",
                       plain(w.name) +
                           (w.is_point  ? ", a point mass"
                            : w.is_skew ? ", along the perpendicular unit vectors nearest to its directors"
                                        : ", in its own coordinates"));
        add_figures(summary, w);
        add_parts(summary, w);
    }
    print(summary.text());
    return exit_ok;
}

}   // namespace

int mass_command(const MassArguments& arguments, const Common& common)
{
    const bool is_scenario = arguments.file.ends_with(".toml");
    if (!is_scenario && !common.parameters.empty())
        throw failure(exit_usage, "--set is for parameters of scenarios, and a mesh has none");
    return is_scenario ? mass_of_scenario(arguments, common) : mass_of_mesh(arguments, common);
}

}   // namespace livens::program
