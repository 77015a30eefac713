// SPDX-License-Identifier: BSD-3-Clause
// A state that is near is put onto its rows: docs/theory.md, "Accelerations".
#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"

namespace livens {

namespace {

constexpr double closed_enough = 1e-12;   // |Phi| / scale

}   // namespace

/// One step of Gauss and Newton, none where rows are closed; returns how far they were open, by their scale.
double InstantSystem::move_towards_rows(InstantState& state)
{
    const ConstraintBasis& basis = state.held.basis;
    const std::vector<int>& rows = state.held.by_joints ? state.held.joints.pattern()->rows() : basis.rows;
    double open = 0;
    for (int c = 0; c < tables_.rank; ++c) {
        const double phi = tables_.rows.value(rows[c], {state.t}, state.X.data());
        row_rates_[c] = -phi;
        const double size = std::abs(phi) / tables_.rows[rows[c]].row->scale;
        if (!(size <= open) && !std::isnan(open)) open = size;   // keeps what is no number
    }
    if (open <= closed_enough) return open;
    // The least step in the mass metric with Ghat y = -Phi: Y R^-T S^-1 (-Phi), or zero, projected.
    double *y = a_.data(), *rest = b_.data();
    std::fill_n(y, tables_.n_twists, 0.0);
    if (state.held.by_joints) {
        state.held.joints.project(y, row_rates_.data(), rest);
    } else {
        for (int c = 0; c < tables_.rank; ++c) y[c] = row_rates_[c] * basis.row_scale(c);
        basis.q.solve_R_transposed(y);
        std::fill_n(rest, tables_.n_twists, 0.0);
        solve(state, rest, y);
    }
    std::vector<double> step(static_cast<std::size_t>(tables_.n_twists));
    tables_.bodies.to_twist(state.maps.data(), y, step.data());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        double moved[6] = {0, 0, 0, 0, 0, 0}, change[12] = {};
        std::copy_n(step.begin() + tables_.bodies[b].first, tables_.bodies[b].dofs, moved);
        double* X = state.X.data() + 12 * b;
        twist::displacement(moved, X, change);
        for (int i = 0; i < 12; ++i) X[i] += change[i];
    }
    return open;
}

bool InstantSystem::close(InstantState& state)
{
    const std::vector<double> given = state.X;
    const std::vector<int> rows = state.held.rows;
    constexpr int most = 6;   // steps, of which each squares what is open
    for (int i = 0; i < most; ++i) {
        const double open = move_towards_rows(state);
        if (open <= closed_enough) return true;
        if (!std::isfinite(open) || !prepare(state, rows)) break;
    }
    state.X = given;
    prepare(state, rows);
    return false;
}

}   // namespace livens
