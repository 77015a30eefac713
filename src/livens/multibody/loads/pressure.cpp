// SPDX-License-Identifier: BSD-3-Clause
// Pressure on a surface of a body, constant or linear in the place in the world, from integrals taken once:
// theory.md, "Bodies from meshes", Loads on surfaces. The normals turn with the body, so the force depends on
// X in two ways.
#include <algorithm>

#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/loads/surface_loads.h"

namespace livens {

namespace {

/// int (q . (1, theta)) n (1, theta)^T dA with body-fixed normals n.
Matrix34 integral(const SurfaceMoments& surface, const Vector4& q)
{
    Matrix34 G;
    for (int i = 0; i < 3; ++i) {
        const Vector4 row = surface.normal[i] * q;
        for (int a = 0; a < 4; ++a) G(i, a) = row[a];
    }
    return G;
}

struct Pressure {
    SurfaceMoments surface;
    TimeFunction value;
    TimeVector gradient;

    Matrix34 integral(const LoadArguments& arguments) const
    {
        // p + g . x with x = X (1, theta) is linear in theta: q = (p, 0) + X^T g.
        Vector4 q = transpose(arguments.X[0]) * load_value(gradient, arguments.at);
        q[0] += value(arguments.at).value;
        return livens::integral(surface, q);
    }

    /// Row a of F = -D G, G_ia = sum_b n_i,ab q_b.
    void record(LoadTape& tape, TapeNumber factor) const
    {
        const bool is_linear = !std::ranges::all_of(
            gradient, [](const TimeFunction& f) { return f.is_constant() && f({}).value == 0; });
        TapeNumber q[4] = {tape.of_time(value)};
        if (is_linear) {
            const TapeVector g = tape.of_time(gradient);
            q[0] = q[0] + dot(g, tape.arm(0, point({})));
            for (int a = 0; a < 3; ++a) q[1 + a] = dot(g, director_on(tape, a));
        }
        for (int a = 0; a < 4; ++a) {
            Vector4 w{};
            w[a] = 1;
            for (int b = 0; b < (is_linear ? 4 : 1); ++b) {
                const Vector3 n{surface.normal[0](a, b), surface.normal[1](a, b), surface.normal[2](a, b)};
                if (n != Vector3{}) tape.pull(0, w, factor * -q[b], tape.arm(0, direction(n)));
            }
        }
    }

    /// F = -D G, and G depends on X by q.
    void add_tangent(const LoadArguments& arguments, Matrix<12, 12>& tangent) const
    {
        const Matrix34 G = integral(arguments);
        const Matrix3 D = directors(arguments.X[0]);
        const Vector3 g = load_value(gradient, arguments.at);
        for (int a = 0; a < 4; ++a) {
            for (int i = 0; i < 3; ++i) add_block(tangent, a, i + 1, -G(i, a) * identity<3>());
            for (int b = 0; b < 4; ++b) {
                const Vector3 n{surface.normal[0](a, b), surface.normal[1](a, b), surface.normal[2](a, b)};
                add_block(tangent, a, b, -outer(D * n, g));
            }
        }
    }
};

}   // namespace

Load pressure(const std::string& name, int body, const SurfaceMoments& surface, const TimeFunction& value,
              const TimeVector& gradient)
{
    Load load = start_load(name, "pressure", {body, world});
    set_load_value(load, {value, TimeFunction(0.0), TimeFunction(0.0)});
    set_load_value(load, gradient);
    load.readings = {
        {"pressure", "Pa", [value](const LoadArguments& arguments) { return value(arguments.at).value; }}};
    load.depends_on_X = true;
    load.needs_directors[0] = true;
    const Pressure of{surface, value, gradient};
    load.forces = [of](const LoadArguments& arguments, LoadForces& F) {
        F[0] = -1. * (directors(arguments.X[0]) * of.integral(arguments));
    };
    load.forces.record = [of](LoadTape& tape, const TapeNumber& factor) { of.record(tape, factor); };
    load.tangent = [of](const LoadArguments& arguments, LoadTangent& tangent) {
        of.add_tangent(arguments, tangent.X[0][0]);
    };
    return load;
}

}   // namespace livens
