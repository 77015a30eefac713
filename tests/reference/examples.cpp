// SPDX-License-Identifier: BSD-3-Clause
// Every example that has a published or recomputed motion meets it, as shipped, at all listed times.
//
// Tolerances are largest differences of a coordinate, in the unit of the quantity. Numbers in benchmarks.json
// carry 12 decimals unless they carry more, so nothing tighter than 1e-11 can be asked of them.
#include <numbers>

#include "livens/diagnostics/diagnostics.h"
#include "reference/shipped.h"

namespace livens::tests::examples_test {
namespace {

void expect_box(const Shipped& s, const nlohmann::json& rows, double tolerance)
{
    for (const auto& row : rows) {
        const double t = row.at("t");
        const State state = s.at(t);
        EXPECT_LE(largest_difference(state.X[0].column(0), vector3(row.at("position"))), tolerance)
            << "t = " << t;
        EXPECT_LE(largest_difference(directors(state.X[0]), triad(row.at("directors"))), tolerance)
            << "t = " << t;
        // the directors' part: the centre of mass is the reference point
        const Matrix34 P = s.solution.motion.momenta[s.end_at(t)];
        Vector3 spin{};
        for (int c = 1; c < 4; ++c) spin += cross(state.X[0].column(c), P.column(c));
        EXPECT_LE(largest_difference(spin, vector3(row.at("angular_momentum_about_centre"))), tolerance)
            << "t = " << t;
    }
}

TEST(Example, FreeBoxMeetsDOP853)
{
    expect_box(solve_example("free_box"), data("reference").at("free_box_constant_torque"), 1e-11);
}

TEST(Example, RectangularTorqueMeetsDOP853AndThePaper)
{
    const Shipped s = solve_example("rectangular_torque");
    expect_box(s, data("reference").at("free_box_rectangular_torque"), 1e-10);
    // Hesch, Glas and Schuss, section 4.1, printed with three decimals
    const Matrix3 printed{0.392, -0.271, 0.879, -0.233, -0.954, -0.190, 0.890, -0.131, -0.437};
    EXPECT_LE(largest_difference(directors(s.at(4).X[0]), printed), 0.0005);
}

void expect_planar_pendulum(const Shipped& s, const nlohmann::json& rows)
{
    for (const auto& row : rows) {
        const double t = row.at("t");
        const State state = s.at(t);
        const Matrix34 upper = state.X[s.body("upper")], lower = state.X[s.body("lower")];
        const Matrix34 upper_rate = state.V[s.body("upper")], lower_rate = state.V[s.body("lower")];
        EXPECT_LE(largest_difference(upper.column(0), vector3(row.at("position_1"))), 1e-8) << "t = " << t;
        EXPECT_LE(largest_difference(lower.column(0), vector3(row.at("reference_point_2"))), 1e-8)
            << "t = " << t;
        EXPECT_LE(largest_difference(lower.column(1), vector3(row.at("d1_of_body_2"))), 1e-8) << "t = " << t;
        EXPECT_LE(largest_difference(upper_rate.column(0), vector3(row.at("velocity_1"))), 1e-7)
            << "t = " << t;
        EXPECT_LE(largest_difference(lower_rate.column(0), vector3(row.at("velocity_of_reference_point_2"))),
                  1e-7)
            << "t = " << t;
    }
}

TEST(Example, CentredDoublePendulumMeetsMinimalCoordinatesToTenSeconds)
{
    expect_planar_pendulum(solve_example("double_pendulum_centred"),
                           data("reference").at("double_pendulum_centred"));
}

TEST(Example, OffsetDoublePendulumMeetsMinimalCoordinatesToFiveSeconds)
{
    expect_planar_pendulum(solve_example("double_pendulum_offset"),
                           data("reference").at("double_pendulum_offset"));
}

TEST(Example, SpatialDoublePendulumMeetsPointMassesToFiveSeconds)
{
    const Shipped s = solve_example("double_pendulum_spatial");
    const nlohmann::json all = data("reference");
    for (const auto& row : all.at("double_pendulum_spatial")) {
        const double t = row.at("t");
        const State state = s.at(t);
        EXPECT_LE(largest_difference(state.X[0].column(0), vector3(row.at("position_1"))), 1e-8)
            << "t = " << t;
        EXPECT_LE(largest_difference(state.X[1].column(0), vector3(row.at("position_2"))), 1e-8)
            << "t = " << t;
        EXPECT_LE(largest_difference(state.V[0].column(0), vector3(row.at("velocity_1"))), 1e-7)
            << "t = " << t;
        EXPECT_LE(largest_difference(state.V[1].column(0), vector3(row.at("velocity_2"))), 1e-7)
            << "t = " << t;
        // no rod has a moment about a centre: cubes of equal moments keep their spin
        for (int b = 0; b < 2; ++b)
            EXPECT_LE(largest_difference(angular_velocity(state.X[b], state.V[b]), {-1, 0, 0}), 1e-8)
                << "t = " << t;
    }
}

TEST(Example, TorqueFreeTopMeetsJacobiFunctionsToTwentySeconds)
{
    const Shipped s = solve_example("torque_free_top");
    const nlohmann::json all = data("reference");
    for (const auto& row : all.at("torque_free_top").at("rows")) {
        const double t = row.at("t");
        EXPECT_LE(largest_difference(body_spin(s.at(t), 0), vector3(row.at("angular_velocity_in_body_axes"))),
                  1e-10)
            << "t = " << t;
    }
}

/// The two quaternions of one orientation differ in sign.
double distance_of_turns(const Vector4& l, const Vector4& r)
{
    return std::min(largest_difference(l, r), largest_difference(l, -r));
}

Vector4 quaternion(const nlohmann::json& j) { return {j.at(0), j.at(1), j.at(2), j.at(3)}; }

// Every turn over starts next to a saddle: the small spins differ there by 1e-3 of the energy from a motion
// that never turns over, so an error of energy or momentum of 1e-15 comes back as 1e-11 rad/s in the next.
// It takes momenta that balance to the last bit and increments that are added up without rounding.
double allowed_for_dzhanibekov(double t) { return t <= 10 ? 1e-11 : 1e-9; }

TEST(Example, DzhanibekovMeetsJacobiFunctionsToFiftySeconds)
{
    const Shipped s = solve_example("dzhanibekov");
    const nlohmann::json all = data("benchmarks"), p08 = all.at("P08");
    for (std::size_t i = 0; i < p08.at("times").size(); ++i) {
        const double t = p08.at("times").at(i);
        EXPECT_LE(largest_difference(body_spin(s.at(t), 0), vector3(p08.at("angular_velocity_body").at(i))),
                  allowed_for_dzhanibekov(t))
            << "t = " << t;
    }
    for (std::size_t i = 0; i < p08.at("quaternion_times").size(); ++i) {
        const double t = p08.at("quaternion_times").at(i);
        const Vector4 q = quaternion_from_directors(directors(s.at(t).X[0]));
        EXPECT_LE(distance_of_turns(q, quaternion(p08.at("quaternion").at(i))), allowed_for_dzhanibekov(t))
            << "t = " << t;
    }
}

TEST(Example, LagrangeTopMeetsDOP853)
{
    const Shipped s = solve_example("lagrange_top");
    const nlohmann::json all = data("benchmarks"), p07 = all.at("P07");
    for (std::size_t i = 0; i < p07.at("times").size(); ++i) {
        const double t = p07.at("times").at(i);
        EXPECT_LE(largest_difference(s.at(t).X[0].column(3), vector3(p07.at("axis_3").at(i))), 1e-9)
            << "t = " << t;
    }
    EXPECT_LE(largest_difference(body_spin(s.at(10), 0), vector3(p07.at("angular_velocity_body_at_10"))),
              1e-9);
    const Balance b = balance(s.model, s.solution.motion);
    const double energy = p07.at("energy");
    // heights are measured from the tip, where the published energy has them too
    for (double e : b.energy) EXPECT_NEAR(e, energy, 1e-9 * energy);
    for (const Vector3& l : b.angular_momentum) EXPECT_NEAR(l[2], b.angular_momentum[0][2], 1e-9 * 50);
}

TEST(Example, RevoluteDoublePendulumMeetsDOP853)
{
    const Shipped s = solve_example("revolute_double_pendulum");
    const nlohmann::json all = data("benchmarks"), p14 = all.at("P14");
    const int lower = s.body("lower");
    for (std::size_t i = 0; i < p14.at("times").size(); ++i) {
        const double t = p14.at("times").at(i);
        const Vector3 center = s.at(t).X[lower] * point({0.5, 0, 0});
        EXPECT_LE(largest_difference(center, vector3(p14.at("center_of_mass_2").at(i))), 1e-9) << "t = " << t;
    }
    for (std::size_t i = 0; i < p14.at("velocity_times").size(); ++i) {
        const double t = p14.at("velocity_times").at(i);
        const Vector3 rate = s.at(t).V[lower] * point({0.5, 0, 0});
        EXPECT_LE(largest_difference(rate, vector3(p14.at("center_of_mass_velocity_2").at(i))), 1e-9)
            << "t = " << t;
    }
}

TEST(Example, TwoBallJointedBricksMeetTwoOtherCodes)
{
    const Shipped s = solve_example("ball_pendulum_two");
    const nlohmann::json all = data("benchmarks"), p16 = all.at("P16");
    for (std::size_t i = 0; i < p16.at("times").size(); ++i) {
        const double t = p16.at("times").at(i), tolerance = t <= 2 ? 1e-11 : 1e-10;
        const State state = s.at(t);
        const Vector3 P1 = state.X[s.body("upper")] * point({1, 0, 0}),
                      P2 = state.X[s.body("lower")] * point({1, 0, 0});
        EXPECT_LE(largest_difference(P1, vector3(p16.at("P1").at(i))), tolerance) << "t = " << t;
        EXPECT_LE(largest_difference(P2, vector3(p16.at("P2").at(i))), tolerance) << "t = " << t;
    }
}

TEST(Example, SimplePendulumMeetsJacobiFunctionsAndItsRodTheTension)
{
    const Shipped s = solve_example("simple_pendulum");
    const nlohmann::json all = data("benchmarks"), p01 = all.at("P01");
    for (std::size_t i = 0; i < p01.at("times").size(); ++i) {
        const double t = p01.at("times").at(i);
        const State state = s.at(t);
        EXPECT_LE(largest_difference(state.X[0].column(0), vector3(p01.at("position").at(i))), 1e-11)
            << "t = " << t;
        EXPECT_LE(largest_difference(state.V[0].column(0), vector3(p01.at("velocity").at(i))), 1e-10)
            << "t = " << t;
        // released from the horizontal: N = 3 m g cos(angle from below), at these times from the published
        // height
        const double tension = 3 * 9.81 * -vector3(p01.at("position").at(i))[1];
        const std::size_t end = static_cast<std::size_t>(s.end_at(t));
        EXPECT_NEAR(s.solution.motion.end_multipliers.at(2 * end) * 1.0, tension, 1e-9)
            << "multiplier times length";
    }
    const Motion& m = s.solution.motion;
    for (int end = 0; end <= m.n_elements(); ++end) {
        const State state = m.at_end(end);
        const Vector3 x = state.X[0].column(0);
        for (int side = 0; side < 2; ++side) {
            const double lambda = m.end_multipliers[static_cast<std::size_t>(2 * end + side)];
            const Reaction r = joint_reaction(s.model, 0, state.X, {&lambda, 1});
            ASSERT_LE(largest_difference(r.force, 3 * 9.81 * x[1] * x), 1e-9)
                << "t = " << state.t;   // towards the pivot
            ASSERT_LE(largest(r.torque), 1e-12);
        }
    }
}

TEST(Example, SpringMassMeetsTheDampedOscillation)
{
    const Shipped s = solve_example("spring_mass");
    for (int end = 0; end <= s.solution.motion.n_elements(); ++end) {
        const State state = s.solution.motion.at_end(end);
        const double t = state.t, c = std::cos(10 * t), q = std::sin(10 * t);
        EXPECT_LE(largest_difference(state.X[0].column(0), {1 + 0.2 * std::exp(-t) * (c + 0.1 * q), 0, 0}),
                  1e-11);
        EXPECT_LE(largest_difference(state.V[0].column(0), {-2.02 * std::exp(-t) * q, 0, 0}), 1e-10);
    }
}

// No published motion: the loop closes, its redundant rows are named, and with its one freedom it keeps its
// energy.
TEST(Example, FourBarClosesItsLoopWithThreeRedundantRows)
{
    const Shipped s = solve_example("four_bar");
    EXPECT_EQ(s.model.n_rows(), 20);
    EXPECT_EQ(s.solution.motion.redundant_rows.size(), 3u);
    EXPECT_LE(violations(s.model, s.solution.motion).joints_at_nodes, 1e-12);
    const Balance b = balance(s.model, s.solution.motion);
    EXPECT_LE(b.relative_energy_drift(), 1e-9);
    EXPECT_GT(b.largest_kinetic, 1);
}

// Drake's free body after Kane: closed form, built here because no example is made of it.
TEST(FreeBody, MeetsTheClosedFormOfASymmetricBody)
{
    const Vector3 w_body{2, 4, 6}, v_body{-4.2, 5.5, 6.1};
    Placement placement;
    placement.position = {1, 2, 3};
    placement.velocity = v_body;   // body axes are the world's at the start
    placement.angular_velocity = w_body;
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("body", {1, {0, 0, 0}, {0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.02}}, placement));
    SolveOptions options;
    options.tolerance = 1e-14;
    const Solution solution = solve(model, {model.start()}, make_time_mesh(0, 10, 100), Lobatto{8}, options);
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;

    const nlohmann::json all = data("benchmarks"), p09 = all.at("P09");
    const double s = 3, p = std::sqrt(4 + 16 + 9);
    for (int end = 1; end <= 100; ++end) {
        const State state = solution.motion.at_end(end);
        const double t = state.t, sp = std::sin(p * t / 2) / p, cp = std::cos(p * t / 2);
        const double ss = std::sin(s * t / 2), cs = std::cos(s * t / 2);
        const Vector4 q{-3 * sp * ss + cp * cs, sp * (2 * cs + 4 * ss), sp * (-2 * ss + 4 * cs),
                        3 * sp * cs + cp * ss};
        ASSERT_LE(distance_of_turns(quaternion_from_directors(directors(state.X[0])), q), 1e-11)
            << "t = " << t;
        const double c = std::cos(s * t), d = std::sin(s * t);
        ASSERT_LE(largest_difference(body_spin(state, 0), {2 * c + 4 * d, -2 * d + 4 * c, 6}),
                  1e-11 * norm(w_body));
        const Vector3 x = placement.position + t * v_body + Vector3{0, 0, -0.5 * 9.81 * t * t};
        ASSERT_LE(largest_difference(state.X[0].column(0), x), 1e-11 * norm(x)) << "t = " << t;
    }
    for (std::size_t i = 0; i < p09.at("times").size(); ++i) {
        const double t = p09.at("times").at(i);
        const State state = solution.motion.at_end(static_cast<int>(std::lround(10 * t)));
        const Vector4 q = quaternion_from_directors(directors(state.X[0]));
        EXPECT_LE(distance_of_turns(q, quaternion(p09.at("quaternion").at(i))), 1e-11) << "t = " << t;
        const Vector3 x = vector3(p09.at("position").at(i));
        EXPECT_LE(largest_difference(state.X[0].column(0), x), 1e-11 * norm(x)) << "t = " << t;
    }
    EXPECT_LE(largest_difference(body_spin(solution.motion.at_end(10), 0),
                                 vector3(p09.at("angular_velocity_body_at_1"))),
              1e-11 * norm(w_body));
}

}   // namespace
}   // namespace livens::tests::examples_test
