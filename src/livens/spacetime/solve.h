// The one entry: model, conditions, time elements and method in; motion and report out.
#pragma once

#include <variant>

#include "livens/multibody/assembly.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/time/time_mesh.h"

namespace livens {

/// Continuous X of degree p per element, nodes and quadrature at Gauss-Lobatto points; order 2p at element
/// ends.
struct Lobatto {
    int degree = 4;   ///< 1..16
};

/// Classical rules, one step per element: independent witnesses.
struct Midpoint {};   ///< energy-momentum midpoint rule, order 2
struct Endpoint {};   ///< implicit Euler, order 1

using Method = std::variant<Lobatto, Midpoint, Endpoint>;

/// What is given at the ends of time; in this version the whole state at the start.
struct Boundary {
    State start;
};

struct SolveOptions {
    /// Newton stops when the estimated error of the scaled increment is below this (relative to the motion
    /// inside the element, at least to 1e-6 of the model's length), or at the rounding level of the residual.
    double tolerance = 1e-12;
    int max_iterations = 30;
    StartPolicy initial = StartPolicy::check;
    ProgressCallback progress;
    int threads = 0;   ///< reserved
};

struct Solution {
    Motion motion;   ///< up to the last good element end
    SolveReport report;
};

/// Throws InputError for wrong input (degree outside 1..16, a start that does not fit, see assemble()).
/// Numerical failure is in the report.
Solution solve(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
               const SolveOptions& options = {});

/// The state at any instant in the full order of the method: one shortened element is solved from the start
/// of the element that contains t (from the stored end state). Status and message are in the report.
struct ExactSample {
    State state;
    SolveReport report;
};
ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options = {});

}   // namespace livens
