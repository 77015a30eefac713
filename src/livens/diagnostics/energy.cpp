// SPDX-License-Identifier: BSD-3-Clause
// Kinetic energy 1/2 tr(V m V^T), which does not depend on X (P7), and the potential of weight and loads:
// theory.md, "Bodies without rotation parameters".
#include <cassert>

#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/unwrapped_angles.h"

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
                        std::span<const Matrix34> V, std::span<const double> angles)
{
    assert(X.size() == V.size() && static_cast<int>(X.size()) == model.n_bodies());
    double energy = 0;
    // The weight is constant, so its potential is -tr(F^T X) = -M g . x of the centre of mass.
    for (int b = 0; b < model.n_bodies(); ++b)
        energy -= dot(weight(model.bodies()[b], model.gravity()), X[b]);
    const UnwrappedAngles turns(model);
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l) {
        const Load& load = model.loads()[l];
        if (load.potential) energy += load.potential(load_arguments(load, at, X, V, turns.of(l, angles)));
    }
    return energy;
}

}   // namespace livens
