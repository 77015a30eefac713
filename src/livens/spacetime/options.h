// SPDX-License-Identifier: BSD-3-Clause
// How a motion is solved, beside its method: tolerances, and what is asked for beside the motion.
#pragma once

#include <array>
#include <string_view>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/method.h"
#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

/// What a solution may use of the machine.
struct SolveResources {
    /// Threads that solve windows of several elements, the caller's included; no bit depends on their number.
    /// 0: as many as the machine has processors. A march, one element after the other, has no use for them.
    int threads = 1;
    /// What the motion may take in memory before a march to an accuracy is given up: it says beforehand only
    /// where it ends.
    double most_bytes = 8.0 * (1u << 30);
};

struct SolveOptions : SolveResources {
    /// Newton stops when the estimated error of the scaled increment is below this (relative to the motion
    /// inside the element, at least to 1e-6 of the model's length), or at the rounding level of the residual.
    /// Elements of lobatto and radau: at 1e-10 at the latest where an estimate or a growth compares motions.
    double tolerance = 1e-14;
    int max_iterations = 30;
    StartPolicy initial = StartPolicy::check;
    ProgressCallback progress;
    /// Condition numbers of the whole matrix, in the report: of the last block (mixed), of all elements
    /// together, reduced to the free motions (lobatto).
    bool condition = false;
    /// Motions that are looked for between both ends of time: other guesses may lead to others. How many
    /// there are nobody knows.
    int roots = 1;
    /// Elements of lobatto that fail, or meet a root of their equations that is none, are divided into two
    /// (from a state).
    bool divide = true;
    /// Elements of lobatto and radau end, beside their mesh, where the law of a load bends or jumps on the
    /// way (marches forwards).
    bool end_at_bends = true;
    /// Laws of loads that need not be smooth are compared inside of elements with what their load points have
    /// of them; false: as if they were smooth, for comparison.
    bool look_at_laws = true;
    /// Every window by Newton's iteration with its tangent: the reference for quicker ways to the same
    /// motion.
    bool by_newton = false;
    /// How far bodies may be from where a joint that begins to act holds them, in lengths, rad and of the
    /// fastest rate; at least the accuracy that is asked for. Farther off would be an impact, which ends the
    /// motion. Infinite: they are moved there, and nothing is said.
    double meeting = 1e-6;
    /// Bounces lower than this, of the scale of a stop's row, are left out: the stop closes. With an accuracy
    /// it is a thousandth of that.
    double lowest_hop = 1e-12;
    bool judge = true;   ///< false: the caller asks estimate() and judge() himself, or does without
    /// What tells the error of the motion, where it is judged.
    enum class Estimate {
        second,   ///< a second solution on the same mesh, of degree + 1 (lobatto from degree 4, under loads
                  ///< or in elements that hardly resolve the motion: + 2); mixed and the classical rules:
                  ///< by witness_of() them
        local,    ///< what every element loses by its velocity jump, grown as neighbouring motions part: one
                  ///< number for all bodies, too large by ten often; nothing of velocities and
                  ///< reactions (lobatto and radau on a mesh, state at the start)
        none
    } estimate = Estimate::second;
    /// Whether a neighbouring motion tells how perturbations grow, after the estimate (state at the start).
    bool growth = false;
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 3> words_of(SolveOptions::Estimate)
{
    return {"second", "local", "none"};
}

}   // namespace gnu::visibility("default")]]livens
