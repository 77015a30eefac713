// SPDX-License-Identifier: BSD-3-Clause
// Loads spread over surfaces, by their moments.   (P20)
#include "livens/multibody/loads/surface_loads.h"

#include <gtest/gtest.h>

namespace livens::surface_loads_test {

namespace {

/// A rectangle about `middle` with the half sides u and v, and the normal n, by hand.
SurfaceMoments rectangle(const Vector3& middle, const Vector3& u, const Vector3& v, const Vector3& n)
{
    const double area = 4 * norm(u) * norm(v);
    const Vector4 p = point(middle);
    Matrix4 of = outer(p, p);
    for (const Vector3& side : {u, v}) {   // int s^2 over -1..1 is a third of the length
        const Vector4 s{0, side[0], side[1], side[2]};
        of += 1. / 3 * outer(s, s);
    }
    SurfaceMoments m;
    m.area = area * of;
    for (int i = 0; i < 3; ++i) m.normal[i] = area * n[i] * of;
    return m;
}

/// A flat side of area 2 with the normal d3, its middle at (0.1, 0, 0.5).
SurfaceMoments side() { return rectangle({0.1, 0, 0.5}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}); }

/// All sides of a box of 2 x 1 x 0.6 about `c`.
SurfaceMoments box(const Vector3& c)
{
    const std::array<Vector3, 3> half{Vector3{1, 0, 0}, Vector3{0, 0.5, 0}, Vector3{0, 0, 0.3}};
    SurfaceMoments all;
    for (int i = 0; i < 3; ++i)
        for (const double sign : {-1., 1.})
            all = all + rectangle(c + sign * half[i], half[(i + 1) % 3], half[(i + 2) % 3],
                                  sign / norm(half[i]) * half[i]);
    return all;
}

/// Of F about the reference point: sum d_i x F_i.
Vector3 moment(const Matrix34& X, const Matrix34& F)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), F.column(i));
    return sum;
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
    for (int i = 0; i < 3; ++i) closed.normal[i](0, i + 1) = closed.normal[i](i + 1, 0) = 4;
    LoadArguments at;
    at.X[0] = {1, 2, 3, 0.9, 0.1, 0, -0.3, 1.2, 0.2, 0, 0.1, 0.8};   // skew
    LoadForces F{};
    pressure("p", 0, closed, 5.0).forces(at, F);
    EXPECT_EQ(norm(F[0].column(0)), 0);
    EXPECT_LE(norm(moment(at.X[0], F[0])), 1e-14);
    EXPECT_GT(norm(F[0]), 20);
}

TEST(SurfaceLoads, TractionsStandInTheWorldOrFollowTheBody)
{
    const TimeVector t{1.0, 0.0, 0.0};
    const Vector4 w = side().area.column(0);
    EXPECT_LE(norm(forces(traction("t", 0, side(), t, Frame::inertial)) - outer(Vector3{1, 0, 0}, w)), 1e-15);
    EXPECT_LE(norm(forces(traction("t", 0, side(), t, Frame::body_fixed)) - outer(Vector3{0, 1, 0}, w)),
              1e-15);
}

/// Archimedes: under water a body is borne by the weight of what it displaces, at the centroid of that,
/// wherever and however it lies.
TEST(SurfaceLoads, PressureThatGrowsWithDepthBearsWhatIsDisplaced)
{
    const Vector3 c{0.3, -0.2, 0.1};
    const double volume = 2 * 1 * 0.6, c1 = std::cos(0.4), s1 = std::sin(0.4);
    LoadArguments at;
    at.X[0] = {1, 2, -30, c1, s1, 0, -s1, c1, 0, 0, 0, 1};
    const Matrix3 about_x{1, 0, 0, 0, c1, s1, 0, -s1, c1};   // columns
    for (int i = 0; i < 3; ++i) at.X[0].set_column(i + 1, about_x * at.X[0].column(i + 1));
    LoadForces F{};
    pressure("p", 0, box(c), 1e5, {0.0, 0.0, -9810.0}).forces(at, F);
    const Vector3 up{0, 0, 9810 * volume};
    EXPECT_LE(norm(F[0].column(0) - up), 1e-9);
    EXPECT_LE(norm(moment(at.X[0], F[0]) - cross(directors(at.X[0]) * c, up)), 1e-9);
    EXPECT_GT(norm(cross(directors(at.X[0]) * c, up)), 1000);
}

/// A flap held at its upper edge in water at rest: its force rho g h A at the middle, and the moment that the
/// growth with depth adds, rho g times the second moment of area.
TEST(SurfaceLoads, PressureThatGrowsWithDepthOpensAFlap)
{
    const double b = 2, h = 0.6, g = 9810;   // wide along y, its normal d1, upper edge at z = 0
    const SurfaceMoments flap = rectangle({0, 0, -h / 2}, {0, b / 2, 0}, {0, 0, h / 2}, {1, 0, 0});
    LoadArguments at;
    LoadForces F{};
    pressure("p", 0, flap, 0.0, {0.0, 0.0, -g}).forces(at, F);
    EXPECT_LE(norm(F[0].column(0) - Vector3{-g * h / 2 * b * h, 0, 0}), 1e-11);
    EXPECT_LE(norm(moment(at.X[0], F[0]) - Vector3{0, g * b * h * h * h / 3, 0}), 1e-11);
}

/// Shear that grows from the middle of a side to its edge twists: int r^2 dA.
TEST(SurfaceLoads, TractionsThatGrowFromTheMiddleTwist)
{
    const SurfaceMoments top = rectangle({0, 0, 0.5}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, 1});
    const std::vector<TimeVector> twist{{0.0, -3.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    const TimeVector none{0.0, 0.0, 0.0};
    LoadArguments at;
    at.X[0] = {1, 2, 3, 0, 1, 0, -1, 0, 0, 0, 0, 1};
    for (const Frame frame : {Frame::inertial, Frame::body_fixed}) {
        LoadForces F{};
        traction("t", 0, top, none, frame, twist).forces(at, F);
        EXPECT_LE(norm(F[0].column(0)), 1e-14);
        const double polar = 2 * (4. + 1) / 12;
        // In world axes the field does not turn with the quarter turn of the body: it points outwards.
        const Vector3 expected{0, 0, frame == Frame::body_fixed ? 3 * polar : 0};
        EXPECT_LE(norm(moment(at.X[0], F[0]) - expected), 1e-14);
    }
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

}   // namespace livens::surface_loads_test
