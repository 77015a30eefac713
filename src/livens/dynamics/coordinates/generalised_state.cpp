// SPDX-License-Identifier: BSD-3-Clause
// What follows from a state: theory.md, "States in coordinates".
#include "livens/dynamics/coordinates/generalised_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/coordinates/state_parts.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/solvers/factors.h"

namespace livens {

namespace {

using Of = GeneralisedCoordinate::Of;

void check_numbers(const Mechanism& mechanism, std::span<const double> given, std::size_t wanted,
                   const std::vector<std::string>& names, const std::string& what)
{
    if (given.size() != wanted) {
        std::string order;
        for (const std::string& name : names) order += (order.empty() ? "" : ", ") + name;
        throw InputError(
            {"coordinate-value", what,
             "'" + what + "' has " + std::to_string(wanted) + (wanted == 1 ? " number" : " numbers"),
             std::to_string(given.size()), "", "", order.empty() ? "nothing moves" : "they are " + order});
    }
    for (std::size_t i = 0; i < given.size(); ++i)
        if (!std::isfinite(given[i]))
            throw InputError({"coordinate-value", what + "[" + names[i] + "]",
                              "'" + names[i] + "' is not finite", to_text(given[i]), "", "",
                              "give a finite number"});
    if (what != "q") return;
    std::size_t k = 0;
    for (const GeneralisedCoordinate& c : mechanism.coordinates) {
        if (c.of == Of::turn && !(norm(Vector4{given[k], given[k + 1], given[k + 2], given[k + 3]}) > 1e-6))
            throw InputError({"coordinate-value", "q[" + c.name + "]",
                              "the quaternion '" + c.name + "' is zero", "", "", "",
                              "give (w, x, y, z) of norm 1"});
        k += static_cast<std::size_t>(c.n_numbers());
    }
}

}   // namespace

GeneralisedCoordinates::GeneralisedCoordinates(const Model& model, const State& placed, StartPolicy policy,
                                               const std::vector<std::string>& wanted)
    : mechanism_(std::make_shared<const Mechanism>(model, placed, policy, wanted)),
      start_(std::make_shared<const Placed>(placed_at_start(*mechanism_)))
{}

const std::vector<GeneralisedCoordinate>& GeneralisedCoordinates::list() const
{
    return mechanism_->coordinates;
}

int GeneralisedCoordinates::n_numbers() const { return static_cast<int>(mechanism_->numbers.size()); }

int GeneralisedCoordinates::n_rates() const { return mechanism_->n_rates; }

const std::vector<double>& GeneralisedCoordinates::placed() const { return mechanism_->numbers; }

std::vector<std::string> GeneralisedCoordinates::names_of_numbers() const
{
    std::vector<std::string> names;
    for (const GeneralisedCoordinate& c : list()) {
        if (c.of != Of::turn) names.push_back(c.name);
        if (c.of == Of::turn)
            for (const char part : {'w', 'x', 'y', 'z'})
                names.push_back(mechanism_->model.body_name(c.part) + ".q" + part);
    }
    return names;
}

std::vector<std::string> GeneralisedCoordinates::names_of_rates() const
{
    std::vector<std::string> names;
    for (const GeneralisedCoordinate& c : list()) {
        if (c.of != Of::turn) names.push_back(c.name + "_rate");
        if (c.of == Of::turn)
            for (const char axis : {'x', 'y', 'z'})
                names.push_back(mechanism_->model.body_name(c.part) + ".w" + axis);
    }
    return names;
}

GeneralisedState GeneralisedCoordinates::at(std::span<const double> numbers,
                                            std::span<const double> rates) const
{
    check_numbers(*mechanism_, numbers, mechanism_->numbers.size(), names_of_numbers(), "q");
    const std::vector<double> rest(static_cast<std::size_t>(n_rates()), 0.0);
    if (rates.empty()) rates = rest;
    check_numbers(*mechanism_, rates, rest.size(), names_of_rates(), "v");
    return GeneralisedState(
        std::make_shared<const StateParts>(mechanism_, lead(*mechanism_, *start_, numbers), rates));
}

StateParts::StateParts(std::shared_ptr<const Mechanism> the_mechanism, Placed the_placed,
                       std::span<const double> the_rates)
    : mechanism(std::move(the_mechanism)), placed(std::move(the_placed)),
      rates(the_rates.begin(), the_rates.end())
{
    const Mechanism& m = *mechanism;
    std::vector<double> twists(static_cast<std::size_t>(m.bodies.n_twists()), 0.0);
    for (int k = 0; k < m.n_rates; ++k) add_scaled(twists, rates[k], placed.by_rates.column(k));
    state = {m.placed.t, placed.X, rates_of_bodies(twists), placed.angles};
    centripetal.resize(state.X.size());
    for (int b = 0; b < m.model.n_bodies(); ++b) {
        if (m.bodies[b].dofs == 3) continue;
        double spin[6] = {0, 0, 0, 0, 0, 0}, out[12] = {};
        std::copy_n(twists.begin() + m.bodies[b].first + 3, 3, spin + 3);
        // X' has the columns w x d_a; the spin alone, without v, leaves zero for the place.
        twist::columns(state.V[b].a, spin, out);
        std::copy_n(out, 12, centripetal[b].a);
    }
    drifts = drifting_twists();
}

std::vector<Matrix34> StateParts::rates_of_bodies(std::span<const double> twists) const
{
    std::vector<Matrix34> V(placed.X.size());
    for (int b = 0; b < mechanism->model.n_bodies(); ++b) {
        const BodyTable& body = mechanism->bodies[b];
        double twist[6] = {0, 0, 0, 0, 0, 0};
        std::copy_n(twists.begin() + body.first, body.dofs, twist);
        twist::columns(placed.X[b].a, twist, V[b].a);
        std::copy_n(twist, 3, V[b].a);
        if (body.dofs == 3) V[b] = configuration(V[b].column(0), Matrix3{});
    }
    return V;
}

/// Twist accelerations without q'': the rows of joints and coordinates take off what velocities do to them.
std::vector<double> StateParts::drifting_twists() const
{
    const Mechanism& m = *mechanism;
    std::vector<double> wanted;
    const auto add = [&](const ConstraintRow& row) {
        double curvature = constraint_curvature(row, {m.placed.t}, state.X, state.V);
        const RowGradient gradient = constraint_gradient(row, {m.placed.t}, state.X);
        for (int side = 0; side < gradient.bodies.size; ++side)
            curvature += dot(gradient.by[side], centripetal[gradient.bodies.bodies[side]]);
        wanted.push_back(-curvature);
    };
    for (const int r : placed.system->rows()) add(m.model.row(r));
    for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
        if (m.coordinates[i].of == Of::joint)
            add(m.rows[i].row);
        else
            wanted.insert(wanted.end(), static_cast<std::size_t>(m.coordinates[i].n_rates()), 0.0);
    }
    return placed.system->twists(wanted);
}

std::vector<double> StateParts::along(std::span<const Matrix34> forces) const
{
    const Mechanism& m = *mechanism;
    std::vector<double> rows(static_cast<std::size_t>(m.bodies.n_twists()), 0.0), along;
    for (int b = 0; b < m.model.n_bodies(); ++b) {
        double row[6];
        twist::rows(placed.X[b].a, forces[b].a, row);
        std::copy_n(row, m.bodies[b].dofs, rows.begin() + m.bodies[b].first);
    }
    for (int k = 0; k < m.n_rates; ++k) along.push_back(dot(placed.by_rates.column(k), rows));
    return along;
}

std::vector<Matrix34> StateParts::weights() const
{
    std::vector<Matrix34> all;
    for (const Body& body : mechanism->model.bodies())
        all.push_back(weight(body, mechanism->model.gravity()));
    return all;
}

std::vector<Matrix34> StateParts::load_forces() const
{
    const Mechanism& m = *mechanism;
    std::vector<Matrix34> all(placed.X.size());
    if (all.empty()) return all;
    std::vector<double> raw(12 * all.size(), 0.0);
    m.loads.add({m.placed.t}, state.X[0].a, state.V[0].a, 1, raw.data(), placed.angles);
    for (std::size_t b = 0; b < all.size(); ++b)
        std::copy_n(raw.begin() + static_cast<std::ptrdiff_t>(12 * b), 12, all[b].a);
    return all;
}

/// m times X'' of twist accelerations.
std::vector<Matrix34> StateParts::inertia_of(std::span<const double> accelerations) const
{
    std::vector<Matrix34> all = rates_of_bodies(accelerations);
    for (std::size_t b = 0; b < all.size(); ++b)
        all[b] = (all[b] + centripetal[b]) * mechanism->model.bodies()[b].mass;
    return all;
}

/// J^T N^T (m X'' - F) with X'' = N (J q'' + b) + X''_c: M q'' + h, less the loads.
std::vector<double> StateParts::less_loads(std::span<const double> accelerations,
                                           std::span<const Matrix34> loads) const
{
    std::vector<double> twists = drifts;
    for (int k = 0; k < mechanism->n_rates; ++k)
        add_scaled(twists, accelerations[k], placed.by_rates.column(k));
    std::vector<Matrix34> forces = inertia_of(twists);
    const std::vector<Matrix34> weight = weights();
    for (std::size_t b = 0; b < forces.size(); ++b) {
        forces[b] -= weight[b];
        if (!loads.empty()) forces[b] -= loads[b];
    }
    std::vector<double> rows = along(forces);
    add_rotors(twists, rows);
    return rows;
}

/// a q'' of each rotor by the slopes of its coordinate.
void StateParts::add_rotors(std::span<const double> accelerations, std::vector<double>& along_rates) const
{
    if (mechanism->rotors.empty()) return;
    std::vector<Matrix34> second = rates_of_bodies(accelerations);
    for (std::size_t b = 0; b < second.size(); ++b) second[b] = second[b] + centripetal[b];
    for (const Rotor& rotor : mechanism->rotors) {
        const ConstraintRow row = coupling_row({{1, rotor.coordinate}}, 0, 1, "rotor");
        const double torque =
            rotor.inertia * (coordinate_rate(rotor.coordinate, placed.X, second) +
                             constraint_curvature(row, {mechanism->placed.t}, placed.X, state.V));
        for (int k = 0; k < mechanism->n_rates; ++k)
            along_rates[k] += torque * coordinate_rate(rotor.coordinate, placed.X,
                                                       rates_of_bodies(placed.by_rates.column(k)));
    }
}

/// Work of the momenta of each rate along all others: the upper triangle, and its mirror image.
DenseMatrix StateParts::mass() const
{
    const int n = mechanism->n_rates;
    std::vector<std::vector<Matrix34>> moved;
    for (int k = 0; k < n; ++k) moved.push_back(rates_of_bodies(placed.by_rates.column(k)));
    DenseMatrix M(n, n);
    for (int k = 0; k < n; ++k)
        for (std::size_t b = 0; b < placed.X.size(); ++b) {
            if (moved[k][b] == Matrix34{}) continue;
            const Matrix34 momentum = moved[k][b] * mechanism->model.bodies()[b].mass;
            for (int i = 0; i <= k; ++i) M(i, k) += dot(moved[i][b], momentum);
        }
    for (const Rotor& rotor : mechanism->rotors) {
        std::vector<double> slope;
        for (int k = 0; k < n; ++k) slope.push_back(coordinate_rate(rotor.coordinate, placed.X, moved[k]));
        for (int k = 0; k < n; ++k)
            for (int i = 0; i <= k; ++i) M(i, k) += rotor.inertia * slope[i] * slope[k];
    }
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < k; ++i) M(k, i) = M(i, k);
    return M;
}

DenseMatrix StateParts::mass_factor() const
{
    DenseMatrix L = cholesky(mass());
    if (!all_finite(L.a))
        throw InputError({"coordinates-singular", "q",
                          "the mass matrix of this state is not positive definite", "", "", "",
                          "give bodies that can move mass and inertia"});
    return L;
}

GeneralisedState::GeneralisedState(std::shared_ptr<const StateParts> parts) : parts_(std::move(parts)) {}

const State& GeneralisedState::state() const { return parts_->state; }
const std::vector<double>& GeneralisedState::numbers() const { return parts_->placed.numbers; }
const std::vector<double>& GeneralisedState::rates() const { return parts_->rates; }
std::vector<std::vector<double>> GeneralisedState::coordinates() const
{
    std::vector<std::vector<double>> all;
    auto next = parts_->placed.counted.begin();
    for (const Joint& joint : model().joints()) {
        const auto end = next + static_cast<std::ptrdiff_t>(joint.coordinates.size());
        all.emplace_back(next, end);
        next = end;
    }
    return all;
}

const Model& GeneralisedState::model() const { return parts_->mechanism->model; }

std::vector<double> GeneralisedState::mass_matrix() const { return parts_->mass().a; }   // symmetric

std::vector<double> GeneralisedState::bias_forces() const
{
    return parts_->less_loads(std::vector<double>(parts_->rates.size(), 0.0), {});
}

std::vector<double> GeneralisedState::gravity_forces() const
{
    std::vector<double> forces = parts_->along(parts_->weights());
    // Not -one, which would make -0 of zero.
    for (double& one : forces) one = 0 - one;
    return forces;
}

std::vector<double> GeneralisedState::load_forces() const { return parts_->along(parts_->load_forces()); }

std::vector<double> GeneralisedState::inverse_dynamics(std::span<const double> accelerations) const
{
    parts_->check(accelerations, "accelerations");
    return parts_->less_loads(accelerations, parts_->load_forces());
}

std::vector<double> GeneralisedState::accelerations(std::span<const double> forces) const
{
    std::vector<double> left = inverse_dynamics(std::vector<double>(parts_->rates.size(), 0.0));
    if (!forces.empty()) parts_->check(forces, "forces");
    for (std::size_t k = 0; k < left.size(); ++k) left[k] = (forces.empty() ? 0 : forces[k]) - left[k];
    return cholesky_solution(parts_->mass_factor(), left);
}

void StateParts::check(std::span<const double> given, const std::string& what) const
{
    const auto n = static_cast<std::size_t>(mechanism->n_rates);
    if (given.size() == n && std::ranges::all_of(given, [](double x) { return std::isfinite(x); })) return;
    throw InputError(
        {"coordinate-value", what,
         given.size() == n ? "'" + what + "' are not finite"
                           : "'" + what + "' are " + std::to_string(n) + (n == 1 ? " number" : " numbers"),
         given.size() == n ? "" : std::to_string(given.size()), "", "", "give one for each rate"});
}

const BodyTable& StateParts::table_of(int body) const
{
    if (body < 0 || body >= mechanism->model.n_bodies())
        throw InputError({"body-unknown", "", "there is no such body", std::to_string(body), "", "",
                          "the world does not move"});
    return mechanism->bodies[static_cast<std::size_t>(body)];
}

std::vector<double> GeneralisedState::jacobian(int body, const Vector3& point) const
{
    const auto n = static_cast<std::size_t>(parts_->mechanism->n_rates);
    const BodyTable& table = parts_->table_of(body);
    std::vector<double> rows(6 * n, 0.0);
    const Vector3 arm = directors(parts_->placed.X[body]) * point;
    for (std::size_t k = 0; k < n; ++k) {
        const auto twist = parts_->placed.by_rates.column(static_cast<int>(k))
                               .subspan(static_cast<std::size_t>(table.first));
        Vector3 v{twist[0], twist[1], twist[2]}, w{};
        if (table.dofs == 6) w = {twist[3], twist[4], twist[5]};
        v += cross(w, arm);
        for (std::size_t i = 0; i < 3; ++i) {
            rows[i * n + k] = v.a[i];
            rows[(3 + i) * n + k] = w.a[i];
        }
    }
    return rows;
}

std::vector<double> GeneralisedState::drift(int body, const Vector3& point) const
{
    const BodyTable& table = parts_->table_of(body);
    const double* twist = parts_->drifts.data() + table.first;
    const Vector3 arm = directors(parts_->placed.X[body]) * point;
    Vector3 a{twist[0], twist[1], twist[2]}, alpha{};
    if (table.dofs == 6) alpha = {twist[3], twist[4], twist[5]};
    a += cross(alpha, arm) + directors(parts_->centripetal[body]) * point;
    return {a[0], a[1], a[2], alpha[0], alpha[1], alpha[2]};
}

double GeneralisedState::kinetic_energy() const
{
    double energy = rotor_energy(parts_->mechanism->rotors, state().X, state().V);
    const std::vector<Body>& bodies = model().bodies();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        energy += 0.5 * dot(state().V[b] * bodies[b].mass, state().V[b]);
    return energy;
}

double GeneralisedState::potential_energy() const
{
    double energy = 0;
    const std::vector<Matrix34> weights = parts_->weights();
    for (std::size_t b = 0; b < weights.size(); ++b) energy -= dot(weights[b], state().X[b]);
    const LoadTables& loads = parts_->mechanism->loads;
    for (int l = 0; l < static_cast<int>(model().loads().size()); ++l) {
        const Load& load = model().loads()[l];
        if (load.potential)
            energy += load.potential(load_arguments(load, {state().t}, state().X, state().V,
                                                    loads.turns.of(l, parts_->placed.angles)));
    }
    return energy;
}

}   // namespace livens
