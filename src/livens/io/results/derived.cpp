// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "livens/diagnostics/sample.h"
#include "livens/io/json.h"
#include "livens/io/results/writing.h"
#include "livens/spacetime/instructions.h"

namespace livens {

namespace {

constexpr std::size_t chunk = 1u << 15;   // numbers of samples that are held at a time

template <class Values>
void append(std::vector<double>& out, const Values& values)
{
    out.insert(out.end(), values.data(), values.data() + Values::rows * Values::cols);
}

std::span<const double> all_of(const std::vector<double>& values) { return values; }
std::span<const double> all_of(const std::vector<Vector3>& values) { return numbers(values); }

/// A variable that is filled piece by piece.
struct Column {
    int variable;
    std::vector<double> values{};
};

using BodyPart = std::variant<Vector3 BodySample::*, Vector4 BodySample::*, Matrix3 BodySample::*>;

struct BodyVariable {
    const char* name;
    const char* units;
    const char* frame;
    const char* long_name;
    BodyPart part;
};

constexpr BodyVariable body_variables[] = {
    {"position", "m", "inertial", "position of the reference point", &BodySample::position},
    {"center_of_mass", "m", "inertial", "position of the centre of mass", &BodySample::center_of_mass},
    {"directors", "1", "inertial", "directors [d1, d2, d3], projected to the nearest orthonormal triad",
     &BodySample::directors},
    {"directors_raw", "1", "inertial",
     "directors [d1, d2, d3] of the motion, with their violation of rigidity", &BodySample::directors_raw},
    {"quaternion", "1", "inertial", "orientation, body to world; sign continuous in time",
     &BodySample::quaternion},
    {"velocity", "m s-1", "inertial", "velocity of the reference point", &BodySample::velocity},
    {"angular_velocity", "rad s-1", "inertial", "angular velocity in inertial axes",
     &BodySample::angular_velocity},
    {"angular_velocity_body", "rad s-1", "body-fixed", "angular velocity in body axes",
     &BodySample::angular_velocity_body},
    {"linear_momentum", "kg m s-1", "inertial", "linear momentum", &BodySample::linear_momentum},
    {"angular_momentum", "kg m2 s-1", "inertial", "angular momentum about the world's origin",
     &BodySample::angular_momentum},
};

VariableInfo info_of(const BodyVariable& v)
{
    VariableInfo info{v.name, {"time", "body", "xyz"}, v.units, v.frame, v.long_name};
    if (v.part.index() == 2) info.dimensions = {"time", "body", "director", "xyz"};
    if (v.part.index() == 1) {
        info.dimensions = {"time", "body", "quaternion_part"};
        info.attributes = {{"order", "w, x, y, z"}};
    }
    return info;
}

struct ErrorVariable {
    VariableInfo info;
    std::vector<double> ErrorEstimate::*errors;
};

/// Beside what they judge.
const std::vector<ErrorVariable>& error_variables()
{
    static const std::vector<ErrorVariable> all{
        {{"estimated_position_error",
          {"time", "body"},
          "1",
          "none",
          "estimated error of the centre of mass, in lengths of the model (model_length)"},
         &ErrorEstimate::position},
        {{"estimated_orientation_error",
          {"time", "body"},
          "rad",
          "none",
          "estimated error of the orientation; 0 for point masses"},
         &ErrorEstimate::orientation},
        {{"estimated_velocity_error",
          {"time", "body"},
          "m s-1",
          "none",
          "estimated error of the velocity of the centre of mass"},
         &ErrorEstimate::velocity},
        {{"estimated_reaction_error",
          {"time", "joint"},
          "1",
          "none",
          "estimated error of force, or torque by model_length, relative to largest_reaction"},
         &ErrorEstimate::reaction}};
    return all;
}

/// Samples at the output times that the motion has reached, some instants at a time.
class Samples {
public:
    Samples(RunWriter& archive, const Model& model, const Run& run)
        : file_(archive.file()), model_(model), motion_(run.motion), estimate_(run.estimate)
    {
        const auto first = std::ranges::lower_bound(run.output, motion_.start());
        const auto last = std::ranges::upper_bound(run.output, motion_.end());
        times_ = {first, last};
        if (times_.empty()) return;
        const VariableInfo time{
            "time", {"time"}, "s", "none", "output times that the motion has reached", {{"axis", "T"}}};
        archive.view(time, NumberType::real, times_);
        if (!run.growth.empty()) {
            std::vector<bool> beyond;
            for (const double t : times_) beyond.push_back(run.verdict.is_beyond_horizon(t));
            const char* const meaning = "1: rounding at the start decides which of many motions is shown";
            archive.flags({"beyond_horizon", {"time"}, "1", "none", meaning}, beyond);
        }
        const std::size_t n = times_.size() * model.bodies().size();
        for (const BodyVariable& v : body_variables) {
            const std::size_t sizes[] = {3, 4, 9};   // of the alternatives of BodyPart
            if (n > 0)
                bodies_.push_back({archive.declare(info_of(v), NumberType::real, n * sizes[v.part.index()])});
        }
        previous_.resize(model.bodies().size(), Vector4{1, 0, 0, 0});
        declare_errors(archive);
        const bool has_multipliers = !motion_.end_multipliers.empty() || !motion_.multipliers.empty();
        if (model.joints().empty() || !has_multipliers) return;
        const std::vector<std::string> sides{"time", "joint", "side", "xyz"};
        const std::size_t n_joint = times_.size() * model.joints().size() * 6;
        const auto joint = [&](const char* name, const char* units, const char* long_name) {
            joints_.push_back(
                {archive.declare({name, sides, units, "inertial", long_name}, NumberType::real, n_joint)});
        };
        joint("reaction_force", "N", "force of the joint on its second body, from both sides");
        joint("reaction_torque", "N m",
              "torque of the joint on its second body about its joint point, from both sides");
    }

    void write()
    {
        std::size_t held = 0;
        for (const double t : times_) {
            if (!bodies_.empty()) add_bodies(t);
            if (!joints_.empty()) add_joints(t);
            add_errors(t);
            held += 62 * model_.bodies().size() + 12 * model_.joints().size();
            if (held < chunk) continue;
            flush();
            held = 0;
        }
        flush();
    }

private:
    void declare_errors(RunWriter& archive)
    {
        const std::size_t n_ends = motion_.mesh.ends.size();
        for (const ErrorVariable& v : error_variables()) {
            const std::vector<double>& errors = estimate_.*v.errors;
            if (errors.empty()) continue;
            const std::size_t n = times_.size() * (errors.size() / n_ends);
            errors_.push_back({archive.declare(v.info, NumberType::real, n)});
            errors_at_ends_.push_back(&errors);
        }
    }

    /// Output times are element ends; at another instant nothing is known of the polynomial's error.
    void add_errors(double t)
    {
        const int end = element_end_at(motion_.mesh, snap_to_element_end(motion_.mesh, t));
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            const std::size_t n = errors_at_ends_[i]->size() / motion_.mesh.ends.size();
            const auto first = errors_at_ends_[i]->begin() + static_cast<std::ptrdiff_t>(n) * end;
            std::vector<double>& values = errors_[i].values;
            if (end >= 0)
                values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(n));
            else
                values.insert(values.end(), n, std::numeric_limits<double>::quiet_NaN());
        }
    }

    void flush()
    {
        for (auto* columns : {&bodies_, &joints_, &errors_})
            for (Column& column : *columns) {
                file_.append(column.variable, std::span<const double>(column.values));
                column.values.clear();
            }
    }

    void add_bodies(double t)
    {
        std::vector<BodySample> samples = sample_bodies(model_, motion_, t);
        for (std::size_t b = 0; b < samples.size(); ++b) {
            previous_[b] = samples[b].quaternion = continued(previous_[b], samples[b].quaternion);
            for (std::size_t i = 0; i < bodies_.size(); ++i)
                std::visit([&](auto part) { append(bodies_[i].values, samples[b].*part); },
                           body_variables[i].part);
        }
    }

    void add_joints(double t)
    {
        std::vector<JointSample> samples = sample_joints(model_, motion_, t);
        if (samples.empty()) {   // this instant has no multipliers, others have
            const double nan = std::numeric_limits<double>::quiet_NaN();
            const Reaction none{{nan, nan, nan}, {nan, nan, nan}};
            samples.assign(model_.joints().size(), {none, none, false, false, false});
        }
        for (const JointSample& joint : samples) {
            append(joints_[0].values, joint.left.force);
            append(joints_[0].values, joint.right.force);
            append(joints_[1].values, joint.left.torque);
            append(joints_[1].values, joint.right.torque);
        }
    }

    ClassicWriter& file_;
    const Model& model_;
    const Motion& motion_;
    const ErrorEstimate& estimate_;
    std::span<const double> times_;
    std::vector<Column> bodies_, joints_, errors_;
    std::vector<const std::vector<double>*> errors_at_ends_;
    std::vector<Vector4> previous_;
};

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
    {"work", "J", "work of the loads without potential since the start", &Balance::work},
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
void write_balance(RunWriter& archive, const Model& model, const Motion& motion, const Balance* known)
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
        if (known != nullptr) return append(*known);
        balance(model, motion, 1 << 12, append);
    });
}

/// Integrals over each element, as the paper shows them: of the Lagrangian the action, of the Hamiltonian and
/// of the angular momentum what divided by the element's length is their mean.
void write_integrals(RunWriter& archive, const Model& model, const Motion& motion)
{
    const int n = motion.n_elements();
    if (n < 1) return;
    const auto declare = [&](const char* name, const char* units, const char* of) {
        return archive.declare({name, {"element"}, units, "none", std::string("integral of ") + of},
                               NumberType::real, static_cast<std::size_t>(n));
    };
    const int lagrangian = declare("action_integral", "J s", "the Lagrangian T - V over each element");
    const int hamiltonian = declare("hamiltonian_integral", "J s", "the Hamiltonian over each element");
    const VariableInfo info{"angular_momentum_integral", {"element", "xyz"}, "kg m2", "inertial",
                            "integral of the angular momentum about the origin over each element"};
    const int moment = archive.declare(info, NumberType::real, static_cast<std::size_t>(3 * n));
    archive.later([&file = archive.file(), &model, &motion, n, lagrangian, hamiltonian, moment] {
        constexpr int some = 1 << 12;
        for (int e = 0; e < n; e += some) {
            const ActionSeries series = action(model, motion, e, std::min(n, e + some));
            file.append(lagrangian, std::span<const double>(series.lagrangian));
            file.append(hamiltonian, std::span<const double>(series.hamiltonian));
            file.append(moment, numbers(series.angular_momentum));
        }
    });
}

void write_violations(RunWriter& archive, const Model& model, const Motion& motion)
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
    archive.later([&, joints, rigidity] {
        const NodeViolations at = node_violations(model, motion);
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
    VariableInfo info{"body_mass_matrix", {"body", "mass_column", "column"}, "mixed", "body-fixed",
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

void write_derived(RunWriter& archive, const Model& model, const Run& run)
{
    const Motion& m = run.motion;
    write_balance(archive, model, m, run.verdict.balances.get());
    write_nodes(archive, "X_node", m.X, m.mesh);
    write_nodes(archive, "P_node", m.P, m.mesh);
    write_nodes(archive, "multiplier_node", m.multipliers, m.mesh);
    write_nodes(archive, "rigidity_node", m.rigidity, m.mesh);
    write_integrals(archive, model, m);
    write_violations(archive, model, m);
    write_model(archive, model);
    const auto samples = std::make_shared<Samples>(archive, model, run);
    archive.later([samples] { samples->write(); });
    archive.text("manifest", "versions, options, figures (JSON)", manifest(run));
}

}   // namespace livens
