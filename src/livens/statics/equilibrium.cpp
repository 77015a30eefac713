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
#include "livens/dynamics/start/singular.h"
#include "livens/multibody/unwrapped_angles.h"
#include "livens/solvers/factors.h"
#include "livens/statics/equilibrium_search.h"
#include "livens/statics/rest_with_states.h"

namespace livens {

namespace {

using Values = std::vector<double>;

constexpr double balance_tolerance = 1e-10;   // residual from which on only Newton's steps polish
constexpr double smallest_step = 1e-13;
constexpr int most_unrestored = 25;    // steps in a row that nothing opposes
constexpr int most_on_the_way = 400;   // of them where a stop may lie ahead
constexpr double passed = 1e-12;       // of the scale of a stop's row: rounding passes nothing
constexpr double no_way = 1e-9;        // of a step

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
Values step_within(const Search& search, const RestPoint& point, double radius)
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

Values scaled(double factor, const Values& step)
{
    Values all(step.size(), 0.0);
    add_scaled(all, factor, step);
    return all;
}

/// A part of a step, joints closed. False: they do not close, or loads are no numbers.
bool go(Search& search, const RestPoint& here, const Values& step, double part, RestPoint& there)
{
    std::vector<Matrix34> X;
    return search.move(here, scaled(part, step), X) && search.look(std::move(X), there);
}

/// How much of a step there is before it passes an open stop, and which; all of it, where it passes none.
struct FreeWay {
    double part = 1;
    int stop = -1;
};

FreeWay free_way(Search& search, const RestPoint& here, const Values& step)
{
    FreeWay way;
    constexpr int looks = 4;
    RestPoint there;
    double low = 0, high = 0;
    for (int k = 1; k <= looks && way.stop < 0; ++k) {
        low = std::exchange(high, static_cast<double>(k) / looks);
        if (!go(search, here, step, high, there)) return way;
        const Search::Depth deepest = search.deepest();
        if (deepest.stop < 0) return way;
        if (deepest.depth > passed) way.stop = deepest.stop;
    }
    if (way.stop < 0) return way;
    while (high - low > 1e-15) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        const bool is_there = go(search, here, step, middle, there);
        const Search::Depth deepest = search.deepest();
        if (is_there && deepest.depth <= passed) {
            low = middle;
            if (deepest.depth > -passed) break;
        } else {
            high = middle;
            if (is_there) way.stop = deepest.stop;
        }
    }
    way.part = low;
    return way;
}

/// Down the work of the forces to where they are balanced, or a stop is met.
SearchOutcome descend(Search& search, const EquilibriumOptions& options, RestPoint& here, int& iterations,
                      int& met)
{
    double radius = largest_step;
    int n_unrestored = 0;
    const int most = search.deepest().stop < 0 ? most_unrestored : most_on_the_way;
    search.add_stiffness(here);
    while (here.residual() > balance_tolerance) {
        if (options.goes_on && !options.goes_on()) return SearchOutcome::cancelled;
        if (iterations == options.max_iterations) return SearchOutcome::limit;
        if (radius < smallest_step) return SearchOutcome::stuck;
        ++iterations;
        Values step = step_within(search, here, radius);
        const FreeWay way = free_way(search, here, step);
        met = way.stop;
        if (met >= 0 && way.part < no_way) return SearchOutcome::met_stop;
        if (met >= 0) step = scaled(way.part, step);
        const double size = search.size_of(here, step);
        Values restored = step;
        for (std::size_t i = 0; i < step.size(); ++i) restored[i] *= here.stiffness[i];
        const double foretold = dot(step, here.forces) - 0.5 * dot(step, restored);
        RestPoint there;
        const bool is_there = go(search, here, step, 1, there);
        const double share = is_there ? Search::work(here, there, step, size) / foretold : -1;
        if (!(share > 0.05)) {
            radius = 0.25 * size;
            continue;
        }
        n_unrestored = is_unrestored(here) ? n_unrestored + 1 : 0;
        here = std::move(there);
        if (met >= 0) return SearchOutcome::met_stop;
        search.add_stiffness(here);
        if (n_unrestored == most) return SearchOutcome::unrestored;
        radius = share < 0.25  ? 0.5 * size
                 : share > 0.7 ? std::min(largest_step, 2 * std::max(radius, size))
                               : radius;
    }
    return SearchOutcome::balanced;
}

/// Newton's steps, whatever the signs of the stiffness, as long as they halve the residual.
void polish(Search& search, RestPoint& here, int& iterations)
{
    for (int i = 0; i < 10 && here.residual() > 0; ++i) {
        const Values step = damped_step(here, -1);
        if (!(search.size_of(here, step) < 1e-3)) return;
        RestPoint there;
        std::vector<Matrix34> X;
        if (!search.move(here, step, X) || !search.look(std::move(X), there)) return;
        if (!(there.residual() < 0.5 * here.residual()) || search.deepest().depth > passed) return;
        ++iterations;
        here = std::move(there);
        search.add_stiffness(here);
    }
}

std::string why_not(const Model& model, const Search& search, const RestPoint& here, SearchOutcome outcome,
                    const Equilibrium& result)
{
    if (outcome == SearchOutcome::cancelled) return "cancelled";
    if (outcome == SearchOutcome::no_numbers) {
        const int load = search.bad_load(here.X);
        return load < 0 ? "the forces are not finite at the start" : not_finite(model.loads()[load]);
    }
    const std::string body = "body '" + model.body_name(std::max(0, result.worst_body)) + "'";
    const std::string rate = result.angular_acceleration * model.length() > result.acceleration
                                 ? to_text(result.angular_acceleration, 3) + " rad/s^2"
                                 : to_text(result.acceleration, 3) + " m/s^2";
    const std::string still = body + " still accelerates by " + rate;
    switch (outcome) {
    case SearchOutcome::unrestored:
        return still + ", and nothing restores it: hold it by a joint or a spring";
    case SearchOutcome::stuck:
        return still + ", but no step, however short, goes with the forces: start nearer to the equilibrium";
    default:
        return still + " after " + std::to_string(result.iterations) +
               " iterations: there may be no equilibrium, or start nearer to it";
    }
}

void describe_worst(const Search& search, const RestPoint& here, Equilibrium& result)
{
    result.residual = here.residual();
    result.worst_body = here.statics->body;
    if (result.worst_body < 0) return;
    const auto& body = search.tables().bodies[result.worst_body];
    const double* a = search.acceleration().data() + body.first;
    result.acceleration = norm(Vector3{a[0], a[1], a[2]});
    if (body.dofs == 6) result.angular_acceleration = norm(Vector3{a[3], a[4], a[5]});
}

/// What holds the bodies, and where they are with that.
struct Stage {
    HeldAtRest held;
    ConsistentStart closed;
    Search search;
    RestPoint here{};
    SearchOutcome outcome = SearchOutcome::no_numbers;

    Stage(const Model& model, const RestingStops& stops, std::vector<int> which, const State& start,
          StartPolicy policy)
        : held(model, stops, std::move(which)), closed(consistent_start(held.part.model, start, policy)),
          search(held, closed)
    {}
    /// Down to rest, or to a stop: its number, else -1.
    int run(const EquilibriumOptions& options, int& iterations)
    {
        int met = -1;
        if (has_states()) here.states = search.states_of(closed.start);
        if (search.look(closed.start.X, here))
            outcome = has_states() ? run_with_states(options, iterations, met)
                                   : descend(search, options, here, iterations, met);
        if (outcome == SearchOutcome::stuck && here.residual() <= equilibrium_tolerance)
            outcome = SearchOutcome::balanced;
        if (outcome == SearchOutcome::balanced && !has_states()) polish(search, here, iterations);
        if (outcome != SearchOutcome::no_numbers) search.look(std::vector<Matrix34>(here.X), here);
        return met;
    }
    bool has_states() const { return std::ranges::any_of(held.whole->bodies(), &Body::holds_states); }
    /// Where that is beyond a stop, it is met.
    SearchOutcome run_with_states(const EquilibriumOptions& options, int& iterations, int& met)
    {
        const SearchOutcome found = rest_with_states(search, options, here, iterations);
        const Search::Depth deepest = search.deepest();
        if (found != SearchOutcome::balanced || deepest.stop < 0 || !(deepest.depth > passed)) return found;
        met = deepest.stop;
        return SearchOutcome::met_stop;
    }
    Pushes pushes() const
    {
        return held.stops->pushes(held.part, held.closed, here.X, search.state().multipliers[1],
                                  search.tables().independent, here.statics->given);
    }
};

/// One stop after the other closes where it is met, and opens where it would have to pull.
std::unique_ptr<Stage> search_with_stops(const Model& model, const RestingStops& stops, const State& start,
                                         const EquilibriumOptions& options, Equilibrium& result)
{
    auto now = std::make_unique<Stage>(model, stops, std::vector<int>{}, start, options.initial);
    result.notes = now->closed.notes;
    if (stops.size() > 0) refuse_beyond_stops(stops, stops.depths_near(now->closed.start.X));
    const int most = 50 + 10 * stops.size();
    for (int changes = 0;; ++changes) {
        const int met = now->run(options, result.iterations);
        std::vector<int> closed = now->held.closed;
        if (now->outcome == SearchOutcome::met_stop) {
            closed.push_back(met);
        } else {
            if (now->outcome != SearchOutcome::balanced || closed.empty()) return now;
            const int release = RestingStops::to_release(now->pushes());
            if (release < 0) return now;
            closed.erase(closed.begin() + release);
        }
        if (changes == most) {
            now->outcome = SearchOutcome::limit;
            result.message = "which stops hold the bodies is not found in " + std::to_string(most) +
                             " changes of them: start nearer to the equilibrium";
            return now;
        }
        State at = now->closed.start;
        at.X = now->here.X;
        if (now->has_states()) at.V = now->search.velocities_of(now->here.states);
        auto next = std::make_unique<Stage>(model, stops, std::move(closed), at, StartPolicy::project);
        next->search.goes_on_from(now->search);
        now = std::move(next);
    }
}

/// From joints and rows of a part to those of the whole: what does not act has no force.
void add_reactions(const Stage& stage, Equilibrium& result)
{
    const HeldAtRest& held = stage.held;
    const UniqueReactions least =
        least_reactions(held.part.model, stage.here.X, stage.search.state().multipliers[1],
                        stage.search.tables().independent);
    result.multipliers.assign(static_cast<std::size_t>(held.whole->n_rows()), 0.0);
    result.joint_is_unique.assign(held.whole->joints().size(), true);
    result.shared.assign(held.whole->joints().size(), {});
    for (std::size_t r = 0; r < held.part.rows.size(); ++r)
        result.multipliers[static_cast<std::size_t>(held.part.rows[r])] = least.multipliers[r];
    for (std::size_t j = 0; j < held.part.joints.size(); ++j) {
        const auto whole = static_cast<std::size_t>(held.part.joints[j]);
        result.joint_is_unique[whole] = least.joint_is_unique[j];
        result.shared[whole] = least.shared[j];
    }
}

}   // namespace

Equilibrium find_equilibrium(const Model& the_model, const State& start, const EquilibriumOptions& options)
{
    refuse_sampling(the_model);
    const Model model = frozen(the_model, {start.t});
    const RestingStops stops(model, start.t);
    State at_rest = start;
    for (std::size_t b = 0; b < at_rest.V.size(); ++b)
        if (!model.bodies()[b].holds_states()) at_rest.V[b] = {};

    Equilibrium result;
    if (model.n_bodies() == 0) {
        const ConsistentStart closed = consistent_start(model, at_rest, options.initial);
        result.state = closed.start;
        result.degrees_of_freedom = closed.degrees_of_freedom;
        result.notes = closed.notes;
        result.is_found = true;
        return result;
    }
    const std::unique_ptr<Stage> stage = search_with_stops(model, stops, at_rest, options, result);
    const Search& search = stage->search;
    result.state = stage->closed.start;
    result.degrees_of_freedom = stage->closed.degrees_of_freedom;
    describe_worst(search, stage->here, result);
    result.state.X = stage->here.X;
    if (stage->has_states()) result.state.V = search.velocities_of(stage->here.states);
    // without what counts turns of stops
    result.state.angles.assign(search.state().angles.begin(),
                               search.state().angles.begin() +
                                   static_cast<std::ptrdiff_t>(std::min(search.state().angles.size(),
                                                                        UnwrappedAngles(model).size())));
    result.coordinates = search.coordinates();
    result.is_found = stage->outcome == SearchOutcome::balanced;
    for (const int k : stage->held.closed)
        result.closed_stops.push_back(static_cast<int>(stops.joint_index(k)));
    add_reactions(*stage, result);
    if (!result.is_found) {
        if (result.message.empty())
            result.message = why_not(model, search, stage->here, stage->outcome, result);
        return result;
    }
    State place = result.state;
    place.angles.clear();
    refuse_singular_start(search.model(), consistent_start(search.model(), place, StartPolicy::project));
    if (stops.size() > 0) refuse_beyond_stops(stops, search.depths());
    result.stability = stability(linearise(model, result.state));
    return result;
}

}   // namespace livens
