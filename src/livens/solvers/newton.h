// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration: one damping and one stopping rule for whatever can be put as a NewtonProblem.
#pragma once

#include <functional>
#include <span>

#include "livens/solvers/report.h"
#include "livens/solvers/room.h"

namespace livens::inline solvers_internal {

/// A system of equations at a current point, as Newton's iteration sees it: no mechanics, no matrices.
///
/// There are two points: the kept one, to which increments are added, and the current one, at which rows and
/// tangents are made. Spans have n_unknowns() numbers.
class NewtonProblem {
public:
    /// What the rows of the last residual() say.
    struct Rows {
        double size = 0;         ///< of the largest scaled row
        double terms = 0;        ///< largest term in any row, scaled alike
        double rounding = 0;     ///< level of the rows' rounding; 0: not known
        bool foretell = false;   ///< rows and increments shrink alike: the next increment is about
                                 ///< size_of(dx) * size / (size before)
        double correction = 0;   ///< what move() still leaves beside dx, in the measure of size_of(): a pull
                                 ///< back onto constraints was of this size; 0: nothing
    };

    NewtonProblem() = default;
    NewtonProblem(const NewtonProblem&) = delete;
    NewtonProblem& operator=(const NewtonProblem&) = delete;
    virtual ~NewtonProblem() = default;

    /// Constant during a run.
    virtual int n_unknowns() const = 0;
    /// Rows at the current point. False: not finite.
    virtual bool residual() = 0;
    /// Tangent at the current point, whose residual() was the last, and its factors. False: singular or not
    /// finite.
    virtual bool factorise() = 0;
    /// dx = -J^-1 r with the last factors and the last rows.
    virtual void solve(std::span<double> dx) = 0;
    /// The current point becomes the kept one moved by damping * dx: a retraction, which may also pull back
    /// onto constraints. Damping 0 is the way back: the kept point as it was. False: not finite.
    virtual bool move(std::span<const double> dx, double damping) = 0;
    /// The current point becomes the kept one.
    virtual void keep() = 0;
    /// Size of an increment, in lengths, radians, impulses; nan or inf if one of its numbers is.
    virtual double size_of(std::span<const double> dx) const = 0;
    /// What the tolerance is relative to, at the current point; asked after residual().
    virtual double scale() const { return 1; }
    virtual Rows rows() const = 0;
    /// Condition numbers of the matrix at the current point, or a note on why there are none; 0 once
    /// `goes_on` says false.
    virtual void measure_condition(SolveReport&, const std::function<bool()>& /*goes_on*/) {}
};

struct NewtonOptions {
    double tolerance = 1e-12;   ///< next increment + Rows::correction <= tolerance * scale(), and, where rows
                                ///< foretell, Rows::size <= tolerance * Rows::terms
    int max_iterations = 30;    ///< accepted steps <= max_iterations
    std::function<bool(int iterations)> goes_on;   ///< asked before each factorisation; false:
                                                   ///< cancelled
};

struct NewtonReport {
    SolveStatus status = SolveStatus::converged;
    int iterations = 0;   ///< accepted steps
    int factorisations = 0;
    bool took_slopes = false;            ///< of stiff loads, in steps without a tangent of the whole
    int slope_factors = 0;               ///< made for these; 0: one from an element before served
    bool has_dear_factor = false;        ///< of these: the next element had better be as long
    bool is_dearer_than_short = false;   ///< shorter elements would do without these, and cost less
    bool reached_limit = false;   ///< of iterations; else not_converged means that no step, however short,
                                  ///< made the increment smaller
    bool ended_by_rounding = false;   ///< converged, but short of the tolerance
    double residual = 0;           ///< Rows::size / Rows::terms where it ended; inf if rows were not finite
    double last_increment = 0;     ///< size of the last increment applied, damping included
    double contraction = 0;        ///< next increment, foretold or solved for, over the last whole one
    double smallest_damping = 1;   ///< of the accepted steps
};

/// Newton's iteration, damped by the natural level function [Deuflhard2011, section 3.3], with factors that
/// stay in use while they contract.
///
/// A step is accepted if the next increment with the same factors is at most (1 - damping/4) of this one. It
/// is foretold by the rows where they do so and that suffices, else solved for; a step that is not accepted
/// is halved, down to 1/1024, or with old factors undone for new ones. The next damping is at most doubled.
///
/// Converged with damping 1 at the tolerance (see NewtonOptions), or at rounding, that is
///
///     next > size/4  and  Rows::size < 4 Rows::rounding,   or   next > size/2, size < 1e-9, factors new
///
/// An increment that was solved for and met the tolerance is applied too; it does not count as an iteration.
/// New factors are made after a damped step, where the next increment is more than 0.3 of the last (an
/// estimate where it is only foretold), after a foretold step above 0.1, and where more than nine whole steps
/// in a row are foreseen.
class Newton {
public:
    /// From the current point of the problem, which becomes the kept one. Afterwards the current point is the
    /// kept one, rows made there, whatever the status: the solution, or the last point accepted. Status
    /// not_finite: the first rows, or those after the shortest step; singular: factorise() said so or an
    /// increment is not finite. Allocates nothing from the second run on, if unknowns are no more.
    NewtonReport run(NewtonProblem& problem, const NewtonOptions& options);

private:
    Room increment_, next_;
};

}   // namespace livens::inline solvers_internal
