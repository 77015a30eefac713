// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/kernel/march_kernel.h"

#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/spacetime/instructions.h"
#include "livens/spacetime/nodal/system.h"

namespace livens {

namespace {

constexpr double slow_contraction = 0.3;
constexpr int most_slow_steps = 2, most_steps = 14, few_steps = 3;
constexpr int most_combinations = 150, most_slow_combinations = 20;
constexpr double hopeless_step = 10;      // lengths or radians
constexpr double smallest_step = 1e-18;   // likewise: nothing moves
// Of the motion: what steps that shrink no more may be; also by the smallest squared pivot, and at most.
constexpr double least_rounding = 1e-14, rounding_by_pivot = 4e-16, most_rounding = 1e-13;
constexpr double fits_on_the_way = 1e-2;   // times the smallest pivot: motion at which a factor is still good
constexpr double fits_at_end = 1e-4;       // for multipliers, whose last change it takes with this error
constexpr double fits_for_next = 1e-8;     // NearFactor
constexpr double least_pivot = 1e-5;       // of the rows' own size
constexpr double share_of_tolerance = 0.1;   // left after the last step, as far as contraction foretells it
// Lengths or radians from a motion nearby, beyond which it is not followed: it may have met a root that is
// none.
constexpr double farthest_parting = 1e-3;
constexpr int elements_alone = 16;          // behind one that was not found so
constexpr double widest_tolerance = 1e-4;   // beyond, two steps hardly tell how they shrink

/// Whether some body's axis of turning turns itself. Where none does, as in a plane, nothing is gyroscopic.
bool turns_in_space(const Tables& tables, const InstantState& start, double h)
{
    const std::vector<double>& accelerations = start.acceleration[h > 0 ? 1 : 0];
    return std::ranges::any_of(tables.bodies, [&](const BodyTable& body) {
        const double *w = start.velocity.data() + body.first + 3, *a = accelerations.data() + body.first + 3;
        if (body.dofs == 3) return false;
        const Vector3 turn{w[0], w[1], w[2]}, change{a[0], a[1], a[2]}, across = cross(turn, change);
        return dot(across, across) > 1e-16 * dot(turn, turn) * dot(change, change);
    });
}

const lanes::Functions* functions_for(int n_lanes)
{
    if (n_lanes == 1) return lanes::sse2(1);   // there is nothing beside it
    switch (instructions()) {
    case Instructions::avx512:
        return lanes::avx512(n_lanes);
    case Instructions::avx2:
        return lanes::avx2(n_lanes);
    case Instructions::sse2:
        break;
    }
    return lanes::sse2(n_lanes);
}

/// How steps shrink, and whether what is left is small enough.
struct Shrinking {
    double tolerance;
    bool has_contracted;   // at first: the guess may be right to rounding
    int n_steps = 0, n_slow = 0;
    double step = 0, contraction = 0;
    bool is_done = false, is_rounded = false;

    /// False: there is no hope.
    bool take(const lanes::Sizes& sizes, double rounding)
    {
        const double motion = std::clamp(sizes.motion, 1e-6, 1.0), allowed = tolerance * motion,
                     before = step;
        step = sizes.step;
        contraction = before > 0 ? step / before : 0;
        ++n_steps;
        is_done = step <= smallest_step;
        if (n_steps == 1 || is_done) return step < hopeless_step;
        const bool is_slow = !(contraction <= slow_contraction);
        // steps that were seen to shrink, and shrink no more, have met their rounding
        is_done = is_slow ? has_contracted && step <= std::max(allowed, rounding * motion)
                          : step * contraction / (1 - contraction) <= share_of_tolerance * allowed;
        is_rounded = is_done && is_slow && step > allowed;
        has_contracted = has_contracted || !is_slow;
        n_slow += is_slow ? 1 : 0;
        return is_done || n_slow < most_slow_steps;
    }
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
};

}   // namespace

MarchKernel::MarchKernel(const Tables& tables, const ElementRule& rule) : tables_(tables), rule_(rule)
{
    if (rule.points != Points::lobatto || !JointFactor::serves(tables)) return;
    functions_ = functions_for(rule.degree);
    if (!serves()) return;
    make_rule();
    work_.twist.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
    for (auto* v : {&work_.X, &work_.V, &work_.raw}) v->assign(12 * tables.bodies.size(), 0.0);
    work_.wrenches.assign(12 * tables.bodies.size(), 0.0);
    guess_.polynomial = Extrapolation(rule, *functions_);
    for (Guess::End* end : {&guess_.by_series, &guess_.by_polynomial})
        end->place.assign(7 * tables.bodies.size(), 0.0);
}

/// Lanes of the tables of lanes::Rule for an element of length 1, and room for another length.
void MarchKernel::make_rule()
{
    const int p = rule_.degree, W = functions_->width, n = rule_.size(), block = W * W;
    scaled_.numbers.assign(static_cast<std::size_t>(8 * block + 2 * W), 0.0);
    double *k = scaled_.numbers.data(), *inverse = k + block, *M = inverse + block, *dM = M + block,
           *M_rows = dM + block, *scaled_k = M_rows + block, *scaled_inverse = scaled_k + block,
           *scaled_dM = scaled_inverse + block, *weights = scaled_dM + block;
    const std::vector<double> K = inverse_of_k(rule_);
    for (int l = 0; l < p; ++l) {
        for (int A = 0; A < p; ++A) {
            k[l * W + A] = rule_.k[static_cast<std::size_t>(A * n + node_of(l))];
            inverse[A * W + l] = -K[static_cast<std::size_t>((node_of(l) - 1) * p + A)];
            M[l * W + A] = rule_.M[static_cast<std::size_t>(A * n + node_of(l))];   // here A is a load point
            dM[l * W + A] = rule_.dM[static_cast<std::size_t>(A * n + node_of(l))];
            M_rows[A * W + l] = rule_.M[static_cast<std::size_t>(A * n + l)];
        }
    }
    scaled_.tables = {scaled_k, scaled_inverse, weights, M, scaled_dM, M_rows, nullptr, tables_.length};
}

void MarchKernel::scale_rule(const Stretch& stretch, const InstantState& start)
{
    scaled_.tables.momentum = start.momentum.data();
    const int few = scaled_.tables.in_still_axes ? few_steps - 1 : few_steps;   // which they made so few
    scaled_.tables.in_still_axes = last_steps_ > few && turns_in_space(tables_, start, stretch.h(0));
    if (stretch.h(0) == scaled_.h) return;
    scaled_.h = stretch.h(0);
    const int W = functions_->width, block = W * W;
    const double h = scaled_.h, *k = scaled_.numbers.data();
    double *scaled = scaled_.numbers.data() + 5 * block, *weights = scaled + 3 * block;
    const auto scale = [block](const double* __restrict of, double* __restrict to, auto&& by) {
        for (int i = 0; i < block; ++i) to[i] = by(of[i]);
    };
    scale(k, scaled, [h](double x) { return x / h; });
    scale(k + block, scaled + block, [h](double x) { return x * h; });
    scale(k + 3 * block, scaled + 2 * block, [h](double x) { return x / h; });
    for (int A = 0; A < rule_.degree; ++A) weights[A] = scaled_.h * rule_.weights[A];
}

void MarchKernel::use(const InstantState& start)
{
    start_ = &start.held.joints;
    if (pattern_ == start_->pattern()) return;
    pattern_ = start_->pattern();
    nodes_.resize(*pattern_, functions_->width);
    guess_.polynomial.forget();
    const std::vector<int>&chosen = pattern_->chosen(), &order = pattern_->rows();
    std::vector<int> places(static_cast<std::size_t>(tables_.n_rows()));
    for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<int>(i);
    place_.clear();
    for (const int row : chosen) place_.push_back(places[row]);
}

/// Loads at their points, and the sum of their wrenches about the centres of mass.
void MarchKernel::evaluate_loads(const Stretch& stretch)
{
    if (tables_.model->loads().empty()) return;
    const int W = functions_->width;
    const lanes::Pattern& pattern = pattern_->view();
    functions_->interpolate(pattern, start_->values(), nodes_.values(), scaled_.tables);
    std::fill(work_.wrenches.begin(), work_.wrenches.end(), 0.0);
    for (int c = 0; c < rule_.degree; ++c) {
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (!pattern.bodies[b].loaded) continue;
            const double* center = tables_.bodies[b].center;
            double *X = work_.X.data() + 12 * b, *V = work_.V.data() + 12 * b;
            for (int i = 0; i < 12; ++i) {
                X[i] = nodes_.values().load_X[(12 * b + i) * W + c];
                V[i] = nodes_.values().load_V[(12 * b + i) * W + c];
            }
            for (int i = 0; tables_.bodies[b].offset && i < 3; ++i)
                for (int a = 0; a < 3; ++a) {
                    X[i] -= center[a] * X[3 + 3 * a + i];
                    V[i] -= center[a] * V[3 + 3 * a + i];
                }
        }
        if (c == 0) work_.angles = stretch.angles;
        tables_.loads.turns.follow(Configurations(work_.X.data()), work_.angles);
        std::fill(work_.raw.begin(), work_.raw.end(), 0.0);
        tables_.loads.add(stretch.load_point(rule_, 0, c), work_.X.data(), work_.V.data(),
                          stretch.h(0) * rule_.loads.weights[c], work_.raw.data(), work_.angles);
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (!pattern.bodies[b].loaded) continue;
            double *F = work_.raw.data() + 12 * b, wrench[6];
            for (int a = 0; a < 3; ++a)
                for (int i = 0; i < 3; ++i) F[3 + 3 * a + i] -= tables_.bodies[b].center[a] * F[i];
            for (int i = 0; i < 12; ++i) nodes_.values().loads[(12 * b + i) * W + c] = F[i];
            twist::rows(work_.X.data() + 12 * b, F, wrench);
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) work_.wrenches[6 * b + i] += wrench[i];
        }
    }
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
    return std::max(far / scaled_.tables.length, wide);
}

bool MarchKernel::iterate(const Stretch& stretch, const InstantState& start, const NewtonOptions& options,
                          bool is_accelerated, bool may_follow, NewtonReport& report)
{
    const bool follows = may_follow && follow(stretch);
    if (!follows) guess(stretch, start);
    guess_.was_followed = follows;
    const lanes::Pattern& pattern = pattern_->view();
    const lanes::Values &nodes = nodes_.values(), &from = start_->values();
    const int most = is_accelerated ? most_combinations : std::min(most_steps, options.max_iterations);
    lanes::Sizes sizes;
    Shrinking progress{std::min(options.tolerance, widest_tolerance), follows};
    if (is_accelerated) acceleration_.begin(static_cast<std::size_t>(pattern.n_twists * functions_->width));
    double moved = 0, pivot = 0;   // since the factor was made, lengths and radians; its own, squared
    for (int steps = 0;; ++steps) {
        functions_->configure(pattern, from, nodes);
        const double still_fits = progress.is_done ? fits_at_end : fits_on_the_way;
        if (steps == 0 || progress.n_slow > 0 || !(moved <= still_fits * pivot)) {
            functions_->factorise(pattern, nodes);
            pivot = *std::min_element(nodes.pivots, nodes.pivots + rule_.degree);
            moved = 0;
        }
        evaluate_loads(stretch);
        functions_->balance(pattern, from, nodes, scaled_.tables, steps == 0, sizes);
        evaluations_ += rule_.size();
        if (!std::isfinite(sizes.finite)) return false;
        if (progress.is_done) break;
        if (steps == most) return false;
        functions_->propose(pattern, nodes, scaled_.tables);
        const double left = is_accelerated ? size_of_proposal() : 0;
        if (is_accelerated) acceleration_.apply(nodes.step);
        functions_->move(pattern, nodes, scaled_.tables, sizes);
        if (follows && steps == 0 && !(sizes.step <= farthest_parting)) return false;
        if (!std::isfinite(sizes.finite)) return false;
        moved += sizes.step;
        const double noise = std::clamp(rounding_by_pivot / pivot, least_rounding, most_rounding);
        if (!(is_accelerated ? progress.approach(left, sizes) : progress.take(sizes, noise))) return false;
    }
    double terms = sizes.terms;
    for (const double momentum : start.momentum) terms = std::max(terms, std::abs(momentum));
    has_near_factor_ = moved <= fits_for_next * pivot;
    report = {};
    report.iterations = progress.n_steps;
    report.last_increment = progress.step;
    report.contraction = progress.contraction;
    report.ended_by_rounding = progress.is_rounded;
    report.residual = terms > 0 ? sizes.rows / terms : sizes.rows;
    return std::min(pivot, from.pivots[0]) > least_pivot * least_pivot;   // false: also no number
}

bool MarchKernel::solve(const Stretch& stretch, const InstantState& start, const NewtonOptions& options,
                        bool soon, NewtonReport& report)
{
    is_solved_ = false;
    if (!start.held.by_joints) return false;
    use(start);
    scale_rule(stretch, start);
    const bool is_large = !soon && tables_.n_twists >= many_twists && options.max_iterations >= most_steps;
    const auto iterates = [&] {
        if (guess_.n_alone > 0) --guess_.n_alone;
        if (iterate(stretch, start, options, false, guess_.n_alone == 0, report)) return true;
        if (!guess_.was_followed) return false;
        guess_.n_alone = elements_alone;   // too near for steps that shrink fast, or too far
        return iterate(stretch, start, options, false, false, report);
    };
    if (!(is_large && last_steps_ > most_steps)) is_solved_ = iterates();
    if (is_large && !is_solved_) is_solved_ = iterate(stretch, start, options, true, false, report);
    last_steps_ = is_solved_ ? report.iterations : most_steps;
    if (is_solved_ && guess_.polynomial.serves()) {
        compare_guesses();
        nodes_.swap_places();
        guess_.polynomial.remember(nodes_.values().last_place, tables_.n_bodies(), stretch.times.front(),
                                   stretch.times.back());
    }
    return is_solved_;
}

void MarchKernel::impulses(int A, double* out) const
{
    for (std::size_t c = 0; c < place_.size(); ++c)
        out[c] = nodes_.values().impulses[place_[c] * functions_->width + A];
}

double MarchKernel::pivot(int A) const
{
    return std::sqrt(A == 0 ? start_->values().pivots[0] : nodes_.values().pivots[lane_of(A)]);
}

void MarchKernel::momentum(const Stretch& stretch, const InstantState& start, double* p)
{
    double* taken = work_.wrenches.data() + 6 * tables_.n_bodies();
    functions_->sum_impulses(pattern_->view(), start_->values(), nodes_.values(), taken);
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        for (int i = 0; i < body.dofs; ++i) {
            const double weight = i < 3 ? stretch.h(0) * body.weight[i] : 0;   // no moment about the centre
            p[body.first + i] =
                start.p[body.first + i] + weight + work_.wrenches[6 * b + i] + taken[6 * b + i];
        }
    }
}

}   // namespace livens
