// SPDX-License-Identifier: BSD-3-Clause
// How far a state is from the joints of a model, by the definition of their rows.
#pragma once

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"

namespace livens {

/// Largest |Phi| / scale.
inline double largest_violation(const Model& model, const State& state)
{
    double worst = 0;
    for (int r = 0; r < model.n_rows(); ++r)
        worst = std::max(worst, std::abs(constraint_value(model.row(r), state.X)) / model.row(r).scale);
    return worst;
}

/// Largest |G V| / scale.
inline double largest_rate(const Model& model, const State& state)
{
    double worst = 0;
    for (int r = 0; r < model.n_rows(); ++r) {
        const RowGradient g = constraint_gradient(model.row(r), state.X);
        double rate = 0;
        for (const int body : g.bodies) rate += dot(g.of(body), state.V[body]);
        worst = std::max(worst, std::abs(rate) / model.row(r).scale);
    }
    return worst;
}

}   // namespace livens
