// SPDX-License-Identifier: BSD-3-Clause
// What every load must fulfil; a new one gets it by a line in load_kit_registry.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "livens/multibody/loads.h"
#include "properties/kit.h"
#include "unit/multibody/random_states.h"

namespace livens {

struct LoadCase {
    std::string type;   ///< Load::type, and the name of its file in src/livens/multibody/loads
    std::string what;   ///< for messages
    std::function<Load(Random&)> make;   ///< on bodies 0 and 1, or on 0 alone
    /// Where the bodies are, for a load that is no number everywhere; else anywhere.
    std::function<std::array<Matrix34, 2>(Random&)> place{};
};

/// Every load of the library, in every variant.
const std::vector<LoadCase>& load_cases();

/// Skew and moving bodies, some way apart so that no two points meet.
LoadArguments random_arguments(Random& random, const Load& load, const LoadCase& load_case);

/// dF/dX and dF/dV equal differences of order 8 (error about 1e-12) at 1000 states with skew directors; where
/// a flag says that there is no dependence, there is none.
Failures check_load_tangent(const LoadCase& load);
/// tr(F^T V) = - d(potential)/dt + power without potential, at any X and V.
Failures check_load_energy(const LoadCase& load);
/// F = - d(potential)/dX at rest.
Failures check_load_potential(const LoadCase& load);
/// F is smooth in time between its breaks, and at a break each side is the limit from there.
Failures check_load_breaks(const LoadCase& load);
/// In lanes of every set of instructions that is here F is what it is alone, to 1e-14 of its scale, also
/// turn after turn.
Failures check_load_lanes(const LoadCase& load);
/// No force outside the first column unless needs_directors says so.
Failures check_load_directors(const LoadCase& load);

Failures check_load(const LoadCase& load);   ///< all of them

}   // namespace livens
