// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::rigidity_test {
namespace {

constexpr int pairs[6][2] = {{1, 1}, {2, 2}, {3, 3}, {1, 2}, {1, 3}, {2, 3}};

/// Accelerations of a body that turns with w and alpha; the point accelerates with a.
Matrix34 acceleration(const Matrix34& X, const Vector3& a, const Vector3& w, const Vector3& alpha)
{
    Matrix34 A = configuration(a, Matrix3{});
    for (int i = 1; i < 4; ++i) A.set_column(i, cross(alpha, X.column(i)) + cross(w, cross(w, X.column(i))));
    return A;
}

TEST(RigidityMultipliers, AreTheCentrifugalTensionOfASpin)
{
    // A sphere that spins about n: lambda_ab = e w^2 (delta_ab - n_a n_b), in whatever orientation.
    const double e = 0.3, w = 2;
    MassProperties ball;
    ball.mass = 1;
    ball.inertia = (2 * e) * identity<3>();   // E = (tr J / 2) I - J = e I
    Placement place;
    place.directors = directors_from_rotation_vector({1, 0.3, -0.4});
    Model model;
    model.add_body(rigid_body("ball", ball, place));
    const Vector3 n = (1 / std::sqrt(14.0)) * Vector3{1, 2, 3};   // body axes
    const State s = model.start();
    const Vector3 spin = w * (place.directors * n);
    const std::vector<Matrix34> A{acceleration(s.X[0], {}, spin, {})};
    const std::vector<double> lambda = rigidity_multipliers(model, 0, {}, s.X, s.V, A, {});
    for (int k = 0; k < 6; ++k) {
        const int a = pairs[k][0] - 1, b = pairs[k][1] - 1;
        EXPECT_NEAR(lambda[k], e * w * w * ((a == b ? 1 : 0) - n[a] * n[b]), 1e-14) << k;
    }
}

TEST(RigidityMultipliers, AreTheTensionOfAHangingBody)
{
    // A body hangs from a ball joint 1.5 m above its centre: lambda_33 is its weight times that length.
    const double mass = 2, g = 9.81;
    Model model{{0, 0, -g}};
    Placement place;
    place.position = {1, 2, -1.5};
    model.add_body(rigid_body("lamp", with_mass(sphere(1, 0.2), mass), place));
    model.add_joint(spherical("hook", world, 0, {{1, 2, 0}, {0, 0, 1.5}, {0, 0, 1}, {0, 0, 1}}));
    const State s = model.start();
    const std::vector<Matrix34> rest(1);
    const std::vector<double> multipliers{0, 0, -mass * g};   // P' = 0 = weight - G^T lambda
    const std::vector<double> lambda = rigidity_multipliers(model, 0, {}, s.X, s.V, rest, multipliers);
    const double exact[6] = {0, 0, mass * g * 1.5, 0, 0, 0};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(lambda[k], exact[k], 1e-13) << k;
}

TEST(RigidityMultipliers, CloseTheEquationsOfMotion)
{
    // A free body with every kind of load: with alpha from Euler's equation the multipliers make up the rest.
    const MassProperties p = with_center(hand_made::skew_properties(), {});
    Placement place;
    place.directors = directors_from_rotation_vector({0.4, 1.3, -0.2});
    place.angular_velocity = {1, -2, 0.5};
    Model model{{0, 0, -9.81}};
    model.add_body(rigid_body("other", p, {}));
    model.add_body(rigid_body("body", p, place));
    const Vector3 mu{0.3, -0.7, 1.1}, f{5, 1, -2}, theta{0.1, 0.2, -0.4};
    model.add_load(torque("motor", 1, {mu[0], mu[1], mu[2]}, Frame::inertial));
    model.add_load(point_force("push", 1, theta, {f[0], f[1], f[2]}, Frame::inertial));
    model.add_load(point_force("elsewhere", 0, theta, {1e3, 1e3, 1e3}, Frame::inertial));
    const double k = 40;   // free length 0: the spring pulls with k r
    const Vector3 hook{-0.3, 0.1, 0.2}, other_hook{0.5, 0, 0};
    model.add_load(spring_damper("spring", 0, other_hook, 1, hook, {k, 0, 0}));
    const State s = model.start();

    const Matrix3 d = place.directors, J = d * p.inertia * transpose(d);
    const Vector3 w = place.angular_velocity, pull = k * (other_hook - d * hook);
    const Vector3 moment = mu + cross(d * theta, f) + cross(d * hook, pull);
    const Vector3 alpha = inverse(J) * (moment - cross(w, J * w));
    const Vector3 a = (1 / p.mass) * (f + pull) + model.gravity();
    std::vector<Matrix34> A(2);
    A[1] = acceleration(s.X[1], a, w, alpha);
    const std::vector<double> lambda = rigidity_multipliers(model, 1, {}, s.X, s.V, A, {});

    const Matrix3 tensor{lambda[0], lambda[3], lambda[4], lambda[3], lambda[1],
                         lambda[5], lambda[4], lambda[5], lambda[2]};
    const Matrix3 d_forces = d * tensor;   // column a: sum_b lambda_ab d_b
    for (int c = 0; c < 3; ++c) {
        const Vector3 inertial = (A[1] * model.bodies()[1].mass).column(c + 1);
        const Vector3 applied = 0.5 * cross(mu, d.column(c)) + theta[c] * f + hook[c] * pull;
        EXPECT_LT(norm(applied - inertial - d_forces.column(c)), 1e-13) << c;
    }
    // and a wrong angular acceleration cannot be made up for
    A[1] = acceleration(s.X[1], a, w, alpha + Vector3{0.1, 0, 0});
    const std::vector<double> wrong = rigidity_multipliers(model, 1, {}, s.X, s.V, A, {});
    EXPECT_GT(std::abs(wrong[3] - lambda[3]) + std::abs(wrong[4] - lambda[4]) +
                  std::abs(wrong[5] - lambda[5]),
              1e-3);
}

TEST(RigidityMultipliers, OfAPointMassAreZero)
{
    Model model{{0, 0, -9.81}};
    model.add_body(point_mass("dust", 1, {1, 2, 3}));
    const State s = model.start();
    EXPECT_EQ(rigidity_multipliers(model, 0, {}, s.X, s.V, s.V, {}), std::vector<double>(6, 0.0));
}

}   // namespace
}   // namespace livens::rigidity_test
