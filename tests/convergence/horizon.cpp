// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow, and until when double precision says something.
#include "convergence/studies.h"
#include "livens/multibody/drives.h"
#include "livens/time/time_laws.h"

namespace livens::tests {
namespace {

Solution with_growth(const Model& model, double end, int n, const Method& method)
{
    SolveOptions options;
    options.growth = true;
    return solve(model, {model.start()}, make_time_mesh(0, end, n), method, options);
}

/// Chaos: motions that differ by 1e-13 at the start differ by 1e-2 after 50 s and 26 s or so.
TEST(Horizon, OfTheDoublePendulumsIsWhereTwoIntegrationsPart)
{
    const Solution centred = with_growth(cubes_on_rods(0), 60, 720, Lobatto{8});
    tell("horizon of the centred pendulum, s", centred.verdict.horizon);
    EXPECT_NEAR(centred.verdict.horizon, 50, 5);
    const Solution offset = with_growth(cubes_on_rods(0.1), 35, 420, Lobatto{8});
    tell("horizon of the offset pendulum, s", offset.verdict.horizon);
    EXPECT_NEAR(offset.verdict.horizon, 26, 4);
}

TEST(Horizon, NoneOfAPendulumThatSwings)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const Solution s = with_growth(model, 60, 600, Lobatto{6});
    ASSERT_EQ(s.growth.size(), 601u);
    EXPECT_TRUE(std::isnan(s.verdict.horizon));
    EXPECT_LT(s.verdict.growth, 1e4);   // it drifts in time: linearly
}

/// A nut that turns over passes its unstable spin six times in a minute, and comes back each time: neighbours
/// part by a thousand or ten (by DOP853 on Euler's equations, four directions at random: 1.4e3, 2.2e3, 4.5e3,
/// 1.3e4). What bends in a neighbour on one side would grow by as much at each passage, to 1e15.
TEST(Horizon, BendsOfNeighboursDoNotGrow)
{
    Model model;
    Placement spinning;
    spinning.angular_velocity = {0.01, 5, 0.02};
    model.add_body(rigid_body("nut", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}, spinning));
    for (const int n : {220, 430, 1000}) {
        const Solution s = with_growth(model, 60, n, Lobatto{7});
        EXPECT_GT(s.verdict.growth, 1e3) << n;
        EXPECT_LT(s.verdict.growth, 2e4) << n;
        EXPECT_TRUE(std::isnan(s.verdict.horizon));
    }
}

/// A body about its middle axis that turns over every 4.5 s; 5.5e4 is the largest singular value of Euler's
/// variational equations (DOP853, 1e-13). From turn to turn a perturbation across the motion grows by 1e8,
/// and so does what a neighbour bends by: measured over 16 elements at a time growth was 6e12, 3e20 or 2e4.
TEST(Horizon, GrowthOfATumblingBodyIsThatOfTheMotionWhateverTheElements)
{
    Model model;
    Placement spinning;
    spinning.angular_velocity = {0.001, 6, 0};
    model.add_body(rigid_body("b", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}, spinning));
    const auto check = [&](const Time& time, const Method& method, const char* what) {
        SolveOptions options;
        options.growth = true;
        const Solution s = solve(model, {model.start()}, time, method, options);
        EXPECT_TRUE(s.report.converged()) << what << ": " << s.report.message;
        EXPECT_TRUE(std::isnan(s.verdict.horizon)) << what;
        EXPECT_GT(s.verdict.growth, 5.5e4 / 3) << what;
        EXPECT_LT(s.verdict.growth, 5.5e4 * 1.5) << what;
        EXPECT_EQ(s.growing.body, 0);
        EXPECT_TRUE(s.growing.turns);
    };
    check(Span{.start = 0, .end = 30, .accuracy = 1e-4}, Lobatto{0}, "1e-4");
    check(Span{.start = 0, .end = 30, .accuracy = 1e-6}, Lobatto{0}, "1e-6");
    check(make_time_mesh(0, 30, 228), Lobatto{7}, "228");
    check(make_time_mesh(0, 30, 600), Lobatto{4}, "600");
}

/// Spins along what turns a body, and across it: neither is missed by the two perturbations that there are.
TEST(Horizon, SteadySpinGrowsByItsAngle)
{
    for (const Vector3& w : {Vector3{0, 0, 5}, Vector3{5, 0, 0}, Vector3{3, 2, 4}}) {
        Model model;
        model.add_body(rigid_body("ball", {1, {}, identity<3>()}, {.angular_velocity = w}));
        const Solution s = with_growth(model, 20, 100, Lobatto{6});
        const double angle = 20 * norm(w);
        EXPECT_GT(s.verdict.growth, 0.5 * angle);
        EXPECT_LT(s.verdict.growth, 1.1 * angle);
    }
}

TEST(Horizon, WhatGrowsIsNamed)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("still", 1, {5, 0, -1}));
    model.add_body(point_mass("bob", 1, {0, 0, 1}));
    model.add_joint(rod("rod", world, 1, {}, 1));
    model.add_joint(rod("hanging", world, 0, {.point_first = {5, 0, 0}}, 1));
    const Solution s = with_growth(model, 10, 200, Lobatto{6});
    EXPECT_EQ(s.growing.body, 1);
    EXPECT_FALSE(s.growing.turns);
    EXPECT_NEAR(norm(s.growing.direction), 1, 1e-12);
    EXPECT_NEAR(s.growing.direction[2], 0, 1e-3);   // it falls to the side
    ASSERT_FALSE(s.verdict.remarks.empty());
    EXPECT_NE(s.verdict.remarks.back().find("body 'bob' moving along ("), std::string::npos)
        << s.verdict.remarks.back();
    EXPECT_NE(s.verdict.remarks.back().find("goes on to 10 s"), std::string::npos);
    EXPECT_NEAR(s.verdict.horizon, std::log(2e11) / std::sqrt(9.81), 0.5);
}

/// On its head for 7 s: growth of some 1e9, so that 1e-8 cannot be promised though the motion is there.
TEST(Horizon, ARefusalNamesWhatGrowsAndSaysThatTheMotionIsWhole)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {0, 0, 1}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    SolveOptions options;
    options.growth = true;
    const auto to = [&](double accuracy) {
        return solve(model, {model.start()}, Span{.start = 0, .end = 7, .accuracy = accuracy}, Lobatto{0},
                     options);
    };
    const Solution s = to(1e-8);
    ASSERT_EQ(s.report.status, SolveStatus::inaccurate);
    EXPECT_EQ(s.motion.end(), 7);
    EXPECT_NE(s.report.message.find("the motion is whole up to 7 s"), std::string::npos) << s.report.message;
    EXPECT_NE(s.report.message.find("most in body 'bob' moving along ("), std::string::npos)
        << s.report.message;
    EXPECT_TRUE(to(1e-5).report.converged());
}

/// On its head a pendulum leaves as exp(sqrt(g / l) t); the growth is that of any neighbour.
TEST(Horizon, GrowthOnAnUnstableRestIsItsExponential)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {0, 0, 1}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    for (const Method& method : {Method(Lobatto{6}), Method(Radau{6})}) {
        const Solution s = with_growth(model, 4, 80, method);
        ASSERT_EQ(s.growth.size(), 81u);
        EXPECT_NEAR(std::log(s.growth[80] / s.growth[40]) / 2, std::sqrt(9.81), 0.01);
        EXPECT_NEAR(s.growth[0], 1, 1e-12);
    }
}

/// Where drives determine the motion, neighbours of the start are the start, and their distance is rounding.
TEST(Horizon, WhatIsDrivenDoesNotGrow)
{
    Model model({0, 0, -9.81});
    const Matrix3 inertia{0.02, 0, 0, 0, 0.08, 0, 0, 0, 0.09};
    model.add_body(rigid_body("crank", {1, {0.5, 0, 0}, inertia}, {.angular_velocity = {0, 2, 0}}));
    model.add_body(point_mass("slug", 1, {3, 0, 0}, {0, 0, 0}));
    const Joint shaft = revolute("shaft", world, 0, {.axis_first = {0, 1, 0}, .axis_second = {0, 1, 0}});
    model.add_joint(shaft);
    model.add_joint(point_on_line("bore", world, 1, {.axis_first = {1, 0, 0}}));
    model.add_joint(rod("coupler", 0, 1, {.point_first = {1, 0, 0}}, 2));
    const std::vector<Matrix34> X = model.start().X;
    model.add_joint(driven_coordinate("motor", shaft, shaft.coordinates.front(), polynomial({0, 2}),
                                      Configurations(X.front().a)));
    SolveOptions options;
    options.growth = true;
    const Solution s =
        solve(model, {model.start()}, Span{.start = 0, .end = 2, .accuracy = 1e-12}, Lobatto{0}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LT(s.estimate.largest, 1e-12);
    const State end = s.motion.at_end(s.motion.n_elements());
    const double x = std::cos(4) + std::sqrt(4 - std::pow(std::sin(4), 2));
    EXPECT_NEAR(end.X[1].column(0)[0], x, 1e-12);
}

}   // namespace
}   // namespace livens::tests
