// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::momentum_test {
namespace {

/// Centre of mass, its velocity, and the inertia about it in world axes: Newton's and Euler's view of the
/// same state.
struct Classical {
    double mass;
    Vector3 x, v, w;
    Matrix3 J;
};

struct Spinning {
    Model model{{0.3, -9.81, 1.1}};
    Classical classical;
    State state;

    Spinning()
    {
        const MassProperties p = hand_made::skew_properties();
        Placement place;
        place.position = {1, 2, -0.5};
        place.directors = directors_from_rotation_vector({0.4, -1.1, 0.3});
        place.velocity = {0.7, -0.2, 1.5};
        place.angular_velocity = {2, -1, 0.5};
        model.add_body(rigid_body("body", p, place));
        model.add_body(point_mass("point", 0.7, {3, 1, -1}, {0, 2, 1}));
        state = model.start();
        const Vector3 r = place.directors * p.center_of_mass;
        classical = {p.mass, place.position + r, place.velocity + cross(place.angular_velocity, r),
                     place.angular_velocity, place.directors * p.inertia * transpose(place.directors)};
    }

    std::vector<Matrix34> momenta() const
    {
        std::vector<Matrix34> P;
        for (int b = 0; b < model.n_bodies(); ++b) P.push_back(state.V[b] * model.bodies()[b].mass);
        return P;
    }
};

void expect_near(const Vector3& found, const Vector3& exact, double tolerance)
{
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], exact[i], tolerance) << i;
}

TEST(KineticEnergy, IsThatOfTheCentreAndTheSpin)
{
    const Spinning s;
    const Classical& c = s.classical;
    const double exact = 0.5 * c.mass * dot(c.v, c.v) + 0.5 * dot(c.w, c.J * c.w) + 0.5 * 0.7 * 5;
    EXPECT_NEAR(kinetic_energy(s.model, s.state.X, s.state.V), exact, 1e-13);
}

TEST(PotentialEnergy, IsLowerAlongGravity)
{
    const Spinning s;
    const Vector3 g = s.model.gravity();
    const double exact = -s.classical.mass * dot(g, s.classical.x) - 0.7 * dot(g, Vector3{3, 1, -1});
    EXPECT_NEAR(potential_energy(s.model, {}, s.state.X, s.state.V), exact, 1e-13);

    std::vector<Matrix34> lower = s.state.X;
    lower[0].set_column(0, lower[0].column(0) + 0.1 * g);
    EXPECT_LT(potential_energy(s.model, {}, lower, s.state.V), exact);
}

TEST(Momentum, IsThatOfTheCentreAndTheSpin)
{
    const Spinning s;
    const Classical& c = s.classical;
    const Vector3 of_point = 0.7 * Vector3{0, 2, 1};
    expect_near(linear_momentum(s.momenta()), c.mass * c.v + of_point, 1e-14);
    const Vector3 exact = c.mass * cross(c.x, c.v) + c.J * c.w + cross(Vector3{3, 1, -1}, of_point);
    expect_near(angular_momentum(s.state.X, s.momenta()), exact, 1e-13);
}

}   // namespace
}   // namespace livens::momentum_test
