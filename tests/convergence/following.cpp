// SPDX-License-Identifier: BSD-3-Clause
// Solutions that follow a motion nearby find what they find alone, sooner.
#include "convergence/studies.h"

namespace livens::tests::following_test {
namespace {

SolveOptions quiet()
{
    SolveOptions options = undivided();
    options.judge = false;
    return options;
}

Solution solved(const Model& model, double end, int n, int degree, const Motion* near)
{
    const Solution s =
        solve(model, {{model.start()}, {}, near}, make_time_mesh(0, end, n), Lobatto{degree}, quiet());
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    return s;
}

/// Largest distance at element ends.
Distance largest_gap(const Motion& a, const Motion& b)
{
    Distance most;
    for (int end = 0; end <= a.n_elements(); ++end) {
        const Distance d = distance(a.at_end(end), b.at_end(end));
        most = {std::max(most.X, d.X), std::max(most.V, d.V)};
    }
    return most;
}

/// A slab that tumbles by half a turn within an element: quaternions come round to the other sign.
Model tumbling()
{
    Placement placed;
    placed.angular_velocity = {3, 0.3, 50};
    placed.velocity = {1, 2, 3};
    MassProperties slab = box(1000, {0.1, 0.2, 0.3});
    slab = with_center(slab, {0.3, -0.1, 0.2});
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("slab", slab, placed));
    return model;
}

TEST(ReferencePredictor, FindsTheSameSooner)
{
    const std::vector<Model> models{two_bricks(), hinged_links(), four_bar(), cubes_on_rods(0.1),
                                    medley(),     heavy_top(),    tumbling()};
    double most = 0, apart = 0;
    double iterations = 0, of_alone = 0;
    for (std::size_t m = 0; m < models.size(); ++m)
        for (const int degree : {3, 4, 7, 12}) {
            SCOPED_TRACE(std::to_string(m) + ", degree " + std::to_string(degree));
            const bool tumbles = m + 1 == models.size();
            if (tumbles && degree < 7) continue;   // too long for it
            const Solution first = solved(models[m], 0.5, tumbles ? 12 : 20, degree, nullptr);
            const int n = first.motion.n_elements(), more = degree < 4 ? 1 : 2;
            const Solution alone = solved(models[m], 0.5, n, degree + more, nullptr),
                           follows = solved(models[m], 0.5, n, degree + more, &first.motion);
            const Distance parted = largest_gap(first.motion, alone.motion),
                           left = largest_gap(follows.motion, alone.motion);
            // rounding: the slab's 25 rad end up to 3e-13 from the true ones, by steps of whatever kind
            EXPECT_LE(left.X, tumbles ? 3e-13 : 1e-13);
            EXPECT_LE(left.V, 1e-11);   // one turns by 50 rad/s
            apart = std::max(apart, parted.X);
            most = std::max(most, left.X);
            iterations += static_cast<double>(follows.report.newton_iterations);
            of_alone += static_cast<double>(alone.report.newton_iterations);
        }
    tell("iterations by those without a motion to follow", iterations / of_alone);
    EXPECT_LT(iterations, 0.85 * of_alone);
    tell("largest difference to those", most);
    EXPECT_GT(apart, 1e-6) << "what is followed is another motion";
}

TEST(ReferencePredictor, GoesAgainstTimeToo)
{
    const Model model = cubes_on_rods(0.1);
    const Motion there = solved(model, 2, 30, 5, nullptr).motion;
    Problem problem;
    problem.conditions.at_start = Known::nothing;
    problem.conditions.at_end = Known::state;
    problem.conditions.end = there.at_end(30);
    const auto back = [&](const Motion* near, int degree) {
        problem.near = near;
        return solve(model, problem, make_time_mesh(0, 2, 30), Lobatto{degree}, quiet());
    };
    const Solution first = back(nullptr, 5), alone = back(nullptr, 7), follows = back(&first.motion, 7);
    ASSERT_TRUE(follows.report.converged()) << follows.report.message;
    const double parted = largest_gap(first.motion, alone.motion).X;
    EXPECT_GT(parted, 1e-9);
    EXPECT_LE(largest_gap(follows.motion, alone.motion).X, 1e-13);
    EXPECT_LE(follows.report.newton_iterations, alone.report.newton_iterations);
}

/// Whose elements are others, or that goes elsewhere, is not followed: not a bit of it is seen.
TEST(ReferencePredictor, TakesNothingFromOtherElementsAndOtherMotions)
{
    const Model model = two_bricks();
    const Solution alone = solved(model, 0.5, 20, 6, nullptr);
    Motion elsewhere = solved(model, 0.5, 20, 4, nullptr).motion;
    for (std::size_t i = 0; i < elsewhere.X.values.size(); ++i)
        elsewhere.X.values[i] += 1e-2 * std::sin(static_cast<double>(i));
    const Motion others = solved(model, 0.5, 19, 4, nullptr).motion;
    for (const Motion* near : {static_cast<const Motion*>(&elsewhere), &others}) {
        const Solution s = solved(model, 0.5, 20, 6, near);
        const Distance gap = largest_gap(s.motion, alone.motion);
        EXPECT_LE(gap.X, 1e-14);
        EXPECT_LE(gap.V, 1e-13);
    }
    EXPECT_EQ(solved(model, 0.5, 20, 6, &others).motion.X.values, alone.motion.X.values);
}

}   // namespace
}   // namespace livens::tests::following_test
