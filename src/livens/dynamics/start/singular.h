// SPDX-License-Identifier: BSD-3-Clause
// What joints allow in a configuration in which they hold less than beside it.  (docs/theory.md, "Singular
// positions")
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"

namespace [[gnu::visibility("default")]] livens {

/// Motions that the joints leave free at a configuration, to second order.
///
/// In first order they are the null space of the twist Jacobian. A redundant combination of rows asks
/// something of them in second order, mu . d2 Phi/dt2 = 0; where joints are redundant in all positions that
/// holds for every motion, in a singular position it does not, and the motions that fulfil it are branches.
struct Mobility {
    int first_order = 0;      ///< independent motions in first order
    int conditions = 0;       ///< independent ones of second order on them; 0: the position is not singular
    int row = -1;             ///< of the model, that takes part in them most
    bool is_locked = false;   ///< a condition is definite: no motion fulfils it
    /// Motions that fulfil all conditions where these leave single directions and no family of them, X' of
    /// all bodies, its largest number 1. Looked for if conditions = first_order - 1 and first_order <= 8.
    std::vector<std::vector<Matrix34>> branches;
    /// Of the given velocities: they fulfil the conditions, and these single out one smooth family of
    /// motions.
    bool are_possible = true, choose_branch = true;

    bool is_singular() const { return conditions > 0; }
};

/// At a state that is closed. Numbers count as zero below 1e-6 of their terms; what only a higher order than
/// the second tells is not seen.
Mobility mobility(const Model& model, const ConsistentStart& closed);

/// `start-singular`, where the joints are in a singular position: no motion goes on from rest there, or
/// several do, and rows that are independent beside it are not so there.
std::optional<Complaint> why_singular(const Model& model, const ConsistentStart& closed);
/// Throws it as InputError.
void refuse_singular_start(const Model& model, const ConsistentStart& closed);

}   // namespace livens
