// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::action_test {
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

// The angular momentum (P36).

TEST(Action, IntegratesTheAngularMomentum)
{
    // A point on a straight line: x cross m v is constant. A body off the origin that turns: orbit and spin.
    Model model;
    const Vector3 x0{1, 2, 3}, v{-1, 0.5, 2}, w{0, 0, 1.7};
    model.add_body(rigid_body("top", with_center(box(3, {0.3, 0.5, 0.9}), {}), {.position = x0}));
    model.add_body(point_mass("stone", 1.5, x0));
    const MassProperties top = mass_properties(model.bodies()[0].mass);
    const Motion turn = motion(model, mesh(0, 1.2, 3), 8, [&](double t) {
        const Matrix34 X = configuration(x0 + t * v, directors_from_rotation_vector(t * w));
        State s = state_of_point(t, x0 + t * v, v);
        return State{t, {X, s.X[0]}, {rate(X, v, w), s.V[0]}};
    });
    const Vector3 exact = (top.mass + 1.5) * cross(x0, v) + top.inertia * w;
    for (const Vector3& moment : action(model, turn).angular_momentum)
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(moment[i], 0.4 * exact[i], 1e-9) << i;
}

// Motions with a momentum of their own: H = T*(P) + V, L = tr(P X'^T) - H.

struct WithMomenta {
    Model model{{0, 0, -2}};
    Motion m;
    Matrix34 P{};

    explicit WithMomenta(bool is_point)
    {
        if (is_point)
            model.add_body(point_mass("body", 2, {1, 0, 0}));
        else
            model.add_body(rigid_body("body", hand_made::skew_properties(), {.position = {1, 0, 0}}));
        // X' = 0.7 along z alone, P constant and of another velocity in all columns that there are
        m = motion(model, mesh(0, 1, 2), 2, [&](double t) {
            return state_of_point(t, {1, 0, 0.7 * t}, {0, 0, 0.7}, is_point ? Matrix3{} : identity<3>());
        });
        const int n = is_point ? 3 : 12;
        for (int i = 0; i < n; ++i) P[i] = 0.3 + 0.1 * i * (i % 2 == 0 ? 1 : -1);
        m.P = hand_made::torn_field(m.mesh, 12, 3, [&](int, double) { return hand_made::stacked(P); });
    }
};

TEST(Action, TakesTheKineticEnergyOfTheMomentum)
{
    for (const bool is_point : {false, true}) {
        const WithMomenta f(is_point);
        const Body& body = f.model.bodies()[0];
        // T* by the definition of the Legendre transform: the largest tr(P V^T) - 1/2 tr(V m V^T).
        const Matrix34 V = f.P * inverse_mass(body.mass, is_point);
        const double T = dot(f.P, V) - kinetic_energy(f.model, std::vector{f.m.at(0).X[0]}, std::vector{V});
        EXPECT_GT(T, 0.05);
        const ActionSeries series = action(f.model, f.m);
        for (int e = 0; e < 2; ++e) {
            const double t = 0.25 + 0.5 * e;   // mean over the element, as V is linear
            const double height = 0.7 * t * body.mass(0, 0) + (is_point ? 0 : body.mass(0, 3));
            const double hamiltonian = T + 2 * height, lagrangian = f.P[2] * 0.7 - hamiltonian;
            EXPECT_NEAR(series.hamiltonian[e], 0.5 * hamiltonian, 1e-14) << is_point;
            EXPECT_NEAR(series.lagrangian[e], 0.5 * lagrangian, 1e-14) << is_point;
            const Matrix34 X = f.m.at(t).X[0];
            const Vector3 moment = angular_momentum(std::vector{X}, std::vector{f.P});
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(series.angular_momentum[e][i], 0.5 * moment[i], 1e-14) << is_point << i;
        }
    }
}

TEST(Action, OfAConsistentMomentumIsThatOfTheVelocity)
{
    const double g = 9.81;
    Model model{{0, 0, -g}};
    model.add_body(point_mass("stone", 2, {}));
    const auto V = [&](double t) { return Vector3{1, 0, 3 - g * t}; };
    Motion fall = motion(model, mesh(0, 1, 3), 2, [&](double t) {
        return state_of_point(t, {t, 0, 3 * t - g * t * t / 2}, V(t));
    });
    const ActionSeries plain = action(model, fall);
    fall.P = hand_made::torn_field(fall.mesh, 12, 1, [&](int, double t) {
        return hand_made::stacked(configuration(2.0 * V(t), {}));
    });
    const ActionSeries own = action(model, fall);
    for (int e = 0; e < 3; ++e) {
        EXPECT_NEAR(own.lagrangian[e], plain.lagrangian[e], 1e-13);
        EXPECT_NEAR(own.hamiltonian[e], plain.hamiltonian[e], 1e-13);
        EXPECT_LT(norm(own.angular_momentum[e] - plain.angular_momentum[e]), 1e-13);
    }
}

TEST(Action, OfARationalMotionIsThatOfTheQuotient)
{
    // A quarter of a unit circle as a rational parabola; the area that x cross x' sweeps twice is pi / 2.
    Model model;
    model.add_body(point_mass("bob", 3, {1, 0, 0}));
    Motion arc = motion(model, mesh(0, 2, 1), 4, [](double t) {
        const double s = t / 2, W = 1 + s * s;
        return state_of_point(t, {(1 - s * s) / W, 2 * s / W, 0}, {});
    });
    for (const double s : gauss_lobatto(5).points) arc.X.denominators.push_back(1 + s * s);
    EXPECT_NEAR(action(model, arc).angular_momentum[0][2], 3 * std::acos(-1.0) / 2, 1e-10);
}

}   // namespace
}   // namespace livens::action_test
