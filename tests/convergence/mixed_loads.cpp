// SPDX-License-Identifier: BSD-3-Clause
// The paper's elements under loads that jump or bend, and the order that motions state.
#include "convergence/studies.h"
#include "mixed_problems.h"

namespace livens::tests::mixed_loads_test {
namespace {

/// A box under a torque of this course in time about (1, 1, 1), as large as makes it turn by radians.
Model driven_box(const TimeFunction& course)
{
    Model model;
    const int body = model.add_body(rigid_body("box", box(1.5, {2, 1, 1})));
    model.add_load(torque("motor", body, {course, course, course}, Frame::inertial));
    return model;
}

Model box_with_jumps() { return driven_box(window(TimeFunction(6), 0.25, 0.75)); }

Model box_with_bends() { return driven_box(linear_table({0, 0.31, 0.67, 1}, {0, 6, -6, 3})); }

Solution solved(const Model& model, const TimeMesh& mesh, const Method& method)
{
    SolveOptions options;
    options.judge = false;
    Solution s = solve(model, {model.start()}, mesh, method, options);
    EXPECT_TRUE(s.report.converged()) << name_of(method) << ": " << s.report.message;
    return s;
}

State exact_end(const Model& model)
{
    return last(solved(model, make_time_mesh(0, 1, 40, model.load_breaks()), Lobatto{12}));
}

/// Numbers of elements that have ends at 0.25 and 0.75.
Study study_of_jumps(const Mixed& method, const std::vector<int>& n)
{
    const Model model = box_with_jumps();
    const State exact = exact_end(model);
    Study s{n, {}};
    for (const int elements : n)
        s.error.push_back(distance(last(solved(model, make_time_mesh(0, 1, elements), method)), exact));
    return s;
}

TEST(MixedJumps, InsideABlockCostNoOrder)
{
    const struct {
        Pairing pairing;
        double order, tolerance;
    } cases[] = {{{lagrange, 1, natural, equal}, 2, 0.15}, {{lagrange, 3, natural, equal}, 4, 0.15},
                 {{lagrange, 4, natural, equal}, 5, 0.2},  {{lagrange, 6, natural, equal}, 7, 0.2},
                 {{bspline, 4, natural, equal}, 5, 0.4},   {{bspline, 6, natural, equal}, 7, 0.7},
                 {{lagrange, 4, natural, lower}, 4, 0.3},  {{lagrange, 4, strong, equal}, 4, 0.3}};
    for (const auto& c : cases) {
        const Study s = study_of_jumps(mixed(c.pairing), {16, 20, 24, 28, 32, 36, 40});
        EXPECT_NEAR(slope(s, &Distance::X, 1e-12), c.order, c.tolerance) << name_of(mixed(c.pairing));
    }
    // A block may be cut at a jump as well, and the motion of both is of one order.
    Mixed cut = mixed({lagrange, 6, natural, equal});
    cut.window = 4;
    const Study s = study_of_jumps(cut, {16, 20, 24, 28});
    EXPECT_GT(slope(s, &Distance::X, 1e-12), 6.5);
}

TEST(MixedJumps, KeepMomenta)
{
    const Model model = box_with_jumps();
    const Motion m = solved(model, make_time_mesh(0, 1, 8), mixed({lagrange, 4, natural, equal})).motion;
    // the torque times the half second that it acts
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(angular_momentum_at(m, 8)[i], 3, 1e-12);
}

TEST(MixedJumps, ThatManyElementsHaveAreNoHarm)
{
    // a table with a row at every other element end
    std::vector<double> times, values;
    for (int i = 0; i <= 16; ++i) {
        times.push_back(i / 16.0);
        values.push_back(6 * std::sin(1.0 * i));
    }
    const Model model = driven_box(linear_table(times, values));
    const State exact = exact_end(model);
    Study s{{32, 48, 64}, {}};
    for (const int n : s.n)
        s.error.push_back(distance(
            last(solved(model, make_time_mesh(0, 1, n), mixed({lagrange, 3, natural, equal}))), exact));
    EXPECT_NEAR(slope(s, &Distance::X, 1e-12), 4, 0.2) << s.error.front().X << " " << s.error.back().X;
}

TEST(StatedOrders, AreThoseOfLoadsThatBreakInsideElements)
{
    const Method methods[] = {Lobatto{4}, mixed({lagrange, 3, natural, equal}), Midpoint{}};
    for (const Method& method : methods) {
        const Model model = box_with_jumps();
        const State exact = exact_end(model);
        Study s{{41, 81, 161}, {}};
        for (const int n : s.n) {
            const Solution found = solved(model, make_time_mesh(0, 1, n), method);
            EXPECT_EQ(found.motion.order_at_ends, 1) << name_of(method);
            s.error.push_back(distance(last(found), exact));
        }
        EXPECT_NEAR(slope(s, &Distance::X, 0), 1, 0.2) << name_of(method);
        EXPECT_EQ(solved(box_with_bends(), make_time_mesh(0, 1, 40), method).motion.order_at_ends, 2);
    }
    const Model model = box_with_jumps();
    EXPECT_EQ(solved(model, make_time_mesh(0, 1, 8), Lobatto{4}).motion.order_at_ends, 8);
    EXPECT_EQ(
        solved(model, make_time_mesh(0, 1, 8), mixed({bspline, 4, natural, equal})).motion.order_at_ends, 5);
}

TEST(StatedOrders, OfQuotientsWithUnequalWeightsAreNone)
{
    Mixed method = mixed({nurbs, 2, natural, equal});
    for (int i = 0; i < 42; ++i) method.weights.push_back(1 + 0.1 * ((i * 7) % 3));
    const Solution rough = solved(free_box(), make_time_mesh(0, 1, 40), method);
    EXPECT_EQ(rough.motion.order_at_ends, 0);
    method.weights.assign(42, 0.7);
    EXPECT_EQ(solved(free_box(), make_time_mesh(0, 1, 40), method).motion.order_at_ends, 3);
}

}   // namespace
}   // namespace livens::tests::mixed_loads_test
