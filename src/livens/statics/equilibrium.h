// SPDX-License-Identifier: BSD-3-Clause
// Static equilibrium: where a mechanism rests under its weight, loads and joints.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/statics/linearisation.h"

namespace [[gnu::visibility("default")]] livens {

struct EquilibriumOptions {
    StartPolicy initial = StartPolicy::project;
    int max_iterations = 3000;         ///< steps that were tried
    std::function<bool()> goes_on{};   ///< asked before each step; false: cancelled
};

/// Of the joints of a mechanism at rest.
struct JointsAtRest {
    std::vector<std::vector<double>> coordinates;   ///< of each joint, as it counts them: turns included
    std::vector<int> closed_stops;                  ///< joints that push one way alone, and do so
};

struct Equilibrium : JointsAtRest {
    bool is_found = false;
    std::string message;   ///< where it was not found: why, and which body still accelerates
    State state;           ///< V = 0; found or not, the last one
    int degrees_of_freedom = 0;
    int iterations = 0;    ///< steps, those that were taken back included
    double residual = 0;   ///< largest unbalanced force on a body over the largest forces on one, in the mass
                           ///< metric and as far as joints leave it free
    int worst_body = -1;   ///< the body of that; -1: none
    double acceleration = 0, angular_acceleration = 0;   ///< of that body's reference point, from rest
    std::vector<double> multipliers;                     ///< of all rows, least where joints are redundant
    std::vector<bool> joint_is_unique;
    std::vector<SharedComponents> shared;   ///< of each joint that is not
    std::vector<std::string> notes;         ///< of consistent_start()
    StabilityReport stability;              ///< where it was found
};

/// The equilibrium that a search from the start leads to: V = 0, drives and loads as they are at start.t,
/// bodies exactly rigid, joints closed, F - G^T lambda = 0.
///
/// Steps are Newton's in the coordinates of the principal stiffnesses k: each coordinate goes by its force
/// over |k| + mu, so that it goes with the force where k is negative; mu is chosen such that no body moves by
/// more than a trust radius of at most half a length of the model, or half a radian. A step is kept if the
/// forces do at least a twentieth of the work on it that the tangent foretells. So the potential energy
/// falls, where there is one, and the search ends in a stable equilibrium unless it starts in another:
/// one that is balanced at the start to 1e-10 is returned, whatever its stability. In the end steps are
/// Newton's alone until the residual does not fall any more.
///
/// Stops (joints with ImpactLaw::open_side that an event closes) hold where they are met, and no more where
/// they would have to pull; no step passes one. What is found pushes at each that is closed, and is beyond
/// none. Throws InputError `stop-violated` for a start beyond one, `event-method` for a rest that touches one
/// without a force; after 50 changes, and 10 for each stop, it is not found.
///
/// Stiff springs that carry what moves far want short steps: about (k L / m g)^(1/3) of them.
///
/// Not found: loads that are no number, a limit of iterations, or 25 steps in a row along directions that
/// nothing restores (a free fall). Throws InputError, see consistent_start(); also
/// `start-singular` where the joints hold less at the rest than beside it.
Equilibrium find_equilibrium(const Model& model, const State& start, const EquilibriumOptions& options = {});

}   // namespace gnu::visibility("default")]]livens
