// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component".
#include "livens/spacetime/march/given_momenta.h"

#include <memory>
#include <span>
#include <string>
#include <utility>

#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/march/end_point.h"

namespace livens::inline spacetime_internal {

namespace {

using Bodies = std::span<const Matrix34>;

/// A motion of all bodies as it is at one place, with what momentum it has by itself.
struct FixedMotion {
    std::vector<Body> bodies;
    std::vector<Vector3> velocities, rates;
    double per_momentum = 0;   ///< m/s

    /// What momenta do along it: p . v + L . w, with the moments L about the reference points.
    double along(Bodies X, Bodies V) const
    {
        double sum = 0;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const Matrix34 P = V[b] * bodies[b].mass;
            sum += dot(P.column(0), velocities[b]);
            for (int a = 1; a < 4; ++a) sum += dot(cross(X[b].column(a), P.column(a)), rates[b]);
        }
        return sum;
    }
};

FixedMotion fixed_motion(const Model& model, const State& place, const std::vector<Matrix34>& V)
{
    FixedMotion motion;
    for (std::size_t b = 0; b < V.size(); ++b) {
        const Body& body = model.bodies()[b];
        motion.bodies.push_back(body);
        motion.velocities.push_back(V[b].column(0));
        motion.rates.push_back(body.is_point ? Vector3{} : angular_velocity(place.X[b], V[b]));
    }
    return motion;
}

}   // namespace

/// One condition for each free motion at the stated place, a basis that is held there: one that is made anew
/// at each iterate converges from fewer guesses. Each is scaled so that the momentum of its own free motion
/// comes out as the speed of that motion, in m/s.
std::vector<Condition> given_momenta(const ModelTables& tables, const State& stated, Condition::At at)
{
    EndPoint point(tables), moving(tables);
    if (!point.place(stated)) return {};
    const std::vector<double> nowhere(static_cast<std::size_t>(tables.n_twists), 0.0);
    const auto rates_of = [&](const std::vector<double>& momenta) {
        return moving.place_moved(point, nowhere.data(), momenta) ? moving.state().V
                                                                  : std::vector<Matrix34>();
    };
    const State here = point.state();
    const std::vector<Matrix34> at_rest = rates_of(nowhere);   // drives may move something
    std::vector<Condition> all;
    for (int j = 0; j < tables.freedoms() && !at_rest.empty(); ++j) {
        std::vector<double> momenta = nowhere;
        point.momenta_along(point.basis(), point.maps(), j, momenta.data());
        std::vector<Matrix34> V = rates_of(momenta);
        if (V.empty()) return {};
        for (std::size_t b = 0; b < V.size(); ++b) V[b] = V[b] - at_rest[b];
        auto motion = std::make_shared<FixedMotion>(fixed_motion(*tables.model, here, V));
        motion->per_momentum =
            point.size_along(point.basis(), point.maps(), j) * tables.length / motion->along(here.X, V);
        StateQuantity q{"momenta along free motion " + std::to_string(j + 1), "m s-1"};
        q.function = [motion](Bodies X, Bodies rates) {
            return motion->per_momentum * motion->along(X, rates);
        };
        const double value = q.function(stated.X, stated.V);
        all.push_back({std::move(q), value, at});
        all.back().is_of_all = true;
    }
    return all;
}

}   // namespace livens::inline spacetime_internal
