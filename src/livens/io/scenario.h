// SPDX-License-Identifier: BSD-3-Clause
// Scenario files (TOML): one file describes bodies, joints, loads, time and method.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/io/diagnostic.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/options.h"
#include "livens/spacetime/problem.h"

namespace [[gnu::visibility("default")]] livens {

class JsonWriter;

/// The surface of a shape, for pictures: a profile that is turned about d3 in so many steps, then stretched
/// along d1, d2, d3; or triangles. Its origin is the centre of mass.
struct Outline {
    std::vector<std::array<double, 2>> profile;   ///< (radius, height), inside on the left; empty: no shape
    int sides = 24;                               ///< with 4 the sides of a square are normal to d1 and d2
    Vector3 stretch{1, 1, 1};
    std::vector<Vector3> points{};   ///< of triangles, stretched likewise
    std::vector<std::array<int, 3>> triangles{};
    std::size_t n_left_out = 0;   ///< triangles of a mesh that has too many to be drawn
    double moved = 0;             ///< by which its corners are moved for that at most, before stretching
    // Of a union: its parts, each at a place and in axes of the whole.
    std::vector<Outline> parts{};
    Vector3 place{};
    Matrix3 axes = identity<3>();
    std::optional<Vector3> color{};   ///< red, green, blue from 0 to 1, in sRGB
    double opacity = 1;
    /// What is drawn instead, each at a place and in axes of the body: from its reference point on.
    std::vector<Outline> visuals{};

    bool is_empty() const { return profile.empty() && triangles.empty() && parts.empty() && visuals.empty(); }
};
Outline ball_outline();   ///< of radius 1

/// One of the solids that a shape unites.
struct ShapePart {
    std::string name;   ///< may be empty
    double mass = 0;    ///< kg, of a hole negative
    Vector3 center{};   ///< of mass, in body coordinates
};

/// Where the meshes of a scenario are, and the files that it includes.
struct MeshSource {
    /// Their paths begin there and do not leave it. None: they cannot be read.
    std::optional<std::filesystem::path> folder = {};
    /// What Scenario::meshes held when the run was solved: what stands in it is not read.
    std::string kept = {};
    /// Files of meshes by what they are called here, wherever they lie: those that a caller names, and
    /// never what a scenario names.
    std::map<std::string, std::filesystem::path> named = {};
};

/// Output times.
struct OutputTimes {
    std::vector<double> output;   ///< all element ends, where known, if the scenario lists none
    bool lists_output = false;    ///< the scenario says which
};

/// A scenario that has been read, checked and closed as far as it can be without solving.
struct Scenario : OutputTimes {
    std::string file;   ///< as given by the caller; messages only, never written to results
    std::string text;   ///< the file itself, with the parameters that were set
    std::string title;
    Model model;
    std::vector<Outline> outlines;               ///< of the bodies, then of the world
    std::vector<std::vector<ShapePart>> parts;   ///< of the bodies' shapes; none of one that is no union
    Time time;   ///< element ends hold jumps of loads (unless breaks = "ignore") and output times
    Method method;
    Conditions conditions;     ///< what is given at start and end, and the states there, with their times
    UnknownNumbers unknowns;   ///< by their names in the file; guesses in SI units
    SolveOptions options;      ///< tolerance, max_iterations, initial, condition
    std::shared_ptr<Prepared> prepared;   ///< what reading has found of the model, for Problem
    std::string resolved;                 ///< all options after defaults, as one JSON object
    /// What its meshes come to, and the texts that it includes, so that a run needs no file beside its own.
    std::string meshes;
    std::vector<std::filesystem::path> mesh_files;   ///< that were read for it, included ones, too
};

/// Values that parameters have instead of those of the file: names, each with a number or an expression.
using ParameterValues = std::vector<std::pair<std::string, std::string>>;

struct ScenarioResult {
    std::optional<Scenario> scenario;                ///< empty if there is an error
    std::vector<Diagnostic> diagnostics;             ///< up to 20
    std::string text;                                ///< what was read, for render()
    std::vector<std::filesystem::path> mesh_files;   ///< that were read or looked for, also after an error
};

/// Memory that solving and writing will take at least, bytes.
struct MemoryNeed {
    double motion = 0;
    double system = 0;   ///< the equations of the elements that are solved together
    double checks = 0;   ///< the estimate of the error, and series while they are judged

    /// What is there at a time: the system goes before the motion is checked.
    double most() const { return motion + (system > checks ? system : checks); }
};
MemoryNeed memory_needed(const Scenario& scenario);

/// Largest scenario in bytes, and deepest nesting; both are checked before parsing.
inline constexpr std::size_t max_scenario_bytes = 16u << 20;
inline constexpr int max_scenario_depth = 64;

/// Reads and checks (including check_method() and consistent_start()). Throws nothing: every problem is a
/// diagnostic; codes `io-...` mean the file could not be read at all. Meshes lie in the file's folder. The
/// text of the scenario is that of the file with `values` in the places of its own: it can be read without
/// them.
ScenarioResult read_scenario(const std::filesystem::path& file, const ParameterValues& values = {});
ScenarioResult parse_scenario(std::string text, const std::string& file_name, const MeshSource& meshes = {},
                              const ParameterValues& values = {});

/// The scenario whose unknown numbers are guessed with these values; it reads nothing but what it has read.
/// Null: it cannot be read, which is a fault of the reader.
std::shared_ptr<const Scenario> with_guesses(const Scenario& scenario, std::span<const double> values);

/// What solving a scenario complains of, at its place in the file.
Diagnostic diagnostic_of(const Scenario& scenario, const Complaint& complaint);

/// Its unknown numbers, if it has some, as "found": of a scenario with what was found.
void write_found(JsonWriter& json, const Scenario& scenario);

/// "mm" in m; 0 for what is no unit of length.
double unit_of_length(const std::string& unit);

/// The schema of scenarios: for editors (JSON Schema draft 2020-12) and for people (Markdown).
std::string schema_json();
std::string schema_markdown();
/// The keys of one type, such as "joint.revolute"; empty for what is not in schema_types().
std::string schema_markdown(std::string_view type);
std::vector<std::string> schema_types();

}   // namespace gnu::visibility("default")]]livens
