// SPDX-License-Identifier: BSD-3-Clause
// A table of samples at the output times, one row each, as spreadsheets read it: docs/results.md. Units stand
// in the header; what is no number is an empty cell.
#include <limits>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports.h"
#include "livens/io/json.h"
#include "livens/io/results/atomic_file.h"

namespace livens {

namespace {

/// RFC 4180: quotes around what holds a separator; line breaks cannot be in a header that other programs
/// should read. Spreadsheets take text in quotes for formulas too: an apostrophe says that it is none.
std::string header_cell(const std::string& name)
{
    const std::size_t first = name.find_first_not_of(" \t");
    bool needs_quotes = first != std::string::npos && std::string_view("=+-@").find(name[first]) < 4;
    needs_quotes |= name.starts_with('\t');
    std::string quoted = needs_quotes ? "'" : "";
    for (const char c : name) {
        if (c == ',' || c == '"' || c == ';') needs_quotes = true;
        if (c == '"') quoted += '"';
        quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return needs_quotes ? '"' + quoted + '"' : quoted;
}

using Parts = std::initializer_list<const char*>;

void add_header(std::string& line, const std::string& of, const char* quantity, Parts parts, const char* unit)
{
    for (const char* part : parts)
        line += "," + header_cell(of + "." + quantity + "." + part + " [" + unit + "]");
}

std::string header(const Model& model, const Run& run, const JointCoordinates& coordinates,
                   bool has_reactions)
{
    std::string line = "t [s]";
    for (const std::string& body : run.body_names) {
        add_header(line, body, "position", {"x", "y", "z"}, "m");
        add_header(line, body, "quaternion", {"w", "x", "y", "z"}, "1");
        add_header(line, body, "velocity", {"x", "y", "z"}, "m/s");
        add_header(line, body, "angular_velocity", {"x", "y", "z"}, "rad/s");
    }
    line += ",kinetic energy [J],potential energy [J],energy [J]";
    for (std::size_t i = 0; i < coordinates.places().size(); ++i) {
        const NamedCoordinate& q = coordinates.coordinate(static_cast<int>(i));
        const std::string name = model.joints()[coordinates.places()[i].joint].name + "." + q.name,
                          unit = q.coordinate.is_angle() ? "rad" : "m";
        line +=
            "," + header_cell(name + " [" + unit + "]") + "," + header_cell(name + "_rate [" + unit + "/s]");
    }
    for (const Joint& joint : model.joints()) {
        if (!has_reactions) break;
        add_header(line, joint.name, "force", {"x", "y", "z"}, "N");
        add_header(line, joint.name, "torque", {"x", "y", "z"}, "N m");
    }
    for (const Sensor& sensor : model.sensors())
        for (const SensorComponent& c : sensor.components)
            line += "," + header_cell(sensor.name + "." + c.name + " [" + c.unit + "]");
    return line + "\r\n";
}

constexpr std::size_t largest_piece = std::size_t{1} << 20;   // of the table that is held in memory
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Vector3 no_number{nan, nan, nan};

void add_cell(std::string& line, double x)
{
    line += ',';
    if (x == x) line += to_text(x);   // nan: an empty cell, which every reader takes for "none"
}

template <int Rows, int Cols>
void add_cells(std::string& line, const Matrix<Rows, Cols>& values)
{
    for (const double x : values.a) add_cell(line, x);
}

/// As in the balance: where loads jump, what follows.
void add_energies(std::string& line, const Model& model, const Motion& motion, const LoadTurns& turns,
                  double t)
{
    const State state = sample_state(motion, t);
    const Instant at{t, t == motion.end() ? Side::left : Side::right};
    const double kinetic = kinetic_energy(model, state.X, state.V);
    const double potential = potential_energy(model, at, state.X, state.V, turns.at(state));
    add_cells(line, Vector3{kinetic, potential, kinetic + potential});
}

}   // namespace

void write_csv(const std::filesystem::path& file, const Model& model, const Run& run)
{
    AtomicFile out(file);
    std::uint64_t n_written = 0;
    const auto write = [&](std::string& text) {   // a small run may have a large table
        out.write(n_written, text);
        n_written += text.size();
        text.clear();
    };
    const JointCoordinates coordinates(model, run.motion);
    const SensorReadings sensors(model, run.motion);
    const JointSampler joints(model, run.motion);
    const bool has_reactions = !sample_joints(model, run.motion, run.motion.start()).empty();
    std::string text = header(model, run, coordinates, has_reactions);
    const LoadTurns turns(model, run.motion);
    std::vector<Vector4> previous(run.body_names.size(), Vector4{1, 0, 0, 0});
    for (const double asked : run.output) {
        if (asked < run.motion.start() || asked > run.motion.end()) continue;
        const State state = sample_state(run.motion, asked);
        const double t = state.t;
        text += to_text(asked);
        const std::vector<BodySample> bodies = sample_bodies(model, run.motion, state);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const BodySample& s = bodies[b];
            // Of q and -q the one that is nearer to the row before: columns have no jumps of sign.
            previous[b] = continued(previous[b], s.quaternion);
            add_cells(text, s.position);
            add_cells(text, previous[b]);
            add_cells(text, s.velocity);
            add_cells(text, s.angular_velocity);
        }
        add_energies(text, model, run.motion, turns, t);
        for (const CoordinateValue& q : coordinates.at(state)) {
            add_cell(text, q.value);
            add_cell(text, q.rate);
        }
        if (has_reactions)
            for (const JointSample& joint : joints.at(state)) {
                // Where a reaction jumps, what follows is told, and at the very end what was.
                const Reaction& r = t == run.motion.end() ? joint.left : joint.right;
                add_cells(text, joint.is_bounded ? r.force : no_number);
                add_cells(text, joint.is_bounded ? r.torque : no_number);
            }
        for (const double reading : sensors.at(state)) add_cell(text, reading);
        text += "\r\n";
        if (text.size() > largest_piece) write(text);
    }
    write(text);
    out.commit();
}

}   // namespace livens
