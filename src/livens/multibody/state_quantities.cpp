// SPDX-License-Identifier: BSD-3-Clause
// Quantities are what sensors read of coordinates, found by name; bodies have those of a sensor at their
// reference point, and turns.
#include "livens/multibody/state_quantities.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

constexpr std::array<const char*, 3> axes{"x", "y", "z"};

std::vector<Matrix34> stated_bodies(const Model& model)
{
    std::vector<Matrix34> X;
    for (const Body& body : model.bodies()) X.push_back(body.X);
    return X;
}

void take(const Sensor& sensor, std::vector<StateQuantity>& all)
{
    for (const SensorComponent& c : sensor.components)
        if (!c.coordinate.coordinate.forms.empty() && !c.is_acceleration())
            all.push_back({sensor.name + "." + c.name, c.unit, c.coordinate, c.derivative});
}

/// The rotation vector from where the body is upright, and the angular velocity, in world axes.
void take_turns(const Body& body, int b, std::span<const Matrix34> stated, std::vector<StateQuantity>& all)
{
    const TriadPair aligned{identity<3>(), transpose(body.upright)};
    for (int k = 0; k < 3; ++k) {
        NamedCoordinate one{std::string("rotation_") + axes[k], rotation_component(world, b, aligned, k)};
        one.at_stated = coordinate_value(one.coordinate, stated);
        all.push_back({body.name + ".rotation_" + axes[k], "rad", std::move(one)});
    }
    for (int k = 0; k < 3; ++k)
        all.push_back({body.name + ".angular_velocity_" + axes[k], "rad s-1", {}, 0, b, k});
}

using Bodies = std::span<const Matrix34>;

double kinetic_of(const Body& body, const Matrix34& V) { return 0.5 * dot(V, V * body.mass); }

/// The speed of the reference point, and energies: with weights where the world's origin is at zero.
void take_energies(const Model& model, const std::string& name, int b, std::vector<StateQuantity>& all)
{
    const Body body = model.bodies()[b];
    const auto at = static_cast<std::size_t>(b);
    const Matrix34 weight = livens::weight(body, model.gravity());
    const auto add = [&](const char* what, const char* unit, double mass, auto function) {
        StateQuantity one{name + "." + what, unit};
        one.function = std::move(function);
        one.mass = mass;
        all.push_back(std::move(one));
    };
    const auto kinetic = [=](Bodies, Bodies V) { return kinetic_of(body, V[at]); };
    add("speed", "m s-1", 0, [=](Bodies, Bodies V) { return norm(V[at].column(0)); });
    add("kinetic_energy", "J", body.mass(0, 0), kinetic);
    add("energy", "J", body.mass(0, 0),
        [=](Bodies X, Bodies V) { return kinetic_of(body, V[at]) - dot(weight, X[at]); });
}

/// That of all bodies, with what loads store. Throws where a load's depends on more than places.
/// It has copies of all that it needs, so that it may outlive the model.
StateQuantity energy_of(const Model& model)
{
    struct All {
        std::vector<Body> bodies;
        std::vector<Matrix34> weights;
        std::vector<Load> loads;
    };
    const auto of = std::make_shared<All>();
    StateQuantity energy{"energy", "J"};
    for (const Body& body : model.bodies()) {
        of->bodies.push_back(body);
        of->weights.push_back(weight(body, model.gravity()));
        energy.mass += body.mass(0, 0);
    }
    for (const Load& load : model.loads()) {
        if (!load.potential) continue;
        if (!load.angles.empty())
            throw InputError({"conditions-not-smooth", "energy",
                              "'energy' cannot be stated at an end of time", "",
                              "places, angles, speeds and their rates",
                              "what load '" + load.name + "' stores depends on how often it has turned",
                              "state the kinetic energy of bodies, or rates"});
        of->loads.push_back(load);
    }
    energy.function = [of](Bodies X, Bodies V) {
        double sum = 0;
        for (std::size_t b = 0; b < X.size(); ++b)
            sum += kinetic_of(of->bodies[b], V[b]) - dot(of->weights[b], X[b]);
        for (const Load& load : of->loads) sum += load.potential(load_arguments(load, {0}, X, V));
        return sum;
    };
    return energy;
}

/// All that has this name: joint, sensors, body.
std::vector<StateQuantity> quantities_of(const Model& model, const std::string& object)
{
    std::vector<StateQuantity> all;
    if (const int j = model.find_joint(object); j >= 0) {
        const Joint& joint = model.joints()[j];
        if (!joint.coordinates.empty() || !joint.readings.empty()) take(joint_sensor(object, joint), all);
    }
    for (const Sensor& sensor : model.sensors())
        if (sensor.name == object) take(sensor, all);
    if (const int b = model.find_body(object); b >= 0) {
        take(point_sensor(object, b, {}, stated_bodies(model)), all);
        if (!model.bodies()[b].is_point) take_turns(model.bodies()[b], b, stated_bodies(model), all);
        take_energies(model, object, b, all);
    }
    return all;
}

/// Why nothing of the motion's places and rates has this name, where something else has.
std::string not_smooth(const Model& model, const std::string& object, const std::string& component)
{
    const std::string of_forces = "it follows from forces, which the motion decides";
    for (const Sensor& sensor : model.sensors())
        if (sensor.name == object)
            for (const SensorComponent& c : sensor.components)
                if (c.name == component)
                    return c.is_acceleration()
                               ? "it is an acceleration: " + of_forces
                               : "a sensor of type " + sensor.type + " reads it: " + of_forces;
    if (component.ends_with("_acceleration")) return "it is an acceleration: " + of_forces;
    if (component.starts_with("force") || component.starts_with("torque") || component.starts_with("moment"))
        return "it is a reaction: " + of_forces;
    return "";
}

std::string list_of(const std::vector<StateQuantity>& all)
{
    std::string list;
    for (const StateQuantity& q : all) list += (list.empty() ? "" : ", ") + q.name;
    return list;
}

double value_here(const StateQuantity& quantity, Bodies stated, Bodies X, Bodies V)
{
    if (quantity.function) return quantity.function(X, V);
    if (quantity.body >= 0) {
        const auto b = static_cast<std::size_t>(quantity.body);
        return angular_velocity(X[b], V[b])[quantity.axis];
    }
    const JointCoordinate& q = quantity.coordinate.coordinate;
    return quantity.derivative == 1 ? coordinate_rate(q, X, V)
                                    : quantity.coordinate.at_stated + coordinate_change(q, stated, X);
}

}   // namespace

/// Rodrigues' formula, 1 + sin a K + (1 - cos a) K^2, for all columns.
Matrix34 turned_rate(const AxisTurn& by, const Matrix34& V)
{
    const Matrix3 K = cross_matrix((1 / norm(by.axis)) * by.axis);
    const double half = std::sin(0.5 * by.angle);   // 1 - cos without cancellation
    return V + (std::sin(by.angle) * K + 2 * half * half * (K * K)) * V;
}

/// The axis need not pass the origin: the reference point turns about a point of it, directors turn alone.
Matrix34 turned(const AxisTurn& by, const Matrix34& X)
{
    Matrix34 from_axis = X;
    from_axis.set_column(0, X.column(0) - by.at);
    Matrix34 after = turned_rate(by, from_axis);
    after.set_column(0, by.at + after.column(0));
    return after;
}

std::vector<StateQuantity> state_quantities(const Model& model, const std::string& name)
{
    if (name == "energy" && model.find_body(name) < 0 && model.find_joint(name) < 0)
        return {energy_of(model)};
    const std::size_t dot = name.rfind('.');
    const std::string object = name.substr(0, dot == std::string::npos ? name.size() : dot),
                      component = dot == std::string::npos ? "" : name.substr(dot + 1);
    const std::vector<StateQuantity> all = quantities_of(model, object);
    std::vector<StateQuantity> found;
    std::string prefix = component + "_";
    if (component == "position") prefix = "";
    if (component == "velocity") prefix = "v";
    const bool is_vector = component == "position" || component == "velocity" || component == "rotation" ||
                           component == "angular_velocity";
    for (const StateQuantity& q : all) {
        const std::string own = q.name.substr(object.size() + 1);
        const bool is_part = is_vector && (own == prefix + "x" || own == prefix + "y" || own == prefix + "z");
        if (own == component || is_part) found.push_back(q);
    }
    if (found.size() == 1 || (is_vector && found.size() == 3)) return found;
    if (found.size() > 1)
        throw InputError({"conditions-unknown", name, "more than one object has a quantity '" + name + "'",
                          "", "", "", "give the sensor, joint or body a name of its own"});
    if (const std::string why = not_smooth(model, object, component); !why.empty())
        throw InputError({"conditions-not-smooth", name, "'" + name + "' cannot be stated at an end of time",
                          "", "places, angles, speeds and energies", why,
                          all.empty() ? "" : "there are " + list_of(all)});
    throw InputError(
        {"conditions-unknown", name, "there is no quantity '" + name + "'", "", "",
         all.empty() ? "no joint with coordinates, sensor or body has the name '" + object + "'" : "",
         all.empty() ? "name them as \"pivot.angle\", \"tip.x\" or \"ball.vx\""
                     : "there are " + list_of(all)});
}

double value_of(const StateQuantity& quantity, std::span<const Matrix34> stated, std::span<const Matrix34> X,
                std::span<const Matrix34> V)
{
    if (!quantity.before) return value_here(quantity, stated, X, V);
    const AxisTurn back = quantity.before->back();
    std::vector<Matrix34> X_before, V_before;
    for (const Matrix34& x : X) X_before.push_back(turned(back, x));
    for (const Matrix34& v : V) V_before.push_back(turned_rate(back, v));
    return value_here(quantity, stated, X_before, V_before);
}

}   // namespace livens
