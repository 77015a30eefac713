// SPDX-License-Identifier: BSD-3-Clause
// What other programs want of a run and livens can make again: energies and balances, integrals, violations,
// masses, samples. It is written piece by piece, never held as a whole (docs/results.md).
#include <algorithm>
#include <string>
#include <variant>

#include "livens/diagnostics/sample.h"
#include "livens/io/json.h"
#include "livens/io/results/writing.h"
#include "livens/multibody/model.h"
#include "livens/solvers/instructions.h"

namespace livens::inline io_internal {

namespace {

std::span<const double> all_of(const std::vector<double>& values) { return values; }
std::span<const double> all_of(const std::vector<Vector3>& values) { return numbers(values); }

void write_nodes(RunWriter& archive, const char* name, const Field& field, const TimeMesh& mesh)
{
    if (field.empty()) return;
    ClassicWriter& file = archive.file();
    const int variable = archive.declare({name, {name}, "s", "none", "times of the nodes"}, NumberType::real,
                                         file.dimension(name));
    archive.later([&, variable] { file.append(variable, node_times(field, mesh)); });
}

using BalancePart = std::variant<std::vector<double> Balance::*, std::vector<Vector3> Balance::*>;

struct BalanceVariable {
    const char* name;
    const char* units;
    const char* long_name;
    BalancePart part;
};

constexpr BalanceVariable balance_variables[] = {
    {"balance_time", "s", "times of the balances: the element ends", &Balance::t},
    {"kinetic_energy", "J", "kinetic energy", &Balance::kinetic},
    {"potential_energy", "J", "potential energy of gravity and of loads that have one", &Balance::potential},
    {"energy", "J", "kinetic and potential energy", &Balance::energy},
    {"work", "J", "work of the loads without potential and of the drives since the start", &Balance::work},
    {"energy_error", "J", "|energy - energy at the start - work|", &Balance::energy_drift},
    {"total_linear_momentum", "kg m s-1", "linear momentum of all bodies", &Balance::linear_momentum},
    {"total_angular_momentum", "kg m2 s-1", "angular momentum of all bodies about the origin",
     &Balance::angular_momentum},
    {"linear_impulse", "kg m s-1", "impulse of gravity, loads and joints to the world since the start",
     &Balance::linear_impulse},
    {"angular_impulse", "kg m2 s-1", "its moment about the origin", &Balance::angular_impulse},
    {"linear_momentum_error", "kg m s-1", "|linear momentum - at the start - impulse|",
     &Balance::linear_momentum_drift},
    {"angular_momentum_error", "kg m2 s-1", "|angular momentum - at the start - moment of the impulse|",
     &Balance::angular_momentum_drift},
};

/// A third of a motion of degree 1: what is not known is made while it is written.
void write_balance(RunWriter& archive, const Model& model, const Motion& motion, const MotionSeries* known)
{
    std::vector<int> variables;
    for (const BalanceVariable& v : balance_variables) {
        const bool is_vector = v.part.index() == 1;
        VariableInfo info{v.name, {"element_end"}, v.units, is_vector ? "inertial" : "none", v.long_name};
        if (is_vector) info.dimensions.push_back("xyz");
        variables.push_back(
            archive.declare(info, NumberType::real, motion.mesh.ends.size() * (is_vector ? 3 : 1)));
    }
    archive.later([&file = archive.file(), &model, &motion, known, variables] {
        const auto append = [&](const Balance& piece) {
            for (std::size_t i = 0; i < variables.size(); ++i)
                std::visit([&](auto part) { file.append(variables[i], all_of(piece.*part)); },
                           balance_variables[i].part);
        };
        // Short motions have kept their balances from the verdict; long ones make them a second time.
        if (known != nullptr) return append(known->balance);
        // 4096 ends at a time, with 20 numbers each: memory does not grow with the motion
        balance(model, motion, 1 << 12, append);
    });
}

/// Integrals over each element, as the paper shows them: of the Lagrangian the action, of the Hamiltonian and
/// of the angular momentum what divided by the element's length is their mean.
void write_integrals(RunWriter& archive, const Model& model, const Motion& motion, const MotionSeries* known)
{
    const int n = motion.n_elements();
    if (n < 1) return;
    const auto declare = [&](const char* name, const char* units, const char* of) {
        return archive.declare({name, {"element"}, units, "none", std::string("integral of ") + of},
                               NumberType::real, static_cast<std::size_t>(n));
    };
    const int lagrangian = declare("action_integral", "J s", "the Lagrangian T - V over each element");
    const int hamiltonian = declare("hamiltonian_integral", "J s", "the Hamiltonian over each element");
    const VariableInfo info{"angular_momentum_integral",
                            {"element", "xyz"},
                            "kg m2",
                            "inertial",
                            "integral of the angular momentum about the origin over each element"};
    const int moment = archive.declare(info, NumberType::real, static_cast<std::size_t>(3 * n));
    archive.later([&file = archive.file(), &model, &motion, known, n, lagrangian, hamiltonian, moment] {
        const auto append = [&](const ActionSeries& series) {
            file.append(lagrangian, std::span<const double>(series.lagrangian));
            file.append(hamiltonian, std::span<const double>(series.hamiltonian));
            file.append(moment, numbers(series.angular_momentum));
        };
        if (known != nullptr && !known->integrals.lagrangian.empty()) return append(known->integrals);
        constexpr int some = 1 << 12;
        for (int e = 0; e < n; e += some) append(action(model, motion, e, std::min(n, e + some)));
    });
}

void write_violations(RunWriter& archive, const Model& model, const Motion& motion, const MotionSeries* known)
{
    if (motion.X.empty()) return;
    ClassicWriter& file = archive.file();
    const auto declare = [&](bool is_there, const char* name, const char* long_name) {
        if (!is_there) return -1;
        return archive.declare({name, {"X_node"}, "1", "none", long_name}, NumberType::real,
                               file.dimension("X_node"));
    };
    const int joints =
        declare(model.n_rows() > 0, "joint_violation", "largest |Phi| / scale of the joints' rows");
    const int rigidity = declare(!std::ranges::all_of(model.bodies(), &Body::is_point), "rigidity_violation",
                                 "largest |Phi| of the bodies' rigidity");
    archive.later([&file, &model, &motion, known, joints, rigidity] {
        const NodeViolations made = known != nullptr ? NodeViolations{} : node_violations(model, motion);
        const NodeViolations& at = known != nullptr ? known->nodes : made;
        if (joints >= 0) file.append(joints, std::span(at.joints));
        if (rigidity >= 0) file.append(rigidity, std::span(at.rigidity));
    });
}

void write_model(RunWriter& archive, const Model& model)
{
    std::vector<Matrix4> masses;
    std::vector<int> first, second, joint_of_row;
    for (const Body& body : model.bodies()) masses.push_back(body.mass);
    for (const Joint& joint : model.joints()) {
        first.push_back(joint.first);
        second.push_back(joint.second);
    }
    for (int r = 0; r < model.n_rows(); ++r) joint_of_row.push_back(model.row_joint(r));
    VariableInfo info{"body_mass_matrix",
                      {"body", "mass_column", "column"},
                      "mixed",
                      "body-fixed",
                      "mass matrix m = [[M, S^T], [S, E]]"};
    info.attributes = {{"column_units", "M: kg, S: kg m, E: kg m2"}};
    archive.list(info, std::move(masses));
    const auto indices = [&](const char* name, const char* over, const char* meaning,
                             std::vector<int>& values) {
        archive.list({name, {over}, "1", "none", meaning}, std::move(values));
    };
    indices("joint_first_body", "joint", "first body of the joint, from 0; -1: the world", first);
    indices("joint_second_body", "joint", "second body of the joint, from 0", second);
    indices("row_joint", "row", "joint that the constraint row belongs to, from 0", joint_of_row);
}

std::string manifest(const Run& run)
{
    JsonWriter json(2);
    json.begin_object();
    json.member("livens_version", run.version);
    json.key("format").begin_array().value(format_major).value(format_minor).end_array();
    json.member("method", run.method);
    json.member("instructions", std::string(to_string(instructions())));
    json.key("options").raw(run.resolved.starts_with('{') ? run.resolved : "null");
    json.key("convergence").begin_object();
    json.member("status", to_string(run.report.status)).member("blocks", run.report.iterations.size());
    write_figures(json, run);
    return json.end_object().end_object().text();
}

}   // namespace

/// All variables are declared first, as the header of the file comes first; what fills them runs later, in
/// this order.
void write_derived(RunWriter& archive, const Model& model, const Run& run, bool has_samples)
{
    const Motion& m = run.motion;
    const MotionSeries* const known = run.verdict.series.get();
    write_balance(archive, model, m, known);
    write_nodes(archive, "X_node", m.X, m.mesh);
    write_nodes(archive, "P_node", m.P, m.mesh);
    write_nodes(archive, "multiplier_node", m.multipliers, m.mesh);
    write_nodes(archive, "rigidity_node", m.rigidity, m.mesh);
    write_integrals(archive, model, m, known);
    write_violations(archive, model, m, known);
    write_model(archive, model);
    if (has_samples) write_samples(archive, model, run);
    archive.text("manifest", "versions, options, figures (JSON)", manifest(run));
}

}   // namespace livens::inline io_internal
