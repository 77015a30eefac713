// SPDX-License-Identifier: BSD-3-Clause
// The verdict: reasons for which a motion that a solver calls converged is suspect, each with its bound.
// theory.md, "What is diagnosed" and "The elements of the paper", Acceptance; bounds stand in
// acceptance_bounds.h.
#include "livens/diagnostics/acceptance.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/diagnostics/acceptance_bounds.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/detail/passed_balance.h"
#include "livens/diagnostics/largest.h"

namespace livens {
namespace {

/// Where something else says that elements are too long for the second solution as well: of 442 runs two were
/// called converged with ten times their estimated error, with a jump of 0.12 and with more energy lost than
/// the error would make.
constexpr double acceptable_unsure_error = 1e-3;
constexpr double unsure_jump = 0.1;
/// Of positions in lengths and rad: what a few steps lose of sixteen digits.
constexpr double rounding_at_start = 1e-13;
constexpr double doubtful_pivot = 1e-6;

/// Reasons, gathered. nan breaks every bound.
class Reasons {
public:
    explicit Reasons(std::vector<std::string>& reasons) : reasons_(reasons) {}

    void violation(double value, double bound, const char* where)
    {
        if (value <= bound) return;
        reasons_.push_back("constraints are violated by " + to_text(value, 3) + where);
    }
    void drift(double value, const char* what)
    {
        if (value <= acceptable_drift) return;
        reasons_.push_back(std::string("the balance of ") + what +
                           (std::isnan(value) ? " is not a number"
                                              : " is off by " + to_text(value, 3) + " of its largest value") +
                           "; more elements or a higher degree may help");
    }
    void zigzag(double value, double t, const char* what, bool has_blocks)
    {
        if (value <= acceptable_zigzag) return;
        reasons_.push_back(std::string(what) + " alternate from node to node near " + to_text(t, 6) +
                           " s (indicator " + to_text(value, 3) +
                           "): the elements are too long to resolve the motion, or Newton's method converged "
                           "to a spurious root; " +
                           (has_blocks ? "smaller blocks or more elements" : "more elements") + " may help");
    }
    void error(const ErrorEstimate& estimate, const Model& model, double bound)
    {
        if (estimate.largest <= bound) return;
        // Blamed on a law only where what it did unseen makes up half of the error.
        const bool is_law = estimate.unseen_load >= 0 && !(estimate.unseen < 0.5 * estimate.largest);
        reasons_.push_back(
            "its estimated error is " + to_text(estimate.largest, 3) + " (model lengths, or rad), of body '" +
            model.body_name(estimate.body) + "' at " + to_text(estimate.time, 6) + " s, by " +
            (is_law ? "what the law of load '" +
                          model.loads()[static_cast<std::size_t>(estimate.unseen_load)].name +
                          "' does inside the element that ends at " + to_text(estimate.unseen_time, 6) +
                          " s, between the points at which it is evaluated; shorter elements there, or an "
                          "accuracy instead of elements, may help"
                    : std::string("a second, finer solution; more elements or a higher degree may help")));
    }
    void unsure(double error, double jump, double drift)
    {
        const bool has_jump = jump > unsure_jump;
        if (!reasons_.empty() || !(error > acceptable_unsure_error) || !(has_jump || drift > error)) return;
        reasons_.push_back(
            "its estimated error, " + to_text(error, 3) +
            ", may be too small: " + "the time elements are too long, for the second solution as well (" +
            (has_jump ? "velocity jump " + to_text(jump, 3) : "energy error " + to_text(drift, 3)) +
            "); use about twice as many, or an accuracy");
    }
    void jump(double value, double t)
    {
        if (value <= acceptable_velocity_jump) return;
        reasons_.push_back(
            "the velocity of the momentum and that of the polynomial differ at the end of the element at " +
            to_text(t, 6) + " s (jump " + to_text(value, 3) +
            "): the element is too long to resolve the motion, or Newton's method converged to a spurious "
            "root; more elements may help");
    }
    void distance(double value, double t)
    {
        if (value <= acceptable_distance) return;
        reasons_.push_back("the motion is " + to_text(value, 3) +
                           " of the model length away from a lobatto solution on the same elements, from "
                           "which it departs near " +
                           to_text(t, 6) +
                           " s: one of the two is wrong; smaller blocks, more elements or a higher degree "
                           "may help");
    }

    void turn(const Load& load, double t)
    {
        reasons_.push_back("the load '" + load.name + "' has lost count of its turns at t = " +
                           to_text(t, 6) + " s: " + load.domain + ", so its force is wrong from there on");
    }

private:
    std::vector<std::string>& reasons_;
};

/// `some`: longer motions' series are made again where they are needed.
void measure(Verdict& v, const Model& model, const Motion& motion, bool holds_weakly, int some = 4096)
{
    const bool is_short = motion.n_elements() < some;
    const auto series = std::make_shared<MotionSeries>();
    MotionPass pass(model, motion, {true, true, is_short && has_own_integrals(model, motion), is_short});
    v.balance = passed_balance(
        model, motion, some,
        [&](Balance& piece) {
            if (is_short) series->balance = std::move(piece);
        },
        pass);
    v.violations = pass.figures().violations;
    if (holds_weakly) add_weak_violations(model, motion, v.violations);
    const ViolationReport& off = v.violations;
    v.max_constraint_violation = off.joints_at_nodes;
    raise_to(v.max_constraint_violation, off.rigidity_at_nodes);
    v.max_velocity_violation = off.velocity_level;
    v.max_weak_violation = off.joints_weakly;   // 0 where they were not asked for
    raise_to(v.max_weak_violation, off.rigidity_weakly);
    if (is_short) {
        series->integrals = std::move(pass.figures().integrals);
        series->nodes = std::move(pass.figures().nodes);
        v.series = series;
    }
    // Radau loses energy by design; only a rise is held against it (theory.md, "What is diagnosed").
    v.energy_drift = motion.damps() ? v.balance.relative_energy_rise() : v.balance.relative_energy_drift();
    v.linear_momentum_drift = v.balance.relative_linear_momentum_drift();
    v.angular_momentum_drift = v.balance.relative_angular_momentum_drift();
    const Zigzag z = zigzag(model, motion);
    v.zigzag_positions = z.positions;
    v.zigzag_momenta = z.momenta;
    v.zigzag_time = z.worst_time;
    if (motion.constraints_hold != ConstraintsHold::at_nodes) return;
    const VelocityJump jump = velocity_jump(model, motion);
    v.velocity_jump = jump.largest;
    v.velocity_jump_time = jump.time;
}

}   // namespace

std::string in_words(const Growing& part, const Model& model)
{
    if (part.body < 0) return "no body";
    std::string words =
        "body '" + model.body_name(part.body) + "' " + (part.turns ? "turning about (" : "moving along (");
    for (int i = 0; i < 3; ++i) words += (i > 0 ? ", " : "") + to_text(part.direction[i], 2);
    return words + ")";
}

namespace {

/// By what rounding does, where that was measured.
void find_horizon(Verdict& v, const Model& model, const Motion& motion, std::span<const double> growth,
                  const Growing& part, std::span<const double> rounding, const Growing& rounding_in)
{
    // 2^-53: half a spacing of numbers at 1, the most that rounding to nearest takes.
    constexpr double spacing = 0.5 * std::numeric_limits<double>::epsilon();
    double first = Verdict::unknown;   // for any perturbation
    for (std::size_t e = 0; e < growth.size(); ++e) {
        if (e == 0) v.growth = 0;
        raise_to(v.growth, growth[e]);
        const bool is_measured = e < rounding.size();
        const double grown = growth[e] * rounding_at_start,
                     by_rounding =
                         is_measured ? std::min(grown, rounding[e] / spacing * rounding_at_start) : grown;
        if (std::isnan(first) && grown >= acceptable_error) first = motion.mesh.ends[e];
        if (std::isnan(v.horizon) && by_rounding >= acceptable_error) v.horizon = motion.mesh.ends[e];
    }
    if (std::isnan(v.horizon) && !std::isnan(first))
        v.remarks.push_back("a disturbance of 1e-13 at the start that moves " + in_words(part, model) +
                            " grows to 0.01 by " + to_text(first, 4) +
                            " s; those numbers stay exactly zero in this run, so rounding does not excite "
                            "it, but any other disturbance would");
    if (!std::isnan(v.horizon))
        v.remarks.push_back(
            "rounding errors at the start have grown to 0.01 by " + to_text(v.horizon, 4) + " s, most in " +
            in_words(rounding_in.body < 0 ? part : rounding_in, model) + ": the motion continues to " +
            to_text(motion.end(), 6) +
            " s, but beyond this horizon it is one of many that double precision cannot distinguish");
}

/// What the balances and the figures of nodes say, and how far the guess is.
void weigh(const Verdict& v, const SolveReport& report, bool holds_weakly, bool has_blocks, bool damps,
           Reasons& reasons)
{
    reasons.distance(report.guess_distance, report.guess_distance_time);
    reasons.violation(v.max_constraint_violation,
                      holds_weakly ? acceptable_nodal_violation : acceptable_violation, " at element nodes");
    reasons.violation(v.max_weak_violation, acceptable_weak_violation, " in the mean over an element");
    if (!damps)   // else an element rings within itself, once, where it damps
        reasons.zigzag(v.zigzag_positions, v.zigzag_time, "velocities", has_blocks);
    if (v.zigzag_momenta != v.zigzag_positions)   // else the momentum is that of the same velocities
        reasons.zigzag(v.zigzag_momenta, v.zigzag_time, "momenta", has_blocks);
    reasons.jump(v.velocity_jump, v.velocity_jump_time);
    reasons.drift(v.energy_drift, "energy");
    reasons.drift(v.linear_momentum_drift, "linear momentum");
    reasons.drift(v.angular_momentum_drift, "angular momentum");
}

}   // namespace

Measured::Measured(const Model& model, const Motion& motion)
    : version_(model.version()), numbers_(motion.X.values.data()), n_(motion.X.values.size())
{
    measure(figures_, model, motion, motion.constraints_hold == ConstraintsHold::weakly);
}

bool Measured::is_of(const Model& model, const Motion& motion) const
{
    return version_ == model.version() && numbers_ == motion.X.values.data() && n_ == motion.X.values.size();
}

Verdict measure_part(const Model& model, const Motion& part)
{
    Verdict v;
    measure(v, model, part, true, std::numeric_limits<int>::max());
    return v;
}

void weigh_weak(Verdict& verdict, const SolveReport& report)
{
    Reasons reasons(verdict.reasons);
    weigh(verdict, report, true, true, false, reasons);
}

Verdict judge(const Model& model, const Motion& motion, const SolveReport& report,
              const ErrorEstimate& estimate, std::span<const double> growth, const Growing& part,
              std::span<const double> rounding, const Growing& rounding_in, const Measured* measured)
{
    if (motion.n_elements() == 0) return {};   // nothing was solved, so there is nothing to judge
    const bool holds_weakly = motion.constraints_hold == ConstraintsHold::weakly;
    Verdict v = measured != nullptr && measured->is_of(model, motion) ? measured->figures()
                                                                      : Measured(model, motion).figures();
    if (report.smallest_pivot < doubtful_pivot)
        v.remarks.push_back("the constraints nearly lost rank (smallest pivot " +
                            to_text(report.smallest_pivot, 3) +
                            "): the mechanism passes near a singular position; an output time, a jump or "
                            "the end of time that falls on it keeps an element end there. With accuracy "
                            "instead of elements an output time does not");
    const double lost = motion.damps() ? v.balance.relative_energy_loss() : 0;
    if (lost > acceptable_drift)
        v.remarks.push_back("the method has damped " + to_text(lost, 3) +
                            " of the energy: either vibrations that its elements do not resolve, or the "
                            "elements are too long for the motion, which the estimated error shows");
    if (!estimate.empty()) {
        v.estimated_error = estimate.largest;
        v.estimated_digits = estimate.digits();
        v.estimated_error_time = estimate.time;
        const ErrorEstimate::Good good = estimate.good(motion.mesh);
        v.good_digits = good.digits;
        v.good_until = good.until;
    }
    find_horizon(v, model, motion, growth, part, rounding, rounding_in);
    // A motion that was broken off has its reason already; its figures are told all the same.
    if (!report.converged()) return v;
    Reasons reasons(v.reasons);
    const bool counts_turns = motion.constraints_hold == ConstraintsHold::at_nodes;
    const LostTurn turned = counts_turns ? LostTurn{} : find_lost_turn(model, motion);
    if (turned.load >= 0) reasons.turn(model.loads()[turned.load], turned.t);
    if (!estimate.empty()) reasons.error(estimate, model, std::max(acceptable_error, report.accuracy));
    if (report.accuracy == 0 && counts_turns)
        reasons.unsure(estimate.largest, v.velocity_jump, motion.damps() ? 0 : v.energy_drift);
    if (!report.estimate_failed.empty())
        v.reasons.push_back("the error is not known, since " + report.estimate_failed);
    const bool has_blocks = report.iterations.size() < static_cast<std::size_t>(motion.n_elements());
    weigh(v, report, holds_weakly, has_blocks, motion.damps(), reasons);
    return v;
}

}   // namespace livens
