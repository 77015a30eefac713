// SPDX-License-Identifier: BSD-3-Clause
// The examples of machines that everybody knows, as shipped, against closed forms, and a chain against its
// angles by DOP853.
#include <numbers>

#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::gallery_test {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

/// Solved, and accepted without a reason against it.
Solved accepted(const std::string& name)
{
    const Shipped shipped = solve_example(name);
    EXPECT_TRUE(shipped.solution.verdict.reasons.empty()) << name;
    return {shipped.model, shipped.solution};
}

TEST(Gallery, TheBicycleWheelStaysLevelAndWalksRoundAtItsExactRate)
{
    const Solved run = accepted("bicycle_wheel");
    const double rate = g * 0.15 / (0.311 * 0.311 * 60);
    for (int i = 0; i <= 40; ++i) {
        const double t = 0.1 * i;
        const BodySample wheel = sample_bodies(run.model, run.solution.motion, t)[0];
        const Vector3 axle = directors_from_quaternion(wheel.quaternion).column(0);
        EXPECT_LE(largest_difference(axle, Vector3{std::cos(rate * t), std::sin(rate * t), 0}), 1e-9) << t;
        // The support bears the weight, and what keeps the centre on its circle.
        const Vector3 expected = Vector3{0, 0, 2 * g} - (2 * 0.15 * rate * rate) * axle;
        EXPECT_LE(largest_difference(run.reaction("support", t).force, expected), 1e-7) << t;
    }
}

/// Depth and duration of an impact on k s^1.5 under gravity, from the balance of energy.
struct Impact {
    double depth = 0, duration = 0;
};
Impact impact_of(double speed, double stiffness_by_mass)
{
    // v^2 + 2 g s - 4/5 (k/m) s^(5/2) vanishes at the largest depth.
    const auto square = [&](double s) {
        return speed * speed + 2 * g * s - 0.8 * stiffness_by_mass * std::pow(s, 2.5);
    };
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) (square(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    // By s = depth (1 - u^2) the integrand has no pole; the rule of midpoints on 1e6 pieces.
    double sum = 0;
    constexpr int n = 1'000'000;
    for (int i = 0; i < n; ++i) {
        const double u = (i + 0.5) / n;
        sum += 4 * low * u / std::sqrt(square(low * (1 - u * u))) / n;
    }
    return {low, sum};
}

TEST(Gallery, TheBouncingBallComesBackAfterHertzsImpacts)
{
    const Solved run = accepted("bouncing_ball");
    const double fall = std::sqrt(2 * 0.97 / g);
    const Impact impact = impact_of(g * fall, 1e6);
    EXPECT_NEAR(impact.depth, 0.0142, 5e-5) << "as the example says";
    EXPECT_NEAR(impact.duration, 2.9433 * impact.depth / (g * fall), 0.004 * impact.duration) << "Hertz";
    const double period = 2 * fall + impact.duration;
    int n_flying = 0;
    for (int i = 0; i <= 150; ++i) {
        const double t = 0.02 * i, since = t - period * std::round(t / period);   // the last or next top
        if (std::abs(since) > fall) continue;                                     // it touches the floor
        const BodySample ball = sample_bodies(run.model, run.solution.motion, t)[0];
        EXPECT_NEAR(ball.position[2], 1 - 0.5 * g * since * since, 2e-7) << t;
        EXPECT_NEAR(ball.position[0], 0.5 * t, 1e-12) << t;
        ++n_flying;
    }
    EXPECT_GT(n_flying, 140);
}

TEST(Gallery, TheTipOfTheFallingChainIsAheadOfAStone)
{
    const Solved run = accepted("falling_chain");
    // Lagrange's equations in the 17 angles by DOP853, relative tolerance 1e-13: x and z of the tip.
    constexpr double rows[][3] = {
        {0.1, 0.09999992125914138, -0.049880369312244634}, {0.2, 0.10000203512289732, -0.20060711519805305},
        {0.3, 0.09998577579433122, -0.46165381678093836},  {0.4, 0.09957883766159642, -0.8653790422963198},
        {0.5, 0.050304250779070296, -1.6215903785132202},  {0.6, -0.050238821613532283, -1.2810436496464275}};
    for (const auto& [t, x, z] : rows) {
        const std::vector<double> tip = run.sensed(t);
        EXPECT_NEAR(tip[0], x, 2e-8) << t;
        EXPECT_NEAR(tip[2], z, 2e-8) << t;
        EXPECT_TRUE(t > 0.45 || tip[2] < -0.5 * g * t * t) << t;
    }
}

TEST(Gallery, ThePlatformOfTheDeltaRobotIsWhereThreeSpheresMeet)
{
    const Solved run = accepted("delta_robot");
    for (int i = 0; i <= 100; ++i) {
        const double t = 0.01 * i;
        const BodySample platform = sample_bodies(run.model, run.solution.motion, t)[3];
        EXPECT_LE(largest_difference(directors_from_quaternion(platform.quaternion), identity<3>()), 1e-12);
        for (int k = 0; k < 3; ++k) {
            const double law = 0.35 * (1 - std::cos(2 * pi * t)) +
                               0.25 * std::sin(4 * pi * t - k * 2 * pi / 3) * std::pow(std::sin(pi * t), 4);
            const double angle = pi / 6 + law, around = 2 * pi * k / 3;
            const double out = 0.2 - 0.045 + 0.3 * std::cos(angle);
            const Vector3 middle{out * std::cos(around), out * std::sin(around), -0.3 * std::sin(angle)};
            EXPECT_NEAR(norm(platform.position - middle), 0.8, 1e-12) << t << " arm " << k + 1;
        }
    }
}

TEST(Gallery, ThePistonsOfTheVTwinAreWhereTheCrankPutsThem)
{
    const Solved run = accepted("v_twin");
    const double r = 0.0484, l = 0.189;
    for (int i = 0; i <= 80; ++i) {
        const double t = 0.0005 * i;
        const std::vector<BodySample> bodies = sample_bodies(run.model, run.solution.motion, t);
        for (const int side : {1, -1}) {
            const double bore = side * pi / 8, a = 100 * pi * t - bore;
            const double out = r * std::cos(a) + std::sqrt(l * l - std::pow(r * std::sin(a), 2));
            const Vector3 expected{out * std::sin(bore), 0, out * std::cos(bore)};
            EXPECT_LE(largest_difference(bodies[side > 0 ? 2 : 4].position, expected), 1e-12) << t;
        }
    }
}

TEST(Gallery, TheExcavatorsBoomCylinderBearsTheMomentOfTheWeights)
{
    const Solved run = accepted("excavator");
    // At both ends all stands still, without acceleration.
    for (const double t : {0.0, 6.0}) {
        const std::vector<BodySample> bodies = sample_bodies(run.model, run.solution.motion, t);
        const double weights[] = {1900 * g, 900 * g, 1600 * g};
        double moment = 0;
        for (std::size_t b = 0; b < 3; ++b) moment += weights[b] * bodies[b].position[0];
        const Vector3 head{2.3, 0, 1.9}, force = run.reaction("boom cylinder", t).force;
        EXPECT_NEAR(head[2] * force[0] - head[0] * force[2], -moment, 1e-7 * moment) << t;
        EXPECT_NEAR(force[1], 0, 1e-6);
    }
}

}   // namespace
}   // namespace livens::tests::gallery_test
