// SPDX-License-Identifier: BSD-3-Clause
// Tractions over a surface, constant or linear in body coordinates (P20): F = [t T] int (1, theta)(1,
// theta)^T dA, from integrals taken once. theory.md, "Bodies from meshes", Loads on surfaces.
#include <cassert>

#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/loads/surface_loads.h"

namespace livens {

namespace {

/// [t T] int (1, theta) (1, theta)^T dA.
Matrix34 integral(const Matrix4& area, const TimeVector& value, const std::vector<TimeVector>& gradient,
                  Instant at)
{
    Matrix34 field;
    field.set_column(0, load_value(value, at));
    for (int i = 0; i < 3; ++i) {
        const Vector3 row = load_value(gradient[i], at);
        for (int j = 0; j < 3; ++j) field(i, j + 1) = row[j];
    }
    return field * area;
}

}   // namespace

Load traction(const std::string& name, int body, const SurfaceMoments& surface, const TimeVector& value,
              Frame frame, const std::vector<TimeVector>& gradient)
{
    const Matrix4 area = surface.area;
    if (gradient.empty()) return uniform_load(name, "traction", body, area.column(0), value, frame, "Pa");
    assert(gradient.size() == 3);
    Load load = start_load(name, "traction", {body, world});
    set_load_value(load, value);
    for (const TimeVector& row : gradient) set_load_value(load, row);
    report_load_value(load, value, "Pa");
    load.needs_directors[0] = true;
    load.depends_on_X = frame == Frame::body_fixed;
    const auto G = [area, value, gradient](Instant at) { return integral(area, value, gradient, at); };
    const auto record = [G, frame](LoadTape& tape, const TapeNumber& factor) {
        for (int a = 0; a < 4; ++a) {
            Vector4 w{};
            w[a] = 1;
            const TapeVector column = tape.at_instant([G, a](Instant at) { return G(at).column(a); });
            tape.pull(0, w, factor, frame == Frame::body_fixed ? along_directors(column) : column);
        }
    };
    if (!load.depends_on_X) {
        load.forces = [G](const LoadArguments& arguments, LoadForces& F) { F[0] = G(arguments.at); };
        load.forces.record = record;
        return load;
    }
    load.forces = [G](const LoadArguments& arguments, LoadForces& F) {
        F[0] = directors(arguments.X[0]) * G(arguments.at);
    };
    load.forces.record = record;
    load.tangent = [G](const LoadArguments& arguments, LoadTangent& tangent) {
        const Matrix34 of = G(arguments.at);
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 3; ++i) add_block(tangent.X[0][0], a, i + 1, of(i, a) * identity<3>());
    };
    return load;
}

}   // namespace livens
