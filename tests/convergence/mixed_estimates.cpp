// SPDX-License-Identifier: BSD-3-Clause
// The estimated error of the paper's elements against the true one.
#include "convergence/studies.h"
#include "mixed_problems.h"

namespace livens::tests::mixed_estimates_test {
namespace {

/// Largest error at all element ends, measured as estimates are: centres by the model's length, turns.
double true_error(const Model& model, const Motion& motion, const Motion& exact)
{
    double error = 0;
    for (int end = 0; end <= motion.n_elements(); ++end) {
        const State a = motion.at_end(end), b = exact.at(motion.mesh.ends[end]);
        for (int k = 0; k < model.n_bodies(); ++k) {
            const Matrix34 d = a.X[k] - b.X[k];
            const Vector3 centre = d * point(mass_properties(model.bodies()[k].mass).center_of_mass);
            error = std::max({error, norm(centre) / model.length(),
                              2 * std::asin(std::min(norm(directors(d)) / std::sqrt(8.0), 1.0))});
        }
    }
    return error;
}

Motion exact_motion(const Model& model, double end, int n) { return solve_evenly(model, end, n, 12).motion; }

void expect_true(const Model& model, const Motion& exact, const Mixed& method, int n)
{
    const Solution s = solve(model, {model.start()}, make_time_mesh(exact.start(), exact.end(), n), method);
    ASSERT_FALSE(s.estimate.empty()) << name_of(method) << ", " << n << ": " << s.report.message;
    const double error = true_error(model, s.motion, exact), told = s.verdict.estimated_error;
    EXPECT_LE(told, 5 * error) << name_of(method) << ", " << n;
    EXPECT_GE(told, error / 5) << name_of(method) << ", " << n;
    EXPECT_FALSE(s.report.converged() && told > 1e-2) << name_of(method);
}

TEST(MixedEstimates, AreTheTrueErrorWithinAFactorOfFive)
{
    for (const Model& model : {free_box({5, 5, 5}), hinged_links()}) {
        const Motion exact = exact_motion(model, 1, 32);
        for (const auto basis : {lagrange, bspline, nurbs})
            for (int p = 1; p <= 5; ++p)
                for (const auto multipliers : {equal, lower})
                    for (const auto start : {natural, strong}) {
                        if (basis == nurbs && (start == strong || multipliers == lower)) continue;
                        Mixed method = mixed({basis, p, start, multipliers});
                        for (int i = 0; basis == nurbs && i < 16 + p; ++i)
                            method.weights.push_back(1 + 0.1 * ((i * 7) % 3));
                        expect_true(model, exact, method, 16);
                    }
    }
}

TEST(MixedEstimates, AreTrueOfBlocksWhateverTheyHandOn)
{
    const Model model = two_bricks();
    const Motion exact = exact_motion(model, 1, 48);
    for (const auto interfaces : {Mixed::Interfaces::carry, Mixed::Interfaces::project})
        for (const int p : {2, 3}) {
            Mixed method = mixed({bspline, p, natural, equal});
            method.window = 6;
            method.interfaces = interfaces;
            expect_true(model, exact, method, 24);
        }
}

TEST(MixedEstimates, KnowConditionsAtBothEnds)
{
    const Model model = free_box({1, 0, 0});
    const Motion exact = exact_motion(model, 1, 40);
    Conditions ends{exact.at_end(0), Known::positions, exact.at_end(40), Known::momenta};
    const Solution s = solve(model, {ends}, make_time_mesh(0, 1, 20), mixed({lagrange, 2, natural, equal}));
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    const double error = true_error(model, s.motion, exact);
    EXPECT_NEAR(s.verdict.estimated_error / error, 1, 0.1);
}

/// What blocks hand on with the strong start is carried away from the motion, each a little: a march from the
/// start of every block sees nothing.
TEST(MixedEstimates, SeeWhatBlocksLoseOneByOne)
{
    const Model model = cubes_on_rods(0);
    const Motion exact = exact_motion(model, 5, 100);
    Mixed method = mixed({lagrange, 1, strong, equal});
    method.window = 5;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 5, 500), method);
    ASSERT_TRUE(s.report.reached_end()) << s.report.message;
    EXPECT_GT(true_error(model, s.motion, exact), 0.05);
    EXPECT_LT(s.report.guess_distance, 0.05) << "negative control: block by block nothing is seen";
    EXPECT_EQ(s.report.status, SolveStatus::suspect);
    EXPECT_NE(s.report.message.find("estimated error"), std::string::npos) << s.report.message;
}

/// Elements that are too long for lobatto(2) and short enough for degree 5 or 8.
TEST(MixedEstimates, DoNotSuspectRightAnswersOfHighDegree)
{
    const struct {
        Model model;
        int degree, n;
    } cases[] = {{hinged_links(), 5, 4}, {cubes_on_rods(0.1), 8, 8}};
    for (const auto& [model, degree, n] : cases) {
        const Motion exact = exact_motion(model, 2, 80);
        const Solution s =
            solve(model, {model.start()}, make_time_mesh(0, 2, n), mixed({lagrange, degree, natural, equal}));
        EXPECT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LT(true_error(model, s.motion, exact), 5e-3);
        SolveOptions as_it_comes;
        as_it_comes.judge = as_it_comes.divide = false;
        const Solution coarse =
            solve(model, {model.start()}, make_time_mesh(0, 2, n), Lobatto{2}, as_it_comes);
        EXPECT_GT(true_error(model, coarse.motion, exact), 0.05) << "negative control";
    }
}

/// A jump inside an element is missed by one solution as by another on the same mesh.
TEST(MixedEstimates, SeeJumpsInsideElements)
{
    Model model;
    const int body = model.add_body(rigid_body("box", box(1.5, {2, 1, 1})));
    const TimeFunction course = window(TimeFunction(2), 0.26, 0.77);
    model.add_load(torque("motor", body, {course, course, course}, Frame::inertial));
    SolveOptions raw;
    raw.judge = false;
    const Motion exact =
        solve(model, {model.start()}, make_time_mesh(0, 1, 40, model.load_breaks()), Lobatto{12}, raw).motion;
    for (const Method& method : {Method(Lobatto{4}), Method(mixed({lagrange, 3, natural, equal}))}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 20), method);
        ASSERT_FALSE(s.estimate.empty()) << s.report.message;
        EXPECT_NEAR(s.verdict.estimated_error / true_error(model, s.motion, exact), 1, 0.1)
            << name_of(method);
    }
}

}   // namespace
}   // namespace livens::tests::mixed_estimates_test
