// SPDX-License-Identifier: BSD-3-Clause
// Impulses of stops are a small linear complementarity problem in what the other joints leave free.
#include "livens/dynamics/instant/impact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/unwrapped_angles.h"

namespace livens::inline dynamics_internal {

namespace {

/// Of what a stop does to itself: less than that of it another does not feel.
constexpr double felt = 1e-12;

const ConstraintRow& row_of(const Joint& stop) { return stop.rows[0]; }

/// Side times the gradient by each body, and the speed that does not depend on velocities.
struct Direction {
    RowGradient gradient;
    int side;
    double own_rate;

    Direction(const Joint& stop, const State& state)
        : gradient(constraint_gradient(row_of(stop), {state.t}, state.X)), side(stop.impact->open_side),
          own_rate(side * constraint_rate(row_of(stop), {state.t}, state.X))
    {}

    double along(std::span<const Matrix34> V) const
    {
        double sum = 0;
        for (int k = 0; k < gradient.bodies.size; ++k) {
            const Matrix34& of_body =
                V[static_cast<std::size_t>(gradient.bodies.bodies[static_cast<std::size_t>(k)])];
            const Matrix34& g = gradient.by[static_cast<std::size_t>(k)];
            for (std::size_t i = 0; i < 12; ++i) sum += g.a[i] * of_body.a[i];
        }
        return side * sum;
    }
    double speed(std::span<const Matrix34> V) const { return own_rate + along(V); }
    std::vector<double> as_forces(std::size_t n_bodies) const
    {
        std::vector<double> raw(12 * n_bodies, 0.0);
        for (int k = 0; k < gradient.bodies.size; ++k)
            for (std::size_t i = 0; i < 12; ++i)
                raw[12 * static_cast<std::size_t>(gradient.bodies.bodies[static_cast<std::size_t>(k)]) + i] =
                    side * gradient.by[static_cast<std::size_t>(k)].a[i];
        return raw;
    }
};

/// Rates [v, w x d_a] of twists.
std::vector<Matrix34> rates_of(const ModelTables& tables, const std::vector<double>& X,
                               const std::vector<double>& twists)
{
    std::vector<double> V(X.size());
    tables.bodies.rates_of(X.data(), twists.data(), V.data());
    std::vector<Matrix34> all(X.size() / 12);
    for (std::size_t b = 0; b < all.size(); ++b) std::copy_n(V.begin() + 12 * b, 12, all[b].a);
    return all;
}

/// D x = b for the chosen rows, by elimination with pivots on the diagonal, as D is symmetric and positive;
/// none: it is singular.
std::optional<std::vector<double>> solved(std::vector<std::vector<double>> D, std::vector<double> b)
{
    const std::size_t n = b.size();
    constexpr double lost = 1e-12;
    std::vector<double> diagonal(n);
    for (std::size_t i = 0; i < n; ++i) diagonal[i] = D[i][i];
    for (std::size_t k = 0; k < n; ++k) {
        if (!(D[k][k] > lost * diagonal[k])) return {};
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = D[i][k] / D[k][k];
            for (std::size_t j = k; j < n; ++j) D[i][j] -= factor * D[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= D[k][j] * b[j];
        b[k] /= D[k][k];
    }
    return b;
}

/// Impulses >= 0 with speeds + D impulses >= least, and one of both zero for each: velocities next to those
/// before, by the dual method of [Goldfarb1983]. One after the other of the stops that are passed
/// fastest is pushed until it is not, while those that push already keep their speed; who would have to pull
/// is let go. It ends with any number of stops, also where some say what others say.
class Complementarity {
public:
    Complementarity(std::vector<std::vector<double>> D, std::vector<double> speeds, std::vector<double> least)
        : D_(std::move(D)), speeds_(std::move(speeds)), least_(std::move(least)),
          impulses_(speeds_.size(), 0.0)
    {
        double size = 0;
        for (std::size_t i = 0; i < speeds_.size(); ++i)
            size = std::max({size, std::abs(speeds_[i]), std::abs(least_[i])});
        tolerance_ = 1e-13 * size;
    }

    /// None: no velocities fulfil all.
    std::optional<std::vector<double>> solve()
    {
        // Each step makes the distance from the velocities before longer, so that no set comes again;
        // rounding may bring one back.
        const std::size_t most = 100 + 20 * impulses_.size();
        for (std::size_t step = 0; step < most; ++step) {
            const std::optional<std::size_t> passed = fastest();
            if (!passed) return impulses_;
            if (!push(*passed)) return {};
        }
        return {};
    }

private:
    double lacking(std::size_t i) const
    {
        double speed = speeds_[i] - least_[i];
        for (std::size_t j = 0; j < impulses_.size(); ++j) speed += D_[i][j] * impulses_[j];
        return -speed;
    }

    std::optional<std::size_t> fastest() const
    {
        std::optional<std::size_t> found;
        double most = tolerance_;
        for (std::size_t i = 0; i < impulses_.size(); ++i)
            if (const double by = lacking(i); by > most && !is_pushing(i)) most = by, found = i;
        return found;
    }
    bool is_pushing(std::size_t i) const { return std::ranges::find(pushing_, i) != pushing_.end(); }

    /// Until stop i is not passed any more. False: it cannot be.
    bool push(std::size_t i)
    {
        constexpr double follows = 1e-11;   // of what it does to itself: what others do not say already
        while (true) {
            const std::optional<std::vector<double>> back = solved(among_pushing(), to_pushing(i));
            if (!back) return false;
            double own = D_[i][i];
            for (std::size_t k = 0; k < pushing_.size(); ++k) own -= D_[i][pushing_[k]] * (*back)[k];
            constexpr double never = std::numeric_limits<double>::infinity();
            const double whole = own > follows * D_[i][i] ? lacking(i) / own : never;
            double step = whole;
            std::size_t leaves = pushing_.size();
            for (std::size_t k = 0; k < pushing_.size(); ++k)
                if ((*back)[k] > 0 && impulses_[pushing_[k]] < step * (*back)[k]) {
                    step = impulses_[pushing_[k]] / (*back)[k];
                    leaves = k;
                }
            if (step == never) return false;
            impulses_[i] += step;
            for (std::size_t k = 0; k < pushing_.size(); ++k) impulses_[pushing_[k]] -= step * (*back)[k];
            if (leaves == pushing_.size()) {
                pushing_.push_back(i);
                return true;
            }
            impulses_[pushing_[leaves]] = 0;
            pushing_.erase(pushing_.begin() + static_cast<std::ptrdiff_t>(leaves));
        }
    }

    std::vector<std::vector<double>> among_pushing() const
    {
        std::vector<std::vector<double>> part;
        for (const std::size_t k : pushing_) part.push_back(to_pushing(k));
        return part;
    }
    std::vector<double> to_pushing(std::size_t i) const
    {
        std::vector<double> column;
        for (const std::size_t k : pushing_) column.push_back(D_[k][i]);
        return column;
    }

    std::vector<std::vector<double>> D_;
    std::vector<double> speeds_, least_, impulses_;
    std::vector<std::size_t> pushing_;
    double tolerance_ = 0;
};

}   // namespace

/// Joints first take off what they do not let pass, and impulses start from there; approaches, by which
/// restitution counts, are those before.
ImpactOutcome impact(SettledInstant& held, const State& before, std::span<const Joint> stops)
{
    ImpactOutcome outcome;
    outcome.stops.resize(stops.size());
    if (stops.size() > most_stops_at_once) return outcome;
    if (!held.settle(before)) return outcome;
    const std::vector<double> X = held.solved().X;
    outcome.V = rates_of(held.tables(), X, held.solved().velocity);
    const std::size_t n = stops.size(), n_bodies = outcome.V.size();
    std::vector<Direction> directions;
    std::vector<std::vector<Matrix34>> responses;
    std::vector<double> speeds(n), least(n);
    for (std::size_t i = 0; i < n; ++i) {
        directions.emplace_back(stops[i], before);
        speeds[i] = directions[i].speed(outcome.V);
        outcome.stops[i].approach = directions[i].speed(before.V);
        least[i] = stops[i].impact->restitution * std::max(-outcome.stops[i].approach, 0.0);
        responses.push_back(rates_of(held.tables(), X, held.response_to(directions[i].as_forces(n_bodies))));
    }
    std::vector<std::vector<double>> D(n, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) D[i][j] = directions[i].along(responses[j]);
    const auto is_hit = [&](std::size_t i) { return outcome.stops[i].approach < 0; };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (is_hit(i) && is_hit(j) && std::abs(D[i][j]) > felt * std::sqrt(D[i][i] * D[j][j]))
                outcome.are_apart = false;
    const std::optional<std::vector<double>> impulses = Complementarity(D, speeds, least).solve();
    if (!impulses) return outcome;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t b = 0; b < n_bodies; ++b) outcome.V[b] += (*impulses)[i] * responses[i][b];
    for (std::size_t i = 0; i < n; ++i) {
        outcome.stops[i].impulse = (*impulses)[i];
        // where it gave an impulse as the law has it, without what rounding leaves
        outcome.stops[i].apart = (*impulses)[i] > 0 ? least[i] : directions[i].speed(outcome.V);
    }
    outcome.is_found = true;
    return outcome;
}

double speed_apart(const Joint& stop, const State& state) { return Direction(stop, state).speed(state.V); }

/// Gradient times X'', with its centripetal part, and the curvature of the row, towards the open side.
std::vector<double> accelerations_apart(std::span<const Joint> stops, SettledInstant& held,
                                        const State& state)
{
    std::vector<double> apart(stops.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> angles = state.angles;
    angles.resize(UnwrappedAngles(*held.tables().model).size(),
                  0.0);   // others come behind those of its loads
    if (!held.accelerate(state, angles, Side::right)) return apart;
    const std::vector<double>& X = held.solved().X;
    std::vector<Matrix34> A = rates_of(held.tables(), X, held.solved().acceleration[1]);
    const double* centripetal = held.system().centripetal();
    for (Matrix34& one : A)
        for (double& a : one.a) a += *centripetal++;
    for (std::size_t k = 0; k < stops.size(); ++k) {
        const Direction direction(stops[k], state);
        apart[k] = direction.along(A) +
                   direction.side * constraint_curvature(row_of(stops[k]), {state.t}, state.X, state.V);
    }
    return apart;
}

double gap_of(const Joint& stop, const State& state)
{
    return stop.impact->open_side * constraint_value(row_of(stop), {state.t}, state.X);
}

}   // namespace livens::inline dynamics_internal
