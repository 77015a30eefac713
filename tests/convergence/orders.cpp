// SPDX-License-Identifier: BSD-3-Clause
// Position and velocity at element ends converge with order 2p.
#include "convergence/studies.h"

namespace livens::tests::orders_test {
namespace {

/// Errors below this many gaps between two fine motions are left out of a rate: one part in 50 moves a rate
/// by 0.1.
constexpr double gaps = 50;

/// The rate of the last two errors above the floor, on both sides of 2p; `refinements` of them at least.
void expect_order(const Study& s, const Fine& reference, int degree, double tolerance,
                  std::size_t refinements = 4)
{
    const double X = gaps * reference.floor.X, V = gaps * reference.floor.V;
    EXPECT_GT(n_above(s, &Distance::X, X), refinements)
        << "lobatto(" << degree << "): too few errors above the floor " << X;
    EXPECT_GT(n_above(s, &Distance::V, V), refinements)
        << "lobatto(" << degree << "): too few errors above the floor " << V;
    EXPECT_NEAR(last_rate(s, &Distance::X, X), 2 * degree, tolerance)
        << "position, lobatto(" << degree << ")";
    EXPECT_NEAR(last_rate(s, &Distance::V, V), 2 * degree, tolerance)
        << "velocity, lobatto(" << degree << ")";
}

/// The slope by least squares, where the last two errors are too near the floor for a rate.
void expect_slope(const Study& s, const Fine& reference, int degree)
{
    const double X = gaps * reference.floor.X, V = gaps * reference.floor.V;
    EXPECT_GT(n_above(s, &Distance::X, X), 3u)
        << "lobatto(" << degree << "): too few errors above the floor " << X;
    EXPECT_GT(n_above(s, &Distance::V, V), 3u)
        << "lobatto(" << degree << "): too few errors above the floor " << V;
    EXPECT_GE(slope(s, &Distance::X, X), 2 * degree - 0.7) << "position, lobatto(" << degree << ")";
    EXPECT_GE(slope(s, &Distance::V, V), 2 * degree - 0.7) << "velocity, lobatto(" << degree << ")";
}

void expect_near(const Vector3& computed, const Vector3& published, double tolerance)
{
    EXPECT_LE(norm(computed - published), tolerance);
}

/// Fine motions that published digits have been checked against, so that the engine is not its own witness.
struct Case {
    Model model;
    double end;
    Fine reference;

    void expect_order(int degree, const std::vector<int>& n, double tolerance,
                      std::size_t refinements = 4) const
    {
        tests::orders_test::expect_order(lobatto_study(model, end, reference, degree, n), reference, degree, tolerance,
                            refinements);
    }
    void expect_slope(int degree, const std::vector<int>& n) const
    {
        tests::orders_test::expect_slope(lobatto_study(model, end, reference, degree, n), reference, degree);
    }
};

Case checked_free_box()
{
    const Model model = free_box();
    const Fine f = fine(model, 1, 8);
    // DOP853 at two tolerances, which agree to 7e-13 (tests/reference/data/reference.json)
    const Matrix3 published{0.7978044728981125,  0.5152634957366052,  -0.3130679686347035,
                            0.08821441839305263, 0.41390924139082147, 0.9060338604482853,
                            0.5964278995916737,  -0.7504549752333888, 0.2847649745598858};
    EXPECT_LE(norm(directors(f.end.X[0]) - published), 2e-12);
    return {model, 1, f};
}

Case checked_two_bricks()
{
    const Model model = two_bricks();
    const Fine f = fine(model, 0.5, 20);
    // two codes that agree to 3e-12 (tests/reference/data/benchmarks.json)
    expect_near(tip(f.end, 0), {0.263543552212, 0.260379198196, -0.928842004452}, 3e-12);
    expect_near(tip(f.end, 1), {1.122007823165, 0.510402770620, -1.376644760952}, 3e-12);
    return {model, 0.5, f};
}

Case checked_hinged_links()
{
    const Model model = hinged_links();
    const Fine f = fine(model, 1, 16);
    // DOP853 (tests/reference/data/benchmarks.json), 12 decimals
    expect_near(f.end.X[1] * point({0.5, 0, 0}), {-0.569764210469, -1.290546602590, 0}, 2e-12);
    expect_near(f.end.V[1] * point({0.5, 0, 0}), {-3.511984057912, 1.029854116171, 0}, 2e-12);
    return {model, 1, f};
}

TEST(Lobatto, ConvergesWithOrder2POnTheFreeBox)
{
    const Case c = checked_free_box();
    c.expect_order(1, {64, 80, 100, 125, 156, 195}, 0.15);
    c.expect_order(2, {20, 25, 31, 38, 47, 58}, 0.15);
    c.expect_order(3, {8, 10, 12, 15, 18, 22}, 0.15);
    c.expect_order(4, {4, 5, 6, 7, 8, 10}, 0.25);
    // Five elements or six leave 1e-12, so there is no room for more within this second; the next test has
    // it.
    c.expect_order(5, {4, 5, 6}, 0.25, 1);
}

TEST(Lobatto, ConvergesWithOrder2POnTheFreeBoxTurningOn)
{
    const Model model = free_box();
    const Case c{model, 2, fine(model, 2, 12)};
    c.expect_order(4, {8, 9, 10, 12, 15, 18}, 0.25);
    c.expect_order(5, {8, 9, 10, 11, 12}, 0.25);
}

TEST(Lobatto, ConvergesWithOrder2POnTwoBricksInSpace)
{
    const Case c = checked_two_bricks();
    c.expect_order(1, {256, 320, 400, 500, 625}, 0.15);
    c.expect_order(2, {64, 80, 100, 125, 156}, 0.15);
    c.expect_order(3, {25, 31, 38, 47, 58}, 0.15);
    c.expect_slope(4, {10, 12, 15, 18});
    c.expect_slope(5, {6, 7, 8, 9, 10});
}

TEST(Lobatto, ConvergesWithOrder2POnRevolutes)
{
    const Case c = checked_hinged_links();
    c.expect_order(1, {128, 160, 200, 250, 312}, 0.15);
    c.expect_order(2, {32, 40, 50, 62, 77}, 0.15);
    c.expect_order(3, {12, 15, 18, 22, 27}, 0.15);
    c.expect_slope(4, {7, 8, 10, 12, 15});
    c.expect_slope(5, {5, 6, 7, 8});
}

TEST(Lobatto, ConvergesWithOrder2POnRodsThatTurnACube)
{
    const Model model = cubes_on_rods(0.1);
    const Case c{model, 2, fine(model, 2, 80)};
    c.expect_slope(1, {400, 500, 625, 780});
    c.expect_slope(2, {160, 200, 250, 312});
    c.expect_slope(3, {80, 100, 125, 156});
    c.expect_slope(4, {56, 62, 70, 77});
}

TEST(Lobatto, ConvergesWithOrder2POnAFastTop)
{
    const Model model = heavy_top();
    const Case c{model, 0.5, fine(model, 0.5, 50)};
    c.expect_slope(2, {100, 125, 156, 195});
    c.expect_slope(3, {40, 50, 62, 77});
    c.expect_slope(4, {25, 31, 38, 47});
    c.expect_slope(6, {8, 9, 10, 12});
}

TEST(Lobatto, ConvergesWithOrder2PWithRedundantRows)
{
    const Model model = four_bar();
    const Case c{model, 0.5, fine(model, 0.5, 12)};
    c.expect_slope(1, {64, 80, 100, 125});
    c.expect_slope(2, {32, 40, 50, 62});
    c.expect_slope(3, {10, 12, 15, 18});
    c.expect_slope(4, {6, 7, 8, 10});
}

// A damper, a torque that turns with its body and varies in time, a point mass, a weld, a universal joint.
TEST(Lobatto, ConvergesWithOrder2PUnderLoadsOfAllKinds)
{
    const Model model = medley();
    const Case c{model, 1, fine(model, 1, 16)};
    c.expect_slope(1, {100, 125, 156, 195});
    c.expect_slope(2, {20, 25, 31, 38});
    c.expect_slope(3, {10, 12, 15, 18});
    c.expect_slope(4, {6, 7, 8, 10});
    const Case longer{model, 1.5, fine(model, 1.5, 24)};
    longer.expect_slope(5, {7, 8, 9, 10});
}

// Elements end where a load jumps; left and right of the jump each sees its own side.
TEST(Lobatto, ConvergesWithOrder2PAcrossAJumpOfTheLoad)
{
    const double mu = 2 / std::sqrt(3.0);
    Model model;
    const int body = model.add_body(rigid_body("box", box(1.5, {2, 1, 1})));
    model.add_load(torque("motor", body, window(TimeVector{mu, mu, mu}, 0.5, 1.5), Frame::inertial));
    const Fine f = fine(model, 2, 16);
    const Case c{model, 2, f};
    auto solve_between_jumps = [&](int degree, int n) {
        SolveOptions options;
        options.tolerance = 1e-14;
        const TimeMesh mesh = make_time_mesh(0, 2, n, model.load_breaks());
        return distance(last(solve(model, {model.start()}, mesh, Lobatto{degree}, options)), f.end);
    };
    // multiples of 4, so that the mesh stays uniform
    for (auto [degree, n] : {std::pair{1, std::vector{64, 80, 100, 124, 152}},
                             {2, {40, 48, 60, 72, 88}},
                             {3, {16, 20, 24, 28, 32}}}) {
        const Study s = study(n, [&, p = degree](int elements) { return solve_between_jumps(p, elements); });
        expect_order(s, f, degree, 0.15);
    }
}

}   // namespace
}   // namespace livens::tests::orders_test
