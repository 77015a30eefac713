// SPDX-License-Identifier: BSD-3-Clause
// livens sample: a body, a joint or a sensor of a run at any instant.
#include <algorithm>
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
#include "livens/io/shown_unit.h"
#include "livens/spacetime/solve.h"
#include "rigidity_members.h"
#include "sample_query.h"
#include "simd.h"

namespace livens::program {

namespace {

/// Of the body or joint that is asked for; of sensors there is none.
int index_of(const SampleArguments& arguments, const Run& run, const Model& model)
{
    if (!arguments.sensor.empty()) return 0;
    const bool is_body = arguments.joint.empty();
    const std::vector<std::string> names = is_body ? run.told_bodies() : run.joint_names;
    const std::string& name = is_body ? arguments.body : arguments.joint;
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw no_such(is_body ? "body" : "joint", name, model);
    return static_cast<int>(found - names.begin());
}

template <int Rows>
void add(JsonWriter& json, const char* key, const Matrix<Rows, 1>& v)
{
    json.key(key).value(std::span<const double>(v.a));
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
    const BodyAcceleration a = acceleration_at(q, t);
    add(json, "acceleration", a.linear);
    json.key("angular_acceleration");
    if (is_point)
        json.null();
    else
        json.value(std::span<const double>(a.angular.a));
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

const char* source_of(const Query& q, const JointSample& s, double t)
{
    const bool is_end = element_end_at(q.run.motion.mesh, t) >= 0;
    if (q.arguments.exact && !is_end) return "solved";
    if (!s.is_acceleration_level) return "interpolated multipliers";
    return is_end ? "acceleration level" : "polynomial";
}

/// The reaction along the axes of each body that has some.
void in_axes_members(JsonWriter& json, const Query& q, const Reaction& r, double t)
{
    const Model& model = q.scenario.model;
    const Joint& joint = model.joints()[static_cast<std::size_t>(q.index)];
    const State state = state_at(q, t);
    for (const auto& [key, v] : {std::pair{"force_in", r.force}, {"torque_in", r.torque}}) {
        json.key(key).begin_object();
        for (const int body : {joint.first, joint.second})
            if (body != world && !model.bodies()[static_cast<std::size_t>(body)].is_point)
                add(json, model.body_name(body).c_str(),
                    transpose(project_directors(directors(state.X[static_cast<std::size_t>(body)]))) * v);
        json.end_object();
    }
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
    in_axes_members(json, q, s.right, t);
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

}   // namespace

int sample_command(const SampleArguments& arguments, const Common& common)
{
    const bool is_of_sensor = !arguments.sensor.empty();
    if (is_of_sensor + !arguments.body.empty() + !arguments.joint.empty() != 1)
        throw failure(exit_usage, "sample needs one of --body NAME, --joint NAME and --sensor NAME");
    if (arguments.exact) pin_instructions("");
    const Run run = read_run(arguments.run);
    const Scenario scenario = scenario_of_run(run, arguments.run);
    Query query{arguments, run, scenario, index_of(arguments, run, scenario.model), {}};
    std::vector<double> times;
    for (const std::string& text : arguments.at) times.push_back(instant_inside(text, run.motion));
    if (!arguments.joint.empty()) query.coordinates.emplace(scenario.model, run.motion);
    if (!run.report.converged())
        say_warning(std::string("the run is not converged: ") + to_string(run.report.status));
    if (!arguments.units.empty() && common.json)
        throw failure(exit_usage, "--unit is for text and CSV; JSON is in SI units");
    if (!is_of_sensor && !arguments.units.empty())
        as_usage([&] { check_shown_units(arguments.units, units_shown(query)); });
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
