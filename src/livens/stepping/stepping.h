// SPDX-License-Identifier: BSD-3-Clause
// Classical time stepping with directors: independent witnesses, written for clarity. They share nothing with
// spacetime.
#pragma once

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/time/time_mesh.h"

namespace livens::inline stepping_internal {

enum class SteppingRule {
    midpoint,   ///< q1 - q0 = h M^-1 p_mid,  p1 - p0 = h (F_mid - G(q_mid)^T lambda),  Phi(q1) = 0; order 2
    endpoint    ///< implicit Euler, everything at the end of the step; order 1
};

struct SteppingOptions {
    double tolerance = 1e-12;
    int max_iterations = 30;
    ProgressCallback progress;
};

/// X is linear in a step, the multipliers are constant there. At step ends `momenta` are those that the rule
/// carries (the midpoint rule keeps energy and angular momentum of these, and they need not be tangent),
/// `velocities` are the nearest tangent ones in the metric of the mass. Mesh and fields end with the last
/// good step.
struct SteppingResult {
    Motion motion;
    SolveReport report;
};

/// Bodies are the 12 numbers of X with weak rigidity multipliers, so m must be positive definite: a singular
/// one is an InputError (`mass-singular`) that names the body.
void check_stepping(const Model& model);

/// One step per element of the mesh, from an assembled start, of what passes check_stepping().
SteppingResult march_stepping(const Model& model, const ConsistentStart& assembly, const TimeMesh& mesh,
                              SteppingRule rule, const SteppingOptions& options);

}   // namespace livens::inline stepping_internal
