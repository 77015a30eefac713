// SPDX-License-Identifier: BSD-3-Clause
// Steps of the march's kernel for motions that are 1e-7 to 1e-4 beside a known one (docs/theory.md, "The
// horizon", What it costs; "Without a tangent").
#include "livens/spacetime/accuracy/neighbour_elements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/start/prepared.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/nodal/kernel/kernel_tangent.h"

namespace livens {

namespace {

constexpr int most_beside_steps = 8, most_slow_beside = 3, most_slow_with_factor = 1;
constexpr int least_beside_degree = 3;   // of which polynomials go on to say something
// Contraction; and of steps of free bodies, which cost a small part of a factor.
constexpr double slow_beside = 0.3, free_beside = 0.6;
constexpr double farthest_beside = 1e-3;      // a step, lengths or radians
constexpr double least_pivot_beside = 1e-5;   // of the rows' own size
// By how much of what a projection takes off it errs with the factor of another neighbour.
constexpr double error_of_factor = 1e-2, error_at_end = 1e-4;
// Of the motion in the element, and of the largest terms of rows: what is rounding.
constexpr double rounding_of_steps = 1e-14, rounding_beside = 4e-16;
constexpr int many_beside_steps = 4;   // for which still axes are of use

const lanes::Functions* functions_beside(const ModelTables& tables, const ElementRule& rule)
{
    return JointFactor::serves(tables) ? lanes::functions(rule.degree) : nullptr;
}

/// A motion by this rule whose elements neighbours can go through.
bool is_known_to(const ModelTables& tables, const ElementRule& rule, const Motion& motion)
{
    const Field& X = motion.X;
    return rule.degree >= least_beside_degree && X.degree == rule.degree && X.points == rule.points &&
           X.denominators.empty() && (tables.loads.turns.size() == 0 || !motion.load_angles.empty());
}

}   // namespace

NeighbourEnds::NeighbourEnds(const ModelTables& tables, const ElementRule& rule, bool serves)
    : tables_(tables), rule_(rule), instant_(tables, serves), momentum_(tables.n_twists, 0.0),
      lambda_(tables.rows.size(), 0.0), rates_(12 * tables.bodies.size(), 0.0), raw_(rates_)
{}

bool NeighbourEnds::begin(BesideState& one, const State& start)
{
    for (InstantState& state : one.ends)
        if (state.X.empty()) state.resize(tables_);
    InstantState& here = one.here();
    here.t = start.t;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        std::copy_n(start.X[b].a, 12, here.X.begin() + 12 * b);
        const BodyTable& body = tables_.bodies[b];
        const Vector3 v = start.V[b].column(0),
                      w = body.dofs == 6 ? angular_velocity(start.X[b], start.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i) here.velocity[body.first + i] = i < 3 ? v[i] : w[i - 3];
    }
    if (!instant_.prepare(here, std::vector<int>(here.held.rows))) return false;
    instant_.from_velocity(here);
    return here.held.by_joints;
}

State NeighbourEnds::state(const BesideState& one) const
{
    const InstantState& here = one.here();
    State state;
    state.t = here.t;
    state.X.resize(tables_.bodies.size());
    state.V.resize(tables_.bodies.size());
    std::ranges::copy(here.X, state.X.front().a);
    tables_.bodies.rates_of(here.X.data(), here.velocity.data(), state.V.front().a);
    return state;
}

bool NeighbourEnds::reach(BesideState& one, const WindowLayout& layout, const lanes::Values& nodes, int width,
                          const NearFactor& near)
{
    const InstantState& here = one.here();
    InstantState& next = one.ends[1 - one.now];
    next.t = layout.times[1];
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const double *by = nodes.increments + 12 * b * width, *c = tables_.bodies[b].center,
                     *X = here.X.data() + 12 * b;
        double *to = next.X.data() + 12 * b, d[12];
        for (int i = 0; i < 12; ++i) d[i] = by[i * width];
        for (int i = 0; i < 3; ++i) d[i] -= d[3 + i] * c[0] + d[6 + i] * c[1] + d[9 + i] * c[2];
        for (int i = 0; i < 12; ++i) to[i] = X[i] + d[i];
    }
    const double h = layout.h(0);
    if (rule_.points == Points::radau) take_spin_of_polynomial(h, nodes, width, next);
    if (!instant_.prepare(next, here.held.rows, nullptr, near)) return false;
    instant_.from_momentum(next, momentum_.data(), h * rule_.weights[rule_.degree], lambda_.data());
    one.now = 1 - one.now;
    return true;
}

/// With radau that of the polynomial's own velocity (ElementEnd).
void NeighbourEnds::take_spin_of_polynomial(double h, const lanes::Values& nodes, int width,
                                            InstantState& next)
{
    const int p = rule_.degree;
    const double* D = rule_.D.data() + p * rule_.size();
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const double *d = nodes.increments + 12 * b * width, *c = tables_.bodies[b].center;
        double* V = rates_.data() + 12 * b;
        for (int i = 0; i < 12; ++i) {
            V[i] = 0;
            for (int B = 1; B <= p; ++B) V[i] += D[B] / h * d[i * width + (B == p ? 0 : B)];
        }
        for (int i = 0; i < 3; ++i) V[i] -= V[3 + i] * c[0] + V[6 + i] * c[1] + V[9 + i] * c[2];
    }
    tables_.bodies.map_twists(next.X.data(), next.maps.data());
    tables_.bodies.times_mass(rates_.data(), 1.0, raw_.data());
    tables_.bodies.twist_rows(next.X.data(), next.maps.data(), raw_.data(), rates_.data());
    for (const BodyTable& body : tables_.bodies)
        for (int i = body.first + 3; i < body.first + body.dofs; ++i) momentum_[i] = rates_[i];
}

NeighbourElements::NeighbourElements(const Model& model, Prepared& prepared, const Method& method,
                                     const Ends& closed, const Motion& motion)
    : tables_(model, closed.independent, false, prepared.pattern(model)), rule_(rule_of(method)),
      functions_(functions_beside(tables_, rule_)),
      serves_(functions_ != nullptr && is_known_to(tables_, rule_, motion)),
      known_(motion, tables_, rule_, serves_ ? functions_ : nullptr), ends_(tables_, rule_, serves_),
      lane_rule_(tables_, rule_, functions_), wrenches_(tables_, rule_, functions_),
      choice_(tables_, rule_, functions_)
{}

bool NeighbourElements::begin(BesideState& one, const State& start, double share)
{
    if (one.apart.empty()) one.apart.assign(known_.places().size(), 0.0);
    for (double& d : one.apart) d *= share;
    return ends_.begin(one, start);
}

void NeighbourElements::open(int element)
{
    known_.open(element);
    wrenches_.begin(known_.layout());
    is_new_ = true;
}

void NeighbourElements::guess(const BesideState& one, const BesideState* mirror)
{
    double* place = nodes_.values().place;
    if (mirror != nullptr)
        known_.guess_mirrored(mirror->apart.data(), place);
    else
        known_.guess(one.has_past && known_.is_behind_last() ? one.apart.data() : nullptr, place);
}

/// What does not hang on the iteration.
void NeighbourElements::use(BesideState& one)
{
    InstantState& here = one.here();
    if (pattern_ != here.held.joints.pattern()) {
        pattern_ = here.held.joints.pattern();
        nodes_.resize(*pattern_, functions_->width);
        if (rule_.points == Points::radau) end_row_.resize(*pattern_, 1);
        is_new_ = true;
    }
    here.acceleration[1] = known_.change();
    lane_rule_.use(known_.layout(), here, known_.turns_in_space() ? many_beside_steps : 0);
    choice_.begin(pattern_, known_.layout());
    pattern_->forms().weigh_nodes(lane_rule_.times(), here.held.joints.values(), nodes_.values(),
                                  functions_->width);
}

bool NeighbourElements::solve(BesideState& one, const BesideLimits& limits, const BesideState* mirror)
{
    if (!one.here().held.by_joints) return false;
    use(one);
    const auto tries = [&](bool by_tangent) {
        guess(one, mirror);
        return iterate(one, limits, by_tangent);
    };
    const bool is_stiff = choice_.by_tangent();
    if (!tries(is_stiff) && !tries(true)) return false;
    const lanes::Values& nodes = nodes_.values();
    for (std::size_t i = 0; i < one.apart.size(); ++i) one.apart[i] = nodes.place[i] - known_.places()[i];
    one.has_past = true;
    functions_->sum_impulses(pattern_->view(), first_row(one), nodes, wrenches_.taken());
    wrenches_.momentum(known_.layout(), one.here(), nodes, lane_rule_.in_lanes(), ends_.momentum());
    return ends_.reach(one, known_.layout(), nodes, functions_->width, factor_at_end(limits.apart));
}

/// Rows that are evaluated last tell by how much the step before has made them smaller.
bool NeighbourElements::iterate(BesideState& one, const BesideLimits& limits, bool by_tangent)
{
    lanes::Sizes sizes;
    double rows = 0;
    const int most = by_tangent ? most_beside_steps : std::max(most_beside_steps, choice_.most_free_steps());
    const auto end = [&](int steps, bool is_solved) {
        choice_.took(steps, is_solved, by_tangent);
        return is_solved;
    };
    for (int steps = 0, n_slow = 0, n_slow_by_slopes = 0;; ++steps) {
        evaluate(one, n_slow == 0 && limits.apart <= error_of_factor * pivot_, sizes);
        if (!std::isfinite(sizes.finite)) return end(most_beside_steps, false);
        const double shrinks = steps > 0 && rows > 0 ? sizes.rows / rows : 0;
        const bool is_slow = !(shrinks <= slow_beside);
        const bool is_rounding = sizes.step <= rounding_of_steps * std::min(sizes.motion, 1.0) ||
                                 sizes.rows <= rounding_beside * sizes.terms ||
                                 (is_slow && sizes.rows <= rounding_beside * lane_rule_.largest_of_sums(
                                                                                 nodes_.values().increments));
        const bool is_small = !is_slow && sizes.step * shrinks <= (1 - shrinks) * limits.left;
        if (steps > 0 && (is_rounding || is_small)) {
            const double pivot = std::min(pivot_, one.here().held.joints.values().pivots[0]);
            return end(steps, pivot > least_pivot_beside * least_pivot_beside);
        }
        if (!(shrinks <= (by_tangent ? slow_beside : free_beside))) ++n_slow;
        // rows do not know how far the guess is off the joints: what the first step leaves says nothing of it
        n_slow_by_slopes += is_slow && steps > 1 ? 1 : 0;
        if (n_slow_by_slopes > most_slow_with_factor &&
            by_tangent) {   // single ones are with a good one, too
            choice_.forget_factor();
            n_slow_by_slopes = 0;
        }
        rows = sizes.rows;
        const bool goes_on = n_slow < most_slow_beside && steps < most;
        if (!goes_on || !take_step(one, by_tangent, sizes)) return end(most_beside_steps, false);
    }
}

/// Rows and constraints at the places at hand.
void NeighbourElements::evaluate(const BesideState& one, bool has_factor, lanes::Sizes& sizes)
{
    const lanes::Pattern& pattern = pattern_->view();
    const lanes::Values &nodes = nodes_.values(), &from = one.here().held.joints.values();
    functions_->configure(pattern, from, nodes);
    if (is_new_ || !has_factor) {
        functions_->factorise(pattern, nodes);
        pivot_ = *std::min_element(nodes.pivots, nodes.pivots + rule_.degree);
    }
    if (!tables_.model->loads().empty())
        wrenches_.evaluate_loads(known_.layout(), pattern, from, nodes, lane_rule_.in_lanes());
    functions_->balance(pattern, first_row(one), nodes, lane_rule_.in_lanes(), is_new_, sizes);
    is_new_ = false;
}

/// False: it leads away, or there is none.
bool NeighbourElements::take_step(const BesideState& one, bool by_tangent, lanes::Sizes& sizes)
{
    const lanes::Pattern& pattern = pattern_->view();
    const lanes::Values &nodes = nodes_.values(), &from = one.here().held.joints.values();
    if (by_tangent && !choice_.is_kept()) {
        functions_->interpolate(pattern, from, nodes, lane_rule_.in_lanes());
        const bool is_good = choice_.tangent().factorise(known_.layout(), one.here().held.joints, nodes);
        choice_.factorised(is_good, known_.layout().h(0));
        if (!is_good) return false;
    }
    if (by_tangent)
        choice_.tangent().propose(nodes);
    else
        functions_->propose(pattern, nodes, lane_rule_.in_lanes());
    functions_->project(pattern, nodes);
    functions_->move(pattern, nodes, lane_rule_.in_lanes(), sizes);
    return sizes.step <= farthest_beside;   // also no number
}

/// As the kernel has it: that of the start, whose numbers are scalars, or of node p.
const lanes::Values& NeighbourElements::first_row(const BesideState& one)
{
    if (rule_.points != Points::radau) return one.here().held.joints.values();
    const lanes::Values &from = nodes_.values(), &to = end_row_.values();
    const auto take = [W = functions_->width](const double* lanes, double* scalars, int n) {
        for (int i = 0; i < n; ++i) scalars[i] = lanes[i * W];
    };
    take(from.numbers, to.numbers, pattern_->n_numbers());
    take(from.gradients, to.gradients, pattern_->view().n_entries);
    take(from.factor, to.factor, pattern_->n_factor());
    return to;
}

/// That of another neighbour errs by what both are apart, squared in two passes.
NearFactor NeighbourElements::factor_at_end(double apart) const
{
    if (!(apart <= error_at_end * pivot_)) return {};
    return {pattern_.get(), &nodes_.values(), functions_->width};
}

}   // namespace livens
