// SPDX-License-Identifier: BSD-3-Clause
// The entry point: takes model, conditions, time and method; returns motion and report.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/estimate.h"
#include "livens/diagnostics/sample.h"
#include "livens/spacetime/options.h"
#include "livens/spacetime/problem.h"

namespace [[gnu::visibility("default")]] livens {

struct Solution {
    Motion motion;        ///< up to the last good element end
    Method method;        ///< as used, with the degree if it was left open
    SolveReport report;   ///< status `suspect` if the verdict has reasons; its message is the first
    Verdict verdict{};
    ErrorEstimate estimate{};
    /// Growth factor of an initial perturbation at element ends (both in model lengths and rad); empty if not
    /// requested, shorter if the neighbouring motion failed.
    std::vector<double> growth{};
    /// Accumulated rounding errors at element ends, in model lengths and rad; empty if 2^-53 times the growth
    /// is a sufficient estimate.
    std::vector<double> rounding{};
    Growing growing{};              ///< the part that grows most, up to the horizon or the end
    Growing rounding_in{};          ///< likewise for `rounding`
    std::vector<Unseen> unseen{};   ///< findings on load laws inside elements, see Unseen
    double estimate_seconds = 0;    ///< time of the second solution and the neighbouring motion
    /// Why the motion cannot begin, if that follows from the preceding motion; solve() throws it.
    std::optional<Complaint> cannot_begin{};
};

/// Throws InputError for invalid input (degree out of range, inconsistent initial state, see
/// consistent_start(), pairings or conditions without a solvable system, `mass-singular` if the method needs
/// the inverse of m). Numerical failure is reported in the report.
/// With an accuracy, the motion has an error estimate below it, or the status `inaccurate`.
Solution solve(const Model& model, const Problem& problem, const Time& time, const Method& method,
               const SolveOptions& options = {});

/// Called by solve() before judge(), if requested and if the iteration converged: computes a second solution
/// and its distance from the first, and growth() if requested. If the second solution fails, the report gives
/// the reason. Lack of memory or cancellation never discards the motion; the report says what is not known.
void estimate(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              Solution& solution);

/// Growth factors, at element ends, of a small initial perturbation of all positions and velocities
/// (velocities divided by the fastest rate). Computed from neighbouring motions over the same elements, which
/// are rescaled as they separate; the larger of two if the first grows strongly (docs/theory.md,
/// "The horizon"). Empty if nothing can move, or without an initial state.
struct Growth {
    std::vector<double> factors{};
    Growing part{};
    double later = 1;                 ///< bound of the growth of later perturbations
    std::vector<double> rounding{};   ///< growth of errors of 1 at the start and in each element
    Growing rounding_in{};
};
/// `told`: if 2^-53 times the growth exceeds this, in model lengths and rad, or beyond the horizon, the
/// growth of rounding errors is measured separately.
Growth growth(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              const Motion& motion, double told = std::numeric_limits<double>::infinity());

/// The last step of solve(): measures the motion, compares it with the conditions at both ends, and decides
/// between converged and suspect; an available error estimate is taken into account. The motion remains
/// unjudged half a second of CPU time after `goes_on` returns false, or if memory is exhausted: a note says
/// so, the verdict has no figures, and a converged motion becomes `cancelled` or `suspect`.
void judge(const Model& model, const Problem& problem, const SolveOptions& options, Solution& solution,
           const std::function<bool()>& goes_on = {});

/// Throws the same errors as solve() for this input, without solving.
void check_method(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options = {});

/// State and reactions at any time in the full order of the method: solves one shortened element from the
/// start of the element that contains t (from the stored end state). Status and message are in the report. A
/// degree that was left open is that of the motion.
struct ExactSample {
    State state;
    std::vector<JointSample> joints;   ///< as from sample_joints(), at acceleration level
    SolveReport report;
};
ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options = {});

/// sample_exactly() at many times: results that depend on model and motion alone are computed once.
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
};

}   // namespace gnu::visibility("default")]]livens
