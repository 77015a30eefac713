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

}   // namespace livens
