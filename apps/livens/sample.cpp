// SPDX-License-Identifier: BSD-3-Clause
// livens sample: a body, a joint or a sensor of a run at any instant.
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "exact.h"
#include "failure.h"
#include "livens/base/error.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/results.h"
#include "livens/spacetime/solve.h"
#include "rigidity_members.h"
#include "simd.h"

namespace livens::program {

namespace {

int index_of(const std::vector<std::string>& names, const std::string& name, const char* kind)
{
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<int>(i);
    std::string known;
    for (std::size_t i = 0; i < names.size() && i < 20; ++i) known += (i > 0 ? ", '" : "'") + names[i] + "'";
    throw failure(exit_usage, fmt::format("the run has no {} '{}'; it has {}", kind, name,
                                          known.empty() ? "none" : known));
}

template <int Rows>
void add(JsonWriter& json, const char* key, const Matrix<Rows, 1>& v)
{
    json.key(key).value(std::span<const double>(v.a));
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Query {
    const SampleArguments& arguments;
    const Run& run;
    const Scenario& scenario;
    int index;                                     ///< of the body or joint
    std::optional<JointCoordinates> coordinates;   ///< of a joint
};

/// Not converged: it cannot be had.
ExactSample solved_at(const Query& q, double t)
{
    ExactSample none;
    none.report.status = SolveStatus::not_converged;
    if (std::holds_alternative<Mixed>(q.scenario.method)) return none;   // all elements of a block are one
    return sample_exactly(q.scenario.model, q.run.motion, q.scenario.method, t, q.scenario.options);
}

BodySample body_at(const Query& q, double t)
{
    if (!q.arguments.exact)
        return sample_bodies(q.scenario.model, q.run.motion, t)[static_cast<std::size_t>(q.index)];
    const ExactSample exact = exact_sample(q.run, q.scenario, t);
    const Body& body = q.scenario.model.bodies()[q.index];
    const Matrix34 &X = exact.state.X[q.index], &V = exact.state.V[q.index];
    return sample_body(body, X, V, V * body.mass);
}

/// Where the polynomial is what is shown, its own distance from the solution adds to the error of both ends.
bool is_interpolated(const Query& q, double t)
{
    return !q.arguments.exact && element_end_at(q.run.motion.mesh, t) < 0;
}

/// nan where there is no estimate.
BodyGap body_error(const Query& q, double t)
{
    const ErrorEstimate& e = q.run.estimate;
    const auto at = [&](const std::vector<double>& errors) {
        return ErrorEstimate::at(errors, e.n_bodies, q.index, q.run.motion.mesh, t);
    };
    BodyGap error{at(e.position), at(e.orientation), at(e.velocity)};
    if (e.empty() || !is_interpolated(q, t)) return error;
    const ExactSample exact = solved_at(q, t);
    if (!exact.report.converged()) return {unknown, unknown, unknown};
    const BodyGap gap = gap_between(sample_state(q.run.motion, t), exact.state,
                                    q.scenario.model.bodies()[q.index], q.index, e.length);
    return {error.position + gap.position, error.orientation + gap.orientation,
            error.velocity + gap.velocity};
}

/// Known where the growth of perturbations is.
std::optional<bool> beyond_horizon(const Query& q, double t)
{
    if (std::isnan(q.run.verdict.growth)) return {};
    return q.run.verdict.is_beyond_horizon(t);
}

void horizon_member(JsonWriter& json, const Query& q, double t)
{
    json.key("beyond_horizon");
    if (const std::optional<bool> is_beyond = beyond_horizon(q, t))
        json.value(*is_beyond);
    else
        json.null();
}

RigiditySample rigidity_at(const Query& q, double t)
{
    const std::size_t body = static_cast<std::size_t>(q.index);
    const Model& model = q.scenario.model;
    const Rigidity rigidity(model, q.run.motion);
    return (q.arguments.exact ? rigidity.at(exact_sample(q.run, q.scenario, t).state) : rigidity.at(t))[body];
}

void body_members(JsonWriter& json, const Query& q, double t)
{
    const BodySample s = body_at(q, t);
    json.member("t", t);
    add(json, "position", s.position);
    add(json, "center_of_mass", s.center_of_mass);
    if (q.scenario.model.bodies()[q.index].is_point) {
        for (const char* key : {"directors", "directors_raw", "quaternion"}) json.key(key).null();
        add(json, "velocity", s.velocity);
        for (const char* key : {"angular_velocity", "angular_velocity_body"}) json.key(key).null();
    } else {
        add_triad(json, "directors", s.directors);
        add_triad(json, "directors_raw", s.directors_raw);
        add(json, "quaternion", s.quaternion);
        add(json, "velocity", s.velocity);
        add(json, "angular_velocity", s.angular_velocity);
        add(json, "angular_velocity_body", s.angular_velocity_body);
    }
    const bool is_point = q.scenario.model.bodies()[q.index].is_point;
    const AcceleratedState at = accelerated_at(q.run, q.scenario, t, q.arguments.exact);
    add(json, "acceleration", at.A[q.index].column(0));
    json.key("angular_acceleration");
    if (is_point)
        json.null();
    else
        json.value(std::span<const double>(angular_acceleration(at.X[q.index], at.A[q.index]).a));
    add(json, "linear_momentum", s.linear_momentum);
    add(json, "angular_momentum", s.angular_momentum);
    if (is_point)
        for (const char* key : {"rigidity", "mean_stress"}) json.key(key).null();
    else
        rigidity_members(json, q.scenario.model.bodies()[q.index], rigidity_at(q, t));
    const BodyGap error = body_error(q, t);
    json.member("estimated_position_error", error.position);
    json.member("estimated_orientation_error", error.orientation);
    json.member("estimated_velocity_error", error.velocity);
    horizon_member(json, q, t);
    const bool is_end = element_end_at(q.run.motion.mesh, t) >= 0;
    json.member("source", is_end ? "element end" : q.arguments.exact ? "solved" : "polynomial");
}

JointSample joint_at(const Query& q, double t)
{
    const std::vector<JointSample> samples = q.arguments.exact
                                                 ? exact_sample(q.run, q.scenario, t).joints
                                                 : sample_joints(q.scenario.model, q.run.motion, t);
    if (samples.empty())
        throw failure(exit_input_output, "the run has no multipliers, so reactions are not known");
    return samples[static_cast<std::size_t>(q.index)];
}

double joint_error(const Query& q, double t)
{
    const ErrorEstimate& e = q.run.estimate;
    const double error = ErrorEstimate::at(e.reaction, e.n_joints, q.index, q.run.motion.mesh, t);
    if (e.reaction.empty() || !is_interpolated(q, t)) return error;
    const ExactSample exact = solved_at(q, t);
    if (!exact.report.converged() || exact.joints.empty()) return unknown;
    const JointSample here = joint_at(q, t), &there = exact.joints[static_cast<std::size_t>(q.index)];
    return e.largest_reaction > 0 ? error + gap_between(here, there, e.length) / e.largest_reaction : error;
}

const char* source_of(const Query& q, const JointSample& s, double t)
{
    if (q.arguments.exact && element_end_at(q.run.motion.mesh, t) < 0) return "solved";
    return s.is_acceleration_level ? "acceleration level" : "interpolated multipliers";
}

struct CoordinateAt {
    std::string name;
    const JointCoordinate* of;
    CoordinateValue value;
};

/// Those of the joint that is asked for.
std::vector<CoordinateAt> coordinates_at(const Query& q, double t)
{
    std::vector<CoordinateAt> all;
    const bool is_exact = q.arguments.exact;
    const State state = is_exact ? exact_sample(q.run, q.scenario, t).state : sample_state(q.run.motion, t);
    const AcceleratedState at = accelerated_at(q.run, q.scenario, t, is_exact);
    const std::vector<CoordinateValue> values = q.coordinates->at(state, &at);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (q.coordinates->places()[i].joint == q.index) {
            const NamedCoordinate& of = q.coordinates->coordinate(static_cast<int>(i));
            all.push_back({of.name, &of.coordinate, values[i]});
        }
    return all;
}

void joint_members(JsonWriter& json, const Query& q, double t)
{
    const JointSample s = joint_at(q, t);
    json.member("t", t);
    add(json, "force", s.right.force);
    add(json, "torque", s.right.torque);
    const auto side = [&](const char* key, const Reaction& r) {
        json.key(key).begin_object();
        add(json, "force", r.force);
        add(json, "torque", r.torque);
        json.end_object();
    };
    side("left", s.left);
    side("right", s.right);
    json.member("estimated_reaction_error", joint_error(q, t));
    horizon_member(json, q, t);
    json.member("source", source_of(q, s, t));
    json.member("unique", s.is_unique);
    json.member("shared", in_words(s.shared));
    json.member("bounded", s.is_bounded);
    for (const auto& [name, of, value] : coordinates_at(q, t)) {
        json.member(name, value.value);
        json.member(name + "_rate", value.rate);
        json.member(name + "_acceleration", value.acceleration);
    }
}

/// One instant: its members stand at the top; several: a list `samples`.
std::string json_of(const Query& q, const std::vector<double>& times)
{
    const bool is_body = !q.arguments.body.empty();
    const auto members = [&](JsonWriter& json, double t) {
        is_body ? body_members(json, q, t) : joint_members(json, q, t);
    };
    JsonWriter json(2);
    json.begin_object();
    json.member(is_body ? "body" : "joint", is_body ? q.arguments.body : q.arguments.joint);
    json.member("converged", q.run.report.reached_end());
    if (times.size() == 1) {
        members(json, times.front());
    } else {
        json.key("samples").begin_array();
        for (const double t : times) {
            json.begin_object();
            members(json, t);
            json.end_object();
        }
        json.end_array();
    }
    json.end_object();
    return json.text() + "\n";
}

template <int Rows>
void add_row(std::string& out, const char* name, const char* unit, const Matrix<Rows, 1>& v)
{
    out += fmt::format("  {:<22}", name);
    for (const double x : v.a) out += fmt::format(" {:>24}", to_text(x));
    out += fmt::format("  {}\n", unit);
}

std::string text_of(const Query& q, double t)
{
    std::string out = fmt::format("t = {} s\n", to_text(t));
    if (beyond_horizon(q, t).value_or(false))
        out += fmt::format(
            "  (beyond the horizon of {} s: one of many motions, rounding at the start chose it)\n",
            to_text(q.run.verdict.horizon, 4));
    if (q.arguments.body.empty()) {
        const JointSample s = joint_at(q, t);
        if (!s.is_bounded)
            return out +
                   "  (no force or torque: the joints lose rank here, and reactions grow without bound)\n";
        for (const auto& [name, of, value] : coordinates_at(q, t)) {
            const char* const unit = of->is_angle() ? "rad" : "m";
            add_row(out, name.c_str(), unit, Matrix<1, 1>{value.value});
            add_row(out, (name + " rate").c_str(), (std::string(unit) + "/s").c_str(),
                    Matrix<1, 1>{value.rate});
        }
        add_row(out, "force", "N", s.right.force);
        add_row(out, "torque", "N m", s.right.torque);
        if (!(s.left.force == s.right.force && s.left.torque == s.right.torque)) {
            add_row(out, "force before", "N", s.left.force);
            add_row(out, "torque before", "N m", s.left.torque);
        }
        if (!s.is_unique)
            out += "  (not unique: other joints could carry part of " + in_words(s.shared) + ")\n";
        if (const double error = joint_error(q, t) * q.run.estimate.largest_reaction; std::isfinite(error))
            out += fmt::format("  {:<22} {:.1e} N, {:.1e} N m\n", "estimated error", error,
                               error * q.run.estimate.length);
        return out + (s.is_acceleration_level ? "" : "  (interpolated multipliers: between element ends)\n");
    }
    const BodySample s = body_at(q, t);
    add_row(out, "position", "m", s.position);
    add_row(out, "center of mass", "m", s.center_of_mass);
    add_row(out, "velocity", "m/s", s.velocity);
    if (!q.scenario.model.bodies()[q.index].is_point) {
        for (int i = 0; i < 3; ++i)
            add_row(out, i == 0 ? "d1" : i == 1 ? "d2" : "d3", "", s.directors.column(i));
        add_row(out, "quaternion w x y z", "", s.quaternion);
        add_row(out, "angular velocity", "rad/s", s.angular_velocity);
        add_row(out, "  in body axes", "rad/s", s.angular_velocity_body);
    }
    add_row(out, "linear momentum", "N s", s.linear_momentum);
    add_row(out, "angular momentum", "N m s", s.angular_momentum);
    const BodyGap error = body_error(q, t);
    if (std::isfinite(error.position))
        out += fmt::format("  {:<22} {:.1e} m, {:.1e} rad{}\n", "estimated error",
                           error.position * q.run.estimate.length, error.orientation,
                           std::isfinite(error.velocity) ? fmt::format(", {:.1e} m/s", error.velocity) : "");
    return out;
}

template <int Rows>
void add_cells(std::string& line, const Matrix<Rows, 1>& v)
{
    for (const double x : v.a) line += "," + (std::isfinite(x) ? to_text(x) : "");
}

std::string csv_of(const Query& q, const std::vector<double>& times)
{
    const bool is_body = !q.arguments.body.empty();
    std::string out =
        is_body ? "t [s],x [m],y [m],z [m],qw,qx,qy,qz,vx [m/s],vy [m/s],vz [m/s],wx [rad/s],wy [rad/s],"
                  "wz [rad/s],estimated_position_error [1],estimated_orientation_error [rad],"
                  "estimated_velocity_error [m/s],beyond_horizon"
                : "t [s],fx [N],fy [N],fz [N],mx [N m],my [N m],mz [N m],estimated_reaction_error [1],"
                  "beyond_horizon";
    if (!is_body)
        for (const auto& [name, of, value] : coordinates_at(q, times.front()))
            out += fmt::format(",{0} [{1}],{0}_rate [{1}/s]", name, of->is_angle() ? "rad" : "m");
    out += "\r\n";
    for (const double t : times) {
        out += to_text(t);
        if (is_body) {
            const BodySample s = body_at(q, t);
            add_cells(out, s.position);
            add_cells(out, s.quaternion);
            add_cells(out, s.velocity);
            add_cells(out, s.angular_velocity);
            const BodyGap error = body_error(q, t);
            add_cells(out, Vector3{error.position, error.orientation, error.velocity});
        } else {
            const JointSample s = joint_at(q, t);
            add_cells(out, s.right.force);
            add_cells(out, s.right.torque);
            add_cells(out, Matrix<1, 1>{joint_error(q, t)});
        }
        const std::optional<bool> is_beyond = beyond_horizon(q, t);
        out += !is_beyond ? "," : *is_beyond ? ",1" : ",0";
        if (!is_body)
            for (const auto& [name, of, value] : coordinates_at(q, t))
                out += "," + to_text(value.value) + "," + to_text(value.rate);
        out += "\r\n";
    }
    return out;
}

}   // namespace

int sample_command(const SampleArguments& arguments, const Common& common)
{
    const bool is_of_sensor = !arguments.sensor.empty();
    if (is_of_sensor + !arguments.body.empty() + !arguments.joint.empty() != 1)
        throw failure(exit_usage, "sample needs one of --body NAME, --joint NAME and --sensor NAME");
    if (arguments.exact) pin_instructions("");
    const Run run = read_run(arguments.run);
    const int index = is_of_sensor              ? 0
                      : arguments.joint.empty() ? index_of(run.body_names, arguments.body, "body")
                                                : index_of(run.joint_names, arguments.joint, "joint");
    std::vector<double> times;
    for (const std::string& text : arguments.at) times.push_back(instant_inside(text, run.motion));
    const Scenario scenario = scenario_of_run(run, arguments.run);
    Query query{arguments, run, scenario, index, {}};
    if (!arguments.joint.empty()) query.coordinates.emplace(scenario.model, run.motion);
    if (!run.report.converged())
        say_warning(std::string("the run is not converged: ") + to_string(run.report.status));
    if (is_of_sensor) {
        print(sample_sensor(arguments, common, run, scenario, times));
    } else if (common.json) {
        print(json_of(query, times));
    } else if (arguments.csv) {
        print(csv_of(query, times));
    } else {
        std::string text;
        for (const double t : times) text += text_of(query, t);
        print(text);
    }
    return exit_ok;
}

}   // namespace livens::program
