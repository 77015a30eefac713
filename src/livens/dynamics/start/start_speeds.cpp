// SPDX-License-Identifier: BSD-3-Clause
// The speeds that rates of a start are compared with: stated ones, those of weight, loads and drives after a
// short while, or rounding. theory.md, "Starting", states the inequality.
#include <algorithm>
#include <cmath>

#include "livens/dynamics/start/start_speeds.h"

namespace livens::inline dynamics_internal {

namespace {

// Of sqrt(a L), and in lengths of the model a second.
constexpr double slowest = 1e-3, per_second = 1e-6;

/// What a force and the moment about the centre of mass begin to do to a body, m/s^2 at the model's length.
double acceleration(const Body& body, const Matrix34& X, const Matrix34& F, double length)
{
    const MassProperties mass = mass_properties(body.mass);
    const Vector3 force = F.column(0);
    double most = norm(force) / mass.mass;
    if (body.is_point || !(trace(mass.inertia) > 0)) return most;
    Vector3 moment = cross(X.column(0) - X * point(mass.center_of_mass), force);
    for (int i = 1; i < 4; ++i) moment += cross(X.column(i), F.column(i));
    // The trace is positive for a needle as well, whose moment about its axis is zero.
    return std::max(most, norm(moment) / trace(mass.inertia) * length);
}

double acceleration_by_loads(const Model& model, const State& state)
{
    std::vector<Matrix34> F(state.X.size(), Matrix34{});
    for (const Load& load : model.loads()) {
        LoadForces forces(load.n_acted);
        load.forces(load_arguments(load, {state.t}, state.X, state.V), forces);
        for (std::size_t b = 0; b < load.n_acted; ++b)
            if (load.bodies[b] != world) F[static_cast<std::size_t>(load.bodies[b])] += forces[b];
    }
    double most = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const double a = acceleration(model.bodies()[b], state.X[b], F[b], model.length());
        if (std::isfinite(a)) most = std::max(most, a);
    }
    return most;
}

double acceleration_by_drives(const Model& model, const State& state, const RowWrenches& wrenches,
                              std::span<const Vector3> centers)
{
    double most = 0;
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        double bend = 0;
        for (const Drive& drive : row.drives)
            bend += std::abs(drive.factor({state.t}).second *
                             form_value(drive.form, row.body_i, row.body_j, state.X));
        const double by_speed = rate_bound(state, wrenches[r], centers, 1, model.length());
        // A law that bends by this much asks for the acceleration that makes as much of the row.
        if (by_speed > 0 && std::isfinite(bend)) most = std::max(most, bend / by_speed);
    }
    return most;
}

}   // namespace

std::vector<Vector3> centers_of_mass(const Model& model)
{
    std::vector<Vector3> centers;
    for (const Body& body : model.bodies()) centers.push_back(mass_properties(body.mass).center_of_mass);
    return centers;
}

double largest_speed(const Model& model, const State& state, std::span<const Vector3> centers)
{
    const double length = model.length();
    double speed = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix34& V = state.V[b];
        speed = std::max(speed, norm(V * point(centers[b])));
        for (int i = 1; i < 4; ++i) speed = std::max(speed, norm(V.column(i)) * length);
    }
    return speed;
}

double rate_bound(const State& state, std::span<const Wrench> row, std::span<const Vector3> centers,
                  double speed, double length)
{
    double bound = 0;
    for (const Wrench& w : row) {
        const Vector3 moment = moment_about(w, state.X[w.body], centers[w.body]);
        // The most that dPhi/dt can be with this speed at the centre and as much by turning at the model's
        // length.
        bound += norm(w.force) * speed + norm(moment) * speed / length;
    }
    return bound;
}

double speed_by_weight(const Model& model)
{
    return slowest * std::sqrt(norm(model.gravity()) * model.length());
}

double speed_of_rounding(const Model& model, const State& state, const RowWrenches& wrenches,
                         std::span<const Vector3> centers)
{
    const double most = std::max(acceleration_by_loads(model, state),
                                 acceleration_by_drives(model, state, wrenches, centers));
    // A thousandth of sqrt(a L), reached within 5e-7 lengths, or 1e-6 lengths a second.
    return std::max(slowest * std::sqrt(most * model.length()), per_second * model.length());
}

}   // namespace livens::inline dynamics_internal
