// SPDX-License-Identifier: BSD-3-Clause
// A witness that shares nothing with the engine but the data of bodies: Newton's and Euler's equations with
// quaternions, ball joints by their accelerations, integrated by extrapolation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::tests {

using Numbers = std::vector<double>;
using Derivative = std::function<Numbers(double t, const Numbers& y)>;

/// y(end) from y(start) in n steps of Gragg's rule, extrapolated over 2, 4 .. 16 parts: order 16.
/// [Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.9]
inline Numbers extrapolated(const Derivative& f, Numbers y, double start, double end, int n)
{
    constexpr int columns = 8;
    const double H = (end - start) / n;
    for (int step = 0; step < n; ++step) {
        const double t = start + step * H;
        std::array<Numbers, columns> table;   // of increments, whose rounding is smaller than that of y
        for (int k = 0; k < columns; ++k) {
            const int parts = 2 * (k + 1);
            const double h = H / parts;
            Numbers before(y.size(), 0.0), now = f(t, y), at(y.size());
            for (double& x : now) x *= h;
            for (int i = 1; i < parts; ++i) {
                for (std::size_t j = 0; j < y.size(); ++j) at[j] = y[j] + now[j];
                const Numbers slope = f(t + i * h, at);
                for (std::size_t j = 0; j < y.size(); ++j)
                    before[j] = std::exchange(now[j], before[j] + 2 * h * slope[j]);
            }
            table[k] = now;
            for (int i = k - 1; i >= 0; --i) {
                const double ratio = 1.0 * parts / (2 * (i + 1));
                for (std::size_t j = 0; j < y.size(); ++j)
                    table[i][j] = table[i + 1][j] + (table[i + 1][j] - table[i][j]) / (ratio * ratio - 1);
            }
        }
        for (std::size_t j = 0; j < y.size(); ++j) y[j] += table[0][j];
    }
    return y;
}

/// Solution of a x = b by elimination with row exchanges; a is n x n, row by row.
inline Numbers solution_of(Numbers a, Numbers b)
{
    const std::size_t n = b.size();
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < n; ++r)
            if (std::abs(a[r * n + c]) > std::abs(a[pivot * n + c])) pivot = r;
        for (std::size_t j = 0; j < n; ++j) std::swap(a[c * n + j], a[pivot * n + j]);
        std::swap(b[c], b[pivot]);
        for (std::size_t r = c + 1; r < n; ++r) {
            const double factor = a[r * n + c] / a[c * n + c];
            if (factor == 0) continue;
            for (std::size_t j = c; j < n; ++j) a[r * n + j] -= factor * a[c * n + j];
            b[r] -= factor * b[c];
        }
    }
    for (std::size_t c = n; c-- > 0;) {
        for (std::size_t j = c + 1; j < n; ++j) b[c] -= a[c * n + j] * b[j];
        b[c] /= a[c * n + c];
    }
    return b;
}

/// A body that moves; everything in world axes but `theta` below.
struct Mover {
    double mass = 0;
    Vector3 center{};   ///< of mass, in body coordinates
    Matrix3 J{};        ///< about the centre of mass, body axes
    Matrix3 R{};        ///< directors
    Vector3 r{};        ///< centre of mass
    Vector3 v{};        ///< its velocity
    Vector3 w{};        ///< angular velocity
    Vector3 force{};
    Vector3 torque{};   ///< about the centre of mass

    Vector3 arm(const Vector3& theta) const { return R * (theta - center); }
    Vector3 at(const Vector3& theta) const { return r + arm(theta); }
    Vector3 velocity(const Vector3& theta) const { return v + cross(w, arm(theta)); }
    void push(const Vector3& theta, const Vector3& f)
    {
        force += f;
        torque += cross(arm(theta), f);
    }
};

using Movers = std::vector<Mover>;
using Pushes = std::function<void(double t, Movers& bodies)>;   ///< adds what loads do, without gravity

/// Point `theta_first` of body `first`, or of the world, is point `theta_second` of body `second`.
struct BallJoint {
    int first = world;
    Vector3 theta_first{};
    int second = 0;
    Vector3 theta_second{};
};

/// A spring and damper between two points: what pulls the first point.
inline Vector3 spring_pull(const Vector3& first, const Vector3& v_first, const Vector3& second,
                           const Vector3& v_second, double stiffness, double damping, double free_length)
{
    const Vector3 r = second - first;
    const double l = norm(r), rate = dot(r, v_second - v_first) / l;
    return ((stiffness * (l - free_length) + damping * rate) / l) * r;
}

/// Bodies of a model under its gravity and `pushes`, from the model's start.
class NewtonEuler {
public:
    NewtonEuler(const Model& model, Pushes pushes, std::vector<BallJoint> joints = {})
        : model_(model), pushes_(std::move(pushes)), joints_(std::move(joints))
    {
    }

    /// X and V at the end, after n steps.
    State run(double start, double end, int n) const
    {
        Numbers y;
        for (const Body& body : model_.bodies()) {
            const Vector3 c = center(body), w = body.is_point ? Vector3{} : spin(body);
            const Vector3 arm = directors(body.X) * c;
            append(y, body.X.column(0) + arm);
            y.insert(y.end(), {1, 0, 0, 0});   // the turn since the start
            append(y, body.V.column(0) + cross(w, arm));
            append(y, w);
        }
        y = extrapolated([&](double t, const Numbers& at) { return slopes(t, at); }, y, start, end, n);
        State state{end, {}, {}};
        for (const Mover& m : movers(y)) {
            const bool is_point = norm(m.J) == 0;
            const Vector3 arm = m.R * m.center;
            state.X.push_back(is_point ? configuration(m.r, {}) : configuration(m.r - arm, m.R));
            state.V.push_back(is_point ? configuration(m.v, {})
                                       : configuration(m.v - cross(m.w, arm), cross_matrix(m.w) * m.R));
        }
        return state;
    }

private:
    static void append(Numbers& y, const Vector3& x) { y.insert(y.end(), x.a, x.a + 3); }
    static Vector3 center(const Body& body)
    {
        return body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass;
    }
    /// w = 1/2 sum_i d_i x d_i'.
    static Vector3 spin(const Body& body)
    {
        Vector3 sum{};
        for (int c = 1; c < 4; ++c) sum += 0.5 * cross(body.X.column(c), body.V.column(c));
        return sum;
    }
    static Matrix3 turn(const double* q)
    {
        const double s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        const Vector3 u{q[1], q[2], q[3]};
        const Matrix3 U = cross_matrix(u);
        return identity<3>() + (2 / s) * (q[0] * U + U * U);
    }

    Movers movers(const Numbers& y) const
    {
        Movers all;
        for (int b = 0; b < model_.n_bodies(); ++b) {
            const Body& body = model_.bodies()[b];
            const double* at = y.data() + 13 * b;
            Mover m;
            m.mass = body.is_point ? body.mass(0, 0) : mass_properties(body.mass).mass;
            m.center = center(body);
            if (!body.is_point) m.J = mass_properties(body.mass).inertia;
            m.R = turn(at + 3) * (body.is_point ? identity<3>() : directors(body.X));
            m.r = {at[0], at[1], at[2]};
            m.v = {at[7], at[8], at[9]};
            m.w = {at[10], at[11], at[12]};
            all.push_back(m);
        }
        return all;
    }

    /// Accelerations and angular accelerations of all bodies, three numbers each.
    Numbers accelerations(double t, Movers& bodies) const
    {
        for (Mover& m : bodies) m.force = m.mass * model_.gravity();
        pushes_(t, bodies);
        const std::size_t nb = 6 * bodies.size(), n = nb + 3 * joints_.size();
        Numbers a(n * n, 0.0), right(n, 0.0);
        auto entry = [&](std::size_t i, std::size_t j, const Matrix3& block) {
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) a[(i + r) * n + j + c] += block(r, c);
        };
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const Mover& m = bodies[b];
            const Matrix3 I = norm(m.J) == 0 ? identity<3>() : m.R * m.J * transpose(m.R);
            const Vector3 gyroscopic = cross(m.w, I * m.w);
            entry(6 * b, 6 * b, m.mass * identity<3>());
            entry(6 * b + 3, 6 * b + 3, I);
            for (int i = 0; i < 3; ++i) {
                right[6 * b + i] = m.force[i];
                right[6 * b + 3 + i] = m.torque[i] - gyroscopic[i];
            }
        }
        for (std::size_t k = 0; k < joints_.size(); ++k) {
            const std::size_t row = nb + 3 * k;
            auto side = [&](int body, const Vector3& theta, double sign) {
                if (body == world) return;
                const Mover& m = bodies[body];
                const Vector3 arm = m.arm(theta), pull = cross(m.w, cross(m.w, arm));
                const std::size_t b = 6 * static_cast<std::size_t>(body);
                entry(row, b, sign * identity<3>());
                entry(row, b + 3, -sign * cross_matrix(arm));
                entry(b, row, -sign * identity<3>());
                entry(b + 3, row, -sign * cross_matrix(arm));
                for (int i = 0; i < 3; ++i) right[row + i] -= sign * pull[i];
            };
            side(joints_[k].first, joints_[k].theta_first, 1);
            side(joints_[k].second, joints_[k].theta_second, -1);
        }
        return solution_of(a, right);
    }

    Numbers slopes(double t, const Numbers& y) const
    {
        Movers bodies = movers(y);
        const Numbers a = accelerations(t, bodies);
        Numbers slope;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const double* q = y.data() + 13 * b + 3;
            const Vector3 w = bodies[b].w, u{q[1], q[2], q[3]};
            append(slope, bodies[b].v);
            slope.push_back(-0.5 * dot(w, u));
            append(slope, 0.5 * (q[0] * w + cross(w, u)));
            slope.insert(slope.end(), a.begin() + 6 * static_cast<long>(b),
                         a.begin() + 6 * static_cast<long>(b) + 6);
        }
        return slope;
    }

    const Model& model_;
    Pushes pushes_;
    std::vector<BallJoint> joints_;
};

}   // namespace livens::tests
