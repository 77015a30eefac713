// SPDX-License-Identifier: BSD-3-Clause
// Whether a motion that a solver calls converged may be believed: bounds on figures of the motion itself.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/estimate.h"
#include "livens/solvers/report.h"

namespace [[gnu::visibility("default")]] livens {

/// Beyond this velocity jump an element has not seen the motion. Of 480 wrong runs of lobatto over 16
/// problems every one was beyond, of 1518 good ones none.
inline constexpr double acceptable_velocity_jump = 0.3;

/// What neighbouring motions part by most: where a body is, or how it is turned.
struct Growing {
    int body = -1;         ///< none: nobody asked
    bool turns = false;    ///< about the direction, else it moves along it
    Vector3 direction{};   ///< of length 1, world axes
};
/// "body 'b' turning about (0.1, 0.98, 0.1)"
std::string in_words(const Growing& part, const Model& model);

/// What nobody measured.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// How far constraints and balances are off, which hold in every true motion.
struct InvariantFigures {
    double max_constraint_violation = not_measured;   ///< at nodes, each row by its scale; rigidity included
    double max_velocity_violation = not_measured;     ///< |dPhi/dt| / scale at element ends, 1/s
    double max_weak_violation = not_measured;         ///< where constraints hold weakly: largest mean, else 0
    double energy_drift = not_measured;               ///< relative, see Balance
    double linear_momentum_drift = not_measured;
    double angular_momentum_drift = not_measured;
};

/// Whether elements are short enough to see the motion.
struct ResolutionFigures {
    double zigzag_positions = not_measured;   ///< 0 smooth to 1 pure zig-zag, see Zigzag
    double zigzag_momenta = not_measured;
    double zigzag_time = not_measured;   ///< of the worst of both, s
    double velocity_jump = 0;            ///< see VelocityJump; 0 where constraints do not hold at nodes
    double velocity_jump_time = not_measured;   ///< s
};

/// How far the motion may be from the true one.
struct ErrorFigures {
    double estimated_error = not_measured;        ///< largest of ErrorEstimate, if there is one
    double estimated_digits = not_measured;       ///< its negative decadic logarithm, 0 to 16
    double estimated_error_time = not_measured;   ///< where it is largest, s
    double good_digits = not_measured;            ///< see ErrorEstimate::good()
    double good_until = not_measured;             ///< likewise, s
    double growth = not_measured;    ///< largest of a perturbation of the start, where it was measured
    double horizon = not_measured;   ///< s, where 1e-13 has grown to 1e-2, if that is before the end
    /// Rounding at the start decides by then which of many motions is shown.
    bool is_beyond_horizon(double t) const { return t > horizon; }
};

/// What was measured of a motion, and what speaks against it. Figures are nan where there is no motion, and
/// in a verdict that nobody asked for.
struct Verdict : InvariantFigures, ResolutionFigures, ErrorFigures {
    static constexpr double unknown = not_measured;

    std::vector<std::string> reasons;   ///< why the motion is suspect, a line each; empty: it is not
    std::vector<std::string> remarks;   ///< what is worth a look and refuses nothing
    BalanceFigures balance;
    std::shared_ptr<const MotionSeries> series;   ///< of motions of up to 4095 elements
    ViolationReport violations;   ///< means only where constraints hold weakly, nothing between nodes
};

/// What judge() measures of a motion alone, for whoever judges it twice.
class Measured {
public:
    Measured(const Model& model, const Motion& motion);
    /// Whether it is what was measured, and nobody has written to it or solved it anew.
    bool is_of(const Model& model, const Motion& motion) const;
    const Verdict& figures() const { return figures_; }

private:
    std::uint64_t version_;
    const double* numbers_;
    std::size_t n_;
    Verdict figures_;
};

/// Figures of one of several parts of a motion by itself, with all its series: parts are joined by who has
/// them.
Verdict measure_part(const Model& model, const Motion& part);
/// Reasons that invariants and zigzags of a motion tell whose constraints hold weakly, as judge() has them.
void weigh_weak(Verdict& verdict, const SolveReport& report);

/// Measures a motion and, if the report says that it converged, judges it. It has a reason to be suspect if
///   |Phi| / scale at nodes > 1e-6, where constraints hold at points;
///   its mean over an element > 1e-3, or |Phi| / scale at nodes > 0.05, where they hold weakly (the latter
///   are errors of the discretisation, not of the solution, and fall with the elements);
///   Zigzag of positions or momenta > 0.5: elements too long to see the motion (positions of a method that
///   damps are left out: its elements ring once where they damp);
///   a velocity jump > 0.3, where constraints hold at nodes: the polynomial of an element does not see its
///   own momentum, because the element is too long or a spurious root; it is farther than 0.05 of the model's
///   length from the march it was guessed by, if it was; the relative drift of energy, linear or angular
///   momentum > 0.05; an estimated error > 1e-2 (or the accuracy asked for); a second solution that failed;
/// or if one of these figures is not a number.
/// `measured`: serves if it is of this motion.
Verdict judge(const Model& model, const Motion& motion, const SolveReport& report,
              const ErrorEstimate& estimate = {}, std::span<const double> growth = {},
              const Growing& part = {}, std::span<const double> rounding = {},
              const Growing& rounding_in = {}, const Measured* measured = nullptr);

}   // namespace gnu::visibility("default")]]livens
