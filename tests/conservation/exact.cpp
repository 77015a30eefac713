// SPDX-License-Identifier: BSD-3-Clause
// Motions that the elements reproduce exactly: what is left is rounding, some ulps an element.
#include <limits>

#include "mechanisms.h"

namespace livens::tests::exact_test {
namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();
constexpr double end_time = 2.5;
constexpr int n = 50;

/// Ulps in all n elements: momenta keep their bits and increments are added up without rounding; what is left is
/// how well the element's equations solve for the increment, whose condition grows with the square of the degree.
double allowed(int degree) { return (20 + 0.7 * degree * degree) * ulp; }

State solved(const Model& model, int degree) { return last(solve_evenly(model, end_time, n, degree)); }

TEST(Lobatto, ReproducesConstantVelocity)
{
    Placement placement;
    placement.position = {0.2, 0.4, -0.9};
    placement.velocity = {3.1, -0.7, 12.3};
    Model model;
    model.add_body(rigid_body("body", with_center(box(7.3, {1, 2, 3}), {0.1, 0.2, -0.3}), placement));
    model.add_body(point_mass("point", 0.3, placement.position, placement.velocity));
    const Vector3 X = placement.position + end_time * placement.velocity;
    for (int degree = 1; degree <= 16; ++degree) {
        const State end = solved(model, degree);
        for (int b = 0; b < 2; ++b) {
            EXPECT_LE(norm(end.X[b].column(0) - X), allowed(degree) * norm(X)) << "lobatto(" << degree << ")";
            EXPECT_LE(norm(end.V[b].column(0) - placement.velocity),
                      allowed(degree) * norm(placement.velocity));
        }
        EXPECT_LE(norm(directors(end.X[0]) - identity<3>()), allowed(degree));
    }
}

TEST(Lobatto, ReproducesUniformAcceleration)
{
    const Vector3 g{1.5, -2.5, -9.81}, v{3.1, -0.7, 12.3};
    Placement placement;
    placement.velocity = v;
    Model model(g);
    model.add_body(rigid_body("body", box(7.3, {1, 2, 3}), placement));
    model.add_body(point_mass("point", 0.3, {0, 0, 0}, v));
    const Vector3 X = end_time * v + 0.5 * end_time * end_time * g, V = v + end_time * g;
    for (int degree = 1; degree <= 16; ++degree) {
        const State end = solved(model, degree);
        for (int b = 0; b < 2; ++b) {
            EXPECT_LE(norm(end.X[b].column(0) - X), allowed(degree) * norm(X)) << "lobatto(" << degree << ")";
            EXPECT_LE(norm(end.V[b].column(0) - V), allowed(degree) * norm(V)) << "lobatto(" << degree << ")";
        }
        EXPECT_EQ(directors(end.X[0]), identity<3>()) << "nothing turns it";
    }
}

// A turn is no polynomial: below degree 4 it is met with the order of the method only (see
// tests/convergence).
TEST(Lobatto, ReproducesSteadySpin)
{
    const Vector3 w{0, 0, 1.7};
    Placement placement;
    placement.angular_velocity = w;
    Model model;
    model.add_body(rigid_body("body", box(7.3, {1, 2, 3}), placement));
    const Matrix3 turn = directors_from_rotation_vector(end_time * w);
    for (int degree = 5; degree <= 16; ++degree) {
        const State end = solved(model, degree);
        EXPECT_LE(norm(directors(end.X[0]) - turn), 2 * allowed(degree) * norm(end_time * w))
            << "lobatto(" << degree << ")";
        EXPECT_LE(norm(angular_velocity(end.X[0], end.V[0]) - w), allowed(degree) * norm(w))
            << "lobatto(" << degree << ")";
    }
}

}   // namespace
}   // namespace livens::tests::exact_test
