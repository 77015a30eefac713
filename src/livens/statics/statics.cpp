// SPDX-License-Identifier: BSD-3-Clause
// Forces, stiffness and damping at one configuration at rest, and the levels that tell what is nothing: the
// residual of theory.md, "Equilibrium", and the largest terms of K of "Small motions".
#include "livens/statics/statics.h"

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"

namespace livens::inline statics_internal {

namespace {

/// Rows of 12 numbers a body in scaled twists.
std::vector<double> scaled_rows(const ModelTables& tables, const InstantState& state,
                                const std::vector<double>& raw)
{
    std::vector<double> q(static_cast<std::size_t>(tables.n_twists)), y(q.size());
    tables.bodies.twist_rows(state.X.data(), state.maps.data(), raw.data(), q.data());
    tables.bodies.to_scaled_rows(state.maps.data(), q.data(), y.data());
    return y;
}

double on_body(const ModelTables& tables, std::span<const double> y, int body)
{
    return norm(y.subspan(tables.bodies[body].first, tables.bodies[body].dofs));
}

}   // namespace

Statics::Statics(const ModelTables& tables, InstantState& state, Side side) : free(tables, state)
{
    auto& acceleration = state.acceleration[side == Side::left ? 0 : 1];
    // Static forces alone: no part of them is balanced by inertia.
    std::fill(acceleration.begin(), acceleration.end(), 0.0);
    const SmallMotions motions(tables, state, side);
    motions.add_loads(stiffness, damping);
    motions.add_constraints(stiffness);
    add_forces(tables, state, {state.t, side});
    add_levels(tables, state);
}

void Statics::add_forces(const ModelTables& tables, const InstantState& state, Instant at)
{
    const double* X = state.X.data();
    const std::vector<double>& lambda = state.multipliers[at.side == Side::left ? 0 : 1];
    std::vector<double> V(state.X.size());   // of states alone
    tables.bodies.rates_of(X, state.velocity.data(), V.data());
    given.assign(V.size(), 0.0);
    tables.bodies.add_weight(1.0, given.data());
    const std::vector<double> of_weight = scaled_rows(tables, state, given);
    tables.loads.add(at, X, V.data(), 1.0, given.data(), state.angles);

    rows = scaled_rows(tables, state, given);
    sizes_.resize(rows.size());
    std::vector<double> row(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        // Absolute parts, since weight and loads may cancel: their sum would then be a level of nothing.
        sizes_[i] = std::abs(of_weight[i]) + std::abs(rows[i] - of_weight[i]);
    for (int r = 0; r < tables.n_rows(); ++r) {
        if (lambda[r] == 0) continue;
        double g[RowTables::gradient_size];
        tables.rows.gradient(r, at, X, g);
        tables.scaled_gradient(r, X, state.maps.data(), g, row.data());
        add_scaled(rows, -lambda[r], row);
        for (std::size_t i = 0; i < row.size(); ++i) sizes_[i] += std::abs(lambda[r]) * std::abs(row[i]);
    }
}

void Statics::add_levels(const ModelTables& tables, const InstantState& state)
{
    double on_bodies = 0;
    for (int b = 0; b < tables.n_bodies(); ++b) on_bodies = std::max(on_bodies, on_body(tables, sizes_, b));
    // Forces that joints bear leave rounding in the free motions; the level never falls below a share of
    // them.
    level = 1e-4 * on_bodies;
    DenseMatrix of_motions = free.Z;
    for (double& entry : of_motions.a) entry = std::abs(entry);
    for (int k = 0; k < free.n; ++k) level = std::max(level, dot(of_motions.column(k), sizes_));
    const std::vector<double> of_stiffness = free.sizes(tables, stiffness);
    for (int k = 0; k < free.n; ++k) {
        const double moved = largest_displacement(tables, free.twists(tables, state, k).data()),
                     size = of_stiffness[static_cast<std::size_t>(k)];
        largest_stiffness = std::max({largest_stiffness, size, 1e-2 * on_bodies * moved});
        // At least what terms of the stiffness do over 1e-5 lengths or rad: loads may be zero here.
        level = std::max(level, size * 1e-5 / moved);
    }
    for (const double size : free.sizes(tables, damping)) largest_damping = std::max(largest_damping, size);
    if (!all_finite(rows) || !std::isfinite(level)) {
        residual = std::nan("");
        return;
    }
    const std::vector<double> left = product(free.Z, transposed_product(free.Z, rows));
    for (int b = 0; b < tables.n_bodies(); ++b) {
        if (!(on_body(tables, left, b) > residual * level)) continue;
        residual = on_body(tables, left, b) / level;
        body = b;
    }
}

double largest_displacement(const ModelTables& tables, const double* twists)
{
    double size = 0;
    for (int b = 0; b < tables.n_bodies(); ++b)
        for (int part = 0; part < tables.bodies[b].dofs; part += 3) {
            if (tables.model->bodies()[static_cast<std::size_t>(b)].holds_states()) continue;
            const double* v = twists + tables.bodies[b].first + part;
            const double now = norm(Vector3{v[0], v[1], v[2]}) / (part == 0 ? tables.length : 1);
            if (!(now <= size) && !std::isnan(size)) size = now;   // nan too
        }
    return size;
}

}   // namespace livens::inline statics_internal
