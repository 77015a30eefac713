// SPDX-License-Identifier: BSD-3-Clause
// States of rest, by steps that go with the forces in every principal direction, within a trust radius and as
// long as forces do at least 0.05 of the foretold work: theory.md, "Equilibrium".
#include "livens/statics/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/start/singular.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"
#include "livens/statics/rest_search.h"
#include "livens/statics/rest_with_states.h"

namespace livens {

namespace {

constexpr double balance_tolerance = 1e-10;   // residual from which on only Newton's steps polish
constexpr double smallest_step = 1e-13;
constexpr int most_unrestored = 25;   // steps in a row that nothing opposes

/// Coordinates that nothing restores, and in which nothing pulls: they stay.
bool is_idle(const RestPoint& point, std::size_t i)
{
    return std::abs(point.stiffness[i]) <= 1e-11 * point.scale &&
           std::abs(point.forces[i]) <= balance_tolerance * point.statics->level;
}

/// With the force over |k| + mu, or for mu < 0 Newton's own step.
Values damped_step(const RestPoint& point, double mu)
{
    const double least = std::max(1e-14 * point.scale, 1e-12 * largest_size(point.forces));
    Values divisor(point.stiffness.size()), forces = point.forces;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const double k = point.stiffness[i], size = std::max(std::abs(k), least);
        divisor[i] = mu < 0 ? std::copysign(size, k) : size + mu;
        if (is_idle(point, i)) {
            forces[i] = 0;
            divisor[i] = 1;
        }
    }
    if (point.skew.is_empty()) {
        for (std::size_t i = 0; i < forces.size(); ++i) forces[i] /= divisor[i];
        return forces;
    }
    DenseMatrix tangent = point.skew;
    for (int i = 0; i < tangent.rows; ++i) tangent(i, i) += divisor[i];
    return lu_solution(tangent, forces).x;
}

/// The step with the least mu that is not longer than the radius. A shorter one goes on to the radius in the
/// coordinates of negative stiffness: the way out of an unstable equilibrium is long.
Values step_within(const RestSearch& search, const RestPoint& point, double radius)
{
    Values step = damped_step(point, 0);
    const double whole = search.size_of(point, step);
    if (whole <= radius) {
        Values outwards = step;
        for (std::size_t i = 0; i < step.size(); ++i)
            if (!(point.stiffness[i] < -1e-11 * point.scale)) outwards[i] = 0;
        const double size = search.size_of(point, outwards);
        if (size > 0) add_scaled(step, (radius - whole) / size, outwards);
        return step;
    }
    double low = 0, high = 1e-6 * (largest_size(point.stiffness) + largest_size(point.forces));
    for (int i = 0; i < 200; ++i) {
        step = damped_step(point, high);
        if (search.size_of(point, step) <= radius) break;
        low = std::exchange(high, 4 * high);
    }
    for (int i = 0; i < 20; ++i) {
        const double mu = 0.5 * (low + high);
        const Values tried = damped_step(point, mu);
        const double size = search.size_of(point, tried);
        if (size > radius) {
            low = mu;
            continue;
        }
        high = mu;
        step = tried;
        if (size > 0.8 * radius) break;
    }
    return step;
}

/// Whether most of what pulls does so where nothing restores.
bool is_unrestored(const RestPoint& point)
{
    double unrestored = 0;
    for (std::size_t i = 0; i < point.forces.size(); ++i)
        if (std::abs(point.stiffness[i]) <= 1e-9 * point.scale)
            unrestored += point.forces[i] * point.forces[i];
    return unrestored > 0.25 * squared_norm(point.forces);
}

/// Down the work of the forces to where they are balanced.
Outcome descend(RestSearch& search, const EquilibriumOptions& options, RestPoint& here, int& iterations)
{
    double radius = largest_step;
    int n_unrestored = 0;
    search.add_stiffness(here);
    while (here.residual() > balance_tolerance) {
        if (options.goes_on && !options.goes_on()) return Outcome::cancelled;
        if (iterations == options.max_iterations) return Outcome::limit;
        if (radius < smallest_step) return Outcome::stuck;
        ++iterations;
        const Values step = step_within(search, here, radius);
        const double size = search.size_of(here, step);
        Values restored = step;
        for (std::size_t i = 0; i < step.size(); ++i) restored[i] *= here.stiffness[i];
        const double foretold = dot(step, here.forces) - 0.5 * dot(step, restored);
        RestPoint there;
        std::vector<Matrix34> X;
        const bool is_there = search.move(here, step, X) && search.look(std::move(X), there);
        const double share = is_there ? search.work(here, there, step, size) / foretold : -1;
        if (!(share > 0.05)) {
            radius = 0.25 * size;
            continue;
        }
        n_unrestored = is_unrestored(here) ? n_unrestored + 1 : 0;
        here = std::move(there);
        search.add_stiffness(here);
        if (n_unrestored == most_unrestored) return Outcome::unrestored;
        radius = share < 0.25  ? 0.5 * size
                 : share > 0.7 ? std::min(largest_step, 2 * std::max(radius, size))
                               : radius;
    }
    return Outcome::balanced;
}

/// Newton's steps, whatever the signs of the stiffness, as long as they halve the residual.
void polish(RestSearch& search, RestPoint& here, int& iterations)
{
    for (int i = 0; i < 10 && here.residual() > 0; ++i) {
        const Values step = damped_step(here, -1);
        if (!(search.size_of(here, step) < 1e-3)) return;
        RestPoint there;
        std::vector<Matrix34> X;
        if (!search.move(here, step, X) || !search.look(std::move(X), there)) return;
        if (!(there.residual() < 0.5 * here.residual())) return;
        ++iterations;
        here = std::move(there);
        search.add_stiffness(here);
    }
}

std::string why_not(const Model& model, const RestSearch& search, const RestPoint& here, Outcome outcome,
                    const Equilibrium& result)
{
    if (outcome == Outcome::cancelled) return "cancelled";
    if (outcome == Outcome::no_numbers) {
        const int load = search.bad_load(here.X);
        return load < 0 ? "the forces are not finite at the start" : not_finite(model.loads()[load]);
    }
    const std::string body = "body '" + model.body_name(std::max(0, result.worst_body)) + "'";
    const std::string rate = result.angular_acceleration * model.length() > result.acceleration
                                 ? to_text(result.angular_acceleration, 3) + " rad/s^2"
                                 : to_text(result.acceleration, 3) + " m/s^2";
    const std::string still = body + " still accelerates by " + rate;
    switch (outcome) {
    case Outcome::unrestored:
        return still + ", and nothing restores it: hold it by a joint or a spring";
    case Outcome::stuck:
        return still + ", but no step, however short, goes with the forces: start nearer to the equilibrium";
    default:
        return still + " after " + std::to_string(result.iterations) +
               " iterations: there may be no equilibrium, or start nearer to it";
    }
}

void describe_worst(const RestSearch& search, const RestPoint& here, Equilibrium& result)
{
    result.residual = here.residual();
    result.worst_body = here.statics->body;
    if (result.worst_body < 0) return;
    const auto& body = search.tables().bodies[result.worst_body];
    const double* a = search.acceleration().data() + body.first;
    result.acceleration = norm(Vector3{a[0], a[1], a[2]});
    if (body.dofs == 6) result.angular_acceleration = norm(Vector3{a[3], a[4], a[5]});
}

}   // namespace

Equilibrium find_equilibrium(const Model& the_model, const State& start, const EquilibriumOptions& options)
{
    refuse_sampling(the_model);
    const Model model = frozen(the_model, {start.t});
    State at_rest = start;
    for (std::size_t b = 0; b < at_rest.V.size(); ++b)
        if (!model.bodies()[b].holds_states()) at_rest.V[b] = {};
    const ConsistentStart closed = consistent_start(model, at_rest, options.initial);

    Equilibrium result;
    result.state = closed.start;
    result.degrees_of_freedom = closed.degrees_of_freedom;
    result.notes = closed.notes;
    if (model.n_bodies() == 0) {
        result.is_found = true;
        return result;
    }
    RestSearch search(model, closed);
    RestPoint here;
    const bool has_states = std::ranges::any_of(model.bodies(), &Body::holds_states);
    if (has_states) here.held = search.held_at(closed.start);
    Outcome outcome = Outcome::no_numbers;
    if (search.look(closed.start.X, here))
        outcome = has_states ? rest_with_states(search, options, here, result.iterations)
                             : descend(search, options, here, result.iterations);
    if (has_states) result.state.V = search.velocities_of(here.held);
    if (outcome == Outcome::stuck && here.residual() <= equilibrium_tolerance) outcome = Outcome::balanced;
    if (outcome == Outcome::balanced && !has_states) polish(search, here, result.iterations);
    if (outcome != Outcome::no_numbers) search.look(std::vector<Matrix34>(here.X), here);   // once more
    describe_worst(search, here, result);
    result.state.X = here.X;
    result.state.angles = search.state().angles;
    result.coordinates = search.coordinates();
    result.is_found = outcome == Outcome::balanced;
    const UniqueReactions least =
        least_reactions(model, here.X, search.state().multipliers[1], search.tables().independent);
    result.multipliers = least.multipliers;
    result.joint_is_unique = least.joint_is_unique;
    result.shared = least.shared;
    if (!result.is_found) {
        result.message = why_not(model, search, here, outcome, result);
        return result;
    }
    refuse_singular_start(model, consistent_start(model, result.state, StartPolicy::project));
    result.stability = stability(linearise(model, result.state));
    return result;
}

}   // namespace livens
