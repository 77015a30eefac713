// SPDX-License-Identifier: BSD-3-Clause
// Quantities of a motion by name, each made of what samples, coordinates, loads and accelerations say.
#include "livens/diagnostics/quantities.h"

#include <algorithm>
#include <limits>

#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/body.h"
#include "livens/multibody/sensors.h"

namespace livens {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// "rad s-1" as "rad/s", as people write it.
std::string spoken_unit(const std::string& unit)
{
    const std::size_t space = unit.find(' '), minus = unit.find('-');
    if (space == std::string::npos || minus == std::string::npos) return unit;
    const std::string power = unit.substr(minus + 1);
    const std::string of = unit.substr(space + 1, minus - space - 1);
    return unit.substr(0, space) + "/" + of + (power == "1" ? "" : "^" + power);
}

template <class Values>
void put(std::span<double> numbers, const NamedQuantity& quantity, const Values& values)
{
    std::copy_n(values.data(), quantity.size, numbers.begin() + quantity.first);
}

struct BodyQuantity {
    const char *what, *unit;
    int size;
};

constexpr BodyQuantity body_quantities[] = {{"position", "m", 3},
                                            {"center_of_mass", "m", 3},
                                            {"quaternion", "1", 4},
                                            {"velocity", "m/s", 3},
                                            {"angular_velocity", "rad/s", 3},
                                            {"acceleration", "m/s^2", 3},
                                            {"angular_acceleration", "rad/s^2", 3},
                                            {"linear_momentum", "kg m/s", 3},
                                            {"angular_momentum", "kg m^2/s", 3}};

/// What a body has at each of its points.
bool is_of_points(std::string_view what)
{
    return what == "position" || what == "velocity" || what == "acceleration";
}

bool needs_accelerations(const NamedQuantity& q) { return q.what.ends_with("acceleration"); }

/// Along the axes of a body.
Vector3 in_axes(const Matrix34& X, const Vector3& v)
{
    return transpose(project_directors(directors(X))) * v;
}

/// The motion of a body's material points as those of the joint point.
Vector3 point_velocity(const Matrix34& X, const Matrix34& V, const Vector3& place)
{
    return V.column(0) + cross(angular_velocity(X, V), place - X.column(0));
}

}   // namespace

std::string component_of(const NamedQuantity& quantity, int i)
{
    if (quantity.size == 1) return "";
    return std::string(1, quantity.size == 4 ? "wxyz"[i] : "xyz"[i]);
}

struct Quantities::Sources {
    Sources(const Model& model, const Motion& motion)
        : accelerations(model, motion), coordinates(model, motion), joints(model, motion, accelerations),
          turns(model, motion), sensors(model, motion)
    {
        for (const Joint& joint : model.joints()) efforts.push_back(drive_effort(joint));
    }

    Accelerations accelerations;
    JointCoordinates coordinates;
    JointSampler joints;   // shares what those find
    LoadTurns turns;
    SensorReadings sensors;
    std::vector<std::optional<DriveEffort>> efforts;   // of the joints
};

Quantities::Quantities(const Model& model, const Motion& motion, const std::vector<std::string>& body_names)
    : model_(model), motion_(motion), sources_(std::make_shared<const Sources>(model, motion)),
      has_reactions_(!model.joints().empty() && !sample_joints(model, motion, motion.start()).empty())
{
    for (const char* what : {"kinetic", "potential", "energy"}) add(QuantityOf::model, 0, "", what, "J");
    for (std::size_t b = 0; b < body_names.size() && !model.bodies()[b].holds_states(); ++b)
        for (const BodyQuantity& q : body_quantities)
            add(QuantityOf::body, static_cast<int>(b), body_names[b], q.what, q.unit, q.size);
    add_points();
    const std::vector<JointCoordinates::Place>& places = sources_->coordinates.places();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const NamedCoordinate& q = sources_->coordinates.coordinate(static_cast<int>(i));
        const std::string unit = q.coordinate.is_angle() ? "rad" : "m";
        const std::string& joint = model.joints()[places[i].joint].name;
        for (const char* derivative : {"", "_rate", "_acceleration"})
            add(QuantityOf::coordinate, static_cast<int>(i), joint, q.name + derivative,
                unit + (*derivative == '\0'    ? ""
                        : derivative[1] == 'r' ? "/s"
                                               : "/s^2"));
    }
    add_parts();
}

void Quantities::add_points()
{
    for (int p = 0; p < std::ssize(model_.points()); ++p)
        for (const BodyQuantity& q : body_quantities) {
            if (!is_of_points(q.what)) continue;
            add(QuantityOf::point, p, model_.points()[p].name, q.what, q.unit, q.size);
            all_.back().is_on_request = true;
        }
}

/// In axes of the world, and of the bodies that have some.
void Quantities::add_reactions(int j)
{
    const Joint& joint = model_.joints()[j];
    add(QuantityOf::reaction, j, joint.name, "force", "N", 3);
    add(QuantityOf::reaction, j, joint.name, "torque", "N m", 3);
    for (const int body : {joint.first, joint.second}) {
        if (body == world || model_.bodies()[body].is_point) continue;
        for (const char* what : {"force", "torque"}) {
            const std::string name = std::string(what) + "_in." + model_.body_name(body);
            add(QuantityOf::reaction, j, joint.name, name, *what == 'f' ? "N" : "N m", 3);
            all_.back().is_on_request = true;
            all_.back().axes = body;
        }
    }
}

/// Of joints, drives, loads and sensors.
void Quantities::add_parts()
{
    for (int j = 0; has_reactions_ && j < std::ssize(model_.joints()); ++j) {
        add_reactions(j);
        const Joint& joint = model_.joints()[j];
        if (!joint.over.empty()) add(QuantityOf::drive, j, joint.name, "tension", "N");
        if (joint.type != "drive") continue;
        if (const auto& effort = sources_->efforts[static_cast<std::size_t>(j)]) {
            const bool is_angle = effort->coordinate.is_angle();
            add(QuantityOf::drive, j, joint.name, "effort", is_angle ? "N m" : "N");
        }
        add(QuantityOf::drive, j, joint.name, "power", "W");
    }
    for (int l = 0; l < std::ssize(model_.loads()); ++l) {
        for (const LoadReading& reading : model_.loads()[l].readings)
            add(QuantityOf::load, l, model_.loads()[l].name, reading.name, spoken_unit(reading.unit));
        add(QuantityOf::load, l, model_.loads()[l].name, "power", "W");
    }
    for (int s = 0; s < std::ssize(model_.sensors()); ++s) {
        const Sensor& sensor = model_.sensors()[s];
        for (const SensorComponent& c : sensor.components) {
            add(QuantityOf::sensor, s, sensor.name, c.name, spoken_unit(c.unit));
            all_.back().is_repeated = sensor.load >= 0 && model_.loads()[sensor.load].name == sensor.name;
        }
    }
}

void Quantities::add(QuantityOf of, int index, const std::string& part, const std::string& what,
                     const std::string& unit, int size)
{
    all_.push_back({of, index, part, what, unit, size, n_numbers_});
    n_numbers_ += size;
}

void Quantities::at(const State& given, Side side, std::span<const NamedQuantity> wanted,
                    std::span<double> numbers, std::span<const JointSample> joints) const
{
    const auto any = [&](auto... kinds) {
        return std::ranges::any_of(wanted, [&](const NamedQuantity& q) { return ((q.of == kinds) || ...); });
    };
    const Accelerations& equations = sources_->accelerations;
    AcceleratedState accelerated;
    const bool is_accelerated = std::ranges::any_of(
        wanted, [](const NamedQuantity& q) { return q.of != QuantityOf::sensor && needs_accelerations(q); });
    if (is_accelerated) accelerated = equations.at(given, side);
    if (any(QuantityOf::reaction, QuantityOf::drive) && joints.empty()) {
        const std::vector<JointSample> found = sources_->joints.at(given);
        put_joints(equations.on_joints(given), side, wanted, found, numbers);
    } else if (!joints.empty()) {
        put_joints(given, side, wanted, joints, numbers);
    }
    // Laws of loads may be steep in what the polynomials have a little off.
    const bool is_forced =
        is_accelerated || any(QuantityOf::reaction, QuantityOf::drive, QuantityOf::load, QuantityOf::sensor);
    const State state = is_forced ? equations.on_joints(given) : given;
    if (any(QuantityOf::body)) put_bodies(state, accelerated, wanted, numbers);
    if (any(QuantityOf::point)) put_points(state, accelerated, wanted, numbers);
    if (any(QuantityOf::coordinate)) {
        const std::vector<CoordinateValue> values =
            sources_->coordinates.at(state, is_accelerated ? &accelerated : nullptr);
        for (const NamedQuantity& q : wanted) {
            if (q.of != QuantityOf::coordinate) continue;
            const CoordinateValue& value = values[static_cast<std::size_t>(q.index)];
            numbers[static_cast<std::size_t>(q.first)] = q.what.ends_with("_rate") ? value.rate
                                                         : needs_accelerations(q)  ? value.acceleration
                                                                                   : value.value;
        }
    }
    if (any(QuantityOf::load, QuantityOf::model)) put_loads(state, side, wanted, numbers);
    if (!any(QuantityOf::sensor)) return;
    const std::vector<double> read = sources_->sensors.at(given, side);
    int first = n_numbers_ - static_cast<int>(read.size());   // sensors stand last
    for (const NamedQuantity& q : wanted)
        if (q.of == QuantityOf::sensor)
            numbers[static_cast<std::size_t>(q.first)] = read[static_cast<std::size_t>(q.first - first)];
}

void Quantities::put_bodies(const State& state, const AcceleratedState& accelerated,
                            std::span<const NamedQuantity> wanted, std::span<double> numbers) const
{
    const std::vector<BodySample> samples = sample_bodies(model_, motion_, state);
    constexpr Vector3 none{no_number, no_number, no_number};
    for (const NamedQuantity& q : wanted) {
        if (q.of != QuantityOf::body) continue;
        const std::size_t b = static_cast<std::size_t>(q.index);
        const BodySample& s = samples[b];
        if (q.what == "position") put(numbers, q, s.position);
        if (q.what == "center_of_mass") put(numbers, q, s.center_of_mass);
        if (q.what == "quaternion") put(numbers, q, s.quaternion);
        if (q.what == "velocity") put(numbers, q, s.velocity);
        if (q.what == "angular_velocity") put(numbers, q, s.angular_velocity);
        if (q.what == "linear_momentum") put(numbers, q, s.linear_momentum);
        if (q.what == "angular_momentum") put(numbers, q, s.angular_momentum);
        if (q.what == "acceleration") put(numbers, q, accelerated.A[b].column(0));
        if (q.what == "angular_acceleration")
            put(numbers, q,
                model_.bodies()[b].is_point ? none
                                            : angular_acceleration(accelerated.X[b], accelerated.A[b]));
    }
}

/// Places and velocities by the nearest rigid triad, as those of bodies; accelerations are A (1, theta).
void Quantities::put_points(const State& state, const AcceleratedState& accelerated,
                            std::span<const NamedQuantity> wanted, std::span<double> numbers) const
{
    const std::vector<BodySample> samples = sample_bodies(model_, motion_, state);
    for (const NamedQuantity& q : wanted) {
        if (q.of != QuantityOf::point) continue;
        const NamedPoint& at = model_.points()[q.index];
        if (at.body == world) {
            put(numbers, q, q.what == "position" ? at.position : Vector3{});
            continue;
        }
        const BodySample& s = samples[static_cast<std::size_t>(at.body)];
        const Vector3 arm = project_directors(directors(state.X[at.body])) * at.position;
        if (q.what == "position") put(numbers, q, s.position + arm);
        if (q.what == "velocity") put(numbers, q, s.velocity + cross(s.angular_velocity, arm));
        if (q.what == "acceleration")
            put(numbers, q, accelerated.A[static_cast<std::size_t>(at.body)] * point(at.position));
    }
}

void Quantities::put_joints(const State& state, Side side, std::span<const NamedQuantity> wanted,
                            std::span<const JointSample> joints, std::span<double> numbers) const
{
    constexpr Vector3 none{no_number, no_number, no_number};
    for (const NamedQuantity& q : wanted) {
        if (q.of != QuantityOf::reaction && q.of != QuantityOf::drive) continue;
        const std::size_t j = static_cast<std::size_t>(q.index);
        const bool is_known = !joints.empty() && joints[j].is_bounded;
        const Reaction r = !is_known            ? Reaction{none, none}
                           : side == Side::left ? joints[j].left
                                                : joints[j].right;
        const Joint& joint = model_.joints()[q.index];
        if (q.of == QuantityOf::reaction) {
            const Vector3& v = q.what.starts_with("force") ? r.force : r.torque;
            put(numbers, q, q.axes == world ? v : in_axes(state.X[q.axes], v));
        }
        if (q.of != QuantityOf::drive) continue;
        numbers[static_cast<std::size_t>(q.first)] =
            q.what == "power"     ? joint_power(joint, state.X, state.V, r)
            : q.what == "tension" ? rope_tension(joint, state.X, r)
                                  : sources_->efforts[j]->of(joint, state.X, r);
    }
}

void Quantities::put_loads(const State& state, Side side, std::span<const NamedQuantity> wanted,
                           std::span<double> numbers) const
{
    const std::vector<double> angles = sources_->turns.at(state);
    const Instant instant{state.t, side};
    const auto kinetic = [&] { return kinetic_energy(model_, state.X, state.V); };
    const auto potential = [&] { return potential_energy(model_, instant, state.X, state.V, angles); };
    for (const NamedQuantity& q : wanted) {
        double& number = numbers[static_cast<std::size_t>(q.first)];
        if (q.of == QuantityOf::model)
            number = q.what == "kinetic"     ? kinetic()
                     : q.what == "potential" ? potential()
                                             : kinetic() + potential();
        if (q.of != QuantityOf::load) continue;
        const Load& load = model_.loads()[q.index];
        const LoadArguments arguments =
            load_arguments(load, instant, state.X, state.V, sources_->turns.turns().of(q.index, angles));
        const auto reading = std::ranges::find(load.readings, q.what, &LoadReading::name);
        number = reading == load.readings.end() ? load_power(load, arguments) : reading->value(arguments);
    }
}

/// The coordinate is read off the drive's row (see driven_coordinate()): of an angle its two factors multiply
/// the forms of sine and cosine, in this order; another row has the form of the coordinate itself.
std::optional<DriveEffort> drive_effort(const Joint& joint)
{
    if (joint.type != "drive" || joint.rows.size() != 1) return {};
    const ConstraintRow& row = joint.rows[0];
    const auto of_bodies = [&](const QuadraticForm& form) {
        PairForm pair;
        static_cast<QuadraticForm&>(pair) = form;
        pair.body_i = row.body_i;
        pair.body_j = row.body_j;
        return pair;
    };
    if (!row.label.starts_with("driven ") || row.drives.empty()) return {};
    const bool is_angle = row.label.starts_with("driven angle");
    if (row.drives.size() == 1)
        return DriveEffort{{{static_cast<const PairForm&>(row)},
                            is_angle ? CoordinateKind::arc_sine : CoordinateKind::displacement}};
    return DriveEffort{{{of_bodies(row.drives[1].form), of_bodies(row.drives[0].form)}}};
}

/// The reaction is Q times the gradient of the coordinate, of which the part is taken that is Q's own: of an
/// angle by turning the second body about the joint point, of a displacement by moving it.
double DriveEffort::of(const Joint& drive, std::span<const Matrix34> X, const Reaction& reaction) const
{
    const bool is_angle = coordinate.is_angle();
    const Vector3& given = is_angle ? reaction.torque : reaction.force;
    const Matrix34& of_second = X[static_cast<std::size_t>(drive.second)];
    const Vector3 place = of_second * point(drive.point_second);
    std::vector<Matrix34> V(X.size());
    Vector3 gradient{};
    for (int k = 0; k < 3; ++k) {
        Vector3 unit{};
        unit[k] = 1;
        V[static_cast<std::size_t>(drive.second)] =
            is_angle ? rate(of_second, cross(unit, of_second.column(0) - place), unit)
                     : rate(of_second, unit, {});
        gradient[k] = coordinate_rate(coordinate, X, V);
    }
    return dot(given, gradient) / dot(gradient, gradient);
}

/// The reaction is the tension times that of a unit tension, minus the gradient of the length.
double rope_tension(const Joint& rope, std::span<const Matrix34> X, const Reaction& reaction)
{
    const Matrix34 G = constraint_gradient(rope.rows[0], X).of(rope.second);
    const Reaction unit = joint_reaction(rope, X[static_cast<std::size_t>(rope.second)], -G);
    const double arm = rope.rows[0].scale;   // torques count as forces at its length
    const auto product = [&](const Reaction& a, const Reaction& b) {
        return dot(a.force, b.force) + dot(a.torque, b.torque) / (arm * arm);
    };
    return product(reaction, unit) / product(unit, unit);
}

/// Both bodies as they move at the second one's joint point, about which the reaction is told.
double joint_power(const Joint& joint, std::span<const Matrix34> X, std::span<const Matrix34> V,
                   const Reaction& reaction)
{
    const auto second = static_cast<std::size_t>(joint.second);
    const Vector3 place = X[second] * point(joint.point_second);
    Vector3 v = point_velocity(X[second], V[second], place), w = angular_velocity(X[second], V[second]);
    if (joint.first != world) {
        const auto first = static_cast<std::size_t>(joint.first);
        v -= point_velocity(X[first], V[first], place);
        w -= angular_velocity(X[first], V[first]);
    }
    return dot(reaction.force, v) + dot(reaction.torque, w);
}

}   // namespace livens
