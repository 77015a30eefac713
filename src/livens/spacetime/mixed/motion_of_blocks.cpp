// SPDX-License-Identifier: BSD-3-Clause
// The motion of solved blocks of (P23). Fields are kept by values at Gauss-Lobatto points of each element,
// which make the same polynomials again, of NURBS with their denominators; orders are stated as they were
// measured (docs/theory.md, "The elements of the paper": Orders).
#include "livens/spacetime/mixed/motion_of_blocks.h"

#include <algorithm>
#include <functional>

#include "livens/dynamics/rows/projection.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/equations.h"
#include "livens/time/quadrature.h"

namespace livens::mixed {

namespace {

/// Gauss-Lobatto points of a field's degree; the middle for degree 0.
std::vector<double> nodes_of(int degree)
{
    return degree == 0 ? std::vector<double>{0.5} : gauss_lobatto(degree + 1).points;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from)
{
    to.insert(to.end(), from.begin(), from.end());
}

/// Order of X and momenta at the ends of one block, as measured (docs/theory.md, "The elements of the
/// paper"); 0: NURBS of unequal weights, whose error need not fall.
int order_of_block(const Mixed& method)
{
    const int p = method.degree;
    if (std::ranges::adjacent_find(method.weights, std::not_equal_to<>()) != method.weights.end()) return 0;
    if (p == 1 || method.gauss_points == p) return 2;
    const bool is_natural_equal =
        method.start == Mixed::Start::natural && method.multipliers == Mixed::Multipliers::equal;
    if (is_natural_equal && method.end_multiplier == Mixed::EndMultiplier::zero) return std::min(p + 1, 4);
    if (is_natural_equal || basis_of(method).has_knots) return p + 1;
    return p % 2 == 0 ? p : p + 1;
}

/// Of many blocks of a fixed number of elements: what projection moves at every interface, or the momentum
/// that a strong start hands on, costs one order.
int order_of(const Mixed& method, std::size_t n_blocks)
{
    const bool is_handed_on_well =
        method.start == Mixed::Start::natural && method.interfaces == Mixed::Interfaces::carry;
    return std::max(order_of_block(method) - (n_blocks > 1 && !is_handed_on_well ? 1 : 0), 0);
}

}   // namespace

MotionOfBlocks::MotionOfBlocks(const Coordinates& coordinates, const TimeMesh& mesh, const Mixed& method)
    : coordinates_(coordinates), mesh_(mesh), method_(method)
{}

void MotionOfBlocks::add(int first, const Equations& equations, const Fields& fields, HandsOn hands_on)
{
    Block& block = blocks_[first];
    const FieldSpace& fields_of = equations.space();
    const TimeSpace& space = fields_of.functions.space();
    block.n_elements = space.n_elements();
    gauss_points_ = fields_of.functions.n_gauss();
    if (hands_on.at_start) block.P_start = equations.end_momentum(fields, false);
    if (hands_on.at_end) block.P_end = equations.end_momentum(fields, true);
    std::vector<double> numbers(coordinates_.root_masses.size()), lambda(coordinates_.rows.size());
    const auto append_columns = [&](std::vector<double>& to) {
        to.resize(to.size() + coordinates_.n_X());
        coordinates_.spread(numbers.data(), to.data() + to.size() - coordinates_.n_X());
    };
    const std::vector<double> nodes = nodes_of(space.degree()),
                              multiplier_nodes = nodes_of(fields_of.functions.multipliers().degree());
    for (int e = 0; e < block.n_elements; ++e) {
        for (const double s : nodes) {
            fields_of.evaluate_X(fields, e, s, numbers.data());
            append_columns(block.X);
            fields_of.evaluate_P(fields, e, s, numbers.data());
            append_columns(block.P);
            if (space.is_rational()) block.denominators.push_back(space.denominator(e, s));
        }
        for (const double s : multiplier_nodes) {
            fields_of.evaluate_multipliers(fields, e, s, lambda.data());
            append_multipliers(lambda, block);
        }
    }
}

/// Those of redundant rows, and of the rigidity of point masses, are zero.
void MotionOfBlocks::append_multipliers(const std::vector<double>& lambda, Block& block) const
{
    std::vector<double> joints(coordinates_.tables.model->n_rows(), 0.0);
    std::vector<double> rigidity(6 * coordinates_.first.size(), 0.0);
    int of_rigidity = 0, body = -1;
    for (int k = 0; k < coordinates_.n_rows(); ++k) {
        const int row = coordinates_.rows[k];
        if (row < coordinates_.tables.n_rows()) {
            joints[row] = lambda[k];
            continue;
        }
        const int of_body = coordinates_.tables.rows[row].bodies[0];
        of_rigidity = of_body == body ? of_rigidity + 1 : 0;
        body = of_body;
        rigidity[6 * body + of_rigidity] = lambda[k];
    }
    append(block.multipliers, joints);
    append(block.rigidity, rigidity);
}

Motion MotionOfBlocks::take(bool torn, const State& start)
{
    Motion motion;
    motion.n_bodies = coordinates_.tables.model->n_bodies();
    motion.n_rows = coordinates_.tables.model->n_rows();
    const int p = method_.degree;
    const int q = method_.multipliers == Mixed::Multipliers::equal ? p : p - 1;
    motion.X = {12 * motion.n_bodies, p, !torn, {}, {}};
    motion.P = {12 * motion.n_bodies, p, false, {}, {}};
    motion.multipliers = {motion.n_rows, q, false, {}, {}};
    motion.rigidity = {6 * motion.n_bodies, q, false, {}, {}};
    motion.order_at_ends = order_of(method_, blocks_.size());
    motion.dense_order_X = std::min(motion.order_at_ends, p + 1);
    motion.dense_order_V = std::min(motion.order_at_ends, p);
    motion.constraints_hold = ConstraintsHold::weakly;
    motion.gauss_points = gauss_points_;
    if (blocks_.empty()) {
        motion.mesh.ends = {start.t};
        std::vector<Matrix34> P = start.V;
        std::vector<double> X;
        for (int b = 0; b < coordinates_.tables.model->n_bodies(); ++b) {
            P[b] = start.V[b] * coordinates_.tables.model->bodies()[b].mass;
            X.insert(X.end(), start.X[b].a, start.X[b].a + 12);
        }
        motion.X.values = X;
        append_end(X.data(), P, false, motion);
        return motion;
    }
    motion.mesh.ends = {mesh_.ends[blocks_.begin()->first]};
    motion.block_ends = {0};
    for (const auto& [first, block] : blocks_) {
        append_block(block, motion.n_elements() == 0, motion);
        for (int e = 0; e < block.n_elements; ++e) motion.mesh.ends.push_back(mesh_.ends[first + e + 1]);
        motion.block_ends.push_back(motion.n_elements());
    }
    return motion;
}

/// The block's nodes, and its element ends but the first, which replaces that of the block before.
void MotionOfBlocks::append_block(const Block& block, bool is_first, Motion& motion) const
{
    const std::size_t n = static_cast<std::size_t>(motion.X.n_values), n_local = method_.degree + 1;
    for (int e = 0; e < block.n_elements; ++e)
        for (std::size_t a = motion.X.continuous && !(is_first && e == 0) ? 1 : 0; a < n_local; ++a) {
            const std::size_t node = static_cast<std::size_t>(e) * n_local + a;
            const auto from = block.X.begin() + static_cast<std::ptrdiff_t>(node * n);
            motion.X.values.insert(motion.X.values.end(), from, from + static_cast<std::ptrdiff_t>(n));
            if (!block.denominators.empty()) motion.X.denominators.push_back(block.denominators[node]);
        }
    append(motion.P.values, block.P);
    append(motion.P.denominators, block.denominators);
    append(motion.multipliers.values, block.multipliers);
    append(motion.rigidity.values, block.rigidity);
    if (method_.multipliers == Mixed::Multipliers::equal) {
        if (motion.n_rows > 0) append(motion.multipliers.denominators, block.denominators);
        append(motion.rigidity.denominators, block.denominators);
    }
    const std::size_t bodies = static_cast<std::size_t>(motion.n_bodies);
    if (!is_first) {
        motion.momenta.resize(motion.momenta.size() - bodies);
        motion.velocities.resize(motion.velocities.size() - bodies);
    }
    const auto append_node = [&](std::size_t at, const std::vector<Matrix34>& handed_on) {
        if (!handed_on.empty()) return append_end(block.X.data() + at, handed_on, true, motion);
        std::vector<Matrix34> P(bodies);
        for (std::size_t b = 0; b < bodies; ++b) std::copy_n(block.P.data() + at + 12 * b, 12, P[b].a);
        append_end(block.X.data() + at, P, false, motion);
    };
    append_node(0, block.P_start);
    for (int e = 1; e < block.n_elements; ++e) append_node(static_cast<std::size_t>(e) * n_local * n, {});
    append_node(block.X.size() - n, block.P_end);
}

/// At ends of blocks the momentum of the law has a part in the range of G^T, so velocities there are the
/// nearest that joints allow; between they are P m^-1 of the field.
void MotionOfBlocks::append_end(const double* X, const std::vector<Matrix34>& P, bool of_block,
                                Motion& motion) const
{
    std::vector<Matrix34> places(P.size()), V(P.size());
    for (std::size_t b = 0; b < P.size(); ++b) {
        std::copy_n(X + 12 * b, 12, places[b].a);
        V[b] = P[b] * coordinates_.inverse_masses[b];
    }
    if (of_block) V = nearest_rates(*coordinates_.tables.model, places, V, coordinates_.tables.independent);
    append(motion.momenta, P);
    append(motion.velocities, V);
}

}   // namespace livens::mixed
