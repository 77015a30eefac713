// What a result file holds of a Run: stated once, walked by the writer, the reader and the digest.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "livens/io/detail/netcdf_file.h"
#include "livens/io/results.h"

namespace livens {

/// Throws IoError if sizes or indices of the run contradict each other, so that nothing that works on it can
/// read beyond its arrays: every file is a stranger, whatever its digest says.
void check_run(const Run& run);

/// Vectors of small matrices are arrays of doubles (base/linear.h says so).
template <class T>
inline constexpr bool is_matrix = std::is_class_v<T>;

template <class T>
inline std::span<const double> numbers(const std::vector<T>& v)
{
    static_assert(sizeof(T) == T::rows * T::cols * sizeof(double));
    return {v.empty() ? nullptr : v.front().data(), v.size() * T::rows * T::cols};
}

/// The finished file.
std::string run_image(const Model& model, const Run& run);
/// `name` serves for messages.
Run run_from_image(std::string image, const std::string& name);

/// Numbers that must live until the image is formed.
using DerivedNumbers = std::tuple<std::deque<std::vector<double>>, std::deque<std::vector<int>>>;

/// What is in the file for readers other than livens, made from model and run: samples at the output times,
/// times of nodes, masses, integrals over elements.
void write_derived(NetcdfWriter& file, const Model& model, const Run& run, DerivedNumbers& owner);

/// As files count them: whether a motion is suspect stands in the text of the status.
inline SolveStatus of_solver(SolveStatus status)
{
    return status == SolveStatus::suspect ? SolveStatus::converged : status;
}

inline VariableInfo coefficients(const std::string& name, const std::string& node,
                                 const std::string& long_name, const std::string& column_units)
{
    return {name,      {node, "body", "column", "xyz"},  "mixed", "inertial",
            long_name, {{"column_units", column_units}}, {}};
}

inline const std::string columns_of_X = "m 1 1 1";
inline const std::string columns_of_V = "m s-1, s-1, s-1, s-1";
inline const std::string columns_of_A = "m s-2, s-2, s-2, s-2";
inline const std::string columns_of_P = "kg m s-1, kg m2 s-1, kg m2 s-1, kg m2 s-1";

/// An archive has: dimension(name, length), text(name, string), number(name, number), status(name, status as
/// text; as a number suspect is converged), names(info, strings), flags(info, bools), list(info, vector) and
/// field(info, Field). It either reads what it is given (the parts are const then) or fills it in.
template <class Archive, class AnyRun>
void visit_sizes(Archive& archive, AnyRun& run)
{
    auto& motion = run.motion;
    archive.number("n_bodies", motion.n_bodies);
    archive.number("n_rows", motion.n_rows);
    archive.dimension("xyz", 3);
    archive.dimension("column", 4);
    archive.dimension("side", 2);
    archive.dimension("body", run.body_names.size());
    archive.dimension("joint", run.joint_names.size());
    archive.dimension("row", run.row_labels.size());
    archive.dimension("element_end", motion.mesh.ends.size());
    archive.dimension("output", run.output.size());
    archive.dimension("redundant_row", motion.redundant_rows.size());
    archive.dimension("block", run.report.iterations.size());
    archive.list({"element_end", {"element_end"}, "s", "none", "ends of the time elements"},
                 motion.mesh.ends);
    archive.list({"output_time", {"output"}, "s", "none", "output times that the scenario asks for"},
                 run.output);
}

template <class Archive, class AnyRun>
void visit_model(Archive& archive, AnyRun& run)
{
    archive.names({"body", {"body"}, "1", "none", "names of the bodies"}, run.body_names);
    archive.names({"joint", {"joint"}, "1", "none", "names of the joints"}, run.joint_names);
    archive.names({"row", {"row"}, "1", "none", "names of the constraint rows of the joints"},
                  run.row_labels);
    archive.flags({"is_point_mass", {"body"}, "1", "none", "1: the body is a point mass without orientation"},
                  run.body_is_point);
    archive.list(
        {"body_center_of_mass", {"body", "xyz"}, "m", "body-fixed", "body coordinates of the centre of mass"},
        run.centers_of_mass);
}

template <class Archive, class AnyMotion>
void visit_motion(Archive& archive, AnyMotion& motion)
{
    archive.field(coefficients("X", "X_node", "configuration [phi d1 d2 d3], values at the elements' nodes",
                               columns_of_X),
                  motion.X);
    archive.field(
        coefficients("P", "P_node", "momentum X' m inside the elements, values at their nodes", columns_of_P),
        motion.P);
    archive.field({"multiplier",
                   {"multiplier_node", "row"},
                   "mixed",
                   "none",
                   "multipliers of the joints' rows, values at the elements' nodes"},
                  motion.multipliers);
    archive.list(coefficients("end_momentum", "element_end", "tangent momentum X' m at the element ends",
                              columns_of_P),
                 motion.momenta);
    archive.list(coefficients("end_velocity", "element_end", "dX/dt at the element ends, from the momentum",
                              columns_of_V),
                 motion.velocities);
    VariableInfo acceleration =
        coefficients("end_acceleration", "element_end",
                     "d2X/dt2 at the element ends, from the left and from the right", columns_of_A);
    acceleration.dimensions.insert(acceleration.dimensions.begin() + 1, "side");
    archive.list(acceleration, motion.accelerations);
    archive.list({"end_multiplier",
                  {"element_end", "side", "row"},
                  "mixed",
                  "none",
                  "multipliers of the acceleration-level equation at the element ends, from the left and "
                  "from the right"},
                 motion.end_multipliers);
    archive.list(
        {"redundant_row", {"redundant_row"}, "1", "none", "rows whose multipliers are not unique, from 0"},
        motion.redundant_rows);
    archive.number("order_at_element_ends", motion.order_at_ends);
    archive.number("dense_order_of_X", motion.dense_order_X);
    archive.number("dense_order_of_V", motion.dense_order_V);
    archive.text("constraints_hold_at", motion.constraints_hold);
}

template <class Archive, class AnySolveReport>
void visit_report(Archive& archive, AnySolveReport& report)
{
    archive.number("report_status", report.status);
    archive.text("report_message", report.message);
    archive.number("report_elements", report.n_elements);
    archive.number("report_unknowns", report.unknowns);
    archive.number("report_newton_iterations", report.newton_iterations);
    archive.number("report_most_iterations", report.most_iterations);
    archive.number("report_factorisations", report.factorisations);
    archive.number("report_guess_factorisations", report.guess_factorisations);
    archive.number("report_rescued", report.rescued);
    archive.number("report_residual_norm", report.residual_norm);
    archive.number("report_smallest_pivot", report.smallest_pivot);
    archive.number("report_failed_at", report.failed_at);
    archive.list(
        {"block_newton_iterations", {"block"}, "1", "none", "Newton iterations of each block of elements"},
        report.iterations);
    archive.names({"report_note", {"report_note"}, "1", "none", "what the solver deemed worth a word"},
                  report.notes);
}

/// What of a run users ask for first. Some of it stands in the report as well.
template <class Archive, class AnyRun>
void visit_summary(Archive& archive, AnyRun& run)
{
    auto& report = run.report;
    auto& verdict = run.verdict;
    bool reached_end = report.reached_end();
    archive.number("converged", reached_end);
    archive.status("status", report.status);
    archive.text("method", run.method);
    archive.text("message", report.message);
    archive.number("elements", report.n_elements);
    archive.number("unknowns", report.unknowns);
    archive.number("newton_iterations", report.newton_iterations);
    archive.number("factorisations", report.factorisations);
    archive.number("residual_norm", report.residual_norm);
    archive.number("max_constraint_violation", verdict.max_constraint_violation);
    archive.number("max_velocity_violation", verdict.max_velocity_violation);
    archive.number("energy_drift", verdict.energy_drift);
    archive.number("angular_momentum_drift", verdict.angular_momentum_drift);
    archive.names({"note", {"note"}, "1", "none", "remarks on the run"}, run.notes);
}

template <class Archive, class AnyBalance>
void visit_balance(Archive& archive, AnyBalance& b)
{
    const auto series = [&](const char* name, const char* units, const char* long_name, auto& values) {
        archive.list({name, {"element_end"}, units, "none", long_name}, values);
    };
    const auto vectors = [&](const char* name, const char* units, const char* long_name, auto& values) {
        archive.list({name, {"element_end", "xyz"}, units, "inertial", long_name}, values);
    };
    series("balance_time", "s", "times of the balances: the element ends", b.t);
    series("kinetic_energy", "J", "kinetic energy", b.kinetic);
    series("potential_energy", "J", "potential energy of gravity and of the loads that have one",
           b.potential);
    series("energy", "J", "kinetic and potential energy", b.energy);
    series("work", "J", "work of the loads without potential since the start", b.work);
    series("energy_error", "J", "|energy - energy at the start - work|", b.energy_drift);
    vectors("total_linear_momentum", "kg m s-1", "linear momentum of all bodies", b.linear_momentum);
    vectors("total_angular_momentum", "kg m2 s-1", "angular momentum of all bodies about the origin",
            b.angular_momentum);
    vectors("linear_impulse", "kg m s-1", "impulse of gravity, loads and joints to the world since the start",
            b.linear_impulse);
    vectors("angular_impulse", "kg m2 s-1", "its moment about the origin", b.angular_impulse);
    series("linear_momentum_error", "kg m s-1", "|linear momentum - at the start - impulse|",
           b.linear_momentum_drift);
    series("angular_momentum_error", "kg m2 s-1", "|angular momentum - at the start - moment of the impulse|",
           b.angular_momentum_drift);
    archive.number("largest_kinetic_energy", b.largest_kinetic);
    archive.number("largest_moment_of_momentum", b.largest_moment);
    archive.number("reference_energy", b.reference_energy);
    archive.number("reference_moment", b.reference_moment);
}

/// What version 1.1 added to the motion: what other families than lobatto and the classical ones need.
template <class Archive, class AnyMotion>
void visit_motion_1(Archive& archive, AnyMotion& motion)
{
    const auto denominators = [&](const char* name, const char* node, const char* of, auto& field) {
        archive.list({name, {node}, "1", "none", std::string("denominators of ") + of + " at its nodes"},
                     field.denominators);
    };
    denominators("X_weight", "X_node", "X", motion.X);
    denominators("P_weight", "P_node", "P", motion.P);
    denominators("multiplier_weight", "multiplier_node", "the multipliers", motion.multipliers);
    archive.dimension("rigidity_row", 6);
    archive.field({"rigidity_multiplier",
                   {"rigidity_node", "body", "rigidity_row"},
                   "N m",
                   "none",
                   "multipliers of the bodies' rigidity (11, 22, 33, 12, 13, 23), values at the elements' "
                   "nodes"},
                  motion.rigidity);
    denominators("rigidity_weight", "rigidity_node", "the multipliers of rigidity", motion.rigidity);
    archive.number("gauss_points", motion.gauss_points);
    archive.dimension("block_end", motion.block_ends.size());
    archive.list({"block_end",
                  {"block_end"},
                  "1",
                  "none",
                  "element ends, from 0, where a block of elements that are solved together begins or ends"},
                 motion.block_ends);
}

/// What version 1.1 added to the figures.
template <class Archive, class AnyRun>
void visit_figures_1(Archive& archive, AnyRun& run)
{
    archive.number("report_condition_1", run.report.condition_1);
    archive.number("report_condition_2", run.report.condition_2);
    archive.number("report_scaled_condition", run.report.scaled_condition);
    archive.number("report_factor_entries", run.report.factor_entries);
    archive.number("report_guess_distance", run.report.guess_distance);
    archive.number("report_guess_distance_time", run.report.guess_distance_time);
    archive.number("max_weak_violation", run.verdict.max_weak_violation);
    archive.number("zigzag_positions", run.verdict.zigzag_positions);
    archive.number("zigzag_momenta", run.verdict.zigzag_momenta);
    archive.number("zigzag_time", run.verdict.zigzag_time);
    archive.number("condition_1", run.report.condition_1);
    archive.number("condition_2", run.report.condition_2);
    archive.number("scaled_condition", run.report.scaled_condition);
}

/// What version 1.`minor` of the format brought.
template <class Archive, class AnyRun>
void visit_run(Archive& archive, AnyRun& run, int minor)
{
    if (minor == 1) {
        visit_motion_1(archive, run.motion);
        visit_figures_1(archive, run);
        return;
    }
    archive.text("title", run.title);
    archive.text("livens_version", run.version);
    visit_sizes(archive, run);
    visit_model(archive, run);
    visit_motion(archive, run.motion);
    visit_report(archive, run.report);
    visit_summary(archive, run);
    visit_balance(archive, run.verdict.balance);
    archive.text("options", run.resolved);
    archive.text("scenario", run.scenario_text);
}

}   // namespace livens
