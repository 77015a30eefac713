// SPDX-License-Identifier: BSD-3-Clause
// Forces of joints are asked at one node in the middle, and count at others by the weights of these, as
// impulses do: a step by them need not be exact (docs/theory.md, "Without a tangent", Stiff loads). Forces
// along coordinates between a body and its parent have directions u and slopes v, and are of rank p: with
// T^T u_b + u_p, z^T u_b at row nodes and T v_b + v_p, z v_b at columns.
#include "livens/spacetime/nodal/kernel/tree_forces.h"

#include <algorithm>
#include <span>

namespace livens {

namespace {

/// out (j; A) += sum_i y_i M (i, j; A), M with d rows.
void add_combined(std::span<const double> y, const Numbers& M, Numbers& out)
{
    const std::size_t columns = out.size();
    for (std::size_t i = 0; i * columns < M.size(); ++i)
        for (std::size_t j = 0; y[i] != 0 && j < columns; ++j) out[j] += y[i] * M[i * columns + j];
}

/// out (i; A) += y_i, as many as there are.
void add_at_all(std::span<const double> y, int p, Numbers& out)
{
    const int n = static_cast<int>(out.size()) / p;
    for (int i = 0; i < n; ++i)
        for (int l = 0; l < p; ++l) out[i * p + l] += y[static_cast<std::size_t>(i)];
}

/// J (i, l; j, l) += w_l sum_k K_ik M (k, j; l), K of n x d numbers in rows of 6.
void add_at_nodes(const double* K, const Numbers& M, int n, int d, const Numbers& w, Numbers& J)
{
    const int p = static_cast<int>(w.size()), columns = static_cast<int>(M.size()) / d;
    double sums[6 * 18];   // of a parent at as many nodes as lanes are for
    for (int i = 0; i < n; ++i) {
        std::fill_n(sums, columns, 0.0);
        for (int k = 0; k < d; ++k) {
            const double *m = M.data() + k * columns, a = K[6 * i + k];
            for (int c = 0; a != 0 && c < columns; ++c) sums[c] += a * m[c];
        }
        double* row = J.data() + i * p * columns;
        for (int j = 0; j < columns; j += p)
            for (int l = 0; l < p; ++l) row[l * columns + j + l] += w[l] * sums[j + l];
    }
}

}   // namespace

void TreeForces::find(const WindowLayout& layout, const RowPattern& pattern, const lanes::Values& nodes,
                      TangentSlopes& slopes)
{
    slopes.loads.find(layout, nodes);
    slopes_ = &slopes;
    h_ = layout.h(0);
    const int p = rule_.degree, last = last_with_joints(rule_, slopes);
    of_joints_ = last > 0 ? &slopes.joints.find_middle(last, layout, pattern, nodes) : nullptr;
    weights_.assign(static_cast<std::size_t>(p), 0.0);
    const double middle = rule_.weights[static_cast<std::size_t>(JointSlopes::middle_of(last))];
    for (int node = 1; node <= last; ++node)
        weights_[static_cast<std::size_t>(node % p)] = rule_.weights[static_cast<std::size_t>(node)] / middle;
}

void TreeForces::put(const TreePlan& plan, TreeBlocks& blocks)
{
    between_.resize(static_cast<std::size_t>(blocks.n_bodies()));
    for (BetweenBodies& between : between_) {
        std::ranges::fill(between.by_parent, 0.0);
        std::ranges::fill(between.of_parent, 0.0);
        between.products.clear();
    }
    for (const SlopesOfPair& pair : slopes_->loads.pairs()) put_pair(pair, blocks);
    for (const SlopesOfProduct& product : slopes_->loads.products()) {
        const int held = held_body(product, plan);
        if (held != world) {
            between_[static_cast<std::size_t>(held)].products.push_back(&product);
            continue;
        }
        for (std::size_t r = 0; r < 2; ++r)
            for (std::size_t s = 0; product.to[r] != world && s < product.from.size(); ++s)
                put_pair(product.of(r, s), blocks);
    }
    if (of_joints_ == nullptr) return;
    for (const SlopesOfPair& pair : *of_joints_) put_of_joint(pair, plan, blocks);
}

void TreeForces::put_pair(const SlopesOfPair& pair, TreeBlocks& blocks) const
{
    const int p = rule_.degree, n = blocks.size(pair.j);
    Numbers& J = blocks.of(pair.i, pair.j);
    const auto add = [&](const double* of_pair, const Numbers& in_time, double factor) {
        for (int a = 0; a < blocks.size(pair.i); ++a)
            for (int b = 0; b < n; ++b) {
                const double slope = factor * of_pair[6 * a + b];
                if (slope == 0) continue;
                for (int A = 0; A < p; ++A)
                    for (int l = 0; l < p; ++l)
                        J[((a * p + A) * n + b) * p + l] += slope * in_time[A * p + l];
            }
    };
    add(pair.by_X, slopes_->loads.in_time_by_X(), h_);
    add(pair.by_V, slopes_->loads.in_time_by_V(), 1);
}

/// Between a body and its parent a slope is kept as 6 x 6 until the body goes; a body by itself, and bodies
/// of a loop's joint, have blocks, which are diagonal in the nodes.
void TreeForces::put_of_joint(const SlopesOfPair& pair, const TreePlan& plan, TreeBlocks& blocks)
{
    const auto add = [&](double* to) {
        for (int a = 0; a < 36; ++a) to[a] += pair.by_X[a];
    };
    if (pair.i != pair.j && plan.parent[static_cast<std::size_t>(pair.i)] == pair.j)
        return add(between_[static_cast<std::size_t>(pair.i)].by_parent);
    if (pair.i != pair.j && plan.parent[static_cast<std::size_t>(pair.j)] == pair.i)
        return add(between_[static_cast<std::size_t>(pair.j)].of_parent);
    const int p = rule_.degree, n = blocks.size(pair.j);
    Numbers& J = blocks.of(pair.i, pair.j);
    for (int a = 0; a < blocks.size(pair.i); ++a)
        for (int b = 0; b < n; ++b)
            for (int l = 0; l < p; ++l)
                J[((a * p + l) * n + b) * p + l] += weights_[l] * pair.by_X[6 * a + b];
}

/// The one whose joint it goes along, if it is between that body and its parent alone; else the world.
int TreeForces::held_body(const SlopesOfProduct& product, const TreePlan& plan) const
{
    std::vector<int> bodies = product.from;
    bodies.insert(bodies.end(), product.to.begin(), product.to.end());
    for (const int b : bodies) {
        if (b == world) continue;
        const int parent = plan.parent[static_cast<std::size_t>(b)];
        const auto is_here = [&](int other) { return other == b || other == parent || other == world; };
        if (std::ranges::all_of(bodies, is_here)) return b;
    }
    return world;
}

/// Directions u stand at rows and take z and T there; slopes take those of columns and are spread in time by
/// h S and C. What is of the parent itself counts as it is.
ForceAlongTree TreeForces::reduced(const SlopesOfProduct& product) const
{
    const int p = rule_.degree, f = motion_->f;
    const int n = parent_ != world ? tables_.bodies[parent_].dofs : 0;
    const auto zeros = [](int rows, int columns) {
        return Numbers(static_cast<std::size_t>(rows * columns), 0.0);
    };
    ForceAlongTree force{zeros(f, p), zeros(n, p), zeros(p, f * p), zeros(p, n * p)};
    for (std::size_t r = 0; r < 2; ++r) {
        const SlopesOfProduct::Twist& u = product.direction[r];
        if (product.to[r] == body_) {
            add_combined(u, motion_->z_rows, force.on_own);
            add_combined(u, motion_->T_rows, force.on_parent);
        } else if (product.to[r] == parent_) {
            add_at_all(u, p, force.on_parent);
        }
    }
    const auto add_slopes = [&](const std::vector<SlopesOfProduct::Twist>& slopes, const Numbers& in_time,
                                double factor) {
        Numbers own = zeros(f, p), above = zeros(n, p);
        for (std::size_t s = 0; s < slopes.size(); ++s) {
            if (product.from[s] == body_) {
                add_combined(slopes[s], motion_->z_columns, own);
                add_combined(slopes[s], motion_->T_columns, above);
            } else {
                add_at_all(slopes[s], p, above);
            }
        }
        const auto add = [&](const Numbers& at_columns, Numbers& by) {
            const int columns = static_cast<int>(at_columns.size());
            for (int A = 0; A < p; ++A)
                for (int j = 0; j < columns; j += p)
                    for (int l = 0; l < p; ++l)
                        by[A * columns + j + l] += factor * in_time[A * p + l] * at_columns[j + l];
        };
        add(own, force.by_own);
        add(above, force.by_parent);
    };
    add_slopes(product.by_X, slopes_->loads.in_time_by_X(), h_);
    add_slopes(product.by_V, slopes_->loads.in_time_by_V(), 1);
    return force;
}

void TreeForces::reduce(int body, int parent, const JointMotion& motion)
{
    body_ = body;
    parent_ = parent;
    motion_ = &motion;
    forces_.clear();
    for (const SlopesOfProduct* product : between_[static_cast<std::size_t>(body)].products)
        forces_.push_back(reduced(*product));
}

/// to (i, A; j, l) += on (i; A) by (A; j, l)
void TreeForces::add_outer(const Numbers& on, const Numbers& by, Numbers& to) const
{
    const int p = rule_.degree, columns = static_cast<int>(by.size()) / p;
    const int n = static_cast<int>(on.size()) / p;
    for (int i = 0; i < n; ++i)
        for (int A = 0; A < p; ++A) {
            const double size = on[i * p + A], *slopes = by.data() + A * columns;
            double* row = to.data() + (i * p + A) * columns;
            for (int j = 0; j < columns; ++j) row[j] += size * slopes[j];
        }
}

void TreeForces::add_to_parent(TreeBlocks& blocks) const
{
    const int p = rule_.degree, n = blocks.size(parent_), d = blocks.size(body_);
    Numbers &J = blocks.of(parent_, parent_), &C = blocks.of(body_, parent_);
    for (const ForceAlongTree& force : forces_) add_outer(force.on_parent, force.by_parent, J);
    if (of_joints_ == nullptr) return;
    const BetweenBodies& between = between_[static_cast<std::size_t>(body_)];
    for (int i = 0; i < d; ++i)
        for (int j = 0; j < n; ++j)
            for (int l = 0; l < p; ++l)
                C[((i * p + l) * n + j) * p + l] += weights_[l] * between.by_parent[6 * i + j];
    add_at_nodes(between.of_parent, motion_->T_columns, n, d, weights_, J);
}

void TreeForces::add_to_own(Numbers& D) const
{
    for (const ForceAlongTree& force : forces_) add_outer(force.on_own, force.by_own, D);
}

void TreeForces::add_by_own(Numbers& E) const
{
    for (const ForceAlongTree& force : forces_) add_outer(force.on_parent, force.by_own, E);
    if (of_joints_ == nullptr) return;
    const BetweenBodies& between = between_[static_cast<std::size_t>(body_)];
    add_at_nodes(between.of_parent, motion_->z_columns, tables_.bodies[parent_].dofs,
                 tables_.bodies[body_].dofs, weights_, E);
}

void TreeForces::add_by_parent(Numbers& W) const
{
    for (const ForceAlongTree& force : forces_) add_outer(force.on_own, force.by_parent, W);
}

}   // namespace livens
