// SPDX-License-Identifier: BSD-3-Clause
// Rotors as coordinates of points, x_k = rho_k q_k with m rho_k^2 = a_k: theory.md, "Inertia along
// coordinates".
#include "livens/multibody/rotors.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace livens::inline multibody_internal {

namespace {

constexpr int axes_of_point = 3;
// rho is the root of the inertias' ratio: beyond this one the smaller rotor would have no digits beside the
// larger.
constexpr double widest_ratio = 1e4;

Vector3 axis(int k)
{
    Vector3 e{};
    e[k] = 1;
    return e;
}

/// Those that may share a point: of one unit, and not too different.
std::vector<std::vector<Rotor>> grouped(std::vector<Rotor> rotors)
{
    std::ranges::stable_sort(rotors, [](const Rotor& a, const Rotor& b) {
        return std::pair(a.coordinate.is_angle(), -a.inertia) <
               std::pair(b.coordinate.is_angle(), -b.inertia);
    });
    std::vector<std::vector<Rotor>> groups;
    for (Rotor& rotor : rotors) {
        const bool fits = !groups.empty() && groups.back().size() < axes_of_point &&
                          groups.back()[0].coordinate.is_angle() == rotor.coordinate.is_angle() &&
                          groups.back()[0].inertia <= widest_ratio * rotor.inertia;
        if (!fits) groups.emplace_back();
        groups.back().push_back(std::move(rotor));
    }
    return groups;
}

/// A name that no other part of this kind has.
template <class Find>
std::string free_name(std::string name, const Find& find)
{
    while (find(name) >= 0) name += "'";
    return name;
}

/// All bodies by a spin about the origin, in each column; and along a velocity.
std::vector<Matrix34> moved_together(std::span<const Matrix34> X, const Vector3& velocity,
                                     const Vector3& spin)
{
    std::vector<Matrix34> V;
    for (const Matrix34& x : X) {
        Matrix34 v;
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < 3; ++i) v(i, c) = cross(spin, x.column(c))[i] + (c == 0 ? velocity[i] : 0);
        V.push_back(v);
    }
    return V;
}

/// 1 a second along the coordinate where all bodies move together: along an axis, or about the origin.
double rate_together(const Rotor& rotor, std::span<const Matrix34> X, const Vector3& velocity,
                     const Vector3& spin)
{
    return coordinate_rate(rotor.coordinate, X, moved_together(X, velocity, spin));
}

/// Of one to the world, beside other coordinates of its joint.
bool turns_its_axis(const Model& model, const Rotor& rotor)
{
    const Joint& joint = model.joints()[static_cast<std::size_t>(rotor.joint)];
    return joint.first == world && rotor.coordinate.is_angle() && joint.coordinates.size() > 1;
}

}   // namespace

std::vector<Rotor> rotors_of(const Model& model)
{
    std::vector<Rotor> rotors;
    for (std::size_t j = 0; model.has_rotors() && j < model.joints().size(); ++j)
        for (const NamedCoordinate& one : model.joints()[j].coordinates)
            if (one.rotor_inertia > 0)
                rotors.push_back({static_cast<int>(j), one.coordinate, one.rotor_inertia});
    return rotors;
}

double rotor_energy(std::span<const Rotor> rotors, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    double energy = 0;
    for (const Rotor& rotor : rotors) {
        const double rate = coordinate_rate(rotor.coordinate, X, V);
        energy += 0.5 * rotor.inertia * rate * rate;
    }
    return energy;
}

RotorMomentum rotor_momentum(const Model& model, std::span<const Rotor> rotors, std::span<const Matrix34> X,
                             std::span<const Matrix34> V)
{
    RotorMomentum sum;
    for (const Rotor& rotor : rotors) {
        if (model.joints()[static_cast<std::size_t>(rotor.joint)].first != world) continue;
        const double momentum = rotor.inertia * coordinate_rate(rotor.coordinate, X, V);
        for (int k = 0; k < 3; ++k) {
            sum.linear[k] += momentum * rate_together(rotor, X, axis(k), {});
            sum.angular[k] += momentum * rate_together(rotor, X, {}, axis(k));
        }
    }
    return sum;
}

bool turn_their_axes(const Model& model, std::span<const Rotor> rotors)
{
    return std::ranges::any_of(rotors, [&](const Rotor& rotor) { return turns_its_axis(model, rotor); });
}

/// d/dt of <grad q, S X> for a spin S is q''(V, S X) + <grad q, S V>; the first by its values for sum and
/// difference.
Vector3 rotor_turning(const Model& model, std::span<const Rotor> rotors, std::span<const Matrix34> X,
                      std::span<const Matrix34> V)
{
    Vector3 sum{};
    for (const Rotor& rotor : rotors) {
        if (!turns_its_axis(model, rotor)) continue;
        const double momentum = rotor.inertia * coordinate_rate(rotor.coordinate, X, V);
        const ConstraintRow row = coupling_row({{1, rotor.coordinate}}, 0, 1, "rotor");
        for (int k = 0; k < 3; ++k) {
            const std::vector<Matrix34> W = moved_together(X, {}, axis(k));
            std::vector<Matrix34> more(V.begin(), V.end()), less = more;
            for (std::size_t b = 0; b < W.size(); ++b) more[b] += W[b], less[b] += -1.0 * W[b];
            const double mixed =
                0.25 * (constraint_curvature(row, {}, X, more) - constraint_curvature(row, {}, X, less));
            sum[k] +=
                momentum * (mixed + coordinate_rate(rotor.coordinate, X, moved_together(V, {}, axis(k))));
        }
    }
    return sum;
}

/// Points and their rows stand behind those of the model, whose numbers stay. A point's mass is that of the
/// largest of its rotors, for which rho is the model's length along angles and 1 along displacements; axes
/// that no rotor has are held where they are.
WithRotors::WithRotors(const Model& model)
    : whole_(model.gravity()), n_bodies_(model.n_bodies()),
      n_joints_(static_cast<int>(model.joints().size())), n_rows_(model.n_rows())
{
    for (const Body& body : model.bodies()) whole_.add_body(body);
    for (Joint joint : model.joints()) {
        for (NamedCoordinate& one : joint.coordinates) one.rotor_inertia = 0;
        whole_.add_joint(std::move(joint));
    }
    const std::vector<Matrix34> X = model.start().X;
    const double size = model.length();
    for (const std::vector<Rotor>& group : grouped(rotors_of(model))) {
        const double unit = group[0].coordinate.is_angle() ? size : 1,
                     mass = group[0].inertia / (unit * unit);
        const std::string owner = model.joints()[static_cast<std::size_t>(group[0].joint)].name;
        Vector3 position{};
        std::vector<double> lengths;
        for (std::size_t k = 0; k < group.size(); ++k) {
            lengths.push_back(std::sqrt(group[k].inertia / mass));
            position[static_cast<int>(k)] = lengths[k] * coordinate_value(group[k].coordinate, X);
        }
        Body point_of_rotors = point_mass(
            free_name("rotor of " + owner, [&](const std::string& name) { return whole_.find_body(name); }),
            mass, position);
        point_of_rotors.is_rotor = true;
        const int body = whole_.add_body(std::move(point_of_rotors));
        second_.push_back(model.joints()[static_cast<std::size_t>(group[0].joint)].second);
        for (int k = 0; k < axes_of_point; ++k) {
            Joint bond;
            bond.first = world;
            bond.second = body;
            bond.type = "rotor";
            const auto at = static_cast<std::size_t>(k);
            if (at < group.size()) {
                const Joint& of = model.joints()[static_cast<std::size_t>(group[at].joint)];
                bond.name = "rotor of " + of.name;
                const JointCoordinate x =
                    displacement_along(world, direction(axis(k)), point({}), body, point({}));
                const double scale = group[at].coordinate.is_angle() ? 1 : size;
                bond.rows.push_back(
                    coupling_row({{1, group[at].coordinate}, {-1 / lengths[at], x}}, 0, scale, "rotor"));
                places_.push_back({group[at], body, k, lengths[at]});
            } else {
                bond.name = "still axis of rotor of " + owner;
                bond.rows.push_back(
                    plane_row(world, direction(axis(k)), point({}), body, point({}), 0, size));
            }
            bond.name =
                free_name(bond.name, [&](const std::string& name) { return whole_.find_joint(name); });
            whole_.add_joint(std::move(bond));
        }
    }
    for (const Load& load : model.loads()) whole_.add_load(load);
    for (const Sensor& sensor : model.sensors()) whole_.add_sensor(sensor);
    for (const Event& event : model.events()) whole_.add_event(event);
    for (const Sampling& sampling : model.samplings()) whole_.add_sampling(sampling);
}

/// Places are as X tells them, up to whole turns, which their rows do not know either.
State WithRotors::with(const State& state) const
{
    State all = state;
    const auto n = static_cast<std::size_t>(whole_.n_bodies());
    all.X.resize(n);
    all.V.resize(n);
    for (const Place& place : places_) {
        const auto b = static_cast<std::size_t>(place.body);
        all.X[b](place.axis, 0) = place.length * coordinate_value(place.rotor.coordinate, state.X);
        all.V[b](place.axis, 0) = place.length * coordinate_rate(place.rotor.coordinate, state.X, state.V);
    }
    return all;
}

std::vector<Matrix34> WithRotors::without(std::span<const Matrix34> all) const
{
    std::vector<Matrix34> some;
    const auto n = static_cast<std::size_t>(n_bodies_), of = static_cast<std::size_t>(whole_.n_bodies());
    for (std::size_t first = 0; first < all.size(); first += of)
        some.insert(some.end(), all.begin() + static_cast<std::ptrdiff_t>(first),
                    all.begin() + static_cast<std::ptrdiff_t>(first + n));
    return some;
}

void WithRotors::take_off(State& state) const
{
    state.X = without(state.X);
    state.V = without(state.V);
}

namespace {

/// The first `wanted` of each `of` numbers.
void narrow(std::vector<double>& values, int wanted, int of)
{
    if (of == 0 || values.empty()) return;
    const auto n = static_cast<std::size_t>(wanted), step = static_cast<std::size_t>(of);
    const std::size_t n_sets = values.size() / step;
    for (std::size_t set = 0; set < n_sets; ++set)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(set * step), n,
                    values.begin() + static_cast<std::ptrdiff_t>(set * n));
    values.resize(n_sets * n);
}

void narrow(Field& field, int wanted)
{
    narrow(field.values, wanted, field.n_values);
    field.n_values = std::min(field.n_values, wanted);
}

}   // namespace

void WithRotors::take_off(Motion& motion) const
{
    if (motion.n_bodies != whole_.n_bodies()) return;   // it has none
    for (auto* all : {&motion.momenta, &motion.velocities, &motion.accelerations}) *all = without(*all);
    narrow(motion.end_multipliers, n_rows_, motion.n_rows);
    narrow(motion.X, 12 * n_bodies_);
    if (!motion.P.empty()) narrow(motion.P, 12 * n_bodies_);
    narrow(motion.multipliers, n_rows_);
    if (!motion.rigidity.empty()) narrow(motion.rigidity, 6 * n_bodies_);
    motion.n_bodies = n_bodies_;
    motion.n_rows = n_rows_;
    std::erase_if(motion.redundant_rows, [this](int row) { return row >= n_rows_; });
}

}   // namespace livens::inline multibody_internal
