#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens {
namespace {

using hand_made::mesh;
using hand_made::motion;
using hand_made::state_of_point;

TEST(Action, OfAFreeFallIsExactPerElement)
{
    const double m = 2, g = 9.81, v0 = 3, z0 = 1;
    Model model{{0, 0, -g}};
    model.add_body(point_mass("stone", m, {0, 0, z0}, {0, 0, v0}));
    const Motion fall = motion(model, mesh(0, 1.2, 3), 2, [&](double t) {
        return state_of_point(t, {0, 0, z0 + v0 * t - g * t * t / 2}, {0, 0, v0 - g * t});
    });
    const ActionSeries series = action(model, fall);
    ASSERT_EQ(series.lagrangian.size(), 3u);
    // int m/2 (v0 - g t)^2 and int m g z
    const auto kinetic = [&](double t) {
        return m / 2 * (v0 * v0 * t - v0 * g * t * t + g * g * t * t * t / 3);
    };
    const auto potential = [&](double t) { return m * g * (z0 * t + v0 * t * t / 2 - g * t * t * t / 6); };
    for (int e = 0; e < 3; ++e) {
        const double a = 0.4 * e, b = 0.4 * (e + 1);
        const double T = kinetic(b) - kinetic(a), V = potential(b) - potential(a);
        EXPECT_NEAR(series.lagrangian[e], T - V, 1e-12);
        EXPECT_NEAR(series.hamiltonian[e], T + V, 1e-12);
        EXPECT_NEAR(series.hamiltonian[e], 0.4 * (m / 2 * v0 * v0 + m * g * z0),
                    1e-12);   // energy times length
    }
}

TEST(Action, IncludesThePotentialOfLoads)
{
    const double k = 4, x0 = 0.5, w = 2;   // m = 1; over a half period the action of an oscillator is 0
    Model model;
    model.add_body(point_mass("bob", 1, {x0, 0, 0}));
    model.add_load(spring_damper("spring", world, {-1, 0, 0}, 0, {}, {k, 0, 1}));
    const double half = std::acos(-1.0) / w;
    const Motion swing = motion(model, mesh(0, half, 8), 8, [&](double t) {
        return state_of_point(t, {x0 * std::cos(w * t), 0, 0}, {-x0 * w * std::sin(w * t), 0, 0});
    });
    const ActionSeries series = action(model, swing);
    double lagrangian = 0, hamiltonian = 0;
    for (const double v : series.lagrangian) lagrangian += v;
    for (const double v : series.hamiltonian) hamiltonian += v;
    EXPECT_NEAR(lagrangian, 0, 1e-12);
    EXPECT_NEAR(hamiltonian, half * 0.5 * k * x0 * x0, 1e-12);
    EXPECT_LT(series.lagrangian.front(), -0.01);   // starts at rest: all is potential
}

TEST(Action, OfAQuadraticPotentialIsExact)
{
    Model model;
    model.add_body(point_mass("bob", 1, {-1, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {6, 0, 0}));
    const Motion line = motion(model, mesh(0, 2, 1), 1, [](double t) {
        return state_of_point(t, {t - 1, 0, 0}, {1, 0, 0});
    });
    // int over [-1, 1] of 1/2 -+ 3 x^2
    EXPECT_NEAR(action(model, line).lagrangian[0], 1 - 2, 1e-14);
    EXPECT_NEAR(action(model, line).hamiltonian[0], 1 + 2, 1e-14);
}

TEST(Action, OfTheTrueMotionIsSmallest)
{
    // Hamilton: a disturbed fall with the same ends has a larger action; in first order nothing changes.
    Model model{{0, 0, -9.81}};
    model.add_body(point_mass("stone", 1, {0, 0, 0}));
    const auto total = [&](double disturbance) {
        const Motion m = motion(model, mesh(0, 1, 4), 4, [&](double t) {
            return state_of_point(t, {0, 0, -9.81 * t * t / 2 + disturbance * t * (1 - t)}, {});
        });
        double sum = 0;
        for (const double v : action(model, m).lagrangian) sum += v;
        return sum;
    };
    EXPECT_NEAR(total(0.1) - total(0), 0.01 / 6, 1e-13);   // 1/2 int (1 - 2 t)^2 d^2
    EXPECT_NEAR(total(-0.1) - total(0), 0.01 / 6, 1e-13);
}

}   // namespace
}   // namespace livens
