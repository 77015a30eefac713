#include <algorithm>
#include <limits>
#include <span>

#include "livens/io/detail/results_layout.h"
#include "livens/io/json.h"
#include "livens/io/sample.h"
#include "livens/time/quadrature.h"

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
            joints.assign(model_.joints().size(), {none, none, false});
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
        // q and -q are one orientation; the sign that continues the motion is the one that can be
        // interpolated.
        const Vector4 q = dot(previous, s.quaternion) < 0 ? -1.0 * s.quaternion : s.quaternion;
        append(quaternion, q);
        previous = q;
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

void put(NetcdfWriter& file, Owner& owner, const VariableInfo& info, std::vector<double> values)
{
    if (values.empty()) return;
    owner.doubles.push_back(std::move(values));
    file.variable(info, std::span<const double>(owner.doubles.back()));
}

void put(NetcdfWriter& file, Owner& owner, const VariableInfo& info, std::vector<int> values)
{
    if (values.empty()) return;
    owner.ints.push_back(std::move(values));
    file.variable(info, std::span<const int>(owner.ints.back()));
}

void write_orientations(NetcdfWriter& file, Samples& s, Owner& owner)
{
    file.dimension("director", 3);
    file.dimension("quaternion_part", 4);
    put(file, owner,
        {"directors",
         {"time", "body", "director", "xyz"},
         "1",
         "inertial",
         "directors [d1, d2, d3], projected to the nearest orthonormal triad"},
        std::move(s.directors));
    put(file, owner,
        {"directors_raw",
         {"time", "body", "director", "xyz"},
         "1",
         "inertial",
         "directors [d1, d2, d3] of the motion, with their violation of rigidity"},
        std::move(s.directors_raw));
    put(file, owner,
        {"quaternion",
         {"time", "body", "quaternion_part"},
         "1",
         "inertial",
         "orientation, body to world; sign continuous in time",
         {{"order", "w, x, y, z"}}},
        std::move(s.quaternion));
}

void write_reactions(NetcdfWriter& file, Samples& s, Owner& owner)
{
    put(file, owner,
        {"reaction_force",
         {"time", "joint", "side", "xyz"},
         "N",
         "inertial",
         "force of the joint on its second body, from the left and from the right"},
        std::move(s.force));
    put(file, owner,
        {"reaction_torque",
         {"time", "joint", "side", "xyz"},
         "N m",
         "inertial",
         "torque of the joint on its second body about its joint point, from the left and from the right"},
        std::move(s.torque));
}

void write_samples(NetcdfWriter& file, const Model& model, const Run& run, Owner& owner)
{
    const std::vector<double> times = sampled_times(run);
    if (times.empty()) return;
    Samples s(model, run);
    for (const double t : times) s.add(t);

    const auto vectors = [&](const char* name, const char* units, const char* frame, const char* long_name,
                             std::vector<double>& values) {
        put(file, owner, {name, {"time", "body", "xyz"}, units, frame, long_name}, std::move(values));
    };
    file.dimension("time", times.size());
    put(file, owner,
        {"time", {"time"}, "s", "none", "output times that the motion has reached", {{"axis", "T"}}}, times);
    vectors("position", "m", "inertial", "position of the reference point", s.position);
    vectors("center_of_mass", "m", "inertial", "position of the centre of mass", s.center_of_mass);
    write_orientations(file, s, owner);
    vectors("velocity", "m s-1", "inertial", "velocity of the reference point", s.velocity);
    vectors("angular_velocity", "rad s-1", "inertial", "angular velocity in inertial axes",
            s.angular_velocity);
    vectors("angular_velocity_body", "rad s-1", "body-fixed", "angular velocity in body axes",
            s.angular_velocity_body);
    vectors("linear_momentum", "kg m s-1", "inertial", "linear momentum", s.linear_momentum);
    vectors("angular_momentum", "kg m2 s-1", "inertial", "angular momentum about the world's origin",
            s.angular_momentum);
    write_reactions(file, s, owner);
}

/// Times of a field's coefficients; with degree 0 the middles of the elements.
std::vector<double> node_times(const Field& field, const TimeMesh& mesh)
{
    const std::vector<double> s =
        field.degree == 0 ? std::vector<double>{0.5} : gauss_lobatto(field.degree + 1).points;
    std::vector<double> times;
    for (int e = 0; e < mesh.n_elements(); ++e) {
        const std::size_t n = field.continuous ? s.size() - 1 : s.size();
        for (std::size_t a = 0; a < n; ++a)
            times.push_back(a + 1 == s.size() && a > 0 ? mesh.ends[e + 1]
                                                       : mesh.ends[e] + s[a] * mesh.length(e));
    }
    if (field.continuous) times.push_back(mesh.end());
    return times;
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
    json.member("method", run.summary.method);
    json.key("options").raw(has_options ? run.resolved : "null");
    json.key("convergence").begin_object();
    json.member("status", run.summary.status).member("blocks", report.iterations.size());
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
    write_violations(file, model, m, owner);
    write_model(file, model, owner);
    write_samples(file, model, run, owner);
    const std::string text = manifest(run);
    file.dimension("manifest_length", text.size());
    file.text_variable(
        {"manifest", {"manifest_length"}, "1", "none", "versions, options, convergence (JSON)"}, text);
}

}   // namespace livens
