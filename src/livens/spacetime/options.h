// SPDX-License-Identifier: BSD-3-Clause
// Options of solve() other than the method: tolerances and additional results.
#pragma once

#include <array>
#include <string_view>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/method.h"
#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

struct SolveOptions {
    /// Newton's iteration stops when the estimated error of the scaled increment is below this (relative to
    /// the motion within the element, but at least to 1e-6 model lengths), or at the rounding level of the
    /// residual. lobatto and radau use 1e-10 at most if an estimate or a growth compares motions.
    double tolerance = 1e-14;
    int max_iterations = 30;
    StartPolicy initial = StartPolicy::check;
    ProgressCallback progress;
    int threads = 0;   ///< reserved
    /// Memory limit in bytes for solutions to an accuracy, whose number of elements is not known in
    /// advance.
    double most_bytes = 8.0 * (1u << 30);
    /// Whether the report contains condition numbers: of the matrix of the last block (mixed), or of all
    /// elements together, reduced to the free motions (lobatto).
    bool condition = false;
    /// Whether elements of lobatto that fail, or converge to a spurious root, are divided in two (from a
    /// state).
    bool divide = true;
    /// Whether elements of lobatto and radau also end at kinks and jumps of loads that are detected during
    /// the solution (forward in time).
    bool end_at_bends = true;
    /// Whether load laws that may not be smooth are inspected inside elements, between quadrature points;
    /// false treats them as smooth, for comparison.
    bool look_at_laws = true;
    /// Solve every window by Newton's iteration with its tangent: the reference for faster algorithms with
    /// the same result.
    bool by_newton = false;
    /// Permitted violation of a joint when it engages, in model lengths, rad and relative to the fastest
    /// rate; at least the accuracy. A larger one would be an impact, which ends the motion. Infinite: the
    /// bodies are projected without notice.
    double meeting = 1e-6;
    bool judge = true;   ///< false: the caller calls estimate() and judge(), or omits them
    /// Error estimate of a motion that is judged.
    enum class Estimate {
        second,   ///< a second solution on the same mesh, of degree + 1 (lobatto from degree 4, under loads
                  ///< or in elements that hardly resolve the motion: + 2); mixed and the classical rules:
                  ///< by witness_of() them
        local,    ///< local errors from velocity jumps, amplified as neighbouring motions separate: one
                  ///< number for all bodies, often ten times too large; none for velocities and
                  ///< reactions (lobatto and radau on a mesh, given initial state)
        none
    } estimate = Estimate::second;
    /// Whether to measure the growth of perturbations by a neighbouring motion (given initial state).
    bool growth = false;
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 3> words_of(SolveOptions::Estimate)
{
    return {"second", "local", "none"};
}

}   // namespace livens
