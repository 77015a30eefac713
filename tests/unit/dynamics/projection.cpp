// SPDX-License-Identifier: BSD-3-Clause
// Projections onto the joints reach rounding whatever the masses are, and are the nearest in the mass metric.
#include <gtest/gtest.h>

#include <algorithm>

#include "linkages.h"
#include "livens/dynamics/instant/nearest_rates.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/start/consistent_start.h"
#include "violations.h"

namespace livens::projection_test {
namespace {

/// Relative to the largest speed.
double relative_rate(const Model& model, const State& state)
{
    double speed = 1;
    for (const Matrix34& V : state.V) speed = std::max(speed, norm(V));
    return largest_rate(model, state) / speed;
}

/// Turned and shifted by about `size`, with rates of about one.
State disturbed(const Model& model, Random& random, double size)
{
    State state = model.start();
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        const Matrix3 turn = directors_from_rotation_vector(size * random.vector());
        state.X[b] = configuration(state.X[b].column(0) + size * random.vector(),
                                   turn * directors(state.X[b]));
        state.V[b] = rate(state.X[b], random.vector(), random.vector());
    }
    return state;
}

TEST(Projection, ReachesRoundingAtAnyRatioOfMasses)
{
    double values = 0, rates = 0;
    for (const double power : {0.0, 15.0}) {
        int open = 0;
        for (unsigned seed = 0; seed < 60; ++seed) {
            const int n = 2 + static_cast<int>(seed % 5);
            for (const int kind : {0, 1, 2}) {
                const Surroundings how{.largest_power = power};
                const Model model = kind == 2 ? ring(seed, n + 4, how, false)
                                    : kind == 1 ? ring(seed, n, how, true)
                                                : open_chain(seed, n, how);
                Random random(seed);
                try {
                    const State start = disturbed(model, random, 1e-3);
                    const ConsistentStart a = consistent_start(model, start, StartPolicy::project);
                    values = std::max(values, largest_violation(model, a.start));
                    rates = std::max(rates, relative_rate(model, a.start));
                } catch (const InputError& error) {
                    if (open++ == 0) std::printf("%s\n", error.what());
                }
            }
        }
        // Masses 30 orders of magnitude apart: 11 of 4500 such mechanisms are refused, by name.
        EXPECT_LE(open, power == 0 ? 0 : 3) << power;
    }
    EXPECT_LT(values, 2e-14);
    EXPECT_LT(rates, 1e-13);
}

/// By the momentum that an instant has, and by a basis of the rows.
TEST(Projection, RatesOfManyStatesAreThoseOfEach)
{
    double apart = 0, moved = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const int n = 2 + static_cast<int>(seed % 7);
        for (const int kind : {0, 1, 2}) {
            const Surroundings how{.shift = 10.0 * (seed % 2), .reference = 0.3, .largest_power = 1};
            const Model model = kind == 2   ? ring(seed, n + 4, how, false)
                                : kind == 1 ? ring(seed, n, how, true)
                                            : open_chain(seed, n, how);
            const ConsistentStart at = consistent_start(model, model.start(), StartPolicy::project);
            NearestRates many(model, at.independent);
            Random random(seed);
            for (int k = 0; k < 3; ++k) {
                std::vector<Matrix34> rigid;
                for (const Matrix34& X : at.start.X)
                    rigid.push_back(rate(X, random.vector(), random.vector()));
                const auto one = nearest_rates(model, at.start.X, rigid, at.independent),
                           other = many.at(0, at.start.X, rigid);
                for (std::size_t b = 0; b < one.size(); ++b) {
                    apart = std::max(apart, norm(one[b] - other[b]));
                    moved = std::max(moved, norm(one[b] - rigid[b]));
                }
            }
        }
    }
    EXPECT_LT(apart, 1e-11);
    EXPECT_GT(moved, 1);   // a negative control: joints take something off
}

TEST(Projection, SharesVelocitiesByMassAtAnyRatioOfMasses)
{
    // Points in a row on rods move along it with the velocity of their common centre.
    const double light = 1e-15, heavy = 1e15;
    const std::vector<double> rows_of_masses[] = {{heavy, light, 3 * heavy},
                                                  {light, heavy, light},
                                                  {heavy, light, light, 3 * heavy},
                                                  {light, 1, heavy, 1, 3 * heavy}};
    for (const std::vector<double>& masses : rows_of_masses) {
        Model model;
        State start;
        double sum = 0, momentum = 0;
        const int n = static_cast<int>(masses.size());
        for (int b = 0; b < n; ++b) {
            const double v = b == 0 ? 1 : b == n - 1 ? 0 : 5;
            model.add_body(point_mass("p" + std::to_string(b), masses[b], {1.0 * b, 0, 0}, {v, 0, 0}));
            if (b > 0) model.add_joint(rod("r" + std::to_string(b), b - 1, b, {}, 1));
            sum += masses[b];
            momentum += masses[b] * v;
        }
        const ConsistentStart a = consistent_start(model, model.start(), StartPolicy::project);
        for (const Matrix34& V : a.start.V) EXPECT_NEAR(V(0, 0), momentum / sum, 1e-14 * momentum / sum);
    }
}

TEST(Projection, OfRatesIsNearestForRemoteReferencePoints)
{
    // The same two bodies, read from reference points at their centres and 1e5 m away: the same motion.
    const auto spins = [](double reference) {
        Linkage l(3, {.reference = reference});
        l.add_link({0, 0, 0});
        l.add_link({1, 0, 0});
        l.ball(0, 1, {0.5, 0.2, 0});
        State start = l.model.start();
        for (int b = 0; b < 2; ++b) {
            const Vector3 c = mass_properties(l.model.bodies()[b].mass).center_of_mass;
            const Vector3 w{0.3, 1.0 * b, -0.2};
            const Vector3 v = Vector3{0, 1.0 - b, 0} - cross(w, start.X[b] * direction(c));
            start.V[b] = rate(start.X[b], v, w);
        }
        const State closed = consistent_start(l.model, start, StartPolicy::project).start;
        return angular_velocity(closed.X[0], closed.V[0]);
    };
    EXPECT_GT(norm(spins(0) - Vector3{0.3, 0, -0.2}), 0.1);   // the joint has something to do
    EXPECT_LT(norm(spins(1e5) - spins(0)), 1e-4);   // J has 5 digits left
}

}   // namespace
}   // namespace livens::projection_test
