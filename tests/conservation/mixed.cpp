// SPDX-License-Identifier: BSD-3-Clause
// What the paper's elements keep, where, and what they do not.
#include "livens/base/error.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/model.h"
#include "livens/time/quadrature.h"
#include "mixed_problems.h"

namespace livens::tests::mixed_test {
namespace {

/// |L(1 s) - torque times 1 s| of free_box().
double lost_angular_momentum(const Mixed& method, int n)
{
    const Solution solution = solve_mixed_evenly(free_box(), 1, n, method);
    const double mu = 2 / std::sqrt(3.0);
    return norm(angular_momentum_at(solution.motion, n) - Vector3{mu, mu, mu});
}

TEST(MixedMomentum, IsExactWithTheNaturalStart)
{
    for (const auto basis : {lagrange, bspline})
        for (const auto multipliers : {equal, lower})
            for (int p = 1; p <= 4; ++p)
                EXPECT_LT(lost_angular_momentum(mixed({basis, p, natural, multipliers}), 8), 1e-12)
                    << name_of(mixed({basis, p, natural, multipliers}));
}

TEST(MixedMomentum, IsLostWithTheStrongStart)
{
    for (const int p : {1, 2, 3})
        EXPECT_GT(lost_angular_momentum(mixed({lagrange, p, strong, equal}), 8), 1e-5) << "degree " << p;
}

TEST(MixedMomentum, IsExactWithCollocationAtGaussPoints)
{
    for (const int p : {1, 2, 3}) {
        Mixed method = mixed({lagrange, p, strong, equal});
        method.gauss_points = p;
        EXPECT_LT(lost_angular_momentum(method, 8), 1e-12) << "degree " << p;
    }
}

TEST(MixedMomentum, BalancesOverBlocksByTheDiagnosticsOfAnyMotion)
{
    Mixed method = mixed({lagrange, 2, natural, equal});
    method.window = 10;
    const Model model = two_bricks();
    const Solution solution = solve_mixed_evenly(model, 0.5, 40, method);
    const Balance b = balance(model, solution.motion);
    for (const int end : solution.motion.block_ends) {
        EXPECT_LT(b.angular_momentum_drift[end], 1e-12) << "t = " << b.t[end];
        EXPECT_LT(b.linear_momentum_drift[end], 1e-12) << "t = " << b.t[end];
    }
    EXPECT_GT(b.angular_momentum_drift[5], 1e-9) << "inside a block it is an error of discretisation";
}

/// Largest |1/2 (d_a . d_b - delta_ab)| at local coordinates s of all elements.
double rigidity_at(const Motion& motion, const std::vector<double>& s)
{
    double worst = 0;
    std::vector<double> x(12);
    for (int e = 0; e < motion.n_elements(); ++e)
        for (const double place : s) {
            motion.X.evaluate(e, place, 0, x);
            const Matrix3 D{x[3], x[4], x[5], x[6], x[7], x[8], x[9], x[10], x[11]};
            const Matrix3 strain = transpose(D) * D - identity<3>();
            for (const double entry : strain.a) worst = std::max(worst, 0.5 * std::abs(entry));
        }
    return worst;
}

TEST(MixedRigidity, HoldsAtTheGaussPointsWhereTheseAreAsManyAsTheDegree)
{
    for (const int p : {1, 2, 3}) {
        Mixed method = mixed({lagrange, p, strong, equal});
        method.gauss_points = p;
        const Solution solution = solve_mixed_evenly(free_box(), 1, 16, method);
        EXPECT_LT(rigidity_at(solution.motion, gauss(p).points), 1e-14) << "degree " << p;
        EXPECT_GT(rigidity_at(solution.motion, {0, 0.5, 1}), 1e-7) << "but not elsewhere, degree " << p;
    }
}

TEST(MixedRigidity, HoldsWeaklyElsewise)
{
    const Model model = free_box();
    const Solution solution = solve_mixed_evenly(model, 1, 16, mixed({lagrange, 2, natural, lower}));
    EXPECT_GT(rigidity_at(solution.motion, gauss(2).points), 1e-7);
    EXPECT_LT(violations(model, solution.motion).rigidity_weakly, 1e-13) << "tested with linear functions";
}

TEST(MixedPlane, StaysOneForTheCentredPendulum)
{
    Mixed method = mixed({lagrange, 2, natural, equal});
    method.window = 50;
    const Solution solution = solve_mixed_evenly(cubes_on_rods(0), 5, 250, method, 1e-12);
    for (int end = 0; end <= 250; ++end)
        for (const Matrix34& X : solution.motion.at_end(end).X) EXPECT_LT(std::abs(X(1, 0)), 1e-12);
}

TEST(MixedConditions, AtTheEndLeadBackToTheStart)
{
    const Model model = cubes_on_rods(0.1);
    const Mixed method = mixed({lagrange, 3, natural, equal});
    const TimeMesh mesh = make_time_mesh(0, 0.5, 16);
    const Solution forth = solve(model, {model.start()}, mesh, method);
    ASSERT_TRUE(forth.report.converged());
    State end = last(forth);
    SolveOptions options;
    options.initial = StartPolicy::project;   // weakly rigid directors are no start
    for (const int block : {0, 4}) {
        Mixed back = method;
        back.window = block;
        const Solution solution =
            solve(model, {model.start(), Known::nothing, end, Known::state}, mesh, back, options);
        ASSERT_TRUE(solution.report.converged()) << solution.report.message;
        EXPECT_LT(distance(solution.motion.at_end(0), model.start()).X, 2e-5) << "blocks of " << block;
        EXPECT_EQ(solution.motion.n_elements(), 16);
        EXPECT_EQ(solution.motion.start(), 0);
    }
}

TEST(MixedConditions, SplitBetweenTheEndsFindTheSameMotion)
{
    const Model model = cubes_on_rods(0.1);
    const Solution fine = solve_evenly(model, 0.25, 40, 8);
    const State start = model.start(), end = last(fine), middle = fine.motion.at_end(20);
    struct {
        Known at_start, at_end;
    } const cases[] = {{Known::positions, Known::positions},
                       {Known::positions, Known::momenta},
                       {Known::momenta, Known::positions}};
    for (const auto basis : {lagrange, bspline})
        for (const auto& given : cases)
            for (const int n : {12, 13}) {   // both parities
                const Solution solution = solve(model, {start, given.at_start, end, given.at_end},
                                                make_time_mesh(0, 0.25, n, std::vector<double>{0.125}),
                                                mixed({basis, 3, natural, equal}));
                ASSERT_TRUE(solution.report.converged()) << solution.report.message;
                const int e = solution.motion.mesh.element_at(0.125);
                EXPECT_LT(distance(solution.motion.at_end(e), middle).X, 3e-5);
                EXPECT_LT(distance(last(solution), end).X, 3e-5);
                EXPECT_LT(distance(solution.motion.at_end(0), start).X, 3e-5);
            }
}

/// The box after it has turned by more than two radians.
TEST(MixedConditions, SplitOnesFindLargeTurns)
{
    Placement turning;
    turning.velocity = {1, 2, 3};
    turning.angular_velocity = {0, 2.5, 0.2};
    Model model;
    model.add_body(rigid_body("box", box(1.5, {2, 1, 1}), turning));
    const Solution fine = solve_evenly(model, 1, 20, 8);
    const State start = model.start(), end = last(fine);
    for (const auto basis : {lagrange, bspline})
        for (const bool forwards : {true, false}) {
            const Conditions boundary = forwards ? Conditions{start, Known::positions, end, Known::momenta}
                                               : Conditions{start, Known::momenta, end, Known::positions};
            const Solution solution =
                solve(model, {boundary}, make_time_mesh(0, 1, 40), mixed({basis, 3, natural, equal}));
            ASSERT_TRUE(solution.report.converged()) << solution.report.message;
            EXPECT_LT(distance(solution.motion.at_end(0), start).X, 1e-4);
            EXPECT_LT(distance(last(solution), end).X, 1e-4);
        }
}

TEST(MixedConditions, AtBothEndsOfASingleElementLeaveNoMultiplierUntied)
{
    const Model model = free_box();
    const State start = model.start();
    State end = start;
    for (const int p : {2, 3, 8}) {
        const Solution solution = solve(model, {start, Known::positions, end, Known::positions},
                                        make_time_mesh(0, 0.3, 1), mixed({lagrange, p, natural, equal}));
        ASSERT_TRUE(solution.report.converged()) << solution.report.message;
        EXPECT_EQ(solution.motion.n_elements(), 1);
    }
}

TEST(MixedFailures, InTheMiddleOfAMarchAreReportedAndKeepWhatIsSolved)
{
    Placement fast;
    fast.velocity = {1, 0, 5};
    fast.angular_velocity = {0, 2.5, 0.2};
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("brick", with_mass(box(1, {1, 0.2, 0.1}), 1), fast));
    int n_failed = 0;
    for (const double h : {1.0, 2.0, 3.31})   // elements of up to more than a turn, one a block
        for (const auto start : {natural, strong})
            for (const auto interfaces : {Mixed::Interfaces::carry, Mixed::Interfaces::project}) {
                Mixed method = mixed({lagrange, 1, start, equal});
                method.window = 1;
                method.interfaces = interfaces;
                Solution solution;
                ASSERT_NO_THROW(solution =
                                    solve(model, {model.start()}, make_time_mesh(0, 12 * h, 12), method));
                const Motion& motion = solution.motion;
                EXPECT_EQ(motion.mesh.ends.size(), static_cast<std::size_t>(solution.report.n_elements) + 1);
                EXPECT_EQ(motion.velocities.size(), motion.mesh.ends.size());
                n_failed += solution.report.converged() ? 0 : 1;
                EXPECT_EQ(solution.report.converged(), solution.report.message.empty());
            }
    EXPECT_GT(n_failed, 0) << "none was too long: nothing was tested";
}

TEST(MixedFailures, MayBeCancellationsWithinABlock)
{
    int of_first = -1;   // iterations
    SolveOptions options;
    options.progress = [&of_first](const Progress& progress) {   // slow machines ask more often than others
        if (progress.done < 10) return true;
        if (of_first < 0) of_first = progress.iterations;
        return progress.iterations >= of_first;   // fewer: within the second block
    };
    Mixed method = mixed({lagrange, 2, natural, equal});
    method.window = 10;
    const Model model = cubes_on_rods(0.1);
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, 1, 20), method, options);
    EXPECT_EQ(solution.report.status, SolveStatus::cancelled);
    EXPECT_NE(solution.report.message.find("stopped as asked in the window of elements 10 to 19 (t = 0.5 to 1 s)"), std::string::npos)
        << solution.report.message;
    EXPECT_EQ(solution.motion.n_elements(), 10);
}

TEST(MixedFailures, NameTheLoadThatIsNoNumberWhereNewtonWantedToGo)
{
    Model model;
    const int body = model.add_body(point_mass("bob", 1, {0, 0, 0}, {1, 0, 0}));
    Load wall;
    wall.name = "wall";
    wall.bodies = {body, world};
    wall.forces = [](const LoadArguments& a, LoadForces& F) {
        F[0](0, 0) = a.at.t > 0.5 ? std::nan("") : 100;   // the guess goes on straight
    };
    model.add_load(wall);
    const Solution solution =
        solve(model, {model.start()}, make_time_mesh(0, 1, 10), mixed({lagrange, 2, natural, equal}));
    EXPECT_EQ(solution.report.status, SolveStatus::not_finite);
    EXPECT_NE(solution.report.message.find("'wall'"), std::string::npos) << solution.report.message;
}

TEST(MixedConditions, ThatMakeNoSolvableSystemAreRefused)
{
    const Model model = free_box();
    const State state = model.start();
    const TimeMesh mesh = make_time_mesh(0, 1, 8);
    const auto code = [&](const Conditions& boundary, const Method& method) {
        try {
            solve(model, {boundary}, mesh, method);
        } catch (const InputError& error) {
            return error.complaint().code + " " + error.complaint().path;
        }
        return std::string("accepted");
    };
    const Mixed any = mixed({lagrange, 2, natural, equal});
    const Conditions two_point{state, Known::positions, state, Known::positions};
    EXPECT_EQ(code({state, Known::momenta, state, Known::momenta}, any), "boundary-conditions end.given");
    EXPECT_EQ(code({state, Known::state, state, Known::positions}, any), "boundary-conditions end.given");
    EXPECT_EQ(code({state, Known::positions}, any), "boundary-conditions end.given");
    EXPECT_EQ(code(two_point, Midpoint{}), "boundary-method start.given");
    EXPECT_EQ(code(two_point, mixed({lagrange, 2, natural, lower})), "mixed-pairing method.multipliers");
    EXPECT_EQ(code({state, Known::positions, state, Known::momenta}, mixed({lagrange, 2, strong, equal})),
              "mixed-pairing end.given");
    Mixed few = any;
    few.gauss_points = 2;
    EXPECT_EQ(code({state}, few), "mixed-pairing method.gauss_points");
    Mixed blocks = any;
    blocks.window = 4;
    EXPECT_EQ(code(two_point, blocks), "mixed-block method.window");
    EXPECT_EQ(code({state}, mixed({bspline, 9, natural, equal})), "degree-out-of-range method.degree");
    Mixed spline = mixed({bspline, 5, natural, equal});
    spline.window = 4;
    EXPECT_EQ(code({state}, spline), "spline-degree method.degree");
    spline.window = 0;
    spline.knots = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
    EXPECT_EQ(code({state}, spline), "spline-degree method.degree");
}

}   // namespace
}   // namespace livens::tests::mixed_test
