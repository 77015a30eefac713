// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/load_values.h"

namespace livens {

/// Virtual work f . d(X (1, theta)), so F = f (1, theta)^T.
Load point_force(const std::string& name, int body, const Vector3& point, const TimeVector& value,
                 Frame frame)
{
    const bool body_fixed = frame == Frame::body_fixed;
    Load load = start_load(name, "force", {body, world});
    check_load_vector(load, point, "the point");
    set_load_value(load, value);
    report_load_value(load, value, "N");
    load.depends_on_X = body_fixed;
    load.needs_directors[0] = body_fixed || dot(point, point) > 0;
    const Vector4 place = livens::point(point);
    if (!body_fixed) {
        load.forces = [place, value](const LoadArguments& arguments, LoadForces& F) {
            F[0] = outer(load_value(value, arguments.at), place);
        };
        return load;
    }
    load.forces = [place, value](const LoadArguments& arguments, LoadForces& F) {
        F[0] = outer(directors(arguments.X[0]) * load_value(value, arguments.at), place);
    };
    // f = sum_i f_i d_i, so dF_a / dd_i = (1, theta)_a f_i I.
    load.tangent = [place, value](const LoadArguments& arguments, LoadTangent& tangent) {
        const Vector3 f = load_value(value, arguments.at);
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 3; ++i) add_block(tangent.X[0][0], a, i + 1, place[a] * f[i] * identity<3>());
    };
    return load;
}

}   // namespace livens
