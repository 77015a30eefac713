// SPDX-License-Identifier: BSD-3-Clause
// The one entry: model, conditions, time elements and method in; motion and report out.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/estimate.h"
#include "livens/dynamics/start/closing.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/method.h"
#include "livens/spacetime/problem.h"
#include "livens/time/time_mesh.h"

namespace [[gnu::visibility("default")]] livens {

struct SolveOptions {
    /// Newton stops when the estimated error of the scaled increment is below this (relative to the motion
    /// inside the element, at least to 1e-6 of the model's length), or at the rounding level of the residual.
    /// Elements of lobatto and radau: at 1e-10 at the latest where an estimate or a growth compares motions.
    double tolerance = 1e-14;
    int max_iterations = 30;
    StartPolicy initial = StartPolicy::check;
    ProgressCallback progress;
    int threads = 0;   ///< reserved
    /// What the motion may take in memory before a march to an accuracy is given up: it says beforehand only
    /// where it ends.
    double most_bytes = 8.0 * (1u << 30);
    /// Condition numbers of the whole matrix, in the report: of the last block (mixed), of all elements
    /// together, reduced to the free motions (lobatto).
    bool condition = false;
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

struct Solution {
    Motion motion;        ///< up to the last good element end
    Method method;        ///< that was taken: a degree that was left open is chosen
    SolveReport report;   ///< `suspect` if the verdict has reasons; the first of them is its message
    Verdict verdict{};
    ErrorEstimate estimate{};
    /// By how much a perturbation of the start has grown, at element ends, in lengths and rad by lengths and
    /// rad at the start; empty if nobody asked, as far as the neighbouring motion came if it failed.
    std::vector<double> growth{};
    /// What the rounding of numbers, at the start and on the way, has grown to, in lengths and rad, at
    /// element ends; empty where 2^-53 of the growth tells enough.
    std::vector<double> rounding{};
    Growing growing{};              ///< what of it grows most, up to the horizon or the end
    Growing rounding_in{};          ///< likewise of `rounding`
    std::vector<Unseen> unseen{};   ///< what laws of loads did inside of elements, see Unseen
    double estimate_seconds = 0;    ///< that the second solution and the neighbouring motion took
};

/// Throws InputError for wrong input (degree out of range, a start that does not fit, see close_start(),
/// pairings and conditions that make no solvable system, `mass-singular` where the method divides by m).
/// Numerical failure is in the report.
/// With an accuracy the motion comes with its estimate, or with the status `inaccurate`.
Solution solve(const Model& model, const Problem& problem, const Time& time, const Method& method,
               const SolveOptions& options = {});

/// What solve() does before it judges, if asked to and if the iteration converged: a second solution, and how
/// far it is from the first, where it fails the report says why; and growth(), if asked for. Nothing that
/// ends it (memory, the caller's word) costs the motion: the report says what is not known.
void estimate(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              Solution& solution);

/// By how much a small perturbation of all positions and velocities at the start (velocities by the fastest
/// rate there is) has grown at element ends: the larger of two, by neighbouring motions over the same
/// elements that are brought near again where they part (docs/theory.md, "The horizon"). Empty where nothing
/// can move, or without a state at the start.
struct Growth {
    std::vector<double> factors{};
    Growing part{};
    double later = 1;                 ///< bounds what perturbations on the way grow by
    std::vector<double> rounding{};   ///< what 1 at the start and in each element grows to
    Growing rounding_in{};
};
/// `told`: where 2^-53 of it would be more, in lengths and rad, or where it is beyond the horizon, what
/// rounding grows to is measured by itself.
Growth growth(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              const Motion& motion, double told = std::numeric_limits<double>::infinity());

/// What solve() does last: measures the motion, compares it with what was stated at the ends of time, and
/// lets the verdict decide between converged and suspect. An estimate that the solution has counts. Half a
/// second of CPU time after `goes_on` says no, or where memory ends, the motion stays unjudged: a note says
/// so, the verdict knows nothing, and what had converged is `cancelled` or `suspect`.
void judge(const Model& model, const Problem& problem, const SolveOptions& options, Solution& solution,
           const std::function<bool()>& goes_on = {});

/// Throws what solve() would throw for this input, without solving.
void check_method(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options = {});

/// State and reactions at any instant in the full order of the method: one shortened element is solved from
/// the start of the element that contains t (from the stored end state). Status and message are in the
/// report. A degree that was left open is that of the motion.
struct ExactSample {
    State state;
    std::vector<JointSample> joints;   ///< as sample_joints() has them, of the acceleration level
    SolveReport report;
};
ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options = {});

}   // namespace gnu::visibility("default")]]livens
