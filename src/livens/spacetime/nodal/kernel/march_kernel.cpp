// SPDX-License-Identifier: BSD-3-Clause
// The rows P_A r_A = 0 and the constraints Phi_B = 0 of one element of lobatto(p) by steps with the inverse
// of the free motion's constant tangent h^-1 K, projected node by node; when steps have shrunk enough, and
// when the element is left to Newton's iteration (docs/theory.md, "Without a tangent").
#include "livens/spacetime/nodal/kernel/march_kernel.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/nodal/kernel/kernel_tangent.h"

namespace livens {

namespace {

constexpr double slow_contraction = 0.3;   // of steps by slopes, and of what is about to meet rounding
constexpr double worse = 1.3;              // than the step before
constexpr double much_worse = 1.25;        // the second step by slopes mends stiff loads and constraints, too
constexpr double free_contraction = 0.6;   // of free bodies, whose steps cost a small part of a factor
constexpr int most_slow_steps = 2,
              most_slow_factors = 5,   // each of these steps is followed by a new factor
    most_kernel_steps = 14;
constexpr int most_combinations = 150, most_slow_combinations = 20;
constexpr double hopeless_step = 10;      // lengths or radians
constexpr double smallest_step = 1e-18;   // likewise: nothing moves
// Of the motion: what steps that shrink no more may be; also by the smallest squared pivot, and at most.
constexpr double least_rounding = 1e-14, rounding_by_pivot = 4e-16, most_rounding = 1e-13;
constexpr double rounding_of_rows = 4e-16;   // of the largest terms: as Newton's iteration has it
constexpr double rounding_of_places =
    1e-15;   // lengths or radians: less is rounding where joints' forces are large
constexpr double fits_on_the_way = 1e-2;   // times the smallest pivot: motion at which a factor is still good
constexpr double fits_at_end = 1e-4;       // for multipliers, whose last change it takes with this error
constexpr double fits_for_next = 1e-8;     // NearFactor
constexpr double least_pivot = 1e-5;       // of the rows' own size
constexpr double share_of_tolerance = 0.1;   // left after the last step, as far as contraction foretells it
// Lengths or radians from a motion nearby, beyond which it is not followed: it may have met a root that is
// none.
constexpr double farthest_parting = 1e-3;
constexpr double least_rate = 0.05;         // at which steps by slopes are taken to shrink
constexpr double widest_tolerance = 1e-4;   // beyond, two steps hardly tell how they shrink

/// Null: the kernel does not serve these rows, inertias or points.
const lanes::Functions* functions_of(const ModelTables& tables, const ElementRule& rule)
{
    return JointFactor::serves(tables) ? lanes::functions(rule.degree) : nullptr;
}

/// How steps shrink, and whether what is left is small enough.
struct Shrinking {
    double tolerance;
    bool has_contracted;   // at first: the guess may be right to rounding
    bool has_slopes = false, has_dear_factor = false;
    // Known of steps by slopes: of loads, and with joints' forces.
    double rows_rounding = 0, joints_rounding = 0;
    int n_steps = 0, n_slow = 0, n_hopeless = 0;
    double step = 0, contraction = 0;
    bool is_done = false, is_rounded = false;

    void know_terms(double of_rows, const TangentSlopes& slopes)
    {
        rows_rounding = rounding_of_rows * (of_rows + slopes.loads.terms());
        joints_rounding = rounding_of_rows * slopes.joints.terms();
    }
    /// False: there is no hope. `sums()`, of which rows round, is asked where it decides.
    bool take(const lanes::Sizes& sizes, double rounding, const auto& sums)
    {
        const double motion = std::clamp(sizes.motion, 1e-6, 1.0), allowed = tolerance * motion,
                     before = step;
        step = sizes.step;
        const double contraction_before = contraction;
        contraction = before > 0 ? step / before : 0;
        ++n_steps;
        is_done = step <= smallest_step;
        if (n_steps == 1 || is_done) return step < hopeless_step;
        const bool is_slow = !(contraction <= slow_contraction);
        const bool is_hopeless = !(contraction <= (has_slopes ? slow_contraction : free_contraction));
        // what slopes lack is not the same at each step: one that was good by chance foretells nothing
        const double rate =
            has_slopes ? std::max({contraction, contraction_before, least_rate}) : contraction;
        // steps that were seen to shrink, and shrink no more, have met their rounding
        const auto is_noise = [&] {
            return step <= std::max(allowed, rounding * motion) || sizes.rows <= rows_rounding ||
                   (step <= rounding_of_places &&
                    sizes.rows <= std::max(joints_rounding, rounding_of_rows * sums()));
        };
        const bool is_met = rate < 1 && step * rate <= share_of_tolerance * allowed * (1 - rate);
        // what shrinks slowly, but as it did, has not met it yet
        const bool is_stuck =
            is_slow && (has_slopes || is_hopeless || contraction > worse * contraction_before);
        is_done = (is_stuck && has_contracted && is_noise()) || (is_met && !(is_slow && has_slopes));
        is_rounded = is_done && is_slow && step > allowed;
        has_contracted = has_contracted || !is_slow;
        n_slow += is_slow ? 1 : 0;
        n_hopeless += is_hopeless && !is_first_mended() ? 1 : 0;
        return is_done || n_hopeless < (has_slopes ? most_slow_factors : most_slow_steps);
    }
    /// What it left of the first step says nothing of a factor that costs as much as many steps.
    bool is_first_mended() const { return has_dear_factor && n_steps == 2 && contraction <= much_worse; }
    /// The same of combined steps, which do not shrink one by one; `left` is what is proposed.
    bool approach(double left, const lanes::Sizes& sizes)
    {
        const double allowed = tolerance * std::clamp(sizes.motion, 1e-6, 1.0);
        const bool is_nearer = n_steps++ == 0 || left < step;
        n_slow = is_nearer ? 0 : n_slow + 1;
        if (is_nearer) step = left;   // the smallest so far
        is_done = left <= std::max(smallest_step, share_of_tolerance * allowed) ||
                  (left <= allowed && n_slow >= most_slow_steps);
        return is_done || (left < hopeless_step && n_slow < most_slow_combinations);
    }
    NewtonReport report(const lanes::Sizes& sizes, const std::vector<double>& momenta) const
    {
        double terms = sizes.terms;
        for (const double momentum : momenta) terms = std::max(terms, std::abs(momentum));
        NewtonReport made;
        made.iterations = n_steps;
        made.last_increment = step;
        made.contraction = contraction;
        made.ended_by_rounding = is_rounded;
        made.residual = terms > 0 ? sizes.rows / terms : sizes.rows;
        return made;
    }
};

}   // namespace

MarchKernel::MarchKernel(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), functions_(functions_of(tables, rule)),
      lane_rule_(tables, rule, functions_), wrenches_(tables, rule, functions_),
      guess_(tables, rule, functions_), choice_(tables, rule, functions_)
{}

void MarchKernel::use(const InstantState& start)
{
    start_ = &start.held.joints;
    if (pattern_ == start_->pattern()) return;
    pattern_ = start_->pattern();
    nodes_.resize(*pattern_, functions_->width);
    if (is_radau()) end_.resize(*pattern_, 1);
    // its places were in the room that was made anew
    guess_.forget_polynomial();
}

void MarchKernel::evaluate_loads(const WindowLayout& layout)
{
    if (tables_.model->loads().empty()) return;
    wrenches_.evaluate_loads(layout, pattern_->view(), start_->values(), nodes_.values(),
                             lane_rule_.in_lanes());
}

/// In lengths and radians.
double MarchKernel::size_of_proposal() const
{
    const int W = functions_->width;
    double far = 0, wide = 0;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const lanes::Body& body = pattern_->view().bodies[b];
        for (int l = 0; l < rule_.degree; ++l) {
            const double* y = nodes_.values().step + body.first * W + l;
            for (int i = 0; i < 3; ++i) far = std::max(far, body.inverse_root_mass * std::abs(y[i * W]));
            for (int i = 0; body.dofs == 6 && i < 3; ++i) {
                const double* s = body.spin + i;   // w = L^-T y_2
                wide = std::max(wide, std::abs(s[0] * y[3 * W] + s[3] * y[4 * W] + s[6] * y[5 * W]));
            }
        }
    }
    return std::max(far / tables_.length, wide);
}

/// With lobatto that of the start, whose numbers are scalars; with radau rows are where columns are.
const lanes::Values& MarchKernel::first_row()
{
    if (!is_radau()) return start_->values();
    const lanes::Values &from = nodes_.values(), &to = end_.values();
    const auto take = [W = functions_->width](const double* lanes, double* scalars, int n) {
        for (int i = 0; i < n; ++i) scalars[i] = lanes[i * W];
    };
    take(from.numbers, to.numbers, pattern_->n_numbers());
    take(from.gradients, to.gradients, pattern_->view().n_entries);
    take(from.factor, to.factor, pattern_->n_factor());
    return to;
}

/// A step, where the factor of loads is made anew unless it is kept. False: there is none.
bool MarchKernel::propose(const WindowLayout& layout, Steps kind)
{
    const lanes::Pattern& pattern = pattern_->view();
    if (has_slopes(kind)) {
        if (!choice_.is_kept()) {
            functions_->interpolate(pattern, start_->values(), nodes_.values(), lane_rule_.in_lanes());
            const bool is_good = choice_.tangent().factorise(layout, *start_, nodes_.values());
            choice_.factorised(is_good, layout.h(0));
            if (!is_good) return false;
        }
        choice_.tangent().propose(nodes_.values());
    } else {
        functions_->propose(pattern, nodes_.values(), lane_rule_.in_lanes());
    }
    functions_->project(pattern, nodes_.values());
    return true;
}

/// A round makes numbers of places, a factor of G G^T where it does not fit any more, loads and rows, and a
/// step. Behind the last step stands one more balance, without a step: rows, loads and multipliers are then
/// those of the places that are handed on. Comparisons are made so that they fail for what is not a number.
bool MarchKernel::iterate(const WindowLayout& layout, const InstantState& start, const NewtonOptions& options,
                          Steps kind, NewtonReport& report)
{
    const bool is_accelerated = kind == Steps::combined;
    guess_.place(layout, start, nodes_.values().place);
    const bool follows = guess_.was_followed();
    const lanes::Pattern& pattern = pattern_->view();
    const lanes::Values &nodes = nodes_.values(), &from = start_->values();
    const int few = kind == Steps::free ? choice_.most_free_steps() : most_kernel_steps;
    const int most = is_accelerated ? most_combinations : std::min(few, options.max_iterations);
    lanes::Sizes sizes;
    Shrinking progress{std::min(options.tolerance, widest_tolerance), follows};
    progress.has_slopes = has_slopes(kind);
    progress.has_dear_factor = kind == Steps::by_tangent && !choice_.tangent().is_reduced();
    if (is_accelerated) acceleration_.begin(static_cast<std::size_t>(pattern.n_twists * functions_->width));
    double moved = 0, pivot = 0;   // since the factor was made, lengths and radians; its own, squared
    for (int steps = 0;; ++steps) {
        functions_->configure(pattern, from, nodes);
        const double still_fits = progress.is_done ? fits_at_end : fits_on_the_way;
        // steps must not be slowed by the error of projections with an old factor
        if (steps == 0 || progress.n_slow > 0 || !(moved <= still_fits * pivot)) {
            functions_->factorise(pattern, nodes);
            pivot = *std::min_element(nodes.pivots, nodes.pivots + rule_.degree);
            moved = 0;
        }
        evaluate_loads(layout);
        functions_->balance(pattern, first_row(), nodes, lane_rule_.in_lanes(), steps == 0, sizes);
        evaluations_ += rule_.size();
        if (!std::isfinite(sizes.finite)) return false;
        if (progress.is_done) break;
        if (steps == most) return false;
        if (!propose(layout, kind)) return false;
        if (progress.has_slopes) progress.know_terms(sizes.terms, choice_.tangent().slopes());
        const double left = is_accelerated ? size_of_proposal() : 0;
        if (is_accelerated) acceleration_.apply(nodes.step);
        functions_->move(pattern, nodes, lane_rule_.in_lanes(), sizes);
        if (follows && steps == 0 && !(sizes.step <= farthest_parting)) return false;
        if (!std::isfinite(sizes.finite)) return false;
        moved += sizes.step;
        const double noise = std::clamp(rounding_by_pivot / pivot, least_rounding, most_rounding);
        const auto sums = [&] { return lane_rule_.largest_of_sums(nodes.increments); };
        const bool goes_on =
            is_accelerated ? progress.approach(left, sizes) : progress.take(sizes, noise, sums);
        if (!goes_on && kind == Steps::free) choice_.gave_up(progress.contraction, layout.h(0));
        if (!goes_on) return false;
        const bool is_slow =
            !progress.is_done && progress.contraction > slow_contraction && !progress.is_first_mended();
        if (progress.has_slopes && is_slow) choice_.forget_factor();   // rounding says nothing of it
    }
    has_near_factor_ = moved <= fits_for_next * pivot;
    report = progress.report(sizes, start.momentum);
    report.took_slopes = progress.has_slopes;
    report.slope_factors = choice_.n_factors();
    return std::min(pivot, from.pivots[0]) > least_pivot * least_pivot;   // false: also no number
}

/// Steps that earlier elements took come first, and behind steps of free bodies those by slopes. Where a
/// factor was kept from before, or is dear along the joints, another try makes new ones wherever steps are
/// slow. Of many bodies, whose tangent would be large, combined steps are the last.
bool MarchKernel::solve(const WindowLayout& layout, const InstantState& start, const NewtonOptions& options,
                        bool soon, NewtonReport& report)
{
    is_solved_ = false;
    if (!start.held.by_joints) return false;
    use(start);
    lane_rule_.use(layout, start, choice_.last_steps());
    choice_.begin(pattern_, layout);
    wrenches_.begin(layout);
    pattern_->forms().weigh_nodes(lane_rule_.times(), start_->values(), nodes_.values(), functions_->width);
    const bool is_large =
        !soon && tables_.n_twists >= many_twists && options.max_iterations >= most_kernel_steps;
    const auto iterates = [&](Steps kind) {
        guess_.begin();
        if (iterate(layout, start, options, kind, report)) return true;
        if (!guess_.was_followed()) return false;
        guess_.part();
        return iterate(layout, start, options, kind, report);
    };
    const auto tries = [&](Steps kind) {
        is_solved_ = iterates(kind);
        choice_.took(is_solved_ ? report.iterations : most_kernel_steps, is_solved_, has_slopes(kind));
        const bool is_by_tangent = is_solved_ && has_slopes(kind);
        report.is_dearer_than_short = is_by_tangent && choice_.is_dearer_than_short(report.slope_factors);
        report.has_dear_factor = is_by_tangent && choice_.is_dear();
        return is_solved_;
    };
    const bool was_kept = choice_.is_kept(), was_slow = choice_.last_steps() > most_kernel_steps;
    const auto by_slopes = [&](bool is_worth_another) {
        if (tries(Steps::by_tangent)) return true;
        const bool was_spared = !choice_.tangent().is_reduced();
        return (was_spared || is_worth_another) && tries(Steps::by_new_tangents);
    };
    bool is_done = choice_.by_tangent() && by_slopes(was_kept);
    if (!is_done && !choice_.by_tangent() && !(is_large && was_slow))
        is_done = tries(Steps::free) || by_slopes(false);
    if (is_large && !is_done) {
        is_solved_ = iterate(layout, start, options, Steps::combined, report);
        choice_.took(is_solved_ ? report.iterations : most_kernel_steps, is_solved_, false);
    }
    if (is_solved_ && guess_.learns()) {
        guess_.compare(nodes_.values().place);
        nodes_.swap_places();
        guess_.remember(nodes_.values().last_place, layout);
    }
    return is_solved_;
}

void MarchKernel::impulses(int A, double* out) const
{
    const int lane = is_radau() ? lane_of(A) : A;
    for (const int place : pattern_->places())
        *out++ = nodes_.values().impulses[place * functions_->width + lane];
}

/// The factor's pivots are squares.
double MarchKernel::pivot(int A) const
{
    return std::sqrt(A == 0 ? start_->values().pivots[0] : nodes_.values().pivots[lane_of(A)]);
}

void MarchKernel::momentum(const WindowLayout& layout, const InstantState& start, double* p)
{
    functions_->sum_impulses(pattern_->view(), first_row(), nodes_.values(), wrenches_.taken());
    wrenches_.momentum(layout, start, nodes_.values(), lane_rule_.in_lanes(), p);
}

}   // namespace livens
