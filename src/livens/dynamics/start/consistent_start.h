// SPDX-License-Identifier: BSD-3-Clause
// Closing the mechanism: independent rows, and a start that fulfils them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/error.h"
#include "livens/multibody/state.h"

namespace [[gnu::visibility("default")]] livens {

enum class StartPolicy {
    check,    ///< an inconsistent start is an InputError that names the row
    project   ///< positions and velocities are moved to the nearest consistent ones in the mass metric
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 2> words_of(StartPolicy) { return {"check", "project"}; }

struct ConsistentStart {
    State start;                      ///< consistent; directors orthonormal, V = [v, w x d_i]
    std::vector<int> independent;     ///< rows of the model, ascending
    std::vector<int> redundant;       ///< rows implied by the others: dropped, multipliers not unique
    int degrees_of_freedom = 0;       ///< twist unknowns less independent rows
    std::vector<std::string> notes;   ///< what the projection moved, what deserves a word
};

/// Checks and closes the mechanism at the given state.
///
/// Rank and inertia are judged by row_rank() and weightless_spin().
/// Throws InputError:
///   `start-position`      |Phi| / scale > 1e-9 under StartPolicy::check, or the projection does not converge
///   `start-velocity`      |dPhi/dt| too large (1e-9 of the largest speed), or rates that deform the triad
///   `joint-branch`        axes that must coincide are opposite; `coupling-range`, `coupling-law`: a law ends
///   `joint-contradiction` a redundant row that cannot be fulfilled, or moved, with the others
///   `spin-without-inertia` a motion that no joint holds and that carries no inertia (a needle's free spin)
ConsistentStart consistent_start(const Model& model, const State& start, StartPolicy policy);

/// A closed start, or what consistent_start() would throw.
struct TriedStart {
    std::optional<ConsistentStart> closed;
    Complaint why;   ///< where there is none
};
TriedStart try_consistent_start(const Model& model, const State& start, StartPolicy policy);

}   // namespace livens
