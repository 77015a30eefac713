// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/load_values.h"
#include "livens/multibody/surface_loads.h"

namespace livens {

Load pressure(const std::string& name, int body, const SurfaceMoments& surface, const TimeFunction& value)
{
    Load load = start_load(name, "pressure", {body, world});
    set_load_value(load, {value, TimeFunction(0.0), TimeFunction(0.0)});
    load.readings = {
        {"pressure", "Pa", [value](const LoadArguments& arguments) { return value(arguments.at).value; }}};
    load.depends_on_X = load.needs_directors[0] = true;
    const Matrix34 N = surface.normal;
    load.forces = [N, value](const LoadArguments& arguments, LoadForces& F) {
        F[0] = -value(arguments.at).value * (directors(arguments.X[0]) * N);
    };
    load.tangent = [N, value](const LoadArguments& arguments, LoadTangent& tangent) {
        const double p = value(arguments.at).value;
        for (int a = 0; a < 4; ++a)
            for (int i = 0; i < 3; ++i) add_block(tangent.X[0][0], a, i + 1, -p * N(i, a) * identity<3>());
    };
    return load;
}

}   // namespace livens
