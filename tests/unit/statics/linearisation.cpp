// SPDX-License-Identifier: BSD-3-Clause
// Linearised equations against differences of accelerations, which no tangent enters, and against closed
// forms.
#include "livens/statics/linearisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/statics/equilibrium.h"
#include "livens/statics/small_motions.h"

namespace livens::linearisation_test {
namespace {

/// Row by row; tests see no other matrices.
double at(const std::vector<double>& A, int n, int i, int j)
{
    return A[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)];
}

/// Twists [dphi, w] of all bodies when coordinate k goes by one.
std::vector<Vector3> twists(const Linearisation& l, int k)
{
    std::vector<Vector3> out(2 * l.state.X.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        for (int c = 0; c < 3; ++c) out[i][c] = at(l.twists, l.n, static_cast<int>(3 * i) + c, k);
    return out;
}

/// Accelerations of all bodies, as the equations of motion have them.
std::vector<Vector3> accelerations(const Model& model, const State& state)
{
    const PreparedState at(model, state, Side::right, true);
    std::vector<Vector3> out;
    for (const auto& body : at.tables.bodies)
        for (int part = 0; part < 6; part += 3) {
            const double* a = at.state.acceleration[1].data() + body.first + part;
            out.push_back(part < body.dofs ? Vector3{a[0], a[1], a[2]} : Vector3{});
        }
    return out;
}

/// Along the coordinate: the joints are closed again, which moves in second order.
State moved(const Linearisation& l, int k, double step)
{
    State s = l.state;
    const std::vector<Vector3> t = twists(l, k);
    for (std::size_t b = 0; b < s.X.size(); ++b) {
        if (norm(directors(s.X[b])) == 0)
            s.X[b].set_column(0, s.X[b].column(0) + step * t[2 * b]);
        else
            s.X[b] = twist::moved(s.X[b], step * t[2 * b], step * t[2 * b + 1]);
    }
    return s;
}

State moving(const Linearisation& l, int k, double speed)
{
    State s = l.state;
    const std::vector<Vector3> t = twists(l, k);
    for (std::size_t b = 0; b < s.X.size(); ++b)
        s.V[b] = rate(s.X[b], speed * t[2 * b], speed * t[2 * b + 1]);
    return s;
}

/// The largest difference of q'' = -K q - C q' (M = 1) from differences of accelerations, over the largest K
/// or C.
double error_of(const Model& model, const Linearisation& l, const std::vector<double>& A, auto&& displaced,
                double step)
{
    double worst = 0, largest = 0;
    for (int k = 0; k < l.n; ++k) {
        const auto plus = accelerations(model, displaced(l, k, step)),
                   minus = accelerations(model, displaced(l, k, -step));
        std::vector<Vector3> foretold(plus.size(), Vector3{});
        for (int i = 0; i < l.n; ++i) {
            largest = std::max(largest, std::abs(at(A, l.n, i, k)));
            const auto t = twists(l, i);
            for (std::size_t p = 0; p < t.size(); ++p) foretold[p] -= at(A, l.n, i, k) * t[p];
        }
        for (std::size_t p = 0; p < plus.size(); ++p)
            worst = std::max(worst, norm((0.5 / step) * (plus[p] - minus[p]) - foretold[p]));
    }
    return worst / largest;
}

/// Two bricks on a ball joint and a skew hinge, springs, dampers, a force that turns with the lower one.
Model bricks(double follower)
{
    Model model({0.3, 0, -9.81});
    const MassProperties brick = with_center(with_mass(box(1, {1, 0.3, 0.2}), 2), {0.5, 0.02, -0.03});
    const Matrix3 tilted = directors_from_rotation_vector({0.2, 0.9, -0.3});
    const int upper = model.add_body(rigid_body("upper", brick, {{0, 0, 0}, tilted}));
    const Vector3 knee = tilted * Vector3{1, 0, 0};
    const Matrix3 across = directors_from_rotation_vector({-0.4, 0.3, 1.1});
    const int lower = model.add_body(rigid_body("lower", brick, {knee, across}));
    model.add_joint(spherical("shoulder", world, upper, {}));
    model.add_joint(
        revolute("elbow", upper, lower,
                 joint_frame(model.bodies()[upper].X, model.bodies()[lower].X, knee, {0.3, 1, 0.2})));
    const int bob = model.add_body(point_mass("bob", 0.7, knee + Vector3{0.4, 0.1, -0.6}));
    model.add_joint(rod("string", lower, bob, {}, 1));
    model.add_load(spring_damper("stay", world, {2, 1, 1}, upper, {0.5, 0.1, 0}, {30, 2, 0.7}));
    model.add_load(spring_damper("tie", upper, {0.2, 0, 0.1}, lower, {0.9, 0, 0}, {50, 1, 0.5}));
    model.add_load(spring_damper("line", world, {0, -2, 0}, bob, {}, {20, 3, 1}));
    if (follower > 0)
        model.add_load(point_force("thruster", lower, {1, 0.1, 0}, {0.2 * follower, follower, -follower},
                                   Frame::body_fixed));
    return model;
}

TEST(Linearisation, IsThatOfDifferencesOfAccelerations)
{
    for (const double follower : {0.0, 1.5}) {
        const Model model = bricks(follower);
        const Equilibrium e = find_equilibrium(model, model.start());
        ASSERT_TRUE(e.is_found) << e.message;
        const Linearisation l = linearise(model, e.state);
        ASSERT_EQ(l.n, 6);
        EXPECT_EQ(l.is_conservative, follower == 0);
        for (int i = 0; i < l.n; ++i)
            for (int j = 0; j < l.n; ++j) EXPECT_NEAR(at(l.M, l.n, i, j), i == j, 1e-12);
        EXPECT_LT(error_of(model, l, l.K, moved, 2e-5), 2e-8) << follower;
        EXPECT_LT(error_of(model, l, l.C, moving, 1e-3), 2e-8) << follower;

        Linearisation wrong = l;   // control: one entry off by a thousandth of the largest
        wrong.K[1] += 1e-3 * *std::ranges::max_element(l.K);
        EXPECT_GT(error_of(model, wrong, wrong.K, moved, 1e-4), 1e-4);
    }
}

/// Rows that are no quadratic forms have a stiffness, too: an eccentric nut on a tilted screw, on a spring.
TEST(Linearisation, OfAScrewIsThatOfDifferencesOfAccelerations)
{
    Model model({2, 0, -9.81});
    const Vector3 axis{0.3, 0.2, 1};
    model.add_body(rigid_body("nut", with_center(with_mass(box(1, {0.3, 0.2, 0.1}), 2), {0.2, 0.1, 0})));
    const Matrix34 X = model.bodies()[0].X;
    const double pitch = 0.4;
    model.add_joint(screw("thread", world, 0, joint_frame(world_configuration, X, {}, axis),
                          world_configuration, X, pitch));
    model.add_load(spring_damper("spring", world, {0, 0, 2}, 0, {0.2, 0, 0}, {25, 3, 1}));
    const Equilibrium e = find_equilibrium(model, model.start());
    ASSERT_TRUE(e.is_found) << e.message;
    EXPECT_GT(norm(e.state.X[0].column(1) - X.column(1)), 0.1);   // it has turned
    const Linearisation l = linearise(model, e.state);
    ASSERT_EQ(l.n, 1);
    EXPECT_LT(error_of(model, l, l.K, moved, 2e-5), 2e-8);
    EXPECT_LT(error_of(model, l, l.C, moving, 1e-3), 2e-8);
    const auto mode = vibration_modes(l).front();
    const Joint& thread = model.joints()[0];
    const auto angle = amplitude(l, mode, find_coordinate(thread, "angle")->coordinate),
               along = amplitude(l, mode, find_coordinate(thread, "displacement")->coordinate);
    EXPECT_NEAR(std::abs(along / angle - pitch / (2 * std::numbers::pi)), 0, 1e-12);
}

TEST(Linearisation, OfAFollowerForceIsNotSymmetric)
{
    const Model model = bricks(1.5);
    const Linearisation l = linearise(model, find_equilibrium(model, model.start()).state);
    double skew = 0, largest = 0;
    for (int i = 0; i < l.n; ++i)
        for (int j = 0; j < l.n; ++j) {
            skew = std::max(skew, std::abs(at(l.K, l.n, i, j) - at(l.K, l.n, j, i)));
            largest = std::max(largest, std::abs(at(l.K, l.n, i, j)));
        }
    EXPECT_GT(skew, 1e-3 * largest);
}

/// Without inertia about its axis, which the hinge holds: the mass metric is singular, the modes are not.
TEST(VibrationModes, OfANeedle)
{
    Model model({0, 0, -9.81});
    const Matrix3 J{0.1, 0, 0, 0, 0.1, 0, 0, 0, 0};
    model.add_body(rigid_body("needle", {2, {0, 0, -0.5}, J}));
    model.add_joint(revolute("pivot", world, 0,
                             joint_frame(world_configuration, model.bodies()[0].X, {}, {0, 1, 0})));
    const auto modes = vibration_modes(linearise(model, model.start()));
    ASSERT_EQ(modes.size(), 1u);
    EXPECT_NEAR(modes[0].frequency(), std::sqrt(2 * 9.81 * 0.5 / (0.1 + 0.5)), 1e-13);
}

/// m q'' + c q' + k q: a complex pair, overdamped roots, and the critical case beside them.
TEST(VibrationModes, OfADampedOscillator)
{
    for (const double zeta : {0.1, 0.6, 3.0}) {
        const double m = 2, k = 50, w = 5, c = 2 * zeta * w * m;
        Model model;
        model.add_body(point_mass("mass", m, {1, 0, 0}));
        model.add_joint(point_on_line(
            "rail", world, 0, joint_frame(world_configuration, model.bodies()[0].X, {1, 0, 0}, {1, 0, 0})));
        model.add_load(spring_damper("spring", world, {0, 0, 0}, 0, {}, {k, c, 1}));
        const auto modes = vibration_modes(linearise(model, model.start()));
        if (zeta < 1) {
            ASSERT_EQ(modes.size(), 1u);
            EXPECT_NEAR(modes[0].frequency(), w, 1e-13);
            EXPECT_NEAR(modes[0].damping_ratio(), zeta, 1e-14);
            EXPECT_NEAR(modes[0].s.imag(), w * std::sqrt(1 - zeta * zeta), 1e-13);
        } else {
            ASSERT_EQ(modes.size(), 2u);
            const double root = std::sqrt(zeta * zeta - 1);
            EXPECT_NEAR(modes[0].s.real(), -w * (zeta - root), 1e-12);
            EXPECT_NEAR(modes[1].s.real(), -w * (zeta + root), 1e-12);
            EXPECT_EQ(modes[0].s.imag(), 0);
        }
        EXPECT_EQ(stability(linearise(model, model.start())).stability, Stability::stable);
    }
}

/// Ziegler's column: two rods of equal length and torsion springs under a force along the last rod. It has
/// one equilibrium, straight, which no stiffness alone can judge: it flutters beyond P l / k = 7/2 - sqrt 2,
/// with masses 2 m at the knee and m at the tip.
TEST(Stability, OfZieglersColumnIsLostByFlutter)
{
    const double l = 1, k = 10, critical = 3.5 - std::sqrt(2.0);
    for (const double P : {0.99 * critical * k, 1.01 * critical * k}) {
        Model model;
        const auto body = [&](const char* name, double mass, double x) {
            MassProperties p = with_mass(box(1, {1e-5, 1e-5, 1e-5}), mass);
            return model.add_body(rigid_body(name, with_center(p, {l, 0, 0}), {{x, 0, 0}}));
        };
        const int lower = body("lower", 2, 0), upper = body("upper", 1, l);
        const auto X = [&] { return model.start().X; };
        model.add_joint(revolute("base", world, lower, {}));
        JointFrame knee;
        knee.point_first = {l, 0, 0};
        model.add_joint(revolute("knee", lower, upper, knee));
        for (const char* joint : {"base", "knee"}) {
            const Joint& j = model.joints()[model.find_joint(joint)];
            model.add_load(joint_spring(std::string(joint) + " spring", *find_coordinate(j, "angle"),
                                        {k, 0, 0}, X()));
        }
        model.add_load(point_force("thrust", upper, {l, 0, 0}, {-P, 0, 0}, Frame::body_fixed));
        const Linearisation linear = linearise(model, model.start());
        EXPECT_FALSE(linear.is_conservative);
        const StabilityReport report = stability(linear);
        EXPECT_EQ(report.stability, P < critical * k ? Stability::stable : Stability::unstable) << P;
        EXPECT_EQ(report.n_unstable, P < critical * k ? 0 : 2);
    }
}

TEST(Stability, OfAFreeBodyIsNeutralInAllDirections)
{
    Model model;
    model.add_body(rigid_body("box", box(1, {1, 2, 3})));
    const Linearisation l = linearise(model, model.start());
    EXPECT_EQ(stability(l).n_neutral, 6);
    for (const VibrationMode& mode : vibration_modes(l)) EXPECT_EQ(mode.frequency(), 0);
}

/// A damper where nothing restores: one root is zero, the other is not.
TEST(VibrationModes, OfAWheelOnADamperAloneIsOneThatStaysAndOneThatDies)
{
    Model model;
    const int wheel = model.add_body(rigid_body("wheel", {2, {}, 3.0 * identity<3>()}));
    model.add_joint(revolute("axle", world, wheel, {}));
    const Joint& axle = model.joints()[0];
    model.add_load(
        joint_spring("friction", *find_coordinate(axle, "angle"), {0, 6, 0}, model.start().X));
    const Linearisation l = linearise(model, model.start());
    const auto modes = vibration_modes(l);
    ASSERT_EQ(modes.size(), 2u);
    EXPECT_EQ(modes[0].s, 0.0);
    EXPECT_NEAR(modes[1].s.real(), -6.0 / 3.0, 1e-14);
    EXPECT_NEAR(std::abs(modes[1].bodies[0].rotation[2]), 1, 1e-14);
    EXPECT_EQ(stability(l).stability, Stability::neutral);
}

std::string code_of(auto&& act)
{
    try {
        act();
    } catch (const InputError& error) {
        return error.complaint().code;
    }
    return "";
}

TEST(Linearisation, RefusesWhatMovesAndWhatWouldBeginTo)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {0, 0, -1}, {0.1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    EXPECT_EQ(code_of([&] { linearise(model, model.start()); }), "not-at-rest");
    State state = model.start();
    state.V[0] = {};
    EXPECT_EQ(code_of([&] { linearise(model, state); }), "");
    state.X[0] = configuration({0.1, 0, -std::sqrt(0.99)}, Matrix3{});
    EXPECT_EQ(code_of([&] { linearise(model, state); }), "not-in-equilibrium");
}

/// A pendulum: x' = A x + B u with u a torque at the pivot or a force at the tip.
TEST(StateMatrices, OfAPendulum)
{
    Model model({0, 0, -9.81});
    const MassProperties rod = with_center(with_mass(box(1, {0.1, 0.1, 1}), 2), {0, 0, 0.5});
    const int body = model.add_body(rigid_body("rod", rod, {{0, 0, -1}}));   // reference point: the tip
    model.add_joint(revolute("pivot", world, body,
                             joint_frame(world_configuration, model.bodies()[body].X, {}, {0, 1, 0})));
    const double J = 2 * (1 + 0.01) / 12 + 2 * 0.25, k = 2 * 9.81 * 0.5;
    const Linearisation l = linearise(model, model.start());
    const StateMatrices s = state_matrices(model, l, {"pivot.angle", "rod.x"},
                                           {"pivot.angle", "pivot.angle_rate", "rod.x", "rod.z"});
    ASSERT_EQ(s.n_states, 2);
    EXPECT_NEAR(s.A[2], -k / J, 1e-13);
    EXPECT_EQ(s.D, std::vector<double>(8, 0.0));
    const double scale = s.C[0];   // angle by q
    EXPECT_NEAR(std::abs(scale), 1 / std::sqrt(J), 1e-14);
    EXPECT_NEAR(scale * s.B[2], 1 / J, 1e-14);    // angle'' by the torque
    EXPECT_NEAR(scale * s.B[3], -1 / J, 1e-14);   // and by a force at the tip: x = - angle there
    EXPECT_NEAR(s.C[3], scale, 1e-15);            // the rate by q'
    EXPECT_NEAR(s.C[4], -scale, 1e-14);
    EXPECT_NEAR(s.C[6], 0, 1e-14);
    const auto ask = [&](const std::string& in, const std::string& out) {
        return code_of([&] { state_matrices(model, l, {in}, {out}); });
    };
    EXPECT_EQ(ask("rod.x", "rod.z_rate"), "");
    for (const char* wrong : {"pivot", "pivot.displacement", "nobody.x", "nojoint.angle", "rod.w", "world.x"})
        EXPECT_EQ(ask("rod.x", wrong), "no-such-port") << wrong;
    EXPECT_EQ(ask("rod.x_rate", "rod.x"), "no-such-port");
}

}   // namespace
}   // namespace livens::linearisation_test
