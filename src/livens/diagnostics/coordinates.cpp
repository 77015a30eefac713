// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of joints, sensors and loads along a motion, with unwrapped angles: theory.md, "Coordinates of
// joints". Turns are counted from node to node, which no accepted element passes by half a turn.
#include "livens/diagnostics/coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/diagnostics/accelerations.h"
#include "livens/diagnostics/detail/sparse_form.h"
#include "livens/diagnostics/sample.h"
#include "livens/solvers/patience.h"

namespace livens {

namespace {

/// Of what positions do not tell: see is_known().
constexpr double unknown_coordinate = std::numeric_limits<double>::quiet_NaN();

std::vector<Matrix34> configurations(const Motion& motion, int element, int node)
{
    const std::span<const double> X = motion.X.coefficient(element, node);
    std::vector<Matrix34> all(static_cast<std::size_t>(motion.n_bodies));
    for (std::size_t b = 0; b < all.size(); ++b) std::copy_n(X.begin() + 12 * b, 12, all[b].data());
    return all;
}

}   // namespace

FollowedCoordinates::FollowedCoordinates(const Model& model, const Motion& motion,
                                         std::vector<NamedCoordinate> coordinates)
    : motion_(motion), coordinates_(std::move(coordinates))
{
    if (coordinates_.empty()) return;
    std::vector<Matrix34> stated;
    for (const Body& body : model.bodies()) stated.push_back(body.X);
    std::vector<SparseCoordinate> sparse;
    for (const NamedCoordinate& q : coordinates_) sparse.emplace_back(q.coordinate, stated.data()->data());
    sparse_ = std::make_shared<const std::vector<SparseCoordinate>>(std::move(sparse));
    // The start may stand turns away from the stated bodies; the turn nearest to zero is taken there.
    std::vector<double> now(coordinates_.size(), 0.0);
    turn(sample_state(motion, motion.start()).X.data()->data(), now);
    at_ends_.reserve(now.size() * motion.mesh.ends.size());
    at_ends_ = now;
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        for (int node = 1; node <= motion.X.degree; ++node)
            // Every node is visited once; element ends are kept, so that a sample looks at one element alone.
            turn(motion.X.coefficient(e, node).data(), now);
        at_ends_.insert(at_ends_.end(), now.begin(), now.end());
    }
}

/// Coordinates less those of the bodies as stated: turns are whole, so that rounding does not gather.
void FollowedCoordinates::turn(const double* X, std::span<double> near) const
{
    for (std::size_t i = 0; i < near.size(); ++i) {
        const SparseCoordinate& q = (*sparse_)[i];
        const double value = q.change(X);
        near[i] = q.counts_turns() ? turned_to(value, near[i]) : value;
    }
}

std::vector<CoordinateValue> FollowedCoordinates::at(const State& state,
                                                     const AcceleratedState* accelerated) const
{
    const std::size_t n = coordinates_.size();
    std::vector<CoordinateValue> all(n);
    if (n == 0) return all;
    const int end = element_end_at(motion_.mesh, state.t);
    std::span<const double> ends(at_ends_);
    std::vector<double> values;
    if (end >= 0) {
        const std::span<const double> here = ends.subspan(static_cast<std::size_t>(end) * n, n);
        values.assign(here.begin(), here.end());
    } else {
        const int element = motion_.mesh.element_at(state.t);
        const std::vector<double> nodes = motion_.X.basis().nodes();
        const double s = (state.t - motion_.mesh.ends[element]) / motion_.mesh.length(element);
        const std::span<const double> begin = ends.subspan(static_cast<std::size_t>(element) * n, n);
        // Inside an element the nodes before the instant are passed, so that its own turn is within half a
        // turn of the last one.
        values.assign(begin.begin(), begin.end());
        for (int node = 1; node <= motion_.X.degree && nodes[node] <= s; ++node)
            turn(motion_.X.coefficient(element, node).data(), values);
        turn(state.X.data()->data(), values);
    }
    const double *const X = state.X.data()->data(), *const V = state.V.data()->data();
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_known = (*sparse_)[i].is_known(X);
        all[i] = {is_known ? coordinates_[i].at_stated + values[i] : unknown_coordinate,
                  (*sparse_)[i].rate(X, V)};
        if (accelerated != nullptr)
            all[i].acceleration = (*sparse_)[i].acceleration(
                accelerated->X.data()->data(), accelerated->V.data()->data(), accelerated->A.data()->data());
    }
    return all;
}

namespace {

std::vector<JointCoordinates::Place> places_of(const Model& model)
{
    std::vector<JointCoordinates::Place> places;
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
        for (int k = 0; k < static_cast<int>(model.joints()[j].coordinates.size()); ++k)
            places.push_back({j, k});
    return places;
}

std::vector<NamedCoordinate> all_coordinates(const Model& model)
{
    std::vector<NamedCoordinate> all;
    for (const Joint& joint : model.joints())
        all.insert(all.end(), joint.coordinates.begin(), joint.coordinates.end());
    return all;
}

}   // namespace

JointCoordinates::JointCoordinates(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), places_(places_of(model)),
      followed_(model, motion, all_coordinates(model))
{}

const NamedCoordinate& JointCoordinates::coordinate(int i) const
{
    return model_.joints()[places_[i].joint].coordinates[places_[i].coordinate];
}

std::vector<CoordinateValue> JointCoordinates::at(double t) const
{
    return places_.empty() ? std::vector<CoordinateValue>() : at(sample_state(motion_, t));
}

std::vector<CoordinateValue> JointCoordinates::at(const State& state,
                                                  const AcceleratedState* accelerated) const
{
    return places_.empty() ? std::vector<CoordinateValue>() : followed_.at(state, accelerated);
}

namespace {

std::vector<NamedCoordinate> sensed_coordinates(const Model& model)
{
    std::vector<NamedCoordinate> all;
    for (const Sensor& sensor : model.sensors())
        for (const SensorComponent& component : sensor.components)
            if (!component.coordinate.coordinate.forms.empty()) all.push_back(component.coordinate);
    return all;
}

void append_load(const Load& load, const State& state, Side side, std::span<const double> angles,
                 std::vector<double>& values)
{
    const LoadArguments arguments = load_arguments(load, {state.t, side}, state.X, state.V, angles);
    for (const LoadReading& reading : load.readings) values.push_back(reading.value(arguments));
    // Of a controller nothing but its numbers, if it has some.
    if (load.type != controller_type || load.readings.empty()) values.push_back(load_power(load, arguments));
}

void append_energy(const Model& model, int b, const State& state, std::vector<double>& values)
{
    const Body& body = model.bodies()[b];
    values.push_back(0.5 * dot(state.V[b] * body.mass, state.V[b]));
    // Weight is constant, so its potential is linear in X: -tr(F X^T).
    values.push_back(-dot(weight(body, model.gravity()), state.X[b]));
}

}   // namespace

LoadTurns::LoadTurns(const Model& model, const Motion& motion) : motion_(motion), turns_(model)
{
    if (turns_.empty()) return;
    // Turns are counted from node to node, as the march counts them; of a part of a motion from where it
    // begins.
    std::vector<double> now = motion.at_end(0).angles;
    if (now.size() != turns_.size()) now = turns_.begin();
    turns_.follow(sample_state(motion, motion.start()).X, now);
    at_ends_ = now;
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        for (int node = 1; node <= motion.X.degree; ++node)
            turns_.follow(configurations(motion, e, node), now);
        at_ends_.insert(at_ends_.end(), now.begin(), now.end());
    }
}

std::vector<double> LoadTurns::at_end(int end) const
{
    const std::size_t n = turns_.size();
    const auto first = at_ends_.begin() + static_cast<std::ptrdiff_t>(n) * end;
    return {first, first + static_cast<std::ptrdiff_t>(n)};
}

std::vector<double> LoadTurns::at(const State& state) const
{
    if (turns_.empty()) return {};
    const int end = element_end_at(motion_.mesh, state.t);
    if (end >= 0) return at_end(end);
    const int element = motion_.mesh.element_at(state.t);
    std::vector<double> now = at_end(element);
    const std::vector<double> nodes = motion_.X.basis().nodes();
    const double s = (state.t - motion_.mesh.ends[element]) / motion_.mesh.length(element);
    for (int node = 1; node <= motion_.X.degree && nodes[node] <= s; ++node)
        turns_.follow(configurations(motion_, element, node), now);
    turns_.follow(state.X, now);
    return now;
}

SensorReadings::SensorReadings(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), followed_(model, motion, sensed_coordinates(model)),
      accelerations_(std::make_shared<const Accelerations>(model, motion)), turns_(model, motion)
{
    for (const Sensor& sensor : model.sensors())
        has_accelerations_ |= std::ranges::any_of(sensor.components, &SensorComponent::is_acceleration);
}

std::vector<double> SensorReadings::at(double t, Side side) const
{
    return at(sample_state(motion_, t), side);
}

std::vector<double> SensorReadings::at(const State& given, Side side) const
{
    AcceleratedState accelerated;
    if (has_accelerations_) accelerated = accelerations_->at(given, side);
    const State state = accelerations_->on_joints(given);
    const std::vector<CoordinateValue> coordinates =
        followed_.at(state, has_accelerations_ ? &accelerated : nullptr);
    const std::vector<double> angles = turns_.at(state);
    std::vector<double> all;
    std::size_t next = 0;
    for (const Sensor& sensor : model_.sensors()) {
        if (sensor.load >= 0)
            append_load(model_.loads()[sensor.load], state, side, turns_.turns().of(sensor.load, angles),
                        all);
        else if (sensor.body >= 0)
            append_energy(model_, sensor.body, state, all);
        else
            for (const SensorComponent& component : sensor.components) {
                const CoordinateValue& q = coordinates[next++];
                all.push_back(component.is_acceleration() ? q.acceleration
                              : component.is_rate()       ? q.rate
                                                          : q.value);
            }
    }
    return all;
}

namespace {

/// The first node beyond half a turn; infinite: none is.
double first_half_turn(const JointCoordinate& q, const Motion& motion)
{
    std::vector<Matrix34> X = sample_state(motion, motion.start()).X;
    double turned = coordinate_value(q, X);
    const std::vector<double> nodes = motion.X.basis().nodes();
    for (int e = 0; e < motion.n_elements(); ++e)
        for (int node = 1; node <= motion.X.degree; ++node) {
            Patience::ask();
            const std::vector<Matrix34> next = configurations(motion, e, node);
            turned += coordinate_change(q, X, next);
            X = next;
            // Beyond half a turn a family that does not count takes the angle for another one.
            if (std::abs(turned) >= std::numbers::pi)
                return motion.mesh.ends[e] + nodes[node] * motion.mesh.length(e);
        }
    return std::numeric_limits<double>::infinity();
}

}   // namespace

LostTurn find_lost_turn(const Model& model, const Motion& motion)
{
    LostTurn found;
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l) {
        for (const JointCoordinate& q : model.loads()[l].angles) {
            const double t = first_half_turn(q, motion);
            if (std::isfinite(t) && (found.load < 0 || t < found.t)) found = {l, t};
        }
    }
    return found;
}

}   // namespace livens
