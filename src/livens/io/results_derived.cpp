#include <algorithm>
#include <limits>
#include <span>

#include "livens/diagnostics/sample.h"
#include "livens/io/detail/results_layout.h"
#include "livens/io/json.h"

namespace livens {

namespace {

template <class Values>
void append(std::vector<double>& out, const Values& values)
{
    out.insert(out.end(), values.data(), values.data() + Values::rows * Values::cols);
}

/// Output times that the motion has reached.
std::vector<double> sampled_times(const Run& run)
{
    std::vector<double> times;
    for (const double t : run.output)
        if (t >= run.motion.start() && t <= run.motion.end()) times.push_back(t);
    return times;
}

/// One array per variable, filled time by time.
class Samples {
public:
    Samples(const Model& model, const Run& run) : model_(model), motion_(run.motion)
    {
        previous_.resize(model.bodies().size(), Vector4{1, 0, 0, 0});
    }

    void add(double t)
    {
        const std::vector<BodySample> bodies = sample_bodies(model_, motion_, t);
        for (std::size_t b = 0; b < bodies.size(); ++b) add_body(bodies[b], previous_[b]);
        if (motion_.end_multipliers.empty() && motion_.multipliers.empty()) return;
        std::vector<JointSample> joints = sample_joints(model_, motion_, t);
        if (joints.empty()) {   // this instant has no multipliers, others have
            const double nan = std::numeric_limits<double>::quiet_NaN();
            const Reaction none{{nan, nan, nan}, {nan, nan, nan}};
            joints.assign(model_.joints().size(), {none, none, false, false});
        }
        for (const JointSample& joint : joints) {
            append(force, joint.left.force);
            append(force, joint.right.force);
            append(torque, joint.left.torque);
            append(torque, joint.right.torque);
        }
    }

    std::vector<double> position, center_of_mass, directors, directors_raw, quaternion, velocity,
        angular_velocity, angular_velocity_body, linear_momentum, angular_momentum, force, torque;

private:
    void add_body(const BodySample& s, Vector4& previous)
    {
        append(position, s.position);
        append(center_of_mass, s.center_of_mass);
        append(directors, s.directors);
        append(directors_raw, s.directors_raw);
        previous = continued(previous, s.quaternion);
        append(quaternion, previous);
        append(velocity, s.velocity);
        append(angular_velocity, s.angular_velocity);
        append(angular_velocity_body, s.angular_velocity_body);
        append(linear_momentum, s.linear_momentum);
        append(angular_momentum, s.angular_momentum);
    }

    const Model& model_;
    const Motion& motion_;
    std::vector<Vector4> previous_;
};

using Owner = DerivedNumbers;

template <class Number>
void put(NetcdfWriter& file, Owner& owner, const VariableInfo& info, std::vector<Number> values)
{
    if (values.empty()) return;
    auto& kept = std::get<std::deque<std::vector<Number>>>(owner);
    file.variable(info, std::span<const Number>(kept.emplace_back(std::move(values))));
}

void write_samples(NetcdfWriter& file, const Model& model, const Run& run, Owner& owner)
{
    const std::vector<double> times = sampled_times(run);
    if (times.empty()) return;
    Samples s(model, run);
    for (const double t : times) s.add(t);

    file.dimension("time", times.size());
    file.dimension("director", 3);
    file.dimension("quaternion_part", 4);
    put(file, owner,
        {"time", {"time"}, "s", "none", "output times that the motion has reached", {{"axis", "T"}}}, times);
    const std::vector<std::string> vector{"time", "body", "xyz"}, triad{"time", "body", "director", "xyz"},
        parts{"time", "body", "quaternion_part"}, sides{"time", "joint", "side", "xyz"};
    const std::string in = "inertial";
    const std::pair<VariableInfo, std::vector<double>*> variables[] = {
        {{"position", vector, "m", in, "position of the reference point"}, &s.position},
        {{"center_of_mass", vector, "m", in, "position of the centre of mass"}, &s.center_of_mass},
        {{"directors", triad, "1", in, "directors [d1, d2, d3], projected to the nearest orthonormal triad"},
         &s.directors},
        {{"directors_raw", triad, "1", in,
          "directors [d1, d2, d3] of the motion, with their violation of rigidity"},
         &s.directors_raw},
        {{"quaternion", parts, "1", in, "orientation, body to world; sign continuous in time",
          {{"order", "w, x, y, z"}}},
         &s.quaternion},
        {{"velocity", vector, "m s-1", in, "velocity of the reference point"}, &s.velocity},
        {{"angular_velocity", vector, "rad s-1", in, "angular velocity in inertial axes"},
         &s.angular_velocity},
        {{"angular_velocity_body", vector, "rad s-1", "body-fixed", "angular velocity in body axes"},
         &s.angular_velocity_body},
        {{"linear_momentum", vector, "kg m s-1", in, "linear momentum"}, &s.linear_momentum},
        {{"angular_momentum", vector, "kg m2 s-1", in, "angular momentum about the world's origin"},
         &s.angular_momentum},
        {{"reaction_force", sides, "N", in,
          "force of the joint on its second body, from the left and from the right"},
         &s.force},
        {{"reaction_torque", sides, "N m", in,
          "torque of the joint on its second body about its joint point, from the left and from the right"},
         &s.torque}};
    for (const auto& [info, values] : variables) put(file, owner, info, std::move(*values));
}

void write_nodes(NetcdfWriter& file, const char* name, const Field& field, const TimeMesh& mesh, Owner& owner)
{
    if (!field.empty())
        put(file, owner, {name, {name}, "s", "none", "times of the nodes"}, node_times(field, mesh));
}

/// Integrals over each element, as the paper shows them: of the Lagrangian the action, of the Hamiltonian and
/// of the angular momentum what divided by the element's length is their mean.
void write_integrals(NetcdfWriter& file, const Model& model, const Motion& motion, Owner& owner)
{
    if (motion.n_elements() < 1) return;
    const ActionSeries series = action(model, motion);
    file.dimension("element", series.lagrangian.size());
    put(file, owner,
        {"action_integral", {"element"}, "J s", "none", "integral of the Lagrangian T - V over each element"},
        series.lagrangian);
    put(file, owner,
        {"hamiltonian_integral", {"element"}, "J s", "none", "integral of the Hamiltonian over each element"},
        series.hamiltonian);
    const std::span<const double> moments = numbers(series.angular_momentum);
    put(file, owner,
        {"angular_momentum_integral",
         {"element", "xyz"},
         "kg m2",
         "inertial",
         "integral of the angular momentum of all bodies about the origin over each element"},
        std::vector<double>(moments.begin(), moments.end()));
}

/// A run that was read from a file has not kept them.
void write_violations(NetcdfWriter& file, const Model& model, const Run& run, Owner& owner)
{
    const bool is_kept = !run.verdict.violations.joints.empty();
    const ViolationReport at =
        is_kept ? run.verdict.violations : violations(model, run.motion, 0, false);
    if (model.n_rows() > 0)
        put(file, owner,
            {"joint_violation", {"X_node"}, "1", "none", "largest |Phi| / scale of the joints' rows"},
            at.joints);
    const bool has_rigid =
        std::ranges::any_of(model.bodies(), [](const Body& body) { return !body.is_point; });
    if (has_rigid)
        put(file, owner,
            {"rigidity_violation", {"X_node"}, "1", "none", "largest |Phi| of the bodies' rigidity"},
            at.rigidity);
}

void write_model(NetcdfWriter& file, const Model& model, Owner& owner)
{
    std::vector<double> masses;
    std::vector<int> first, second, joint_of_row;
    for (const Body& body : model.bodies()) append(masses, body.mass);
    for (const Joint& joint : model.joints()) {
        first.push_back(joint.first);
        second.push_back(joint.second);
    }
    for (int r = 0; r < model.n_rows(); ++r) joint_of_row.push_back(model.row_joint(r));
    file.dimension("mass_column", 4);
    put(file, owner,
        {"body_mass_matrix",
         {"body", "mass_column", "column"},
         "mixed",
         "body-fixed",
         "mass matrix m = [[M, S^T], [S, E]]",
         {{"column_units", "M: kg, S: kg m, E: kg m2"}}},
        std::move(masses));
    put(file, owner,
        {"joint_first_body", {"joint"}, "1", "none", "first body of the joint, from 0; -1: the world"},
        std::move(first));
    put(file, owner, {"joint_second_body", {"joint"}, "1", "none", "second body of the joint, from 0"},
        std::move(second));
    put(file, owner, {"row_joint", {"row"}, "1", "none", "joint that the constraint row belongs to, from 0"},
        std::move(joint_of_row));
}

std::string manifest(const Run& run)
{
    const SolveReport& report = run.report;
    const bool has_options = run.resolved.starts_with('{');
    JsonWriter json(2);
    json.begin_object();
    json.member("livens_version", run.version);
    json.key("format").begin_array().value(format_major).value(format_minor).end_array();
    json.member("method", run.method);
    json.key("options").raw(has_options ? run.resolved : "null");
    json.key("convergence").begin_object();
    json.member("status", to_string(report.status)).member("blocks", report.iterations.size());
    json.member("newton_iterations", report.newton_iterations)
        .member("most_iterations", report.most_iterations);
    json.member("factorisations", report.factorisations).member("residual_norm", report.residual_norm);
    json.member("smallest_pivot", report.smallest_pivot).end_object();
    json.key("orders").begin_object();
    json.member("element_ends", run.motion.order_at_ends).member("between_X", run.motion.dense_order_X);
    json.member("between_V", run.motion.dense_order_V).end_object();
    json.end_object();
    return json.text();
}

}   // namespace

void write_derived(NetcdfWriter& file, const Model& model, const Run& run, Owner& owner)
{
    const Motion& m = run.motion;
    write_nodes(file, "X_node", m.X, m.mesh, owner);
    write_nodes(file, "P_node", m.P, m.mesh, owner);
    write_nodes(file, "multiplier_node", m.multipliers, m.mesh, owner);
    write_nodes(file, "rigidity_node", m.rigidity, m.mesh, owner);
    write_integrals(file, model, m, owner);
    write_violations(file, model, run, owner);
    write_model(file, model, owner);
    write_samples(file, model, run, owner);
    const std::string text = manifest(run);
    file.dimension("manifest_length", text.size());
    file.text_variable(
        {"manifest", {"manifest_length"}, "1", "none", "versions, options, convergence (JSON)"}, text);
}

}   // namespace livens
