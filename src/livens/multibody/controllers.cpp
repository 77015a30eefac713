// SPDX-License-Identifier: BSD-3-Clause
// States z as velocities of point masses without weight, three of them one body: theory.md, "States". A state
// has a unit, the velocity (m/s) of its body where it is one; rates of states are forces.
#include "livens/multibody/controllers.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/loads/load_coordinate.h"

namespace livens {

namespace {

/// The coordinate factor * x_k of a body.
JointCoordinate along_axis(int body, int k, double factor)
{
    Vector3 n{};
    n[k] = factor;
    return displacement_along(world, direction(n), point({}), body, point({}));
}

/// The speed at which the state is one.
double unit_of(const ControllerState& state, const StateScale& scale) { return scale.speed / state.size; }

}   // namespace

Body body_of_states(const std::string& name, const std::string& owner,
                    std::span<const ControllerState> states, const StateScale& scale)
{
    Vector3 velocity{};
    for (std::size_t k = 0; k < states.size(); ++k)
        velocity[static_cast<int>(k)] = unit_of(states[k], scale) * states[k].start;
    Body body = point_mass(name, scale.mass, {}, velocity);
    body.state_speed = scale.speed;
    for (std::size_t k = 0; k < states.size(); ++k) {
        Vector3 along{};
        along[static_cast<int>(k)] = 1;
        body.states.push_back({owner + "." + states[k].name, unit_of(states[k], scale), along});
    }
    return body;
}

JointCoordinate coordinate_of_state(int body, int k, const ControllerState& state, const StateScale& scale)
{
    return along_axis(body, k, 1 / unit_of(state, scale));
}

Load unit_of_state(const std::string& name, int body, int k, const ControllerState& state,
                   const StateScale& scale, const Configurations& X)
{
    // x = z unit and m x'' = F: the force of z' = 1 is m unit, which is the gradient of this coordinate.
    return unit_along(name, along_axis(body, k, scale.mass * unit_of(state, scale)), X);
}

namespace {

/// What an observer looks at, in its list of bodies.
struct Observed {
    std::vector<LoadCoordinate> coordinates;

    double read(const LawEnergy& reading, const LoadArguments& arguments) const
    {
        std::vector<double> values, rates;
        for (const LoadCoordinate& coordinate : coordinates) {
            const CoordinateState state = coordinate.look(arguments);
            values.push_back(state.value);
            rates.push_back(state.rate);
        }
        return reading({arguments.at, values, rates});
    }
};

}   // namespace

Load observer(const std::string& name, const std::vector<LawCoordinate>& coordinates,
              const std::vector<LawReading>& readings, const Configurations& X)
{
    Load load;
    load.name = name;
    load.type = controller_type;
    Observed observed;
    for (const LawCoordinate& q : coordinates)
        observed.coordinates.emplace_back(q.coordinate, q.at_stated, X);
    std::vector<int> bodies;
    for (const LoadCoordinate& coordinate : observed.coordinates)
        for (const int body : coordinate.bodies())
            if (body != world && std::ranges::find(bodies, body) == bodies.end()) bodies.push_back(body);
    if (bodies.empty())
        throw InputError({"load-empty", "load[" + name + "]", "it looks at no body", "", "", "", ""});
    // It would act on the first body, and on the world, if it did something.
    load.bodies = {bodies[0], world};
    load.bodies.insert(load.bodies.end(), bodies.begin() + 1, bodies.end());
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        observed.coordinates[i].place(load, coordinates[i].is_needed);
    load.is_smooth = true;
    const auto all = std::make_shared<const Observed>(std::move(observed));
    for (const LawReading& reading : readings)
        load.readings.push_back(
            {reading.name, reading.unit,
             [all, value = std::make_shared<const LawEnergy>(reading.value)](const LoadArguments& arguments) {
                 return all->read(*value, arguments);
             }});
    load.forces = [](const LoadArguments&, LoadForces&) {};
    load.forces.record = [](LoadTape&, const TapeNumber&) {};
    return load;
}

bool acts_on_states(const Model& model, const Load& load)
{
    const int body = load.bodies[0] == world ? load.bodies[1] : load.bodies[0];
    return body != world && model.bodies()[static_cast<std::size_t>(body)].holds_states();
}

/// The velocity along a state's axis, over its unit, is its value.
std::vector<NamedState> states_in(const Model& model, std::span<const Matrix34> V)
{
    std::vector<NamedState> all;
    for (std::size_t b = 0; b < model.bodies().size(); ++b)
        for (const HeldState& state : model.bodies()[b].states)
            all.push_back({state.name, dot(state.along, V[b].column(0)) / state.unit,
                           model.bodies()[b].state_speed / state.unit});
    return all;
}

void check_change(const StateChange& change, const std::vector<Body>& bodies, const std::vector<Load>& loads,
                  const std::string& path)
{
    const auto is_state = [&](const JointCoordinate& one) {
        if (one.forms.size() != 1 || one.kind != CoordinateKind::displacement) return false;
        const int body = one.forms[0].body_j;
        return body >= 0 && body < static_cast<int>(bodies.size()) &&
               bodies[static_cast<std::size_t>(body)].holds_states();
    };
    const bool is_load = change.load >= 0 && change.load < static_cast<int>(loads.size());
    if (is_load && loads[static_cast<std::size_t>(change.load)].readings.size() == change.states.size() &&
        std::ranges::all_of(change.states, is_state))
        return;
    throw InputError(
        {"controller-state", path, "a change of states needs a reading for each state", "", "", "", ""});
}

void check_sampling(const Sampling& sampling, const std::vector<Body>& bodies, const std::vector<Load>& loads)
{
    const std::string path = "controller[" + sampling.name + "]";
    if (!(sampling.every > 0) || !std::isfinite(sampling.every) || !std::isfinite(sampling.first) ||
        !std::isfinite(sampling.last))
        throw InputError({"controller-every", path + ".every",
                          "the period of a sampled controller must be positive", "", "", "", ""});
    check_change(sampling.change, bodies, loads, path);
}

}   // namespace livens
