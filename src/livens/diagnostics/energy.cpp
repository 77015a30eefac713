// SPDX-License-Identifier: BSD-3-Clause
#include <cassert>

#include "livens/diagnostics/diagnostics.h"

namespace livens {

double kinetic_energy(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    assert(X.size() == V.size() && static_cast<int>(V.size()) == model.n_bodies());
    static_cast<void>(
        X);   // T does not depend on X in these coordinates (P7); the signature leaves room for it
    double energy = 0;
    for (int b = 0; b < model.n_bodies(); ++b) energy += 0.5 * dot(V[b] * model.bodies()[b].mass, V[b]);
    return energy;
}

double potential_energy(const Model& model, Instant at, std::span<const Matrix34> X,
                        std::span<const Matrix34> V)
{
    assert(X.size() == V.size() && static_cast<int>(X.size()) == model.n_bodies());
    double energy = 0;
    // The weight is constant, so its potential is -tr(F^T X) = -M g . x of the centre of mass.
    for (int b = 0; b < model.n_bodies(); ++b)
        energy -= dot(weight(model.bodies()[b], model.gravity()), X[b]);
    for (const Load& load : model.loads()) {
        if (load.potential) energy += load.potential(load_arguments(load, at, X, V));
    }
    return energy;
}

}   // namespace livens
