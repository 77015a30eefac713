// What acts on the bodies in a given state: the generalised forces that the diagnostics add up.
#pragma once

#include <span>

#include "livens/multibody/loads.h"
#include "livens/multibody/model.h"

namespace livens {

/// What a load is asked with, from the states of all bodies.
inline LoadArguments load_arguments(const Load& load, Instant at, std::span<const Matrix34> X,
                                    std::span<const Matrix34> V)
{
    LoadArguments arguments;
    arguments.at = at;
    for (int b = 0; b < 2; ++b) {
        if (load.bodies[b] == world) continue;
        arguments.X[b] = X[load.bodies[b]];
        arguments.V[b] = V[load.bodies[b]];
    }
    return arguments;
}

/// Gradients of a row on its two bodies; that of the world is zero.
struct RowGradient {
    Matrix34 i{};
    Matrix34 j{};
};
inline RowGradient row_gradient(const ConstraintRow& row, Instant at, std::span<const Matrix34> X)
{
    RowGradient g;
    const Matrix34& X_i = row.body_i == world ? world_configuration : X[row.body_i];
    constraint_gradient(row, at, X_i, X[row.body_j], g.i, g.j);
    return g;
}
/// The part of dPhi/dt that stays where X does not move.
inline double row_rate(const ConstraintRow& row, Instant at, std::span<const Matrix34> X)
{
    const Matrix34& X_i = row.body_i == world ? world_configuration : X[row.body_i];
    return constraint_rate(row, at, X_i, X[row.body_j]);
}

}   // namespace livens
