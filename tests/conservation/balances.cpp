// SPDX-License-Identifier: BSD-3-Clause
// Momentum, energy, constraints and planes over ten seconds.
#include <functional>

#include "livens/diagnostics/diagnostics.h"
#include "livens/time/quadrature.h"
#include "mechanisms.h"

namespace livens::tests::balances_test {
namespace {

struct LongRun {
    std::string name;
    Model model;
    int degree;
    int n;   ///< elements in 10 s
};

std::vector<LongRun> runs()
{
    return {{"two bricks", two_bricks(), 6, 400},
            {"two bricks, high degree", two_bricks(), 12, 200},
            {"hinged links", hinged_links(), 4, 400},
            {"cubes on rods", cubes_on_rods(0), 6, 200},
            {"cubes, off centre", cubes_on_rods(0.1), 6, 400},
            {"four-bar", four_bar(), 4, 400},
            {"heavy top", heavy_top(), 6, 2000},
            {"medley", medley(), 6, 400}};
}

/// Sum over bodies of sum over columns x_c cross p_c, here by hand.
Vector3 moment(const Motion& motion, int end)
{
    Vector3 sum{};
    for (int b = 0; b < motion.n_bodies; ++b) {
        const Matrix34 X = motion.at_end(end).X[b], P = motion.momenta[end * motion.n_bodies + b];
        for (int c = 0; c < 4; ++c) sum += cross(X.column(c), P.column(c));
    }
    return sum;
}

TEST(Lobatto, BalancesAngularMomentumOverTenSeconds)
{
    for (const LongRun& run : runs()) {
        const Solution s = solve_evenly(run.model, 10, run.n, run.degree);
        const Balance b = balance(run.model, s.motion);
        ASSERT_EQ(b.angular_momentum_drift.size(), static_cast<std::size_t>(run.n) + 1) << run.name;
        const double drift =
            *std::max_element(b.angular_momentum_drift.begin(), b.angular_momentum_drift.end());
        EXPECT_LE(drift, 1e-11 * b.largest_moment) << run.name;
        EXPECT_GT(b.largest_moment, 0.1) << run.name;
        const double linear =
            *std::max_element(b.linear_momentum_drift.begin(), b.linear_momentum_drift.end());
        // a body that spins fast about a slow centre shows the rounding of its spin here
        EXPECT_LE(linear, 1e-11 * b.largest_moment / run.model.length()) << run.name;
    }
}

// The same by hand where it is easy: the ball joint at the origin has no moment about it, so all that changes
// the angular momentum of two bricks is gravity, whose impulse the elements sum with their own weights.
TEST(Lobatto, BalancesAngularMomentumOfTwoBricksWithGravityAlone)
{
    const Model model = two_bricks();
    const int p = 6;
    const Motion m = solve_evenly(model, 10, 400, p).motion;
    const Quadrature rule = gauss_lobatto(p + 1);
    Vector3 impulse{};
    double drift = 0, largest = 0, vertical = 0;
    for (int e = 0; e < m.n_elements(); ++e) {
        for (int a = 0; a <= p; ++a) {
            const auto X = m.X.coefficient(e, a);
            for (int b = 0; b < 2; ++b) {
                Matrix34 X_b{};
                std::copy_n(X.begin() + 12 * b, 12, X_b.a);
                const Vector3 center = X_b * point({0.5, 0, 0});
                impulse += m.mesh.length(e) * rule.weights[a] * cross(center, {0, 0, -9.81});
            }
        }
        const Vector3 now = moment(m, e + 1);
        drift = std::max(drift, norm(now - moment(m, 0) - impulse));
        vertical = std::max(vertical, std::abs(now[2] - moment(m, 0)[2]));
        largest = std::max(largest, norm(now));
    }
    EXPECT_GT(largest, 1);
    EXPECT_LE(drift, 1e-11 * largest);
    EXPECT_LE(vertical, 1e-11 * largest);
}

// Without the world nothing is left to sum up: both momenta are constants.
TEST(Lobatto, KeepsMomentaOfAFloatingChain)
{
    Model model;
    Placement spinning;
    spinning.angular_velocity = {0.4, 1, 3};
    const int first = model.add_body(rigid_body("first", brick({}), spinning));
    Placement next;
    next.position = {1, 0, 0};
    next.velocity = cross(spinning.angular_velocity, {1, 0, 0});
    next.angular_velocity = {2, -1, 0.5};
    const int second = model.add_body(rigid_body("second", brick({}), next));
    JointFrame elbow;
    elbow.point_first = {1, 0, 0};
    model.add_joint(spherical("elbow", first, second, elbow));
    model.add_load(spring_damper("strut", first, {0, 0, 0}, second, {1, 0, 0}, {5, 0.1, 1}));
    for (int degree : {1, 2, 5, 9}) {
        const Motion m = solve_evenly(model, 10, 2000 / degree, degree).motion;
        Vector3 start{}, end{};
        for (int b = 0; b < 2; ++b) {
            start += m.momenta[b].column(0);
            end += m.momenta[m.n_elements() * 2 + b].column(0);
        }
        // the chain flies off with some 3 m/s, so moments about the origin grow out of large terms
        EXPECT_LE(norm(end - start), 1e-11 * norm(start)) << "lobatto(" << degree << ")";
        const double moments = norm(end) * norm(m.at_end(m.n_elements()).X[0].column(0));
        EXPECT_LE(norm(moment(m, m.n_elements()) - moment(m, 0)), 1e-11 * moments)
            << "lobatto(" << degree << ")";
    }
}

TEST(Lobatto, HoldsConstraintsAtNodesOverTenSeconds)
{
    for (const LongRun& run : runs()) {
        const Solution s = solve_evenly(run.model, 10, run.n, run.degree);
        const ViolationReport v = violations(run.model, s.motion);
        EXPECT_LE(v.joints_at_nodes, 1e-12)
            << run.name << ", row " << v.worst_row << ", t = " << v.worst_time;
        EXPECT_LE(v.rigidity_at_nodes, 1e-12) << run.name;
        EXPECT_LE(v.velocity_level, 1e-11) << run.name;
    }
}

// By hand: the pins of two bricks meet at all nodes, and the rods of the cubes keep their length.
TEST(Lobatto, KeepsPinsTogetherAndRodsLong)
{
    auto largest_at_nodes = [](const Motion& m,
                               const std::function<double(const Matrix34&, const Matrix34&)>& gap) {
        double worst = 0;
        for (int e = 0; e < m.n_elements(); ++e) {
            for (int a = 0; a <= m.X.degree; ++a) {
                const auto X = m.X.coefficient(e, a);
                Matrix34 first{}, second{};
                std::copy_n(X.begin(), 12, first.a);
                std::copy_n(X.begin() + 12, 12, second.a);
                worst = std::max(worst, gap(first, second));
            }
        }
        return worst;
    };
    auto pins = [](const Matrix34& first, const Matrix34& second) {
        const Vector3 elbow = first * point({1, 0, 0}) - second.column(0);
        return std::max(norm(first.column(0)), norm(elbow));
    };
    EXPECT_LE(largest_at_nodes(solve_evenly(two_bricks(), 10, 400, 6).motion, pins), 1e-12);
    auto rods = [](const Matrix34& first, const Matrix34& second) {
        const double upper = norm(first.column(0)), lower = norm(second.column(0) - first.column(0));
        return std::max(std::abs(upper - 4), std::abs(lower - 4)) / 4;
    };
    EXPECT_LE(largest_at_nodes(solve_evenly(cubes_on_rods(0.1), 10, 400, 6).motion, rods), 1e-12);
}

/// Largest coordinate across the plane whose normal is the world axis `normal`: of points, and of directors.
/// A director starts along the normal and has no other component then.
double out_of_plane(const Motion& m, int normal)
{
    double worst = 0;
    for (std::size_t i = 0; i < m.X.values.size(); i += 12) {
        for (int c = 0; c < 4; ++c) {
            const bool is_normal = c == normal + 1;
            for (int k = 0; k < 3; ++k)
                if ((k == normal) != is_normal) worst = std::max(worst, std::abs(m.X.values[i + 3 * c + k]));
        }
    }
    return worst;
}

TEST(Lobatto, KeepsPlanarMotionsPlanarForTenSeconds)
{
    EXPECT_LE(out_of_plane(solve_evenly(cubes_on_rods(0.1), 10, 400, 6).motion, 1), 1e-28);
    EXPECT_LE(out_of_plane(solve_evenly(cubes_on_rods(0), 10, 200, 6).motion, 1), 1e-28);
    EXPECT_LE(out_of_plane(solve_evenly(hinged_links(), 10, 400, 6).motion, 2), 1e-28);
    EXPECT_LE(out_of_plane(solve_evenly(hinged_links(), 10, 1000, 3).motion, 2), 1e-28);
}

TEST(Lobatto, KeepsPlanarMotionsPlanarByNewtonToo)
{
    SolveOptions options;
    options.by_newton = true;
    const auto solved = [&](const Model& model, int n) {
        return solve(model, {model.start()}, make_time_mesh(0, 10, n), Lobatto{6}, options).motion;
    };
    EXPECT_LE(out_of_plane(solved(cubes_on_rods(0.1), 400), 1), 1e-28);
    EXPECT_LE(out_of_plane(solved(cubes_on_rods(0), 200), 1), 1e-28);
    EXPECT_LE(out_of_plane(solved(hinged_links(), 400), 2), 1e-28);
}

double largest_energy_error(const Balance& b, double from, double to)
{
    double worst = 0;
    for (std::size_t e = 0; e < b.t.size(); ++e)
        if (b.t[e] >= from && b.t[e] <= to) worst = std::max(worst, std::abs(b.energy[e] - b.energy[0]));
    return worst;
}

// Energy swings about its value with the order of the method and does not run away: the elements come from a
// variational principle. The top is a motion without chaos, coarse enough for the swing to show.
TEST(Lobatto, KeepsTheEnergyErrorBounded)
{
    const Model model = heavy_top();
    for (auto [degree, n] : {std::pair{1, 20000}, {2, 4000}, {3, 1200}}) {
        const Balance b = balance(model, solve_evenly(model, 20, n, degree).motion);
        const double early = largest_energy_error(b, 0, 5), late = largest_energy_error(b, 15, 20);
        EXPECT_GT(early, 1e-8) << "lobatto(" << degree << "): nothing to see";
        EXPECT_LE(late, 1.5 * early) << "lobatto(" << degree << ")";
    }
}

TEST(Lobatto, ConvergesInEnergyWithOrder2P)
{
    const Model model = two_bricks();
    for (auto [degree, n] : {std::pair{1, 500}, {2, 125}, {3, 24}, {4, 12}}) {
        const double coarse =
            largest_energy_error(balance(model, solve_evenly(model, 0.5, n, degree).motion), 0, 1);
        const double finer =
            largest_energy_error(balance(model, solve_evenly(model, 0.5, n + n / 4, degree).motion), 0, 1);
        const double refinement = std::log(1.0 * (n + n / 4) / n);
        EXPECT_GE(std::log(coarse / finer) / refinement, 2 * degree - 0.7) << "lobatto(" << degree << ")";
    }
}

// What a damper takes away is what the mechanism loses.
TEST(Lobatto, BalancesEnergyWithTheWorkOfLoads)
{
    const Model model = medley();
    const Balance b = balance(model, solve_evenly(model, 3, 120, 8).motion);
    EXPECT_GT(*std::max_element(b.energy_drift.begin(), b.energy_drift.end()), 0);
    EXPECT_LE(b.relative_energy_drift(), 1e-10);
    EXPECT_GT(std::abs(b.work.back()), 0.1) << "nothing to balance";
}

}   // namespace
}   // namespace livens::tests::balances_test
