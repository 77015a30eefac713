// SPDX-License-Identifier: BSD-3-Clause
// Kinetic energy 1/2 tr(V m V^T), which does not depend on X (P7), and the potential of weight and loads:
// theory.md, "Bodies without rotation parameters".
#include <cassert>

#include "livens/diagnostics/detail/passed_balance.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/rotors.h"

namespace livens {

double kinetic_energy(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    assert(X.size() == V.size() && static_cast<int>(V.size()) == model.n_bodies());
    // Of bodies T does not depend on X in these coordinates (P7); of rotors it does.
    double energy = rotor_energy(rotors_of(model), X, V);
    for (int b = 0; b < model.n_bodies(); ++b)
        if (const Body& body = model.bodies()[b]; !body.holds_states())
            energy += 0.5 * dot(V[b] * body.mass, V[b]);
    return energy;
}

double potential_energy(const Model& model, Instant at, std::span<const Matrix34> X,
                        std::span<const Matrix34> V, std::span<const double> angles)
{
    assert(X.size() == V.size() && static_cast<int>(X.size()) == model.n_bodies());
    return PotentialEnergy(model).at(at, X, V, angles);
}

PotentialEnergy::PotentialEnergy(const Model& model) : model_(model), turns_(model)
{
    for (const Body& body : model.bodies()) weights_.push_back(weight(body, model.gravity()));
}

double PotentialEnergy::at(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V,
                           std::span<const double> angles) const
{
    double energy = 0;
    // The weight is constant, so its potential is -tr(F^T X) = -M g . x of the centre of mass.
    for (std::size_t b = 0; b < X.size(); ++b) energy -= dot(weights_[b], X[b]);
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        if (load.potential) energy += load.potential(load_arguments(load, at, X, V, turns_.of(l, angles)));
    }
    return energy;
}

}   // namespace livens
