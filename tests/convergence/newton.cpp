// SPDX-License-Identifier: BSD-3-Clause
// What a solution costs: iterations and factorisations.
#include "mechanisms.h"

namespace livens::tests::newton_test {
namespace {

Solution two_bricks_to_2(int degree, double h, double tolerance)
{
    const Model model = two_bricks();
    SolveOptions options;
    options.tolerance = tolerance;
    options.by_newton = true;
    return solve(model, {model.start()}, make_time_mesh(0, 2, static_cast<int>(std::lround(2 / h))),
                 Lobatto{degree}, options);
}

// Elements of 0.1 s turn the bricks by up to a radian; a guess by extrapolation diverges there.
TEST(Newton, ConvergesInTenIterationsOnLongElementsOfHighDegree)
{
    for (double tolerance : {1e-12, 1e-14}) {
        for (int degree : {8, 12, 16}) {
            const SolveReport report = two_bricks_to_2(degree, 0.1, tolerance).report;
            EXPECT_TRUE(report.converged()) << report.message;
            EXPECT_EQ(report.n_elements, 20);
            EXPECT_LE(report.most_iterations, 10) << "lobatto(" << degree << ")";
        }
    }
}

// With the exact tangent two or three iterations do; with one term missing convergence is linear and takes
// more.
TEST(Newton, NeedsThreeIterationsAnElementOnTheAverage)
{
    for (auto [degree, h] :
         {std::pair{1, 0.001}, {2, 0.01}, {4, 0.025}, {6, 0.025}, {8, 0.025}, {12, 0.05}, {16, 0.1}}) {
        const SolveReport report = two_bricks_to_2(degree, h, 1e-12).report;
        EXPECT_TRUE(report.converged()) << report.message;
        EXPECT_LE(report.newton_iterations, 3.0 * report.n_elements)
            << "lobatto(" << degree << "), h = " << h;
    }
}

TEST(Newton, FactorisesOnceAnElementWhereErrorsAreSmall)
{
    struct Case {
        const char* name;
        Model model;
        double end;
    };
    const std::vector<Case> cases{{"two bricks", two_bricks(), 2},
                                  {"free box", free_box(), 1},
                                  {"hinged links", hinged_links(), 2},
                                  {"cubes on rods", cubes_on_rods(0), 2},
                                  {"cubes, off centre", cubes_on_rods(0.1), 2},
                                  {"heavy top", heavy_top(), 1}};
    for (const Case& c : cases) {
        const State reference = last(solve_evenly(c.model, c.end, 120, 12));
        int n_accurate = 0;
        SolveOptions options;
        options.by_newton = true;
        for (int degree : {1, 2, 3, 4, 6, 8, 12, 16}) {
            for (double h : {0.1, 0.05, 0.025, 0.01, 0.002}) {
                const int n = static_cast<int>(std::lround(c.end / h));
                if (n * degree > 1200) continue;   // nothing new there, but time
                const Solution s =
                    solve(c.model, {c.model.start()}, make_time_mesh(0, c.end, n), Lobatto{degree}, options);
                if (!s.report.converged() || s.report.divided > 0 || distance(last(s), reference).X > 1e-6)
                    continue;
                ++n_accurate;
                EXPECT_LE(s.report.factorisations, 1.1 * n)
                    << c.name << ", lobatto(" << degree << "), h = " << h;
            }
        }
        EXPECT_GE(n_accurate, 10) << c.name;
    }
}

}   // namespace
}   // namespace livens::tests::newton_test
