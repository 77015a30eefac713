// SPDX-License-Identifier: BSD-3-Clause
// Forces with one vector all over: F = f w^T, w = (1, theta) for a point, the first column of m per unit
// mass, int (1, theta) dA for a traction (P20). theory.md, "The law".
#include "livens/multibody/loads/load_values.h"

namespace livens {

Load multibody_internal::uniform_load(const std::string& name, const char* type, int body, const Vector4& w,
                                      const TimeVector& value, Frame frame, const char* unit)
{
    Load load = start_load(name, type, {body, world});
    set_load_value(load, value);
    report_load_value(load, value, unit);
    load.depends_on_X = frame == Frame::body_fixed;
    load.needs_directors[0] = load.depends_on_X || w[1] != 0 || w[2] != 0 || w[3] != 0;
    if (!load.depends_on_X) {
        load.forces = [w, value](const LoadArguments& arguments, LoadForces& F) {
            F[0] = outer(load_value(value, arguments.at), w);
        };
        load.forces.record = [w, value](LoadTape& tape, const TapeNumber& factor) {
            tape.pull(0, w, factor, tape.of_time(value));
        };
        return load;
    }
    load.forces = [w, value](const LoadArguments& arguments, LoadForces& F) {
        F[0] = outer(directors(arguments.X[0]) * load_value(value, arguments.at), w);
    };
    load.forces.record = [w, value](LoadTape& tape, const TapeNumber& factor) {
        tape.pull(0, w, factor, along_directors(tape.of_time(value)));
    };
    // dF_a / dd_i = w_a t_i I.
    load.tangent = [w, value](const LoadArguments& arguments, LoadTangent& tangent) {
        const Vector3 t = load_value(value, arguments.at);
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 3; ++i) add_block(tangent.X[0][0], a, i + 1, w[a] * t[i] * identity<3>());
    };
    return load;
}

/// Virtual work f . d(X (1, theta)), so F = f (1, theta)^T.
Load point_force(const std::string& name, int body, const Vector3& point, const TimeVector& value,
                 Frame frame)
{
    Load load = uniform_load(name, "force", body, livens::point(point), value, frame, "N");
    check_load_vector(load, point, "the point");
    return load;
}

}   // namespace livens
