// SPDX-License-Identifier: BSD-3-Clause
// A mechanism at rest in one configuration: what of its forces the joints do not hold, and its stiffness.
#pragma once

#include <vector>

#include "livens/statics/small_motions.h"

namespace livens::inline statics_internal {

/// Forces and linear terms at rest.
struct Statics {
    /// `state`: prepared, without velocity, with a basis and with multipliers on that side; its accelerations
    /// become zero, since the tangent of forces has no inertia in it.
    Statics(const ModelTables& tables, InstantState& state, Side side);

    FreeMotions free;
    TwistTerms stiffness, damping;
    std::vector<double> given;      ///< weight and loads, 12 a body
    std::vector<double> rows;       ///< F - G^T lambda in scaled twists: what would accelerate the bodies
    double largest_stiffness = 0;   ///< what rounding of Z^T K Z is relative to, 1/s^2
    double largest_damping = 0;     ///< likewise, 1/s
    /// Of forces: the largest sum of sizes of terms along a free motion; at least 1e-4 of those on a body,
    /// which round, and what the stiffness does on 1e-5 lengths or rad.
    double level = 0;
    double residual = 0;   ///< largest of `rows` on a body, as far as it is free, over the level; nan where a
                           ///< load is
    int body = -1;         ///< the body of that; -1: all are in balance

private:
    void add_forces(const ModelTables& tables, const InstantState& state, Instant at);
    void add_levels(const ModelTables& tables, const InstantState& state);

    std::vector<double> sizes_;   // of the terms of `rows`, entry by entry
};

/// Of all bodies the largest displacement of the reference point, by the model's length, or turn.
double largest_displacement(const ModelTables& tables, const double* twists);

}   // namespace livens::inline statics_internal
