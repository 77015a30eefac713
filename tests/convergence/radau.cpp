// SPDX-License-Identifier: BSD-3-Clause
// radau(p): order 2p - 1 at element ends, constraints at nodes, and what is stiff is damped, not resolved.
#include <limits>

#include "convergence/studies.h"

namespace livens::tests::radau_test {
namespace {

Solution solve_radau(const Model& model, double end, int n, int degree, const SolveOptions& options = {})
{
    Solution s = solve(model, {model.start()}, make_time_mesh(0, end, n), Radau{degree}, options);
    EXPECT_TRUE(s.report.converged()) << "radau(" << degree << "), " << n << ": " << s.report.message;
    return s;
}

/// The rate of the last two errors above 50 gaps of the fine motion, after four refinements.
void expect_order(const Model& model, double end, const Fine& reference, int degree,
                  const std::vector<int>& n)
{
    const Study s = radau_study(model, end, reference.end, degree, n);
    const double X = 50 * reference.floor.X, V = 50 * reference.floor.V;
    tell("radau(" + std::to_string(degree) + "), order of positions", last_rate(s, &Distance::X, X));
    tell("radau(" + std::to_string(degree) + "), order of velocities", last_rate(s, &Distance::V, V));
    EXPECT_GE(n_above(s, &Distance::X, X), 5u) << degree;
    EXPECT_GE(n_above(s, &Distance::V, V), 5u) << degree;
    EXPECT_NEAR(last_rate(s, &Distance::X, X), 2 * degree - 1, 0.2) << "position, radau(" << degree << ")";
    EXPECT_NEAR(last_rate(s, &Distance::V, V), 2 * degree - 1, 0.2) << "velocity, radau(" << degree << ")";
}

// The fine motions are those that published digits are checked against in orders.cpp.
TEST(Radau, ConvergesWithOrder2PLess1OnTheFreeBox)
{
    const Model model = free_box();
    const Fine f = fine(model, 1, 8);
    expect_order(model, 1, f, 1, {160, 200, 250, 312, 390});
    expect_order(model, 1, f, 2, {20, 25, 31, 38, 47});
    expect_order(model, 1, f, 3, {8, 10, 12, 15, 18});
    expect_order(model, 1, f, 4, {6, 7, 8, 10, 12});
}

TEST(Radau, ConvergesWithOrder2PLess1OnTwoBricksInSpace)
{
    const Model model = two_bricks();
    const Fine f = fine(model, 0.5, 20);
    expect_order(model, 0.5, f, 2, {40, 50, 62, 77, 96});
    expect_order(model, 0.5, f, 3, {20, 25, 31, 38, 47});
    expect_order(model, 0.5, f, 4, {12, 15, 18, 22, 27});
}

TEST(Radau, ConvergesWithOrder2PLess1OnRevolutes)
{
    const Model model = hinged_links();
    const Fine f = fine(model, 1, 16);
    expect_order(model, 1, f, 2, {32, 40, 50, 62, 77});
    expect_order(model, 1, f, 3, {12, 15, 18, 22, 27});
    expect_order(model, 1, f, 4, {8, 9, 11, 13, 16});
}

/// A load on the hinged brick that follows the velocity and one that jumps, at an end of elements.
TEST(Radau, TakesLoadsAtItsNodesFromTheElementsSide)
{
    Model model({0, -9.81, 0});
    const int body = model.add_body(rigid_body("bar", brick({})));
    model.add_joint(revolute("hinge", world, body, {}));
    const TimeFunction push = window(4.0, 0.5, 2);
    model.add_load(point_force("push", body, {1, 0, 0}, {push, 0, 0}, Frame::inertial));
    model.add_load(spring_damper("strut", world, {0.5, 0.8, 0}, body, {1, 0, 0}, {30, 1.5, 0.6}));
    const Fine f = fine(model, 1, 16);
    expect_order(model, 1, f, 3, {24, 30, 36, 44, 54});
}

// --- constraints and momenta

TEST(Radau, HoldsConstraintsAtItsNodesToRounding)
{
    double largest = 0;
    for (const Model& model : {two_bricks(), hinged_links(), four_bar(), cubes_on_rods(0.1), medley()})
        for (const int degree : {1, 2, 3, 5, 8}) {
            const Solution s = solve_radau(model, 0.5, 40, degree, undivided());
            const ViolationReport v = violations(model, s.motion, 1, false);
            largest = std::max({largest, v.joints_at_nodes, v.rigidity_at_nodes});
            EXPECT_LE(v.joints_at_nodes, 2e-14) << degree;
            EXPECT_LE(v.rigidity_at_nodes, 2e-14) << degree;
            EXPECT_LE(v.velocity_level, 1e-12) << degree;
            // a control: between the nodes they do not hold
            if (degree == 2) {
                EXPECT_GT(v.joints_between + v.rigidity_between, 1e-8);
            }
        }
    tell("largest violation at nodes, of five mechanisms and degrees", largest);
}

TEST(Radau, BalancesLinearMomentumWithItsMultipliers)
{
    for (const int degree : {1, 2, 4, 8}) {
        const Solution s = solve_radau(two_bricks(), 0.5, 20, degree, undivided());
        const Balance b = balance(two_bricks(), s.motion);
        EXPECT_LE(b.relative_linear_momentum_drift(), 1e-12) << degree;
        if (degree == 2) {
            EXPECT_GT(b.relative_angular_momentum_drift(), 1e-7);   // not so, and a control
        }
    }
}

// --- stability and stiffness

/// (x omega, v) after one element of a mass on a spring with h omega = 1e4.
double radius_of_a_stiff_spring(int degree)
{
    double map[2][2];
    for (int column = 0; column < 2; ++column) {
        Model model;
        const double omega = 1e4;
        const int mass = model.add_body(
            point_mass("mass", 1, {column == 0 ? 1 / omega : 0, 0, 0}, {column == 1 ? 1.0 : 0, 0, 0}));
        model.add_load(spring_damper("spring", world, {}, mass, {}, {omega * omega, 0, 0}));
        const State end = last(solve_radau(model, 1, 1, degree, undivided()));
        map[0][column] = end.X[0](0, 0) * omega;
        map[1][column] = end.V[0](0, 0);
    }
    const double half = 0.5 * (map[0][0] + map[1][1]);
    const double square = half * half - (map[0][0] * map[1][1] - map[0][1] * map[1][0]);
    return square < 0 ? std::sqrt(half * half - square) : std::abs(half) + std::sqrt(square);
}

TEST(Radau, DampsWhatItDoesNotResolve)
{
    for (int degree = 1; degree <= 8; ++degree) {
        const double radius = radius_of_a_stiff_spring(degree);
        tell("spectral radius of radau(" + std::to_string(degree) + ") at h omega = 1e4", radius);
        EXPECT_LT(radius, 1e-3) << degree;
        EXPECT_NEAR(radius, degree / 1e4, 0.02 * degree / 1e4) << degree;   // |R(iy)| -> p / y
    }
}

TEST(Radau, StopsAMassByAStrongDamper)
{
    Model model;
    model.add_body(point_mass("mass", 1, {1, 0, 0}, {1, 0, 0}));
    model.add_load(spring_damper("damper", world, {}, 0, {}, {0, 1e6, 0}));
    for (int degree = 1; degree <= 8; ++degree) {
        const Solution s = solve_radau(model, 1, 10, degree);   // judged, and not suspect
        EXPECT_EQ(s.report.divided, 0);
        tell("v(1 s) of radau(" + std::to_string(degree) + "), m/s", last(s).V[0](0, 0));
        EXPECT_LE(std::abs(last(s).V[0](0, 0)), 1e-9) << degree;
        EXPECT_NEAR(last(s).X[0](0, 0), 1 + 1e-6, 1e-9) << degree;
        EXPECT_TRUE(std::ranges::any_of(s.verdict.remarks, [](const std::string& remark) {
            return remark.find("has damped") != std::string::npos;
        }));
    }
    // a control: lobatto reflects the velocity
    const Solution l = solve(model, {model.start()}, make_time_mesh(0, 1, 10), Lobatto{4}, undivided());
    EXPECT_GT(std::abs(last(l).V[0](0, 0)), 0.1);
}

/// A bob on a spring of 1 MN/m with critical damping, let go from the horizontal. The first shock of 1e-5 m
/// is over after some milliseconds.
TEST(Radau, FollowsAStiffElasticPendulum)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {1, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {1e6, 2e3, 1}));
    const auto at = [&](const Method& method, int n) {
        return last(solve(model, {model.start()}, make_time_mesh(0, 1, n), method, undivided()));
    };
    const State reference = at(Lobatto{4}, 8000);
    for (const int n : {20, 40, 80})
        tell("radau(4) with " + std::to_string(n) + " elements, m", distance(at(Radau{4}, n), reference).X);
    EXPECT_LE(distance(at(Lobatto{5}, 6000), reference).X, 2e-11);
    EXPECT_LE(distance(at(Radau{4}, 20), reference).X, 1e-6);
    EXPECT_LE(distance(at(Radau{4}, 40), reference).X, 4e-8);
    EXPECT_LE(distance(at(Radau{4}, 80), reference).X, 2e-9);
}

/// A hook of 1 kg between two rods with 10 t below swings slowly and could vibrate with the root of T / m (1
/// / l
/// + 1 / l), 443 / s, which elements of a tenth of a second do not see: 2e-8 m of it are in the start.
TEST(Radau, SwingsALightHookUnderAHeavyLoad)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("hook", 1, {0, 0, -1}, {0.5, 0, 0}));
    model.add_body(point_mass("load", 1e4, {0, 0, -2}, {1, 0, 0}));
    model.add_joint(rod("upper", world, 0, {}, 1));
    model.add_joint(rod("lower", 0, 1, {}, 1));
    const auto at = [&](const Method& method, int n) {
        return last(solve(model, {model.start()}, make_time_mesh(0, 1, n), method, undivided()));
    };
    const State reference = at(Lobatto{4}, 4000);
    EXPECT_LE(distance(at(Lobatto{5}, 3000), reference).X, 1e-10);
    const Study s = radau_study(model, 1, reference, 3, {8, 9, 10});
    EXPECT_LE(s.error.front().X, 5e-7);
    EXPECT_LE(s.error.back().X, 1e-7);
    EXPECT_NEAR(last_rate(s, &Distance::X, 0), 5, 0.3);
    EXPECT_LE(distance(at(Radau{3}, 40), reference).X, 1e-7);    // what it does not resolve stays below that
    EXPECT_LE(distance(at(Radau{3}, 640), reference).X, 1e-9);   // what it does, it follows
    // With two elements there is a root of the equations that is none: it is refused, and divided.
    EXPECT_GT(distance(at(Radau{3}, 2), reference).X, 1e-2);
    const Solution divided = solve_radau(model, 1, 2, 3);
    EXPECT_GT(divided.report.divided, 0);
    tell("hook, 40 elements, m", distance(at(Radau{3}, 40), reference).X);
    tell("hook, 2 elements, some divided, m", distance(last(divided), reference).X);
    tell("of which it says, m", model.length() * divided.estimate.largest);
    EXPECT_LE(distance(last(divided), reference).X, 2e-4);
    EXPECT_LE(distance(last(divided), reference).X, 3 * model.length() * divided.estimate.largest);
}

// --- the error of an element from its velocity jump

/// From states of a fine motion: the slope of log(error) over log(jump) and the median of error /
/// local_error.
struct Calibration {
    double slope = 0, median = 0;
    int n = 0;
};
Calibration calibrate(const Model& model, double end, Points points, int degree,
                      const std::vector<int>& meshes)
{
    const Method method = points == Points::radau ? Method(Radau{degree}) : Method(Lobatto{degree});
    std::vector<double> x, y, ratio;
    for (const int n : meshes) {
        const int pieces = std::max(2, 160 / n);
        const Solution fine =
            solve(model, {model.start()}, make_time_mesh(0, end, n * pieces), Lobatto{10}, undivided());
        for (int e = 0; e < n; e += std::max(1, n / 6)) {
            const State from = fine.motion.at_end(e * pieces), to = fine.motion.at_end((e + 1) * pieces);
            SolveOptions options = undivided();
            options.initial = StartPolicy::project;
            const Solution s = solve(model, {from}, TimeMesh{{from.t, to.t}}, method, options);
            if (!s.report.converged()) continue;   // too long
            const double jump = velocity_jump(model, s.motion).largest;
            const double error = distance(last(s), to).X / std::max(1.0, model.length());
            if (error < 1e-11 || jump > 0.3) continue;
            x.push_back(std::log(jump));
            y.push_back(std::log(error));
            ratio.push_back(error / local_error(points, degree, jump));
        }
    }
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const double m = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i];
    }
    if (x.size() < 8) return {};
    std::ranges::sort(ratio);
    return {(m * sxy - sx * sy) / (m * sxx - sx * sx), ratio[ratio.size() / 2], static_cast<int>(x.size())};
}

/// Mechanisms that calibrated nothing: a brick on a spring, which slides and swings, and beads on rods.
std::vector<Model> unseen_mechanisms()
{
    Model slider({0, 0, -9.81});
    const int body = slider.add_body(rigid_body("brick", brick({}), {{0.2, 0, 0}}));
    slider.add_load(spring_damper("spring", world, {0, 0, 0.5}, body, {0, 0, 0}, {60, 0.4, 0.4}));
    Model chain({0, 0, -9.81});
    for (int i = 0; i < 3; ++i) {
        chain.add_body(point_mass("bead " + std::to_string(i), 1 + i, {i + 1.0, 0, 0}));
        chain.add_joint(rod("rod " + std::to_string(i), i == 0 ? world : i - 1, i, {}, 1));
    }
    return {slider, chain};
}

/// `most`: of the median by C_p.
void check_calibration(const Model& model, Points points, int degree, const std::vector<int>& meshes,
                       double most)
{
    SCOPED_TRACE(degree);
    const double q = (2.0 * degree + (points == Points::radau ? 0 : 1)) / (degree + 1);
    const Calibration c = calibrate(model, points == Points::radau ? 1 : 2, points, degree, meshes);
    tell("degree " + std::to_string(degree) + ", exponent by the expected one", c.slope / q);
    tell("degree " + std::to_string(degree) + ", median of error by C_p J^q", c.median);
    EXPECT_GE(c.n, 8);
    EXPECT_NEAR(c.slope / q, 1, 0.26);
    EXPECT_GE(c.median, 1.0 / 5);
    EXPECT_LE(c.median, most);
}

TEST(Radau, TellsTheErrorOfAnElementByItsVelocityJump)
{
    std::vector<Model> models{free_box(), two_bricks(), hinged_links(), four_bar()};
    for (const Model& unseen : unseen_mechanisms()) models.push_back(unseen);
    for (const Model& model : models)
        for (const int degree : {2, 3, 4})
            check_calibration(model, Points::radau, degree, {5, 7, 10, 14, 20, 28, 40}, 5);
}

/// The part that moves fastest may be a small one, with a small jump and all of its error: C_p is exceeded by
/// far more on beads, whose light end cracks like a whip, than on what calibrated it.
TEST(Lobatto, TellsTheErrorOfAnElementByItsVelocityJump)
{
    for (const Model& model : unseen_mechanisms()) {
        for (const int degree : {2, 4})
            check_calibration(model, Points::lobatto, degree, {5, 7, 10, 14, 20, 28, 40}, 20);
        check_calibration(model, Points::lobatto, 8, {1, 2, 3, 4, 5, 6, 7, 8}, 40);
    }
}

}   // namespace
}   // namespace livens::tests::radau_test
