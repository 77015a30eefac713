// SPDX-License-Identifier: BSD-3-Clause
// What all loads share: their beginning, checks of input, breaks and power. A load is data and functions;
// laws of single kinds stand in loads/. Its force is F of theory.md, "The law", per body 3 x 4.
#include "livens/multibody/loads.h"

#include <algorithm>

#include "livens/base/error.h"
#include "livens/multibody/loads/load_values.h"
#include "livens/multibody/wording.h"

namespace livens {

Load multibody_internal::start_load(const std::string& name, const char* type,
                                    const std::array<int, 2>& bodies)
{
    if (bodies[0] == bodies[1])
        throw InputError({"load-self", "load[" + name + "]",
                          bodies[0] == world ? "a load needs a body to act on"
                                             : "a load between two points needs two bodies",
                          "", "", "", ""});
    Load load;
    load.name = name;
    load.type = type;
    load.bodies = {bodies[0], bodies[1]};
    load.is_smooth = true;   // what is not says so
    return load;
}

void multibody_internal::check_load_vector(const Load& load, const Vector3& value, const std::string& what)
{
    require_finite(value, "load[" + load.name + "]", what);
}

void multibody_internal::check_not_negative(const Load& load, double value, const std::string& key)
{
    if (value >= 0 && std::isfinite(value)) return;
    throw InputError({"load-negative", "load[" + load.name + "]." + key, key + " must not be negative",
                      to_text(value), ">= 0", "", ""});
}

void multibody_internal::set_load_value(Load& load, const TimeVector& value)
{
    for (const TimeFunction& component : value) {
        // One look at t = 0 refuses what never is a number; what becomes one later ends the motion by the
        // load's name.
        const double sample = component(Instant{}).value;
        if (!std::isfinite(sample))
            throw InputError({"not-finite", "load[" + load.name + "].value",
                              "the value of a load must be finite", to_text(sample), "finite numbers", "",
                              ""});
        load.breaks.insert(load.breaks.end(), component.breaks().begin(), component.breaks().end());
    }
    std::ranges::sort(load.breaks);
    const auto repeated = std::unique(load.breaks.begin(), load.breaks.end());
    load.breaks.erase(repeated, load.breaks.end());
}

void multibody_internal::report_load_value(Load& load, const TimeVector& value, const char* unit)
{
    for (std::size_t k = 0; k < 3; ++k)
        load.readings.push_back(
            {std::string(1, "xyz"[k]), unit,
             [component = value[k]](const LoadArguments& at) { return component(at.at).value; }});
}

std::string not_finite(const Load& load)
{
    return "the load '" + load.name + "' is not finite" +
           (load.domain.empty() ? "" : " (" + load.domain + ")");
}

TimeVector window(const TimeVector& value, double from, double until)
{
    return {window(value[0], from, until), window(value[1], from, until), window(value[2], from, until)};
}

LoadArguments load_arguments(const Load& load, Instant at, std::span<const Matrix34> X,
                             std::span<const Matrix34> V, std::span<const double> angles)
{
    LoadArguments arguments(load.bodies.size());
    arguments.at = at;
    arguments.angles = angles;
    for (std::size_t b = 0; b < load.bodies.size(); ++b) {
        if (load.bodies[b] == world) continue;
        arguments.X[b] = X[load.bodies[b]];
        arguments.V[b] = V[load.bodies[b]];
    }
    return arguments;
}

double load_power(const Load& load, const LoadArguments& arguments)
{
    LoadForces F(load.n_acted);
    load.forces(arguments, F);
    double power = 0;
    for (std::size_t b = 0; b < load.n_acted; ++b)
        if (load.bodies[b] != world) power += dot(F[b], arguments.V[b]);
    return power;
}

double power_without_potential(const Load& load, const LoadArguments& arguments)
{
    if (load.power) return load.power(arguments);
    // A load with a potential and without a power of its own does work that is counted as energy already.
    return load.potential ? 0 : load_power(load, arguments);
}

}   // namespace livens
