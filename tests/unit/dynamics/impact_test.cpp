// SPDX-License-Identifier: BSD-3-Clause
// Impacts of many stops at once: what Moreau's law says, whoever solves it.
#include "livens/dynamics/instant/impact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "livens/multibody/joints/stops.h"
#include "livens/multibody/model.h"

namespace livens::impact_test {

namespace {

/// Balls in a row that touch, free to move.
struct Row {
    Model held;
    std::vector<Joint> stops;
    std::vector<double> masses;

    Row(const std::vector<double>& mass, const std::vector<double>& speed, double restitution) : masses(mass)
    {
        Model with_stops;
        for (std::size_t k = 0; k < mass.size(); ++k) {
            const Vector3 x{0.5 * static_cast<double>(k), 0, 0}, v{speed[k], 0, 0};
            for (Model* model : {&held, &with_stops})
                model->add_body(point_mass("b" + std::to_string(k), mass[k], x, v));
        }
        const State start = held.start();
        for (int k = 1; k < held.n_bodies(); ++k) {
            const int at = add_distance_stop(with_stops, "s" + std::to_string(k), {k - 1, {}}, {k, {}},
                                             {0.5, true, restitution, true}, Configurations(start.X));
            stops.push_back(with_stops.joints()[static_cast<std::size_t>(at)]);
        }
    }
    ImpactOutcome meet() const
    {
        const State start = held.start();
        SettledInstant instant(held, most_rows(held, std::span(&start, 1)));
        return impact(instant, start, stops);
    }
};

TEST(Impact, OfARowOfBallsIsSharedByAllThatTouch)
{
    for (const std::size_t n : {2, 3, 9, 40}) {
        const double e = 0.6;
        std::vector<double> speed(n, 0.0);
        speed[0] = 1;
        const ImpactOutcome outcome = Row(std::vector<double>(n, 2.0), speed, e).meet();
        ASSERT_TRUE(outcome.is_found) << n;
        const double together = (1 + e) / static_cast<double>(n);
        EXPECT_NEAR(outcome.V[0](0, 0), together - e, 1e-13) << n;
        for (std::size_t k = 1; k < n; ++k) EXPECT_NEAR(outcome.V[k](0, 0), together, 1e-13) << n << " " << k;
    }
}

/// Velocities next to those before are those that fulfil these conditions, and no others.
TEST(Impact, FulfilsItsLawForAnyMassesAndSpeeds)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> speed(-1, 1), mass(-2, 2);
    int n_pushing = 0, n_idle = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const std::size_t n = 2 + random() % 30;
        std::vector<double> masses, speeds;
        for (std::size_t k = 0; k < n; ++k) {
            masses.push_back(std::pow(10, mass(random)));
            speeds.push_back(speed(random));
        }
        const Row row(masses, speeds, 0.5);
        const ImpactOutcome outcome = row.meet();
        ASSERT_TRUE(outcome.is_found) << trial;
        for (std::size_t k = 0; k < n; ++k) {   // momentum: rows are of half the squared distance
            const double left = k > 0 ? 0.5 * outcome.stops[k - 1].impulse : 0,
                         right = k + 1 < n ? 0.5 * outcome.stops[k].impulse : 0;
            EXPECT_NEAR(masses[k] * (outcome.V[k](0, 0) - speeds[k]), left - right,
                        1e-11 * std::max(1.0, masses[k]))
                << trial << " " << k;
        }
        for (std::size_t k = 0; k + 1 < n; ++k) {
            const double before = speeds[k + 1] - speeds[k],
                         after = outcome.V[k + 1](0, 0) - outcome.V[k](0, 0),
                         least = std::max(-0.5 * before, 0.0), impulse = outcome.stops[k].impulse;
            EXPECT_GE(impulse, 0);
            EXPECT_GE(after, least - 1e-11) << trial << " " << k;
            EXPECT_TRUE(impulse == 0 || std::abs(after - least) < 1e-12 * (1 + impulse))
                << trial << " " << k << " " << impulse << " " << after - least;
            ++(impulse > 0 ? n_pushing : n_idle);
        }
    }
    EXPECT_GT(n_pushing, 500);
    EXPECT_GT(n_idle, 50);
}

/// A plate of 3 kg over sixteen posts that touch it, at a speed down and turning.
struct Plate {
    static constexpr double mass = 3, inertia = 0.2;
    Model held;
    std::vector<Joint> stops;
    std::vector<Vector3> at;

    /// `restitution(k)` of post k.
    Plate(double speed, double w_x, double w_y, const std::function<double(std::size_t)>& restitution)
    {
        Model with_stops;
        for (Model* model : {&held, &with_stops})
            model->add_body(rigid_body("plate", {mass, {}, {inertia, 0, 0, 0, inertia, 0, 0, 0, 0.4}},
                                       {{0, 0, 1}, identity<3>(), {0, 0, speed}, {w_x, w_y, 0}}));
        const State start = held.start();
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                at.push_back({0.2 * i - 0.3, 0.2 * j - 0.3, 0});
                const int stop = add_distance_stop(
                    with_stops, "post " + std::to_string(at.size()), {world, at.back()}, {0, at.back()},
                    {1, true, restitution(at.size() - 1), true}, Configurations(start.X));
                stops.push_back(with_stops.joints()[static_cast<std::size_t>(stop)]);
            }
    }
    ImpactOutcome meet() const
    {
        const State start = held.start();
        SettledInstant instant(held, most_rows(held, std::span(&start, 1)));
        return impact(instant, start, stops);
    }
};

/// What sixteen posts bear is not unique, what it does is.
TEST(Impact, OfMoreStopsThanAreNeededIsThatOfThePlate)
{
    const ImpactOutcome outcome = Plate(-2, 0, 0, [](std::size_t) { return 0.25; }).meet();
    ASSERT_TRUE(outcome.is_found);
    Matrix34 wanted{};
    wanted(2, 0) = 0.5;
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(outcome.V[0].a[i], wanted.a[i], 1e-12) << i;
}

/// Where it turns, posts that push at first are left by what others do.
TEST(Impact, LetsGoOfStopsThatWouldPull)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> speed(-1, 0.3), spin(-4, 4), restitution(0, 1);
    int n_idle = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const double v = speed(random), w_x = spin(random), w_y = spin(random);
        std::vector<double> e;
        for (int i = 0; i < 16; ++i) e.push_back(restitution(random));
        const Plate plate(v, w_x, w_y, [&](std::size_t k) { return e[k]; });
        const ImpactOutcome outcome = plate.meet();
        ASSERT_TRUE(outcome.is_found) << trial;
        const Matrix34& V = outcome.V[0];   // [v, w x e_x, w x e_y, ..]
        const double v_after = V(2, 0), w_x_after = V(2, 2), w_y_after = -V(2, 1);
        double force = 0, about_x = 0, about_y = 0;
        for (std::size_t i = 0; i < plate.at.size(); ++i) {
            const double impulse = outcome.stops[i].impulse, x = plate.at[i][0], y = plate.at[i][1];
            const double before = v + w_x * y - w_y * x, after = v_after + w_x_after * y - w_y_after * x,
                         least = std::max(-e[i] * before, 0.0);
            EXPECT_GE(impulse, 0);
            EXPECT_GE(after, least - 1e-12) << trial << " " << i;
            EXPECT_TRUE(impulse == 0 || std::abs(after - least) < 1e-12) << trial << " " << i;
            n_idle += before < 0 && impulse == 0 ? 1 : 0;
            force += impulse;
            about_x += impulse * y;
            about_y -= impulse * x;
        }
        EXPECT_NEAR(Plate::mass * (v_after - v), force, 1e-12) << trial;
        EXPECT_NEAR(Plate::inertia * (w_x_after - w_x), about_x, 1e-12) << trial;
        EXPECT_NEAR(Plate::inertia * (w_y_after - w_y), about_y, 1e-12) << trial;
    }
    EXPECT_GT(n_idle, 100) << "of what is hit, some is left by what others do";
}

}   // namespace

}   // namespace livens::impact_test
