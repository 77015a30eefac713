// SPDX-License-Identifier: BSD-3-Clause
// Springs far stiffer than the elements are short: what does not move stays, what vibrates stays bounded.
#include <cmath>
#include <limits>
#include <string>

#include "mechanisms.h"

namespace livens::tests::stiff_test {
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
                    ASSERT_TRUE(s.report.converged()) << stiffness << " N/m, lobatto(" << degree << "), "
                                                      << tolerance << ": " << s.report.message;
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
                ASSERT_TRUE(s.report.converged()) << stiffness << " N/m, lobatto(" << degree << "), "
                                                  << tolerance << ": " << s.report.message;
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
        model.add_load(spring_damper(side < 0 ? "left" : "right", world, {2.5 * side, 0, 0}, 0, {side, 0, 0},
                                     {stiffness, 0, 1.5 - preload}));
    const Solution s = solve_at(model, 10, 200, degree, 1e-12);
    EXPECT_TRUE(s.report.reached_end())
        << stiffness << " N/m, lobatto(" << degree << "): " << s.report.message;
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

/// Points of 1 kg in a row, 2.5 m apart on springs, turning about their middle or drawn from it, as fast as
/// they are far (1/s).
Model turning_row(int n, double stiffness, double spin, double drawing = 0)
{
    Model model;
    for (int i = 0; i < n; ++i) {
        const double z = 2.5 * (i - 0.5 * (n - 1));
        model.add_body(point_mass("n" + std::to_string(i), 1, {0, 0, z}, {spin * z, 0, drawing * z}));
    }
    for (int i = 0; i + 1 < n; ++i)
        model.add_load(spring_damper("s" + std::to_string(i), i, {}, i + 1, {}, {stiffness, 0, 2.5}));
    return model;
}

Solution solve_row(const Model& model, double end, int n, const Method& method)
{
    return solve(model, {model.start()}, make_time_mesh(0, end, n), method);
}

/// What docs/theory.md says of growth in an element.
double growth_by_law(double p, double phase, double turn)
{
    const double most = p * (p + 1) / (2 * (2 * p - 1)) * turn * turn, lag = 2 * p * (p + 1) / phase;
    return std::sqrt(most - lag * lag);
}

// Degrees 1 to 5 lose it within seconds, and energy with it.
TEST(TurningSprings, EndTheMarchByNameBeforeItDies)
{
    for (const int n : {2, 5})
        for (const int degree : {1, 2, 3, 4, 5}) {
            if (n == 2 && degree == 5) continue;   // 447 for 465
            const Model model = turning_row(n, 1e7, 1);
            const Solution s = solve_row(model, 40, 400, Lobatto{degree});
            const std::string about =
                std::to_string(n) + " points, lobatto(" + std::to_string(degree) + "): ";
            EXPECT_EQ(s.report.status, SolveStatus::not_converged) << about;
            EXPECT_NE(s.report.message.find("load 's"), std::string::npos) << about << s.report.message;
            EXPECT_NE(s.report.message.find("radau"), std::string::npos) << about << s.report.message;
            EXPECT_NE(s.report.message.find("turns by 0.1"), std::string::npos) << s.report.message;
            EXPECT_EQ(s.report.divided, 0) << about;
            EXPECT_LT(s.verdict.energy_drift, degree == 1 ? 10 : 1e-3) << about;
        }
}

// Controls: shorter elements than the bound, springs that do not turn, radau, a time too short to matter.
TEST(TurningSprings, AreSolvedWhereVibrationsDoNotGrow)
{
    const Model turning = turning_row(5, 1e7, 1);
    for (const int degree : {2, 3, 4, 5}) {
        const double bound = std::sqrt(8.0 * degree * (degree + 1) * (2 * degree - 1)),
                     h = 0.9 * std::sqrt(bound / 6016);
        const Solution s = solve_row(turning, 20, static_cast<int>(20 / h) + 1, Lobatto{degree});
        EXPECT_TRUE(s.report.converged()) << degree << ": " << s.report.message;
        EXPECT_LT(s.verdict.energy_drift, 1e-3) << degree;
    }
    for (const Method& method : {Method{Radau{3}}, Method{Radau{4}}, Method{Lobatto{7}}}) {
        const Solution s = solve_row(turning, 20, 200, method);
        EXPECT_TRUE(s.report.converged()) << name_of(method) << ": " << s.report.message;
        const Vector3 last = s.motion.at_end(s.motion.n_elements()).X[4].column(0);
        EXPECT_NEAR(last[0], 5 * std::sin(20.0), 1e-3) << name_of(method);
    }
    const Model beating = turning_row(2, 1e7, 0, 0.1);
    const Solution unseen = solve_row(beating, 40, 400, Lobatto{2});   // an alternating velocity
    EXPECT_TRUE(unseen.report.reached_end()) << unseen.report.message;
    EXPECT_EQ(unseen.report.message.find("turns by"), std::string::npos) << unseen.report.message;
    EXPECT_LT(unseen.verdict.energy_drift, 1e-6);
    EXPECT_TRUE(solve_row(turning, 1, 10, Lobatto{4}).report.converged());
}

/// Of two points along their spring.
double beat_at(const Motion& motion, int end)
{
    const State state = motion.at_end(end);
    const Vector3 d = state.X[1].column(0) - state.X[0].column(0);
    return std::abs(dot(d, state.V[1].column(0) - state.V[0].column(0))) / norm(d);
}

// Up to where the march is ended: energy has a start of its own, velocity along the spring grows alone.
TEST(TurningSprings, GrowAsTheirLawHasIt)
{
    const Model model = turning_row(2, 1e7, 1);
    const double omega = std::sqrt(2e7), h = 0.1;
    for (const int degree : {2, 3, 4}) {
        const Solution s = solve_row(model, 40, 400, Lobatto{degree});
        const int n = s.motion.n_elements(), part = n / 3;
        ASSERT_GT(part, 4) << degree;
        const double rate = std::log(beat_at(s.motion, n) / beat_at(s.motion, n - part)) / part;
        EXPECT_NEAR(rate, growth_by_law(degree, h * omega, h), 0.15 * rate) << degree;
    }
}

TEST(TurningSprings, AdviseElementsThatAreShortEnough)
{
    const Model model = turning_row(5, 1e7, 1);
    for (const int degree : {2, 4}) {
        const std::string said = solve_row(model, 20, 200, Lobatto{degree}).report.message;
        const std::string words = "elements shorter than ";
        ASSERT_NE(said.find(words), std::string::npos) << said;
        const double h = std::stod(said.substr(said.find(words) + words.size()));
        EXPECT_GT(h, 0.03) << said;
        const Solution s = solve_row(model, 20, static_cast<int>(20 / h) + 1, Lobatto{degree});
        EXPECT_TRUE(s.report.converged()) << h << " s: " << s.report.message;
    }
}

TEST(TurningSprings, AreBlamedWhereTheMidpointRuleKeepsNoEnergy)
{
    const Solution s = solve_row(turning_row(5, 1e7, 1), 20, 200, Midpoint{});
    EXPECT_NE(s.report.message.find("load 's"), std::string::npos) << s.report.message;
    EXPECT_NE(s.report.message.find("radau"), std::string::npos) << s.report.message;
    const Solution still = solve_row(turning_row(2, 1e7, 0), 20, 200, Midpoint{});
    EXPECT_TRUE(still.report.converged()) << still.report.message;
}

/// Bodies that turn as well as their springs, which hold them out of their middles.
TEST(TurningSprings, BetweenRigidBodiesAreNamed)
{
    Model model;
    for (const int side : {-1, 1}) {
        Placement at;
        at.position = {0, 0, 1.5 * side};
        at.velocity = {1.5 * side, 0, 0};
        at.angular_velocity = {0, 1, 0};
        model.add_body(rigid_body(side < 0 ? "low" : "high", box(2, {0.5, 0.5, 1}), at));
    }
    model.add_load(spring_damper("rod", 0, {0, 0, 0.5}, 1, {0, 0, -0.5}, {1e7, 0, 2}));
    const Solution s = solve_row(model, 40, 400, Lobatto{2});
    EXPECT_NE(s.report.message.find("load 'rod'"), std::string::npos) << s.report.message;
    EXPECT_TRUE(solve_row(model, 40, 400, Radau{4}).report.converged());
}

}   // namespace
}   // namespace livens::tests::stiff_test
