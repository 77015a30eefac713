// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/coordinate_load.h"
#include "livens/multibody/detail/load_values.h"

namespace livens {

Load actuator(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
              const TimeFunction& value, const Configurations& X)
{
    const CoordinateLoad along(joint, coordinate, X);
    Load load = start_load(name, "actuator", along.bodies());
    set_load_value(load, {value, 0.0, 0.0});
    load.depends_on_X = true;
    load.needs_directors = along.needs_directors();
    load.forces = [along, value](const LoadArguments& arguments, LoadForces& F) {
        along.forces(arguments, value(arguments.at).value, F);
    };
    load.tangent = [along, value](const LoadArguments& arguments, LoadTangent& tangent) {
        along.tangent(arguments, {value(arguments.at).value, 0, 0}, tangent);
    };
    return load;
}

}   // namespace livens
