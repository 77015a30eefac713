// SPDX-License-Identifier: BSD-3-Clause
// J = Q / q'' by the response of the mechanism to a unit of force along each coordinate (docs/theory.md,
// "Coordinates of joints", Limits).
#include "livens/dynamics/instant/inertia_along.h"

#include <algorithm>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/rotors.h"

namespace livens {

namespace {

/// Bodies and joints alone.
Model without_drives(const Model& model)
{
    Model held;
    for (const Body& body : model.bodies()) held.add_body(body);
    for (const Joint& joint : model.joints())
        if (std::ranges::all_of(joint.rows, [](const ConstraintRow& row) { return row.drives.empty(); }))
            held.add_joint(joint);
    return held;
}

}   // namespace

std::vector<double> inertias_along(const Model& all, std::span<const JointCoordinate> coordinates)
{
    const Model held = without_drives(all);
    const Model model = held.has_rotors() ? WithRotors(held).model() : held;
    const State start = model.start();
    const std::vector<Matrix34> rest(start.X.size());
    const ModelTables tables(model, row_rank(model, start.X, all_rows(model)).independent);
    InstantSystem instant(tables);
    InstantState state;
    state.resize(tables);
    for (std::size_t b = 0; b < start.X.size(); ++b) std::copy_n(start.X[b].a, 12, state.X.begin() + 12 * b);
    std::vector<double> inertias(coordinates.size(), 0.0);
    if (!instant.prepare(state, std::vector<int>(state.held.rows))) return inertias;
    std::vector<double> twists(state.velocity.size()), A(state.X.size());
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
        const Load unit = unit_along("unit", coordinates[k], start.X);
        LoadForces F{};
        unit.forces(load_arguments(unit, {0}, start.X, rest), F);
        std::vector<double> forces(state.X.size(), 0.0);
        for (std::size_t side = 0; side < F.size() && side < unit.bodies.size(); ++side)
            if (unit.bodies[side] != world)
                std::copy_n(F[side].a, 12, forces.begin() + 12 * unit.bodies[side]);
        instant.respond(state, forces.data(), twists.data());
        tables.bodies.rates_of(state.X.data(), twists.data(), A.data());
        std::vector<Matrix34> moved(start.X.size());
        for (std::size_t b = 0; b < moved.size(); ++b)
            std::copy_n(A.begin() + static_cast<std::ptrdiff_t>(12 * b), 12, moved[b].a);
        // From rest q'' is the rate of q by the accelerations: nothing is quadratic in velocities.
        inertias[k] = 1 / coordinate_rate(coordinates[k], start.X, moved);
    }
    return inertias;
}

}   // namespace livens
