// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow, and until when double precision says something.
#include "convergence/studies.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joints/drives.h"
#include "livens/time/time_laws.h"

namespace livens::tests::horizon_test {
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

/// Held at its centre it has nothing but its spin that could grow: not by a push, which takes a free body as
/// far.
TEST(Horizon, SteadySpinOfABodyThatIsHeldGrowsByItsAngle)
{
    for (const Vector3& w : {Vector3{0, 0, 5}, Vector3{5, 0, 0}, Vector3{3, 2, 4}}) {
        Model model;
        model.add_body(rigid_body("ball", {1, {}, identity<3>()}, {.angular_velocity = w}));
        model.add_joint(spherical("centre", world, 0, {}));
        const Solution s = with_growth(model, 20, 100, Lobatto{6});
        EXPECT_GT(s.verdict.growth, 0.5 * 20 * norm(w));
        EXPECT_LT(s.verdict.growth, 1.1 * 20 * norm(w));
    }
}

/// Bodies at random and how they turn, by the largest singular value of Euler's variational equations (order
/// 8, extended precision).
TEST(Horizon, GrowthOfBodiesThatTurnOver)
{
    struct Case {
        Vector3 inertia, spin;
        double end, growth;
    };
    for (const Case& c :
         {Case{{1.1, 1.4, 2.4}, {0.0017, 5.7, 0.0001}, 50, 3.87e4},
          Case{{1, 2, 3}, {0.01, 6, 0}, 100, 2.58e4}, Case{{0.5, 1.5, 1.8}, {0.036, 6, 0.0006}, 54, 4.85e3},
          Case{{1.2, 1.8, 2.7}, {-1.2, -0.3, -2.2}, 50, 132}}) {
        Model model;
        const Matrix3 J{c.inertia[0], 0, 0, 0, c.inertia[1], 0, 0, 0, c.inertia[2]};
        model.add_body(rigid_body("b", {1, {}, J}, {.angular_velocity = c.spin}));
        SolveOptions options;
        options.growth = true;
        for (const Time& time :
             {Time{Span{.start = 0, .end = c.end, .accuracy = 1e-4}},
              Time{Span{.start = 0, .end = c.end, .accuracy = 1e-6}}, Time{make_time_mesh(0, c.end, 1000)},
              Time{make_time_mesh(0, c.end, 3000)}}) {
            const bool is_mesh = std::holds_alternative<TimeMesh>(time);
            const Solution s = solve(model, {model.start()}, time, Lobatto{is_mesh ? 6 : 0}, options);
            EXPECT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_GT(s.verdict.growth, c.growth / 3);
            EXPECT_LT(s.verdict.growth, c.growth * 1.5);
        }
    }
}

using Real = long double;

/// Euler's equations and the quaternion of a free body, by Taylor series of extended precision.
class FreeBody {
public:
    FreeBody(const Vector3& inertia, const Vector3& spin) : inertia_(inertia)
    {
        for (int i = 0; i < 3; ++i) y_[i] = spin[i];
        y_[3] = 1;
    }
    /// Rotation from the start on, at ascending instants.
    Matrix3 at(double t)
    {
        const Real whole = t - t_;
        const int n = 1 + static_cast<int>(whole / 0.05L);
        for (int k = 0; k < n; ++k) step(whole / n);
        t_ = t;
        const Real s = y_[3], x = y_[4], y = y_[5], z = y_[6];
        const auto d = [](Real number) { return static_cast<double>(number); };
        return {d(1 - 2 * (y * y + z * z)), d(2 * (x * y + s * z)),     d(2 * (x * z - s * y)),
                d(2 * (x * y - s * z)),     d(1 - 2 * (x * x + z * z)), d(2 * (y * z + s * x)),
                d(2 * (x * z + s * y)),     d(2 * (y * z - s * x)),     d(1 - 2 * (x * x + y * y))};
    }

private:
    void step(Real h)
    {
        constexpr int order = 30;
        Real c[7][order + 1];
        for (int i = 0; i < 7; ++i) c[i][0] = y_[i];
        const Real a = inertia_[0], b = inertia_[1], g = inertia_[2];
        for (int n = 0; n < order; ++n) {
            const auto product = [&](int i, int j) {
                Real sum = 0;
                for (int k = 0; k <= n; ++k) sum += c[i][k] * c[j][n - k];
                return sum;
            };
            const Real rates[7] = {(b - g) / a * product(1, 2),
                                   (g - a) / b * product(2, 0),
                                   (a - b) / g * product(0, 1),
                                   -(product(4, 0) + product(5, 1) + product(6, 2)) / 2,
                                   (product(3, 0) + product(5, 2) - product(6, 1)) / 2,
                                   (product(3, 1) + product(6, 0) - product(4, 2)) / 2,
                                   (product(3, 2) + product(4, 1) - product(5, 0)) / 2};
            for (int i = 0; i < 7; ++i) c[i][n + 1] = rates[i] / (n + 1);
        }
        for (int i = 0; i < 7; ++i) {
            y_[i] = 0;
            for (int n = order; n >= 0; --n) y_[i] = y_[i] * h + c[i][n];
        }
    }

    Vector3 inertia_;
    Real y_[7] = {};
    double t_ = 0;
};

/// Beside an unstable axis the start may grow by 1e4 while what is rounded in mid-flip grows by 1e8:
/// accuracies that rounding does not let be reached are refused, and what is told covers it.
TEST(Horizon, RoundingsOnTheWayAreTold)
{
    int n_refused = 0;
    for (const double tilt : {0.0008, 0.001, 0.0012, 0.0014, 0.0017, 0.002, 0.0025, 0.003, 0.004, 0.005, 0.007})
        for (const double accuracy : {1e-5, 3e-6, 1e-6, 1e-7, 3e-8}) {
            const Vector3 inertia{1, 2, 3}, spin{tilt, 6, 0};
            Model model;
            model.add_body(
                rigid_body("b", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}, {.angular_velocity = spin}));
            SolveOptions options;
            options.growth = true;
            const Solution s = solve(model, {model.start()}, Span{0, 30, accuracy}, Lobatto{0}, options);
            FreeBody body(inertia, spin);
            double error = 0;
            for (int e = 0; e <= s.motion.n_elements(); ++e) {
                const Matrix3 off = directors(s.motion.at_end(e).X[0]) - body.at(s.motion.mesh.ends[e]);
                error = std::max(error, norm(off) / std::sqrt(2.0));
            }
            n_refused += s.report.converged() ? 0 : 1;
            if (!s.report.converged()) continue;
            EXPECT_LT(error, 3 * s.estimate.largest) << tilt << ", " << accuracy;
            EXPECT_LT(error, 3 * accuracy) << tilt;
        }
    EXPECT_GT(n_refused, 2);
}

/// Pieces of motions that other families begin anew are not the motion: they are compared with each other.
TEST(Horizon, GrowthIsTheSameByOtherFamilies)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const double known = with_growth(model, 5, 100, Lobatto{6}).verdict.growth;
    Mixed mixed;
    mixed.degree = 3;
    for (const Method& method : {Method(Radau{5}), Method(mixed), Method(Midpoint{})})
        EXPECT_NEAR(with_growth(model, 5, 400, method).verdict.growth / known, 1, 0.01) << name_of(method);
}

/// How many elements neighbours take for each of the motion.
double elements_of_neighbours(const Model& model, double end, int n, double told)
{
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, end, n), Lobatto{6});
    int n_solved = 0;
    SolveOptions options;
    options.progress = [&](const Progress&) {
        ++n_solved;
        return true;
    };
    const Growth grown = growth(model, {model.start()}, Lobatto{6}, options, s.motion, told);
    EXPECT_EQ(grown.factors.size(), s.motion.mesh.ends.size());
    return 1.0 * n_solved / s.motion.n_elements();
}

Model pendulum(const Vector3& place)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, place));
    model.add_joint(rod("rod", world, 0, {}, norm(place)));
    return model;
}

TEST(Horizon, CalmMotionsHaveOneNeighbour)
{
    EXPECT_LT(elements_of_neighbours(pendulum({1, 0, 0}), 5, 100, 1e-11), 1.3);   // some are begun in vain
}

/// What may grow beyond what is told has a second perturbation, lest the first one misses it.
TEST(Horizon, WhatGrowsHasTwoNeighbours)
{
    const double n = elements_of_neighbours(pendulum({0, 0, 1}), 4, 80, 3e-10);
    EXPECT_GT(n, 1.9);
    EXPECT_LT(n, 2.6);
}

/// What shrinks as much as it grew has neighbours on both sides for either.
TEST(Horizon, WhatTurnsOverHasNeighboursOnBothSides)
{
    Model model;
    model.add_body(
        rigid_body("b", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}, {.angular_velocity = {0.001, 6, 0}}));
    EXPECT_GT(elements_of_neighbours(model, 30, 228, 1e-7), 4.5);   // and some before that was seen
}

/// Neighbours that go through elements side by side part as those do that windows march, of degree 2.
TEST(Horizon, ElementsOfNeighboursTellWhatWindowsDo)
{
    const auto grow_alike = [](const Model& model, double end, const Method& by_elements, const char* what) {
        const Solution known = with_growth(model, end, 3000, Lobatto{2}),
                       found = with_growth(model, end, 150, by_elements);
        ASSERT_EQ(known.growth.size(), 3001u) << what;
        ASSERT_EQ(found.growth.size(), 151u) << what;
        EXPECT_GT(known.verdict.growth, 1.5) << what;
        for (int e = 0; e <= 150; ++e)
            EXPECT_NEAR(found.growth[e], known.growth[20 * e], 1e-3 * known.verdict.growth)
                << what << ", element end " << e;
    };
    Model stiff = hinged_links();
    stiff.add_load(spring_damper("spring", world, {3, 0, 0}, 1, {1, 0, 0}, {.stiffness = 3e4}));
    grow_alike(hinged_links(), 2, Lobatto{6}, "links");
    grow_alike(hinged_links(), 2, Radau{5}, "links, radau");
    grow_alike(stiff, 0.5, Lobatto{6}, "links on a stiff spring");
    grow_alike(four_bar(), 1, Lobatto{6}, "four-bar");
    grow_alike(heavy_top(), 0.3, Lobatto{7}, "heavy top");
    grow_alike(medley(), 0.5, Lobatto{4}, "medley");
}

/// In a plane of the axes, where a light mass between rods lashes about, perturbations across the plane grow
/// by 6e15 in 10 s, but rounding does not reach them.
class LightBetweenRods : public ::testing::Test {
protected:
    static Model model(const Matrix3& axes)
    {
        Model model(axes * Vector3{0, -9.81, 0});
        model.add_body(point_mass("upper", 1e-4, axes * Vector3{0.8, 0.6, 0}));
        model.add_body(point_mass("lower", 1, axes * Vector3{1.8, 0.6, 0}));
        model.add_joint(rod("above", world, 0, {}, norm(axes * Vector3{0.8, 0.6, 0})));
        model.add_joint(rod("below", 0, 1, {}, norm(axes * Vector3{1, 0, 0})));
        return model;
    }
    static Solution solved(const Matrix3& axes, double accuracy)
    {
        SolveOptions options;
        options.growth = true;
        options.initial = StartPolicy::project;
        const Model light = model(axes);
        return solve(light, {light.start()}, Span{.start = 0, .end = 10, .accuracy = accuracy}, Lobatto{0},
                     options);
    }
};

TEST_F(LightBetweenRods, RoundingDoesNotLeaveAPlaneOfTheAxes)
{
    for (const double accuracy : {1e-4, 1e-6}) {
        const Solution s = solved(identity<3>(), accuracy);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_GT(s.verdict.growth, 1e14);
        EXPECT_TRUE(std::isnan(s.verdict.horizon));
        // by DOP853 on its equations, 1e-13
        const Vector3 end = s.motion.at_end(s.motion.n_elements()).X[0].column(0);
        EXPECT_LT(norm(end - Vector3{0.86646193, -0.49924316, 0}), accuracy);
        ASSERT_FALSE(s.rounding.empty());
        EXPECT_LT(s.rounding.back(), 1e-7);
        ASSERT_FALSE(s.verdict.remarks.empty());
        EXPECT_NE(s.verdict.remarks.back().find("rounding does not excite it"), std::string::npos)
            << s.verdict.remarks.back();
        EXPECT_NE(s.verdict.remarks.back().find("moving along ("), std::string::npos);
    }
}

/// Control: in any other plane numbers are rounded across it.
TEST_F(LightBetweenRods, RoundingLeavesAnyOtherPlane)
{
    const Matrix3 tilted = directors_from_rotation_vector({0.4, 0.3, -0.2});
    const Solution s = solved(tilted, 1e-6);
    EXPECT_EQ(s.report.status, SolveStatus::inaccurate);
    EXPECT_NE(s.report.message.find("rounding errors grow to"), std::string::npos) << s.report.message;
    EXPECT_NE(s.report.message.find("most in body 'upper'"), std::string::npos) << s.report.message;
    EXPECT_GT(s.verdict.growth, 1e6);
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
    EXPECT_NE(s.verdict.remarks.back().find("continues to 10 s"), std::string::npos);
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
    EXPECT_NE(s.report.message.find("the motion is complete up to 7 s"), std::string::npos)
        << s.report.message;
    EXPECT_NE(s.report.message.find("most in body 'bob' moving along ("), std::string::npos)
        << s.report.message;
    EXPECT_TRUE(to(1e-5).report.converged());
}

/// Rounding inside of elements costs more than that of the start where bodies turn over: the refusal tells
/// the growth, too.
TEST(Horizon, ARefusalByRoundingTellsTheGrowth)
{
    Model model;
    Placement spinning;
    spinning.angular_velocity = {0.001, 6, 0};
    model.add_body(rigid_body("b", {1, {}, Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3}}, spinning));
    SolveOptions options;
    options.growth = true;
    const Solution s =
        solve(model, {model.start()}, Span{.start = 0, .end = 30, .accuracy = 1e-8}, Lobatto{0}, options);
    ASSERT_EQ(s.report.status, SolveStatus::inaccurate);
    EXPECT_GT(s.verdict.growth, 5.5e4 / 3);
    EXPECT_LT(s.verdict.growth, 5.5e4 * 1.5);
    EXPECT_TRUE(std::isnan(s.verdict.horizon));
    for (const char* words :
         {"the motion is complete up to 30 s", "rounding errors grow to", "most in body 'b' turning about ("})
        EXPECT_NE(s.report.message.find(words), std::string::npos) << s.report.message;
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

/// An event between bodies beside it takes nothing off: what pieces over it begin from is the motion. Let go
/// itself, it falls, and neighbours part as time goes.
TEST(Horizon, GrowthGoesOnBehindAnEvent)
{
    for (const bool is_let_go : {false, true}) {
        Model model({0, 0, -9.81});
        model.add_body(point_mass("bob", 1, {0, 0, 1}));
        model.add_body(point_mass("other", 1, {3, 0, -1}));
        Joint head = rod("rod", world, 0, {}, 1), hanger = rod("hanger", world, 1, {3, 0, 0}, 1);
        (is_let_go ? head : hanger).until = 2;
        model.add_joint(head);
        model.add_joint(hanger);
        const Solution s = with_growth(model, 4, 80, Lobatto{6});
        ASSERT_EQ(s.growth.size(), 81u);
        EXPECT_NEAR(std::log(s.growth[38] / s.growth[18]), std::sqrt(9.81), 0.02);
        // let go its rate is sqrt(g) times the distance from there on
        const double expected = is_let_go ? 1 + 2 * std::sqrt(9.81) : std::exp(2 * std::sqrt(9.81));
        EXPECT_NEAR(s.growth[80] / s.growth[40] / expected, 1, 0.02);
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
}   // namespace livens::tests::horizon_test
