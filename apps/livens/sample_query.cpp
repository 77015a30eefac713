// SPDX-License-Identifier: BSD-3-Clause
#include "sample_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "exact.h"
#include "livens/multibody/sensors.h"

namespace livens::program {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Not converged: it cannot be had.
ExactSample solved_at(const Query& q, double t)
{
    ExactSample none;
    none.report.status = SolveStatus::not_converged;
    if (std::holds_alternative<Mixed>(q.scenario.method)) return none;   // all elements of a block are one
    return sample_exactly(q.scenario.model, q.run.motion, q.scenario.method, t, q.scenario.options);
}

template <class Part>
std::vector<std::string> names_of(const std::vector<Part>& parts)
{
    std::vector<std::string> names;
    for (const Part& part : parts) names.push_back(part.name);
    return names;
}

/// Where the polynomial is what is shown, its own distance from the solution adds to the error of both ends.
bool is_interpolated(const Query& q, double t)
{
    return !q.arguments.exact && element_end_at(q.run.motion.mesh, t) < 0;
}

}   // namespace

Model with_all_readings(const Model& model)
{
    Model all = model;
    const auto has = [&](const std::string& name) {
        return std::ranges::find(all.sensors(), name, &Sensor::name) != all.sensors().end();
    };
    for (const NamedPoint& point : model.points())
        if (point.body != world && !has(point.name))
            all.add_sensor(point_sensor(point.name, point.body, point.position, model.start().X));
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l)
        if (const Load& load = model.loads()[static_cast<std::size_t>(l)];
            load.type != controller_type && !has(load.name))
            all.add_sensor(load_sensor(load.name, l, load));
    return all;
}

Failure no_such(std::string_view kind, const std::string& name, const Model& model)
{
    std::vector<Body> bodies = model.bodies();
    std::erase_if(bodies, [](const Body& body) { return body.holds_states(); });
    const std::pair<std::string_view, std::vector<std::string>> kinds[] = {
        {"body", names_of(bodies)},
        {"joint", names_of(model.joints())},
        {"sensor", names_of(with_all_readings(model).sensors())}};
    std::string known;
    for (const auto& [other, names] : kinds) {
        if (other != kind && std::ranges::find(names, name) != names.end())
            return failure(exit_usage,
                           fmt::format("the run has no {} '{}': it is asked for by --{}", kind, name, other));
        for (std::size_t i = 0; other == kind && i < names.size() && i < 20; ++i)
            known += (i > 0 ? ", '" : "'") + names[i] + "'";
    }
    if (kind == "sensor" && model.find_point(name) >= 0)
        return failure(exit_usage, fmt::format("'{}' is a point of the world, which stands still", name));
    return failure(exit_usage, fmt::format("the run has no {} '{}'; it has {}", kind, name,
                                           known.empty() ? "none" : known));
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

std::optional<bool> beyond_horizon(const Query& q, double t)
{
    if (std::isnan(q.run.verdict.growth)) return {};
    return q.run.verdict.is_beyond_horizon(t);
}

BodyAcceleration acceleration_at(const Query& q, double t)
{
    const AcceleratedState at = accelerated_at(q.run, q.scenario, t, q.arguments.exact);
    const bool is_point = q.scenario.model.bodies()[q.index].is_point;
    return {at.A[q.index].column(0), is_point ? Vector3{unknown, unknown, unknown}
                                              : angular_acceleration(at.X[q.index], at.A[q.index])};
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

State state_at(const Query& q, double t)
{
    return q.arguments.exact ? exact_sample(q.run, q.scenario, t).state : sample_state(q.run.motion, t);
}

std::vector<CoordinateAt> coordinates_at(const Query& q, double t)
{
    std::vector<CoordinateAt> all;
    const State given = state_at(q, t);
    const Accelerations accelerations(q.scenario.model, q.run.motion);
    const AcceleratedState at = accelerations.at(given);
    const std::vector<CoordinateValue> values = q.coordinates->at(accelerations.on_joints(given), &at);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (q.coordinates->places()[i].joint == q.index) {
            const NamedCoordinate& of = q.coordinates->coordinate(static_cast<int>(i));
            all.push_back({of.name, &of.coordinate, values[i]});
        }
    return all;
}

}   // namespace livens::program
