// SPDX-License-Identifier: BSD-3-Clause
// Mechanisms and small references that the tests of stepping share.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "livens/stepping/stepping.h"

namespace stepping_test {

using namespace livens;

inline MassProperties properties(double mass, const Vector3& center, const Vector3& inertia)
{
    Matrix3 J{};
    for (int i = 0; i < 3; ++i) J(i, i) = inertia[i];
    return {mass, center, J};
}

/// Torque-free, J = diag(1, 2, 2.5), spun about all axes.
inline Model free_top()
{
    Model model;
    Placement placement;
    placement.directors = directors_from_rotation_vector({0.3, -0.2, 0.5});
    placement.velocity = {1, 2, -1};
    placement.angular_velocity = {0.4, 2, 0.7};
    model.add_body(rigid_body("top", properties(3, {0, 0, 0}, {1, 2, 2.5}), placement));
    return model;
}

/// Its directors at t by Runge and Kutta on d_i' = w x d_i with constant angular momentum.
inline Matrix3 free_top_directors(double t)
{
    const Model model = free_top();
    Matrix3 D = directors(model.bodies()[0].X);
    const Vector3 J{1, 2, 2.5};
    const Vector3 w0 = transpose(D) * Vector3{0.4, 2, 0.7};
    const Vector3 L = D * Vector3{J[0] * w0[0], J[1] * w0[1], J[2] * w0[2]};
    const auto slope = [&](const Matrix3& d) {
        const Vector3 body = transpose(d) * L;
        return cross_matrix(d * Vector3{body[0] / J[0], body[1] / J[1], body[2] / J[2]}) * d;
    };
    const int n = 2000;
    const double h = t / n;
    for (int k = 0; k < n; ++k) {
        const Matrix3 a = slope(D), b = slope(D + 0.5 * h * a), c = slope(D + 0.5 * h * b),
                      e = slope(D + h * c);
        D += (h / 6) * (a + 2 * b + 2 * c + e);
    }
    return D;
}

/// Point mass 1 kg on a rod of 1 m, released horizontally (benchmark A01 of IFToMM).
inline Model simple_pendulum()
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {-1, 0, 0}));
    model.add_joint(rod("string", world, 0, {}, 1));
    return model;
}

/// A brick on a revolute about y, released horizontally: theta'' = -w2 sin(theta), theta(0) = pi / 2.
inline Model brick_pendulum()
{
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("brick", properties(2, {0.5, 0, 0}, {0.01, 0.17, 0.175})));
    const Matrix34 X = model.bodies()[0].X;
    model.add_joint(revolute("hinge", world, 0, joint_frame(world_configuration, X, {0, 0, 0}, {0, 1, 0})));
    return model;
}

struct Swing {
    double angle, rate;   ///< from the downward vertical
};
inline Swing brick_pendulum_swing(double t)
{
    const double w2 = 2 * 9.81 * 0.5 / (0.17 + 2 * 0.25);
    std::array<double, 2> y{std::acos(0.0), 0};
    const auto slope = [w2](const std::array<double, 2>& s) {
        return std::array{s[1], -w2 * std::sin(s[0])};
    };
    const auto moved = [](const std::array<double, 2>& s, double h, const std::array<double, 2>& k) {
        return std::array{s[0] + h * k[0], s[1] + h * k[1]};
    };
    const int n = 4000;
    const double h = t / n;
    for (int k = 0; k < n; ++k) {
        const auto a = slope(y), b = slope(moved(y, h / 2, a)), c = slope(moved(y, h / 2, b)),
                   e = slope(moved(y, h, c));
        for (int i = 0; i < 2; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + e[i]);
    }
    return {y[0], y[1]};
}

/// Two bricks 1 x 0.2 x 0.1 m on ball joints, released at rest: the first along x, the second along y (P16).
inline Model two_bricks(const Vector3& gravity = {0, 0, -9.81}, bool to_world = true)
{
    Model model(gravity);
    const MassProperties brick = properties(1, {0.5, 0, 0}, {0.05 / 12, 1.01 / 12, 1.04 / 12});
    model.add_body(rigid_body("one", brick));
    Placement second;
    second.position = {1, 0, 0};
    second.directors = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    model.add_body(rigid_body("two", brick, second));
    const Matrix34 X1 = model.bodies()[0].X, X2 = model.bodies()[1].X;
    if (to_world)
        model.add_joint(spherical("upper", world, 0, joint_frame(world_configuration, X1, {0, 0, 0})));
    model.add_joint(spherical("lower", 0, 1, joint_frame(X1, X2, {1, 0, 0})));
    return model;
}

inline SteppingResult march(const Model& model, double end, int steps, SteppingRule rule,
                            const SteppingOptions& options = {})
{
    return march_stepping(model, consistent_start(model, model.start(), StartPolicy::check),
                          make_time_mesh(0, end, steps), rule, options);
}

/// 1/2 tr(P m^-1 P^T) - sum M g . x of all bodies, by solving with the 4 x 4 matrix m (point masses: by M).
inline double energy(const Model& model, const Motion& motion, int end)
{
    double total = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Body& body = model.bodies()[b];
        const Matrix34& P = motion.momenta[end * motion.n_bodies + b];
        const Matrix34 X = motion.at_end(end).X[b];
        total -= dot(weight(body, model.gravity()), X);
        if (body.is_point) {
            total += 0.5 * dot(P, P) / body.mass(0, 0);
            continue;
        }
        Matrix4 m = body.mass;
        Matrix34 Q = P;   // columns eliminated until Q = P L^-T D^(-1/2): sum of squares is tr(P m^-1 P^T)
        for (int k = 0; k < 4; ++k) {
            for (int j = k + 1; j < 4; ++j) {
                const double l = m(j, k) / m(k, k);
                for (int i = k; i < 4; ++i) m(j, i) -= l * m(k, i);
                Q.set_column(j, Q.column(j) - l * Q.column(k));
            }
            total += 0.5 * dot(Q.column(k), Q.column(k)) / m(k, k);
        }
    }
    return total;
}

inline Vector3 angular_momentum(const Motion& motion, int end)
{
    Vector3 sum{};
    const State state = motion.at_end(end);
    for (int b = 0; b < motion.n_bodies; ++b)
        for (int c = 0; c < 4; ++c) {
            sum += cross(state.X[b].column(c), motion.momenta[end * motion.n_bodies + b].column(c));
        }
    return sum;
}

/// Largest |Phi| / scale of joints and rigidity.
inline double violation(const Model& model, const std::vector<Matrix34>& X)
{
    double worst = 0;
    const auto look = [&](const ConstraintRow& row) {
        worst = std::max(worst, std::abs(constraint_value(row, X)) / row.scale);
    };
    for (int r = 0; r < model.n_rows(); ++r) look(model.row(r));
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        for (const ConstraintRow& row : rigidity_rows(b)) look(row);
    }
    return worst;
}

}   // namespace stepping_test
