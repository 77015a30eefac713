// SPDX-License-Identifier: BSD-3-Clause
// Eleven digits where the motion is known in closed form.
#include <array>
#include <numbers>

#include "convergence/studies.h"

namespace livens::tests::closed_forms_test {
namespace {

/// Jacobi's sn, cn and dn by the arithmetic-geometric mean [AbramowitzStegun1964, 16.4].
std::array<long double, 3> jacobi(long double u, long double k)
{
    std::array<long double, 24> a{1}, c{k};
    long double b = std::sqrt((1 - k) * (1 + k));
    int n = 0;
    for (; c[n] > 1e-20L; ++n) {
        a[n + 1] = (a[n] + b) / 2;
        c[n + 1] = (a[n] - b) / 2;
        b = std::sqrt(a[n] * b);
    }
    long double phi = std::ldexp(a[n] * u, n), before = phi;
    for (; n > 0; --n) {
        before = phi;
        phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
    }
    return {std::sin(phi), std::cos(phi), std::cos(phi) / std::cos(before - phi)};
}

/// The largest error at output times, by the length of the model or in rad; a failure if it does not end
/// well.
double error_to_eleven_digits(const Model& model, double end, const std::function<Matrix34(double)>& exact)
{
    Span span{0, end, 1e-11};
    for (int k = 1; k <= 8; ++k) span.output.push_back(end * k / 8);
    const Solution s = solve(model, {model.start()}, span, Lobatto{0});
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LT(s.estimate.largest, 1e-11);
    double error = 0;
    for (const double t : span.output) {
        const Matrix34 d = s.motion.at(t).X[0] - exact(t);
        error = std::max({error, norm(d.column(0)) / model.length(), norm(directors(d)) / std::sqrt(2.0)});
    }
    return error;
}

/// From rest at a right angle to the vertical: sin(theta / 2) = k cd(w t), k = sin(pi / 4).
TEST(ClosedForms, APendulumToElevenDigits)
{
    const double length = 0.7, g = 9.81;
    Model model({0, 0, -g});
    model.add_body(point_mass("bob", 2, {length, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, length));
    EXPECT_LT(error_to_eleven_digits(model, 20,
                                     [&](double t) {
                                         const long double k = std::sqrt(0.5L);
                                         const auto [sn, cn, dn] =
                                             jacobi(std::sqrt(static_cast<long double>(g) / length) * t, k);
                                         const long double theta = 2 * std::asin(k * cn / dn);
                                         return configuration(
                                             {length * static_cast<double>(std::sin(theta)), 0,
                                              -length * static_cast<double>(std::cos(theta))},
                                             Matrix3{});
                                     }),
              3e-11);
}

TEST(ClosedForms, AMassOnASpringToElevenDigits)
{
    Model model;
    model.add_body(point_mass("mass", 2, {1.3, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {.stiffness = 50, .free_length = 1}));
    EXPECT_LT(error_to_eleven_digits(model, 20,
                                     [](double t) {
                                         return configuration({1 + 0.3 * std::cos(5 * t), 0, 0}, Matrix3{});
                                     }),
              3e-11);
}

/// Falls along a parabola and turns about its axis of largest inertia.
TEST(ClosedForms, AFallingBoxToElevenDigits)
{
    Model model({0, 0, -9.81});
    Placement placed;
    placed.velocity = {1, 0, 4};
    placed.angular_velocity = {0, 3, 0};
    model.add_body(rigid_body("box", {2, {}, Matrix3{1, 0, 0, 0, 3, 0, 0, 0, 2}}, placed));
    EXPECT_LT(
        error_to_eleven_digits(
            model, 8,   // and 282 m: 1e-11 of a length are 4e-14 of them, behind 10 s less than rounding
            [](double t) {
                const double c = std::cos(3 * t), s = std::sin(3 * t);
                return configuration({t, 0, 4 * t - 0.5 * 9.81 * t * t}, Matrix3{c, 0, -s, 0, 1, 0, s, 0, c});
            }),
        3e-11);
}

/// A top without torque: the precession turns about L at |L| / A, and the spin about its axis by what is
/// left.
TEST(ClosedForms, ATorqueFreeTopToElevenDigits)
{
    const double A = 2, C = 3;
    const Vector3 w{0.6, 0, 4};
    Model model;
    Placement placed;
    placed.angular_velocity = w;
    model.add_body(rigid_body("top", {1, {}, Matrix3{A, 0, 0, 0, A, 0, 0, 0, C}}, placed));
    const Vector3 L{A * w[0], 0, C * w[2]};
    const auto turn = [](const Vector3& axis, double angle) {
        const Matrix3 K = cross_matrix((1 / norm(axis)) * axis);
        return identity<3>() + std::sin(angle) * K + (1 - std::cos(angle)) * (K * K);
    };
    EXPECT_LT(error_to_eleven_digits(
                  model, 20,
                  [&](double t) {
                      const double left = w[2] - C * w[2] / A;
                      return configuration({}, turn(L, norm(L) / A * t) * turn({0, 0, 1}, left * t));
                  }),
              3e-11);
}

/// A top of 1600 turns a second, tilted by 0.7 and let go: its nutation and precession in Jacobi's elliptic
/// functions, evaluated with 30 digits (mpmath).
TEST(ClosedForms, AFastHeavyTopByAnAccuracyAlone)
{
    Placement placement;
    placement.directors = directors_from_rotation_vector({0.7, 0, 0});
    placement.angular_velocity = 1e4 * placement.directors.column(2);
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("top", {100, {0, 0, 0.2}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}, placement));
    model.add_joint(spherical("tip", world, 0, {}));
    const Solution s = solve(model, {model.start()}, Span{0, 1, 1e-6}, AutomaticFamily{});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const Matrix34 X = last(s).X[0];
    const Vector3 d1{-0.952079138705748282, -0.241512594422143626, -0.187661877793028817},
        d3{0.0126330182834644740, -0.644100284950316145, 0.764836734065494005};
    EXPECT_LE(norm(X.column(1) - d1), 3e-6);
    EXPECT_LE(norm(X.column(3) - d3), 1e-11);   // the axis is slow: the error is that of the spin
    EXPECT_NEAR(s.estimate.largest, norm(X.column(1) - d1), 0.5 * s.estimate.largest);
}

}   // namespace
}   // namespace livens::tests::closed_forms_test
