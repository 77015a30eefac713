// SPDX-License-Identifier: BSD-3-Clause
// What a result file holds of a Run besides its figures: stated once, walked by the writer and the reader.
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "livens/io/results.h"
#include "livens/io/results/classic_netcdf.h"

namespace livens::inline io_internal {

/// What a variable says about itself. `frame` is the frame that its components refer to.
struct VariableInfo {
    std::string name;
    std::vector<std::string> dimensions;
    std::string units = "1";
    std::string frame = "none";
    std::string long_name{};
    std::vector<Attribute> attributes{};
};

/// Throws IoError if sizes or indices of the run contradict each other, so that nothing that works on it can
/// read beyond its arrays: every file is a stranger, whatever its checksums say.
void check_run(const Run& run);

/// How a file names the local nodes of a field.
inline const char* words_for(Points points)
{
    return points == Points::lobatto ? "Gauss-Lobatto points of each element, in ascending time"
                                     : "start and right Radau points of each element, in ascending time";
}

/// Vectors of small matrices are arrays of doubles (base/linear.h says so).
template <class T>
inline constexpr bool is_matrix = std::is_class_v<T>;

template <class T>
inline auto numbers(T& v)
{
    using Element = typename T::value_type;
    using Number = std::conditional_t<std::is_const_v<T>, const double, double>;
    static_assert(sizeof(Element) == Element::rows * Element::cols * sizeof(double));
    return std::span<Number>(v.empty() ? nullptr : v.front().data(),
                             v.size() * Element::rows * Element::cols);
}

/// Writes a file to `sink`; what write_run() does but for the disk.
void write_run_to(const ByteSink& sink, const Model& model, const Run& run,
                  std::uint64_t largest_in_cdf2 = ClassicWriter::largest_in_cdf2);
Run read_run_from(ByteSource source, bool verify = true);

/// An archive has: figures(run), choice(name, enum, its last), word(name, short text), text(name, meaning,
/// long text), names(name, meaning, strings), flags(info, bools), list(info, vector) and field(info, Field).
/// It either reads what it is given (the parts are const then) or fills it in. The first dimension of a list
/// has as many entries as the list.
///
/// What `livens info` shows: small, whatever the run.
template <class Archive, class AnyRun>
void visit_head(Archive& archive, AnyRun& run)
{
    archive.word("title", run.title);
    archive.word("livens_version", run.version);
    archive.word("method", run.method);
    archive.word("message", run.report.message);
    archive.choice("constraints_hold_at", run.motion.constraints_hold, ConstraintsHold::weakly);
    archive.choice("status", run.report.status, SolveStatus::suspect);
    archive.figures(run);
    archive.names("body", "names of the bodies", run.body_names);
    archive.flags({"holds_states", {"body"}, "1", "none", "1: it stands for states of a controller"},
                  run.body_holds_states);
    archive.names("joint", "names of the joints", run.joint_names);
    archive.names("note", "remarks on the run", run.notes);
    archive.names("number", "unknown numbers that were found", run.numbers.names);
    archive.list({"number_value", {"number"}, "mixed", "none", "what was found, in SI units"},
                 run.numbers.values);
    archive.list(
        {"number_error", {"number"}, "mixed", "none", "estimated, of what was found; nan: not known"},
        run.numbers.errors);
    archive.names("event", "what the motion decided, in its order", run.events.names);
    archive.list({"event_time", {"event"}, "s", "none", "when"}, run.events.times);
    archive.list({"event_error", {"event"}, "s", "none", "estimated, of the instants; nan: not known"},
                 run.events.errors);
    archive.list(
        {"event_impulse", {"event"}, "mixed", "none", "of impacts, along the row of the stop; 0: none"},
        run.events.impulses);
    archive.list({"event_speed", {"event"}, "mixed", "none", "with which bodies met, at impacts; 0: none"},
                 run.events.speeds);
    archive.list({"event_rest",
                  {"event"},
                  "s",
                  "none",
                  "of stops that close: when bounces too low to be followed would be over; nan: they do not"},
                 run.events.rests);
    archive.text("options", "all options after defaults, JSON", run.resolved);
}

template <class Archive, class AnyRun>
void visit_model(Archive& archive, AnyRun& run)
{
    archive.names("row", "names of the constraint rows of the joints", run.row_labels);
    archive.names("report_note", "what the solver deemed worth a word", run.report.notes);
    archive.text("scenario", "the scenario, byte by byte", run.scenario_text);
    archive.text("meshes", "what the scenario's meshes come to", run.meshes);
    archive.flags({"is_point_mass", {"body"}, "1", "none", "1: the body is a point mass without orientation"},
                  run.body_is_point);
    archive.list({"body_center_of_mass", {"body", "xyz"}, "m", "body-fixed", "in body coordinates"},
                 run.centers_of_mass);
    archive.list({"block_newton_iterations", {"block"}, "1", "none", "Newton iterations of each block"},
                 run.report.iterations);
    archive.list({"output_time", {"output"}, "s", "none", "output times of the scenario"}, run.output);
}

template <class Archive, class AnyMotion>
void visit_motion(Archive& archive, AnyMotion& m)
{
    using Names = std::vector<std::string>;
    const auto field = [&](const char* name, const Names& over, const char* meaning, const char* units,
                           const char* column_units, const char* weight, auto& values) {
        VariableInfo info{name, over, units, over.size() == 4 ? "inertial" : "none", meaning};
        if (column_units != nullptr) info.attributes = {{"column_units", column_units}};
        archive.field(info, values);
        archive.list({weight, {over[0]}, "1", "none", std::string(name) + ": denominators at its nodes"},
                     values.denominators);
    };
    const auto at_ends = [&](const char* name, const Names& over, const char* column_units,
                             const char* meaning, auto& values) {
        archive.list({name, over, "mixed", "inertial", meaning, {{"column_units", column_units}}}, values);
    };
    const auto indices = [&](const char* name, const char* meaning, auto& values) {
        archive.list({name, {name}, "1", "none", meaning}, values);
    };
    const char* const of_P = "kg m s-1, kg m2 s-1, kg m2 s-1, kg m2 s-1";
    const Names ends{"element_end", "body", "column", "xyz"};
    const Names sides{"element_end", "side", "body", "column", "xyz"};

    archive.list({"element_end", {"element_end"}, "s", "none", "ends of the time elements"}, m.mesh.ends);
    field("X", {"X_node", "body", "column", "xyz"}, "configuration [phi d1 d2 d3] at the elements' nodes",
          "mixed", "m 1 1 1", "X_weight", m.X);
    field("P", {"P_node", "body", "column", "xyz"}, "momentum X' m at the elements' nodes", "mixed", of_P,
          "P_weight", m.P);
    field("multiplier", {"multiplier_node", "row"}, "multipliers of the joints' rows at the elements' nodes",
          "mixed", nullptr, "multiplier_weight", m.multipliers);
    field("rigidity_multiplier", {"rigidity_node", "body", "rigidity_row"},
          "multipliers of the bodies' rigidity (11, 22, 33, 12, 13, 23) at the elements' nodes", "N m",
          nullptr, "rigidity_weight", m.rigidity);
    at_ends("end_momentum", ends, of_P, "tangent momentum X' m at the element ends", m.momenta);
    at_ends("end_velocity", ends, "m s-1, s-1, s-1, s-1", "dX/dt at the element ends, from the momentum",
            m.velocities);
    indices("impact_end", "element ends, from 0, where velocities change by an impact", m.impacts.ends);
    const Names impacts{"impact_end", "body", "column", "xyz"};
    at_ends("impact_momentum", impacts, of_P, "momenta before the impacts", m.impacts.momenta);
    at_ends("impact_velocity", impacts, "m s-1, s-1, s-1, s-1", "dX/dt before the impacts",
            m.impacts.velocities);
    at_ends("end_acceleration", sides, "m s-2, s-2, s-2, s-2",
            "d2X/dt2 at the element ends, from the left and from the right", m.accelerations);
    archive.list({"end_multiplier",
                  {"element_end", "side", "row"},
                  "mixed",
                  "none",
                  "multipliers of the acceleration-level equation at the element ends, from both sides"},
                 m.end_multipliers);
    archive.list(
        {"load_angle",
         {"load_angle"},
         "rad",
         "none",
         "for each element end in turn, angles used by loads with full turns, minus their values where "
         "[[body]] places the bodies"},
        m.load_angles);
    indices("redundant_row", "rows whose multipliers are not unique, from 0", m.redundant_rows);
    indices("block_end", "element ends, from 0, between blocks of elements solved together", m.block_ends);
}

template <class Archive, class AnyEstimate>
void visit_estimate(Archive& archive, AnyEstimate& e)
{
    const auto errors = [&](const char* name, const char* over, const char* units, const char* meaning,
                            auto& values) {
        archive.list({name, {"element_end", over}, units, "none", meaning}, values);
    };
    errors("end_position_error", "body", "1", "estimated, of the centre of mass, in model lengths",
           e.position);
    errors("end_orientation_error", "body", "rad", "estimated; 0 for point masses", e.orientation);
    errors("end_velocity_error", "body", "m s-1", "estimated, of the centre of mass", e.velocity);
    errors("end_reaction_error", "joint", "1", "estimated, relative to the largest reaction of the run",
           e.reaction);
}

template <class Archive, class AnyRun>
void visit_run(Archive& archive, AnyRun& run)
{
    visit_head(archive, run);
    visit_model(archive, run);
    visit_motion(archive, run.motion);
    visit_estimate(archive, run.estimate);
    archive.list({"growth",
                  {"element_end"},
                  "1",
                  "none",
                  "growth factor of a small initial perturbation up to then, in model lengths and rad"},
                 run.growth);
}

}   // namespace livens::inline io_internal
