// SPDX-License-Identifier: BSD-3-Clause
// Stiff springs released: the first guess may lie far off, the solution does not.
#include "mechanisms.h"

namespace livens::tests::stretched_test {
namespace {

/// 1 kg released with its spring stretched, in elements of 0.05 s.
Solution released(double stiffness, double free_length, double stretch, int degree)
{
    Model model;
    model.add_body(point_mass("mass", 1, {free_length + stretch, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {stiffness, 0, free_length}));
    SolveOptions options;
    options.tolerance = 1e-12;
    options.judge = options.divide = false;   // a vibration that elements do not see is suspect, as it should be
    return solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{degree}, options);
}

// Without free length the problem is linear: one tangent solves it from any guess. At h omega = 5000 a solution
// of the linear system itself has half the digits, and each iteration adds as many.
TEST(Stretched, LinearSpringsConvergeInThreeIterations)
{
    for (const double stiffness : {1e4, 1e6, 1e8, 1e10})
        for (const int degree : {1, 2, 4, 8}) {
            const Solution s = released(stiffness, 0, 1, degree);
            ASSERT_TRUE(s.report.converged())
                << stiffness << " N/m, lobatto(" << degree << "): " << s.report.message;
            EXPECT_LE(s.report.most_iterations, stiffness < 1e10 ? 3 : 5) << stiffness << " N/m, lobatto(" << degree << ")";
            EXPECT_EQ(s.report.rescued, 0) << stiffness << " N/m, lobatto(" << degree << ")";
        }
}

// 0.1 mm of a spring of 1 m, 10 kN at most.
TEST(Stretched, SpringsWithAFreeLengthConverge)
{
    for (const double stiffness : {1e4, 1e6, 1e8})
        for (const int degree : {1, 2, 4, 8}) {
            const Solution s = released(stiffness, 1, 1e-4, degree);
            ASSERT_TRUE(s.report.converged())
                << stiffness << " N/m, lobatto(" << degree << "): " << s.report.message;
            for (int e = 0; e <= 20; ++e)
                EXPECT_NEAR(s.motion.at_end(e).X[0](0, 0), 1, 1.01e-4)
                    << stiffness << " N/m, lobatto(" << degree << "), element end " << e;
        }
}

}   // namespace
}   // namespace livens::tests::stretched_test
