// SPDX-License-Identifier: BSD-3-Clause
// Springs far stiffer than the elements are short: what does not move stays, what vibrates stays bounded.
#include <limits>

#include "mechanisms.h"

namespace livens::tests {
namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

Solution solve_at(const Model& model, double end, int n, int degree, double tolerance)
{
    SolveOptions options;
    options.tolerance = tolerance;
    return solve(model, {model.start()}, make_time_mesh(0, end, n), Lobatto{degree}, options);
}

/// Largest distances from the start at all element ends.
Distance largest_from_start(const Solution& solution)
{
    Distance largest;
    const State start = solution.motion.at_end(0);
    for (int e = 0; e <= solution.motion.n_elements(); ++e) {
        const Distance d = distance(solution.motion.at_end(e), start);
        largest = {std::max(largest.X, d.X), std::max(largest.V, d.V)};
    }
    return largest;
}

/// 1 kg that hangs at rest from a spring.
Model hanging_mass(double stiffness, double free_length)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("mass", 1, {0, 0, -(free_length + 9.81 / stiffness)}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {stiffness, 0, free_length}));
    return model;
}

/// 3 kg that hang at rest from two springs side by side.
Model hanging_box(double stiffness)
{
    const double length = 1 + 3 * 9.81 / (2 * stiffness);
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("box", box(1.5, {2, 1, 1})));
    for (const double side : {-1.0, 1.0})
        model.add_load(spring_damper(side < 0 ? "left" : "right", world, {side, 0, 0.5 + length}, 0,
                                     {side, 0, 0.5}, {stiffness, 0, 1}));
    return model;
}

// An ulp of the length is a force of k ulps, which moves the mass by some ulps: bounds are 100 of them for
// k = 1e6 N/m and ten times as many for 1e8, where each of 100 elements of h omega = 10 has its own.
TEST(Stiffness, LeavesAMassAtRestAtEveryTolerance)
{
    for (const double stiffness : {1e6, 1e8})
        for (const double free_length : {0.0, 1.0})
            for (const int degree : {1, 2, 4, 8})
                for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
                    const Solution s =
                        solve_at(hanging_mass(stiffness, free_length), 0.1, 100, degree, tolerance);
                    ASSERT_TRUE(s.report.converged())
                        << stiffness << " N/m, lobatto(" << degree << "), " << tolerance << ": "
                        << s.report.message;
                    const Distance d = largest_from_start(s);
                    const double allowed = 100 * ulp * std::max(1.0, stiffness / 1e7);
                    EXPECT_LE(d.X, allowed) << stiffness << " N/m, lobatto(" << degree << ")";
                    EXPECT_LE(d.V, std::sqrt(stiffness) * allowed) << stiffness << " " << degree;
                }
}

TEST(Stiffness, LeavesABodyAtRestAtEveryTolerance)
{
    for (const double stiffness : {1e6, 1e8})
        for (const int degree : {1, 2, 4, 8})
            for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
                const Solution s = solve_at(hanging_box(stiffness), 0.1, 100, degree, tolerance);
                ASSERT_TRUE(s.report.converged())
                    << stiffness << " N/m, lobatto(" << degree << "), " << tolerance << ": "
                    << s.report.message;
                EXPECT_LE(largest_from_start(s).X, 100 * ulp * std::max(1.0, stiffness / 1e7));
            }
}

// A control: the same mass a hair from its place vibrates, so that the bounds above can fail.
TEST(Stiffness, ShowsAVibrationOfAThousandUlps)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("mass", 1, {0, 0, -(1 + 9.81 / 1e6) * (1 + 1000 * ulp)}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {1e6, 0, 1}));
    EXPECT_GT(largest_from_start(solve_at(model, 0.2, 200, 4, 1e-14)).X, 100 * ulp);
}

/// How far 3 kg fall between two springs, which are free at first or pull already; h = 0.05 s.
double largest_fall(double stiffness, double preload, int degree)
{
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("box", box(1.5, {2, 1, 1})));
    for (const double side : {-1.0, 1.0})
        model.add_load(spring_damper(side < 0 ? "left" : "right", world, {2.5 * side, 0, 0}, 0,
                                     {side, 0, 0}, {stiffness, 0, 1.5 - preload}));
    const Solution s = solve_at(model, 10, 200, degree, 1e-12);
    EXPECT_TRUE(s.report.reached_end()) << stiffness << " N/m, lobatto(" << degree << "): " << s.report.message;
    return largest_from_start(s).X;
}

// The box falls until its springs hold it, at most twice the sag. With a preload T each end bears T z / l:
// the sag is m g l / (2 T). Without, k z^3 / l^2 = m g holds it.
TEST(Stiffness, BoundsUnresolvedVibrations)
{
    for (const double stiffness : {1e6, 1e7, 1e8})
        for (const int degree : {1, 2, 3, 4, 8}) {
            const double drawn = 3 * 9.81 * 1.5 / (2 * 0.1 * stiffness);
            EXPECT_LE(largest_fall(stiffness, 0.1, degree), 2.2 * drawn) << stiffness << " " << degree;
            EXPECT_GE(largest_fall(stiffness, 0.1, degree), 1.5 * drawn) << stiffness << " " << degree;
            const double free = std::cbrt(3 * 9.81 * 1.5 * 1.5 / stiffness);
            EXPECT_LE(largest_fall(stiffness, 0, degree), 2.2 * free) << stiffness << " " << degree;
        }
}

}   // namespace
}   // namespace livens::tests
