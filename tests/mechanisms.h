// SPDX-License-Identifier: BSD-3-Clause
// The mechanisms that the proofs of the engine run on, built by hand. The shipped examples say the same in
// TOML.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::tests {

/// How a mechanism is described: turned about the world's origin (gravity too), and in which unit of length.
struct Setting {
    Matrix3 turn = identity<3>();
    double metre = 1;   ///< one metre in the unit of length: 1000 for millimetres
};

inline Placement placed(const Setting& setting, const Vector3& position, const Matrix3& axes = identity<3>())
{
    return {setting.metre * (setting.turn * position), setting.turn * axes, {}, {}};
}

/// A brick of 1 kg and 1 x 0.2 x 0.1 m, its reference point at one end of its long axis d1.
inline MassProperties brick(const Setting& setting)
{
    const double m = setting.metre;
    return with_center(with_mass(box(1, {m, 0.2 * m, 0.1 * m}), 1), {0.5 * m, 0, 0});
}

/// Two bricks on ball joints, the second across the first, at rest (docs/examples.md, the benchmark P16).
inline Model two_bricks(const Setting& setting = {})
{
    const double m = setting.metre;
    const Matrix3 across{0, 1, 0, -1, 0, 0, 0, 0, 1};
    Model model(setting.turn * Vector3{0, 0, -9.81 * m});
    const int upper = model.add_body(rigid_body("upper", brick(setting), placed(setting, {0, 0, 0})));
    const int lower = model.add_body(rigid_body("lower", brick(setting), placed(setting, {1, 0, 0}, across)));
    model.add_joint(spherical("shoulder", world, upper, {}, m));
    JointFrame elbow;
    elbow.point_first = {m, 0, 0};
    model.add_joint(spherical("elbow", upper, lower, elbow, m));
    return model;
}

/// A chain of bricks on ball joints, stretched out, at rest.
inline Model hanging_bricks(int n)
{
    Model model({0, 0, -9.81});
    for (int b = 0; b < n; ++b) {
        const std::string number = std::to_string(b);
        model.add_body(rigid_body("brick " + number, brick({}), placed({}, {1.0 * b, 0, 0})));
        JointFrame ball;
        if (b > 0) ball.point_first = {1, 0, 0};
        model.add_joint(spherical("ball " + number, b > 0 ? b - 1 : world, b, ball));
    }
    return model;
}

/// End of brick `body`, where the next one hangs.
inline Vector3 tip(const State& state, int body, double metre = 1)
{
    return state.X[body] * point({metre, 0, 0});
}

/// A box of 2 x 1 x 1 m and 3 kg, at rest or in flight, under a torque of 2 N m along (1, 1, 1).
inline Model free_box(const Vector3& velocity = {})
{
    const double mu = 2 / std::sqrt(3.0);
    Model model;
    const int body =
        model.add_body(rigid_body("box", box(1.5, {2, 1, 1}), {{}, identity<3>(), velocity, {}}));
    model.add_load(torque("motor", body, {mu, mu, mu}, Frame::inertial));
    return model;
}

/// Two links on parallel hinges, released from the horizontal (P14).
inline Model hinged_links()
{
    const MassProperties link{1, {0.5, 0, 0}, identity<3>()};
    Model model({0, -10, 0});
    const int upper = model.add_body(rigid_body("upper", link));
    const int lower = model.add_body(rigid_body("lower", link, {{1, 0, 0}}));
    model.add_joint(revolute("shoulder", world, upper, {}));
    JointFrame elbow;
    elbow.point_first = {1, 0, 0};
    model.add_joint(revolute("elbow", upper, lower, elbow));
    return model;
}

/// The paper's double pendulum in the plane y = 0: cubes on rods of 4 m, the lower one hinged `offset` from
/// its centre.
inline Model cubes_on_rods(double offset)
{
    const double c = 4 / std::sqrt(2.0);
    Model model({0, 0, -9.81});
    const int upper = model.add_body(rigid_body("upper", box(1.5, {1, 1, 1}), {{c, 0, c}}));
    const MassProperties small = with_center(box(1.5, {0.8, 0.8, 0.8}), {offset, 0, 0});
    const int lower = model.add_body(rigid_body("lower", small, {{2 * c, 0, 2 * c}}));
    model.add_joint(rod("upper rod", world, upper, {}, 4));
    model.add_joint(rod("lower rod", upper, lower, {}, 4));
    return model;
}

/// The fast heavy top of Simo and Wong on its tip (P07).
inline Model heavy_top()
{
    Placement tilted;
    tilted.directors = directors_from_rotation_vector({0.05, 0, 0});
    tilted.angular_velocity = tilted.directors * Vector3{0, 0, 50};
    Model model({0, 0, -1});
    const int top = model.add_body(rigid_body("top", {100, {0, 0, 0.2}, identity<3>()}, tilted));
    model.add_joint(spherical("tip", world, top, {}));
    return model;
}

/// A planar loop of four hinges in space: 20 rows of rank 17.
inline Model four_bar()
{
    auto bar = [](double length) {
        return with_center(box(7850, {length, 0.04, 0.02}), {0.5 * length, 0, 0});
    };
    auto along = [](double x, double z) { return Matrix3{x, 0, z, 0, 1, 0, -z, 0, x}; };
    Model model({0, 0, -9.81});
    const int crank = model.add_body(rigid_body("crank", bar(0.42), {{0, 0, 0}, along(0, 1)}));
    const int coupler = model.add_body(rigid_body("coupler", bar(0.9), {{0, 0, 0.42}, along(0.8, 0.6)}));
    const int rocker = model.add_body(rigid_body("rocker", bar(1), {{1, 0, 0}, along(-0.28, 0.96)}));
    auto hinge = [&](const std::string& name, int first, int second, const Vector3& at) {
        const Matrix34 x = first == world ? world_configuration : model.bodies()[first].X;
        model.add_joint(
            revolute(name, first, second, joint_frame(x, model.bodies()[second].X, at, {0, 1, 0})));
    };
    hinge("crank shaft", world, crank, {0, 0, 0});
    hinge("crank pin", crank, coupler, {0, 0, 0.42});
    hinge("rocker pin", coupler, rocker, {0.72, 0, 0.96});
    hinge("rocker shaft", world, rocker, {1, 0, 0});
    return model;
}

/// Joints and loads of many kinds: a brick on a universal joint, a second welded at an angle to it, a point
/// mass on a rod, a spring with damper, a torque in body axes that varies in time.
inline Model medley()
{
    Model model({0, 0, -9.81});
    const Setting si;
    const int first = model.add_body(rigid_body("first", brick(si)));
    const int second =
        model.add_body(rigid_body("second", brick(si), placed(si, {1, 0, 0}, {0, 1, 0, -1, 0, 0, 0, 0, 1})));
    const int bob = model.add_body(point_mass("bob", 0.3, {1, 1, -0.5}));
    JointFrame gimbal;
    gimbal.axis_first = {0, 1, 0};
    model.add_joint(universal("gimbal", world, first, gimbal));
    JointFrame seat;
    seat.point_first = {1, 0, 0};
    model.add_joint(weld("seat", first, second, seat, model.bodies()[first].X, model.bodies()[second].X));
    JointFrame eye;
    eye.point_first = {1, 0, 0};
    model.add_joint(rod("string", second, bob, eye, 0.5));
    model.add_load(spring_damper("strut", world, {0, 0, 1}, second, {0.5, 0, 0}, {40, 1.5, 0.7}));
    const TimeFunction wave = spline_table({0, 1, 2, 3}, {1, -2, 3, 0});   // one cubic
    model.add_load(torque("motor", second, {wave, 2, 0.5}, Frame::body_fixed));
    return model;
}

/// Solves with `n` equal elements, as exactly as Newton can; the test fails if that does not converge.
inline Solution solve_evenly(const Model& model, double end, int n, int degree)
{
    SolveOptions options;
    options.estimate = SolveOptions::Estimate::none;
    options.divide = false;
    Solution solution = solve(model, {model.start()}, make_time_mesh(0, end, n), Lobatto{degree}, options);
    EXPECT_TRUE(solution.report.converged()) << solution.report.message;
    return solution;
}

/// Largest entry of a difference: positions (m, 1) and velocities (m/s, 1/s) of all bodies.
struct Distance {
    double X = 0;
    double V = 0;
};
inline Distance distance(const State& l, const State& r)
{
    Distance d;
    for (std::size_t b = 0; b < l.X.size(); ++b) {
        for (int i = 0; i < 12; ++i) {
            d.X = std::max(d.X, std::abs(l.X[b].a[i] - r.X[b].a[i]));
            d.V = std::max(d.V, std::abs(l.V[b].a[i] - r.V[b].a[i]));
        }
    }
    return d;
}

inline State last(const Solution& solution) { return solution.motion.at_end(solution.motion.n_elements()); }

}   // namespace livens::tests
