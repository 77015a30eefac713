// SPDX-License-Identifier: BSD-3-Clause
// What an impact makes of velocities: docs/theory.md, "Impacts".
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/instant/settled_instant.h"
#include "livens/multibody/joints.h"

namespace livens::inline dynamics_internal {

/// Of a joint with one row that pushes one way alone (ImpactLaw::open_side).
struct StopImpact {
    double approach = 0;   ///< speed apart before it, m/s or rad/s of its row: negative where bodies meet
    double apart = 0;      ///< behind it
    double impulse = 0;    ///< along the row to its open side, not negative
};

struct ImpactOutcome {
    std::vector<Matrix34> V;   ///< of all bodies behind it
    std::vector<StopImpact> stops;
    bool are_apart = true;   ///< no two of those that are hit feel each other: each law says the same of them
    bool is_found = false;   ///< false: joints lose rank there, or no velocities fulfil the law
};

/// Moreau's law: V = argmin 1/2 |V - V_before|^2 in the mass metric with all rates of the joints of `held`,
/// and of each stop a speed apart of at least its restitution times that together before. Of many at once no
/// more than `most_stops_at_once` are tried.
ImpactOutcome impact(SettledInstant& held, const State& before, std::span<const Joint> stops);
inline constexpr std::size_t most_stops_at_once = 200;

/// How fast the bodies of a stop go apart, by the sign of its open side.
double speed_apart(const Joint& stop, const State& state);
/// The rates of that for some stops, where nothing but the joints of `held` acts on their bodies; nan: joints
/// lose rank there.
std::vector<double> accelerations_apart(std::span<const Joint> stops, SettledInstant& held,
                                        const State& state);
/// How far they are apart, in units of its row.
double gap_of(const Joint& stop, const State& state);

}   // namespace livens::inline dynamics_internal
