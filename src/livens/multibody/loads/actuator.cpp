// SPDX-License-Identifier: BSD-3-Clause
// A stated force or torque along a coordinate of a joint, Q(t): the work Q dq gives F = Q dq/dX on each body
// (theory.md, "Coordinates of joints", Loads along coordinates).
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

Load actuator(const std::string& name, const NamedCoordinate& coordinate, const TimeFunction& value,
              const Configurations& X)
{
    Load load = unit_along(name, coordinate.coordinate, X);
    load.type = "actuator";
    set_load_value(load, {value, 0.0, 0.0});
    const Load unit = load;
    load.forces = [unit, value](const LoadArguments& arguments, LoadForces& F) {
        unit.forces(arguments, F);
        for (Matrix34& of_body : F) of_body *= value(arguments.at).value;
    };
    load.forces.record = [unit, value](LoadTape& tape, const TapeNumber& factor) {
        unit.forces.record(tape, factor * tape.of_time(value));
    };
    load.tangent = [unit, value](const LoadArguments& arguments, LoadTangent& tangent) {
        unit.tangent(arguments, tangent);
        for (auto& of_body : tangent.X)
            for (std::size_t c = 0; c < 2; ++c) of_body[c] *= value(arguments.at).value;
    };
    load.readings = {{"effort", coordinate.coordinate.is_angle() ? "N m" : "N",
                      [value](const LoadArguments& arguments) { return value(arguments.at).value; }}};
    return load;
}

}   // namespace livens
