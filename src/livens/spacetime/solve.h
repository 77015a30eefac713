// SPDX-License-Identifier: BSD-3-Clause
// The one entry: model, conditions, time elements and method in; motion and report out.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/estimate.h"
#include "livens/diagnostics/sample.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/options.h"
#include "livens/spacetime/problem.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace multibody_internal {
class WithRotors;
}   // namespace multibody_internal

/// What the motion decided.
struct SolvedEvent {
    int event = 0;   ///< of the model
    double t = 0;    ///< s
    /// Estimated, of t (s): by what that of the second solution differs, and rounding. nan: not known.
    double error = std::numeric_limits<double>::quiet_NaN();
    /// Of an impact: what the joint gave along its row, N s or N m s, and the speed with which its bodies
    /// met. 0: there was none.
    double impulse = 0, speed = 0;
    /// Of a stop that begins to hold: when bounces too low to be followed would be over, s. nan: it does not,
    /// and bodies bounce.
    double rests_at = std::numeric_limits<double>::quiet_NaN();
    double rounding = 0;   ///< what rounding of the state there makes of t, s
};

/// What the motion decided, and what that makes of the model.
struct Decided {
    std::vector<SolvedEvent> events{};   ///< in the order of the motion
    /// From there on (s) the second solution has other events, so that nobody knows these; nan: it has not.
    double undecided_from = std::numeric_limits<double>::quiet_NaN();
    /// With joints and loads as events had them begin and end, to which the motion belongs; null: there are
    /// no events.
    std::shared_ptr<const Model> decided{};
};

/// How errors grow along the motion.
struct GrowthOfErrors {
    /// By how much a perturbation of the start has grown, at element ends, in lengths and rad by lengths and
    /// rad at the start; empty if nobody asked, as far as the neighbouring motion came if it failed.
    std::vector<double> growth{};
    /// What the rounding of numbers, at the start and on the way, has grown to, in lengths and rad, at
    /// element ends; empty where 2^-53 of the growth tells enough.
    std::vector<double> rounding{};
    Growing growing{};       ///< what of it grows most, up to the horizon or the end
    Growing rounding_in{};   ///< likewise of `rounding`
};

struct Solution : Decided, GrowthOfErrors {
    Motion motion;        ///< up to the last good element end
    Method method;        ///< that was taken: a degree that was left open is chosen
    SolveReport report;   ///< `suspect` if the verdict has reasons; the first of them is its message
    Verdict verdict{};
    std::shared_ptr<const Measured> measured{};   ///< where its figures were asked for on the way
    ErrorEstimate estimate{};
    std::vector<Unseen> unseen{};   ///< what laws of loads did inside of elements, see Unseen
    double estimate_seconds = 0;    ///< that the second solution and the neighbouring motion took
    /// Why the motion has no beginning, where that is a matter of the motion before it, or an unknown number
    /// no value; solve() throws it.
    std::optional<Complaint> cannot_begin{};
    FoundNumbers numbers{};
    /// Where several motions were asked for: the others that were found, by their effort.
    std::vector<Solution> roots{};
    /// Of a model with inertias along coordinates the same with their points, see WithRotors: what estimate()
    /// goes on from. Null: it has none.
    std::shared_ptr<Solution> with_rotors{};
};

/// Throws InputError for wrong input (degree out of range, a start that does not fit, see consistent_start(),
/// pairings and conditions that make no solvable system, `mass-singular` where the method divides by m).
/// Numerical failure is in the report.
/// With an accuracy the motion comes with its estimate, or with the status `inaccurate`.
Solution solve(const Model& model, const Problem& problem, const Time& time, const Method& method,
               const SolveOptions& options = {});

/// A model with joints and loads as these events had them begin and end, in a motion that began at `start`
/// (s): Solution::decided.
Model decided_model(const Model& model, double start, std::span<const SolvedEvent> events);

/// By which several motions are ordered: the kinetic energy over all of time, J s.
double effort_of(const Model& model, const Motion& motion);

/// What solve() does before it judges, if asked to and if the iteration converged: a second solution, and how
/// far it is from the first, where it fails the report says why; and growth(), if asked for. Nothing that
/// ends it (memory, the caller's word) costs the motion: the report says what is not known.
void estimate(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              Solution& solution);

/// By how much a small perturbation of all positions and velocities at the start (velocities by the fastest
/// rate there is) has grown at element ends: the larger of two where the first one grows by much, by
/// neighbouring motions over the same elements that are brought near again where they part (docs/theory.md,
/// "The horizon"). Empty where nothing can move, or without a state at the start.
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

/// sample_exactly() at many instants: what follows from model and motion is found once.
class ExactSampler {
public:
    /// Model and motion must outlive it.
    ExactSampler(const Model& model, const Motion& motion, const Method& method,
                 const SolveOptions& options = {});

    ExactSample at(double t) const;

private:
    const Model& model_;
    const Motion& motion_;
    Method method_;
    SolveOptions options_;
    LoadTurns turns_;
    JointSampler joints_;
    std::shared_ptr<Prepared> prepared_;
    std::shared_ptr<const WithRotors> rotors_;   // null: there are none
};

}   // namespace livens
