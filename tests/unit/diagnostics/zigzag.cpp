// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "livens/base/error.h"
#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::zigzag_test {
namespace {

using hand_made::mesh;
using hand_made::motion;
using hand_made::stacked;
using hand_made::state_of_point;
using hand_made::torn_field;

using Function = std::function<double(double)>;

/// A point mass along x, somewhere off the origin; nodes are one second apart.
struct Line {
    Model model;

    Line() { model.add_body(point_mass("bob", 2, {})); }

    Motion along(const TimeMesh& times, int degree, const Function& x, const Function& v) const
    {
        return motion(model, times, degree, [&](double t) {
            return state_of_point(t, {x(t), 3, -1}, {v(t), 0, 0});
        });
    }
    Motion along(int seconds, const Function& x, const Function& v) const
    {
        return along(mesh(0, seconds, seconds), 1, x, v);
    }
    Zigzag of(int seconds, const Function& x, const Function& v) const
    {
        return zigzag(model, along(seconds, x, v));
    }
};

double sign(double t) { return std::lround(t) % 2 == 0 ? 1 : -1; }

void expect_both(const Zigzag& z, double value, double tolerance)
{
    EXPECT_NEAR(z.positions, value, tolerance);
    EXPECT_NEAR(z.momenta, value, tolerance);
}

TEST(Zigzag, OfASwingIsTheSquaredSineOfHalfItsAngleAStep)
{
    const Line line;
    for (const double theta : {0.1, 0.3, 0.7, 1.0})
        for (const double phase : {0.0, 0.4, 1.1, 2.0}) {
            const Zigzag z = line.of(
                60, [&](double t) { return std::sin(theta * t + phase); },
                [&](double t) { return theta * std::cos(theta * t + phase); });
            const double exact = std::pow(std::sin(theta / 2), 2);
            expect_both(z, exact, 0.12 * exact);   // the window holds no whole number of periods
            EXPECT_LT(std::max(z.positions, z.momenta), 0.3);
        }
}

TEST(Zigzag, OfATurningBodyIsThatOfItsAngle)
{
    for (const int degree : {1, 2, 4, 8}) {
        Model model;
        model.add_body(rigid_body("top", hand_made::skew_properties()));
        const double theta = 0.9;   // rad a step
        const auto at = [&](double t) {
            const Vector3 w{0, 0, theta};
            const Matrix34 X = configuration({}, directors_from_rotation_vector(t * w));
            return State{t, {X}, {rate(X, {}, w)}};
        };
        Motion turn = motion(model, mesh(0, 48, 48 / degree), degree, at);
        const double exact = std::pow(std::sin(theta / 2), 2);
        expect_both(zigzag(model, turn), exact, degree == 1 ? 0.01 : 0.06);
        const Matrix4& m = model.bodies()[0].mass;
        turn.P = torn_field(turn.mesh, 12, degree, [&](int, double t) { return stacked(at(t).V[0] * m); });
        expect_both(zigzag(model, turn), exact, degree == 1 ? 0.01 : 0.06);
    }
}

TEST(Zigzag, OfAnAlternatingMotionIsOne)
{
    const Line line;
    const Function zero = [](double) { return 0.0; };
    expect_both(line.of(40, sign, sign), 1, 1e-12);
    EXPECT_NEAR(line.of(40, sign, zero).positions, 1, 1e-12);
    EXPECT_EQ(line.of(40, sign, zero).momenta, 0) << "each speaks for itself";
    EXPECT_EQ(line.of(40, zero, sign).positions, 0);
    EXPECT_NEAR(line.of(40, zero, sign).momenta, 1, 1e-12);
}

TEST(Zigzag, IsTheAlternatingShareOfTheVelocity)
{
    const Line line;
    for (const double ratio : {0.01, 0.1, 0.5, 1.0, 3.0}) {
        const double share = ratio / std::sqrt(1 + ratio * ratio);
        const Zigzag z = line.of(
            40, [&](double t) { return t + ratio / 2 * sign(t); },
            [&](double t) { return 1 + ratio * sign(t); });
        EXPECT_NEAR(z.positions, share, 1e-12);
        EXPECT_NEAR(z.momenta, share, 0.02 * share) << "of 41 samples, whose alternating part has a mean";
    }
}

TEST(Zigzag, OfASmallAlternatingErrorIsSmallAlsoWhereTheMotionTurns)
{
    // A slow swing with 1 % of its largest increments alternating: more than all else where it turns.
    const Line line;
    for (const double theta : {0.01, 0.05, 0.2}) {
        const Zigzag z = line.of(
            700, [&](double t) { return std::sin(theta * t) + 0.005 * theta * sign(t); },
            [&](double t) { return theta * (std::cos(theta * t) + 0.01 * sign(t)); });
        EXPECT_LT(std::max(z.positions, z.momenta), 0.03) << theta;
        EXPECT_GT(std::min(z.positions, z.momenta), 0.01) << theta;
    }
}

TEST(Zigzag, OfRestAStraightLineAndConstantAccelerationIsZero)
{
    const Line line;
    const Function zero = [](double) { return 0.0; };
    expect_both(line.of(40, zero, zero), 0, 0);
    // Rounding alternates, but next to what X is that is rest.
    const Function rounding = [](double t) { return 1e-14 * sign(t); };
    expect_both(line.of(
                    40, [&](double t) { return 100 + rounding(t); }, rounding),
                0, 1e-4);
    expect_both(line.of(
                    40, [](double t) { return 100 + t / 3; }, [](double) { return 1.0 / 3; }),
                0, 1e-12);
    expect_both(line.of(
                    40, [](double t) { return t / 3 + 0.7 * t * t; },
                    [](double t) { return 1.0 / 3 + 1.4 * t; }),
                0, 1e-12);
}

TEST(Zigzag, IgnoresKinks)
{
    const Line line;
    for (const double kink : {3.0, 7.3, 20.0, 38.0, 38.5, 39.0}) {
        const Zigzag acceleration = line.of(
            40, [&](double t) { return t > kink ? (t - kink) * (t - kink) : 0; },
            [&](double t) { return 2 * std::max(t - kink, 0.0); });
        EXPECT_LT(std::max(acceleration.positions, acceleration.momenta), 0.3) << kink;
        for (const double before : {0.0, 0.01, -1.0}) {   // a run that starts, or turns
            const Zigzag velocity = line.of(
                40, [&](double t) { return (t < kink ? before : 1) * (t - kink); },
                [&](double t) { return t < kink ? before : 1; });
            EXPECT_LT(std::max(velocity.positions, velocity.momenta), 0.3) << kink;
        }
    }
}

TEST(Zigzag, OfALoadThatSwitchesOnAndOffIsSmall)
{
    // A rectangular torque's motion: acceleration from 10 s to 20 s, rest before and a steady run after it.
    const Line line;
    const auto v = [](double t) { return std::clamp(t - 10, 0.0, 10.0); };
    const auto x = [&](double t) { return v(t) * v(t) / 2 + (t > 20 ? 10 * (t - 20) : 0); };
    const Zigzag z = line.of(40, x, v);
    EXPECT_LT(std::max(z.positions, z.momenta), 0.02);
}

TEST(Zigzag, FindsTheWindowWhereItIs)
{
    // Twenty seconds of zig-zag in a smooth swing of the same speed.
    const Line line;
    const auto inside = [](double t) { return t > 39.5 && t < 60.5 ? 1.0 : 0.0; };
    const Zigzag z = line.of(
        100, [&](double t) { return std::sin(0.3 * t) + 0.3 * inside(t) * sign(t); },
        [&](double t) { return 0.3 * std::cos(0.3 * t); });
    EXPECT_GT(z.positions, 0.85);
    EXPECT_LT(z.momenta, 0.05);
    EXPECT_NEAR(z.worst_time, 50, 5);
}

TEST(Zigzag, IsNotHiddenByAFastFlight)
{
    // A body flies at 10 m/s and its directors alternate by 0.01.
    Model model;
    model.add_body(rigid_body("box", hand_made::skew_properties()));
    const Matrix4& m = model.bodies()[0].mass;
    const Vector3 c = hand_made::skew_properties().center_of_mass;
    const auto at = [&](double t, double angle, double spin) {
        const Vector3 v{10, 0, 0}, w{0, 0, spin};
        const Matrix3 d = directors_from_rotation_vector({0, 0, angle});
        const Matrix34 X = configuration(t * v - d * c, d);
        return State{t, {X}, {rate(X, v - cross(w, d * c), w)}};
    };
    const auto judge = [&](const hand_made::StateAt& state) {
        Motion flight = motion(model, mesh(0, 40, 40), 1, state);
        const Zigzag of_ends = zigzag(model, flight);
        flight.P = torn_field(flight.mesh, 12, 1, [&](int, double t) { return stacked(state(t).V[0] * m); });
        EXPECT_NEAR(zigzag(model, flight).momenta, of_ends.momenta, 1e-3) << "two ways to the same";
        return of_ends;
    };
    const Zigzag trembling = judge([&](double t) { return at(t, 0.01 * sign(t), 0.02 * sign(t)); });
    EXPECT_GT(trembling.positions, 0.9);
    EXPECT_GT(trembling.momenta, 0.9);
    // the spin alone, without the flight, is the same; one far below the speed of flight does not count
    const Zigzag faint = judge([&](double t) { return at(t, 1e-6 * sign(t), 2e-6 * sign(t)); });
    EXPECT_LT(faint.positions, 0.01);
    EXPECT_LT(faint.momenta, 0.01);
    const Zigzag smooth = judge([&](double t) { return at(t, 0.3 * t, 0.3); });
    EXPECT_LT(std::max(smooth.positions, smooth.momenta), 0.05);
}

TEST(Zigzag, DoesNotMindUnevenElements)
{
    const Line line;
    TimeMesh uneven{{0}};
    for (int i = 0; i < 60; ++i) uneven.ends.push_back(uneven.ends.back() + (i % 20 < 10 ? 0.1 : 0.013));
    const Function x = [](double t) { return 5 + t + std::sin(t); };
    const Function v = [](double t) { return 1 + std::cos(t); };
    const Zigzag z = zigzag(line.model, line.along(uneven, 1, x, v));
    EXPECT_LT(std::max(z.positions, z.momenta), 0.05);
    // an element of 10 ns, where differences are rounding
    uneven.ends.insert(uneven.ends.begin() + 30, uneven.ends[29] + 1e-8);
    const Zigzag sliver = zigzag(line.model, line.along(uneven, 1, x, v));
    EXPECT_LT(std::max(sliver.positions, sliver.momenta), 0.05);
}

TEST(Zigzag, DoesNotMindJumpsOfXBetweenBlocksButLooksAcrossThem)
{
    const Line line;
    const TimeMesh times = mesh(0, 40, 40);
    const auto torn = [&](const Function& x, double jump) {
        Motion m = line.along(times, 1, x, [](double) { return 0.0; });
        m.X = torn_field(times, 12, 1, [&](int e, double t) {
            return stacked(configuration({x(t) + jump * std::sin(1.0 * e), 3, -1}, {}));
        });
        return zigzag(line.model, m).positions;
    };
    const Function swing = [](double t) { return std::sin(0.2 * t); };
    EXPECT_LT(torn(swing, 1), 0.02);
    EXPECT_NEAR(torn(sign, 0), 1, 1e-12);
    EXPECT_NEAR(torn(sign, 1), 1, 1e-12);
}

TEST(Zigzag, HonoursDenominators)
{
    // The same nodal values with other denominators are another curve between the nodes.
    const Line line;
    const auto judge = [&](int degree, bool rational) {
        const int n = 12;
        Motion m = line.along(
            mesh(0, n * degree, n), degree, [](double t) { return t; }, [](double) { return 1.0; });
        for (std::size_t i = 0; rational && i < m.X.values.size() / 12; ++i)
            m.X.denominators.push_back(i % 2 == 0 ? 1 : 9);
        return zigzag(line.model, m).positions;
    };
    EXPECT_LT(judge(2, false), 1e-9);
    EXPECT_LT(judge(2, true), 1e-9) << "steps end at nodes";
    EXPECT_LT(judge(3, false), 1e-9);
    EXPECT_GT(judge(3, true), 0.1) << "thirds of an element are no nodes";
}

TEST(Zigzag, WeighsBodiesByTheirMasses)
{
    Model model;
    model.add_body(point_mass("heavy", 100, {}));
    model.add_body(point_mass("light", 1, {}));
    const auto of = [&](bool heavy) {
        return zigzag(model, motion(model, mesh(0, 40, 40), 1, [&](double t) {
                          State a = state_of_point(t, {t, 0, 0}, {1, 0, 0});
                          State b = state_of_point(t, {0, sign(t) / 2, 0}, {0, sign(t), 0});
                          if (heavy) std::swap(a, b);
                          return State{t, {a.X[0], b.X[0]}, {a.V[0], b.V[0]}};
                      }));
    };
    expect_both(of(true), std::sqrt(100.0 / 101), 1e-9);
    expect_both(of(false), std::sqrt(1.0 / 101), 1e-9);
}

TEST(Zigzag, WorksForMassesThatCannotBeInverted)
{
    Model model;
    MassProperties needle{1, {}, {0, 0, 0, 0, 1, 0, 0, 0, 1}};
    model.add_body(rigid_body("needle", needle));
    Motion turn = motion(model, mesh(0, 40, 40), 1, [](double t) {
        const Vector3 w{0, 0, 0.5};
        const Matrix34 X = configuration({}, directors_from_rotation_vector(t * w));
        return State{t, {X}, {rate(X, {}, w)}};
    });
    turn.P = torn_field(turn.mesh, 12, 1, [](int, double) { return std::vector<double>(12, 0.0); });
    expect_both(zigzag(model, turn), std::pow(std::sin(0.25), 2), 1e-3);
}

TEST(Zigzag, OfTooFewSamplesIsNotJudged)
{
    const Line line;
    EXPECT_EQ(line.of(5, sign, sign).positions, 0);
    EXPECT_NEAR(line.of(6, sign, sign).positions, 1, 1e-12);
    EXPECT_NEAR(zigzag(line.model, line.along(9, sign, sign), 100).positions, 1, 1e-12);
    EXPECT_THROW(zigzag(line.model, line.along(9, sign, sign), 5), InputError);
    EXPECT_EQ(zigzag(line.model, line.along({{0.0}}, 1, sign, sign)).positions, 0);
}

TEST(Zigzag, OfANumberThatIsNoneIsNone)
{
    const Line line;
    const Function x = [](double t) { return std::sin(0.2 * t); };
    const Motion swing = line.along(40, x, x);
    Motion m = swing;
    m.X.coefficient(30, 0)[0] = NAN;
    EXPECT_TRUE(std::isnan(zigzag(line.model, m).positions));
    EXPECT_FALSE(std::isnan(zigzag(line.model, m).momenta));
    EXPECT_NEAR(zigzag(line.model, m).worst_time, 30, 1.5);
    m = swing;
    m.velocities[12][0] = INFINITY;
    EXPECT_TRUE(std::isnan(zigzag(line.model, m).momenta));
    EXPECT_NEAR(zigzag(line.model, m).worst_time, 12, 1.5);
    m = line.along(4, x, x);   // too short to judge, but not to see that it is none
    m.X.coefficient(2, 0)[0] = NAN;
    EXPECT_TRUE(std::isnan(zigzag(line.model, m).positions));
}

TEST(Zigzag, IsRelativeToTheSpeedInTheMeanOverTime)
{
    // 20 s at 10 m/s, then 20 ms of alternation by 1 m/s: as many samples, but no time.
    const Line line;
    TimeMesh times{{0}};
    for (int i = 0; i < 40; ++i) times.ends.push_back(times.ends.back() + (i < 20 ? 1 : 1e-3));
    const auto x = [](double t) {
        return t < 20 ? 10 * t : 200 - 0.5e-3 * sign((t - 20) * 1000);
    };
    EXPECT_NEAR(zigzag(line.model, line.along(times, 1, x, [](double) { return 0.0; })).positions, 0.1, 0.02);
}

TEST(Zigzag, NeverExceedsOne)
{
    const Line line;
    // A burst that ends with its window: more second differences for its size than a pure zig-zag has.
    const Function burst = [](double t) { return t > 0.5 && t < 4.5 ? sign(t) : 0; };
    EXPECT_EQ(line.of(5, burst, burst).momenta, 1);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 20; ++n) {
        std::vector<double> noise;
        for (int i = 0; i <= 60; ++i) noise.push_back(normal(random) * (i % 7 == n % 7 ? 100 : 1));
        const Function x = [&](double t) { return noise[static_cast<std::size_t>(std::lround(t))]; };
        const Zigzag z = line.of(60, x, x);
        EXPECT_LE(z.positions, 1);
        EXPECT_LE(z.momenta, 1);
        EXPECT_GT(z.positions, 0.5);
    }
}

}   // namespace
}   // namespace livens::zigzag_test
