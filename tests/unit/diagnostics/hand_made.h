// SPDX-License-Identifier: BSD-3-Clause
// Motions written down instead of solved, for tests of what is said about a motion.
#pragma once

#include <functional>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/time/quadrature.h"

namespace livens::hand_made {

/// X and V of all bodies at t, and joint multipliers.
using StateAt = std::function<State(double t)>;
using MultipliersAt = std::function<std::vector<double>(double t)>;

/// The interpolation of an exact motion in polynomials of the given degree, exact at nodes and ends.
inline Motion motion(const Model& model, const TimeMesh& mesh, int degree, const StateAt& state,
                     const MultipliersAt& multipliers = {})
{
    Motion m;
    m.n_bodies = model.n_bodies();
    m.n_rows = model.n_rows();
    m.mesh = mesh;
    m.X = {12 * m.n_bodies, degree, true, {}};
    m.multipliers = {m.n_rows, degree, false, {}};
    m.order_at_ends = 2 * degree;
    const std::vector<double> nodes = gauss_lobatto(degree + 1).points;
    const auto append_X = [&](const State& s) {
        for (const Matrix34& X : s.X) m.X.values.insert(m.X.values.end(), X.a, X.a + 12);
    };
    const auto append_end = [&](const State& s) {
        for (int b = 0; b < m.n_bodies; ++b) {
            m.velocities.push_back(s.V[b]);
            m.momenta.push_back(s.V[b] * model.bodies()[b].mass);
        }
    };
    append_X(state(mesh.start()));
    append_end(state(mesh.start()));
    for (int e = 0; e < mesh.n_elements(); ++e) {
        for (int a = 0; a <= degree; ++a) {
            const double t = a == degree ? mesh.ends[e + 1] : mesh.ends[e] + nodes[a] * mesh.length(e);
            if (a > 0) append_X(state(t));
            if (multipliers) {
                const std::vector<double> lambda = multipliers(t);
                m.multipliers.values.insert(m.multipliers.values.end(), lambda.begin(), lambda.end());
            }
        }
        append_end(state(mesh.ends[e + 1]));
    }
    return m;
}

/// A field that jumps between elements, of what `value` is at its nodes in element e at t.
using ValuesAt = std::function<std::vector<double>(int e, double t)>;
inline Field torn_field(const TimeMesh& mesh, int n_values, int degree, const ValuesAt& value)
{
    Field field{n_values, degree, false, {}};
    const std::vector<double> nodes =
        degree == 0 ? std::vector<double>{0.5} : gauss_lobatto(degree + 1).points;
    for (int e = 0; e < mesh.n_elements(); ++e) {
        for (const double s : nodes) {
            const std::vector<double> now = value(e, mesh.ends[e] + s * mesh.length(e));
            field.values.insert(field.values.end(), now.begin(), now.end());
        }
    }
    return field;
}

/// One body's 12 numbers.
inline std::vector<double> stacked(const Matrix34& X) { return {X.a, X.a + 12}; }

/// State of a model of one body whose only moving part is its reference point.
inline State state_of_point(double t, const Vector3& x, const Vector3& v, const Matrix3& d = Matrix3{})
{
    Matrix34 V{};
    V.set_column(0, v);
    return {t, {configuration(x, d)}, {V}};
}

/// Uniform elements over [start, end].
inline TimeMesh mesh(double start, double end, int n) { return make_time_mesh(start, end, n); }

inline double largest(const std::vector<double>& values)
{
    double most = 0;
    for (const double v : values) {
        if (!(v <= most)) most = v;
    }
    return most;
}

/// A body with its centre of mass off the reference point and three different moments.
inline MassProperties skew_properties()
{
    MassProperties p;
    p.mass = 2;
    p.center_of_mass = {0.1, -0.2, 0.3};
    p.inertia = {0.5, 0.02, 0, 0.02, 0.6, -0.03, 0, -0.03, 0.8};
    return p;
}

}   // namespace livens::hand_made
