// SPDX-License-Identifier: BSD-3-Clause
// Loads spread over surfaces, by their moments.   (P20)
#include "livens/multibody/surface_loads.h"

#include <gtest/gtest.h>

namespace livens {

namespace {

/// A flat side of area 2 with the normal d3, its middle at (0.1, 0, 0.5).
SurfaceMoments side()
{
    const Vector4 w{2, 0.2, 0, 1};
    return {w, outer(Vector3{0, 0, 1}, w)};
}

Matrix34 forces(const Load& load)
{
    LoadArguments at;
    at.X[0] = {1, 2, 3, 0, 1, 0, -1, 0, 0, 0, 0, 1};   // a quarter turn about z
    LoadForces F{};
    load.forces(at, F);
    return F[0];
}

TEST(SurfaceLoads, PressurePushesAgainstTheNormalAtTheMiddleOfASide)
{
    const Matrix34 F = forces(pressure("p", 0, side(), 3.0));
    EXPECT_LE(norm(F - outer(Vector3{0, 0, -6}, Vector4{1, 0.1, 0, 0.5})), 1e-15);
}

TEST(SurfaceLoads, PressureOnAClosedSurfaceNeitherPushesNorTurns)
{
    SurfaceMoments closed;   // int n dA = 0, int n theta^T dA = V I
    for (int i = 0; i < 3; ++i) closed.normal(i, i + 1) = 4;
    LoadArguments at;
    at.X[0] = {1, 2, 3, 0.9, 0.1, 0, -0.3, 1.2, 0.2, 0, 0.1, 0.8};   // skew
    LoadForces F{};
    pressure("p", 0, closed, 5.0).forces(at, F);
    Vector3 moment{};
    for (int i = 1; i < 4; ++i) moment += cross(at.X[0].column(i), F[0].column(i));
    EXPECT_EQ(norm(F[0].column(0)), 0);
    EXPECT_LE(norm(moment), 1e-14);
    EXPECT_GT(norm(F[0]), 20);
}

TEST(SurfaceLoads, TractionsStandInTheWorldOrFollowTheBody)
{
    const TimeVector t{1.0, 0.0, 0.0};
    const Vector4 w = side().area;
    EXPECT_LE(norm(forces(traction("t", 0, side(), t, Frame::inertial)) - outer(Vector3{1, 0, 0}, w)), 1e-15);
    EXPECT_LE(norm(forces(traction("t", 0, side(), t, Frame::body_fixed)) - outer(Vector3{0, 1, 0}, w)),
              1e-15);
}

TEST(SurfaceLoads, ForcesPerUnitMassActAsGravityDoes)
{
    Matrix4 m{};
    m.set_column(0, {3, 0.3, 0, -1});
    EXPECT_LE(norm(forces(body_force("b", 0, m, {0.0, 0.0, -9.81}, Frame::inertial)) -
                   outer(Vector3{0, 0, -9.81}, Vector4{3, 0.3, 0, -1})),
              1e-15);
}

}   // namespace

}   // namespace livens
