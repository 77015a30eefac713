// SPDX-License-Identifier: BSD-3-Clause
// A mechanism with every kind of row and body, its states as flat arrays, and what rows say by differences of
// their values alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "linkages.h"
#include "livens/dynamics/rows/tables.h"

namespace livens {

using Numbers = std::vector<double>;

inline double inner(const Numbers& a, const Numbers& b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
inline double furthest(const Numbers& a, const Numbers& b)
{
    double most = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        most = std::isnan(a[i] - b[i]) ? a[i] - b[i] : std::max(most, std::abs(a[i] - b[i]));
    return most;
}

inline Numbers flat(const std::vector<Matrix34>& X)
{
    Numbers x;
    for (const Matrix34& m : X) x.insert(x.end(), m.a, m.a + 12);
    return x;
}
inline Matrix34 body_of(const Numbers& x, int body)
{
    Matrix34 X{};
    std::copy_n(x.begin() + 12 * body, 12, X.a);
    return X;
}

/// a + b sin(c t + d), smooth and with both rates.
inline TimeFunction swing(double a, double b, double c, double d)
{
    return {[=](Instant at) {
                const double s = std::sin(c * at.t + d), k = std::cos(c * at.t + d);
                return TimeValue{a + b * s, b * c * k, -b * c * c * s};
            },
            {}};
}

inline Joint only_rows(const std::string& name, std::vector<ConstraintRow> rows)
{
    Joint joint;
    joint.name = name;
    joint.type = "rows";
    joint.first = rows.front().body_i;
    joint.second = rows.front().body_j;
    joint.rows = std::move(rows);
    return joint;
}

/// Links with remote reference points on joints of any kind, one of them held by the world, a body with
/// principal axes and its reference point at the centre, a point mass on a rod; loads on one and two bodies.
inline Model workshop(unsigned seed)
{
    Surroundings how;
    how.reference = 0.7;
    how.largest_power = 1;
    Linkage l(seed, how);
    for (int b = 0; b < 4; ++b) {
        l.add_link(l.random.vector());
        l.any_joint(b - 1, b, false);
    }
    Random& random = l.random;
    Model model({1.5, -9.81, 4});
    for (const Body& body : l.model.bodies()) model.add_body(body);
    for (const Joint& joint : l.model.joints()) model.add_joint(joint);
    const MassProperties brick = box(1.2, {1, 0.4, 0.7});
    const int plain =
        model.add_body(rigid_body("plain", brick, {random.vector(), random.rotation(), {}, {}}));
    const int bob = model.add_body(point_mass("bob", 0.3, random.vector()));
    const JointFrame hook{random.vector(), {}, {0, 0, 1}, {0, 0, 1}};
    model.add_joint(
        rod("line", plain, bob, hook,
            norm(model.bodies()[bob].X.column(0) - model.bodies()[plain].X * point(hook.point_first))));
    model.add_load(spring_damper("strut", 0, random.vector(), plain, random.vector(), {4, 0.3, 0.2}));
    model.add_load(spring_damper("stay", bob, {}, world, random.vector(), {2, 0.1, 0.4}));
    model.add_load(torque("motor", 2, {swing(0, 1, 2, 0), 0.4, -0.3}, Frame::body_fixed));
    model.add_load(point_force("push", 1, random.vector(), {0.2, swing(1, 0.5, 3, 1), 0}, Frame::inertial));
    return model;
}

/// The workshop with a point that is led, a length and an angle that are driven; not closed.
inline Model driven_workshop(unsigned seed)
{
    Model model = workshop(seed);
    Random random(seed + 100);
    const auto place = [&] { return point(random.vector()); };
    model.add_joint(only_rows(
        "led", driven_point_rows(1, place(), 4, place(),
                                 {swing(0, 0.3, 2, 0), swing(0.1, 0.5, 1.5, 1), swing(0, 0.7, 0.8, 2)}, 1)));
    model.add_joint(
        only_rows("ram", {driven_distance_row(world, place(), 5, point({}), swing(2, 0.4, 3, 0), 2)}));
    const Matrix3 D = random.rotation();
    model.add_joint(
        only_rows("servo", {driven_angle_row(0, direction(random.unit()), 3, direction(D.column(0)),
                                             direction(D.column(1)), swing(0.3, 0.9, 2, 1))}));
    return model;
}

/// Random directors for everything but point masses, rigid or not.
inline Numbers random_places(const Model& model, Random& random, bool rigid)
{
    std::vector<Matrix34> X;
    for (const Body& body : model.bodies()) {
        X.push_back(rigid ? random.rigid() : random.skew());
        if (body.is_point) X.back() = configuration(X.back().column(0), Matrix3{});
    }
    return flat(X);
}

/// Phi by the row's definition.
inline double phi_of(const ConstraintRow& row, Instant at, const Numbers& x)
{
    return constraint_value(row, at, Configurations(x.data()));
}

/// dPhi/dX by central differences, exact for what is quadratic in X.
inline Numbers gradient_of(const ConstraintRow& row, Instant at, const Numbers& x)
{
    Numbers g(x.size(), 0.0), moved = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double step = 0.5;
        moved[i] = x[i] + step;
        g[i] = phi_of(row, at, moved);
        moved[i] = x[i] - step;
        g[i] = (g[i] - phi_of(row, at, moved)) / (2 * step);
        moved[i] = x[i];
    }
    return g;
}

/// First or second derivative of f at 0 by five points, to about 1e-9 where f changes within seconds.
template <typename Function>
double derivative(const Function& f, int order)
{
    const double h = 0.004, near = f(h), back = f(-h), far = f(2 * h), behind = f(-2 * h);
    if (order == 1) return (8 * (near - back) - (far - behind)) / (12 * h);
    return (16 * (near + back) - (far + behind) - 30 * f(0.0)) / (12 * h * h);
}

/// d2 Phi/dt2 on the straight line x + s v.
inline double curvature_of(const ConstraintRow& row, Instant at, const Numbers& x, const Numbers& v)
{
    const auto along = [&](double s) {
        Numbers moved = x;
        for (std::size_t i = 0; i < x.size(); ++i) moved[i] += s * v[i];
        return phi_of(row, {at.t + s, at.side}, moved);
    };
    return derivative(along, 2);
}

/// Rooms for the gradient of one row; what a row does not touch stays nan.
inline constexpr int numbers_a_row = 48;
inline Numbers untouched() { return Numbers(numbers_a_row, std::numeric_limits<double>::quiet_NaN()); }

/// The gradient of the tables, 12 numbers a body.
inline Numbers table_gradient(const ModelTables& tables, int r, Instant at, const Numbers& x)
{
    Numbers g = untouched(), full(x.size(), 0.0);
    tables.rows.gradient(r, at, x.data(), g.data());
    const RowTable& row = tables.rows[r];
    for (int side = 0; side < row.n_sides; ++side)
        for (const int a : row.columns[side])
            for (int i = a; i < a + 3; ++i) full[12 * row.bodies[side] + i] += g[12 * side + i];
    return full;
}

}   // namespace livens
