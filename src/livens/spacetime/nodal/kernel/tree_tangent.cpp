// SPDX-License-Identifier: BSD-3-Clause
// Outwards from the world a body moves with its parent and by its own freedoms, y_b = T y_p + z theta at each
// node, with T and z from the gradients of its joint there. From the leaves inwards the freedoms of all nodes
// of a body are eliminated together, and what is left of its inertia, mass and loads goes to its parent.
// Joints that close loops are unknowns of their own, which go once what is inside of them is gone: then they
// have pivots, -G J^-1 G^T of it (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/tree_tangent.h"

#include <algorithm>

namespace livens {

void TreeBlocks::resize(const std::vector<int>& sizes, int p)
{
    p_ = p;
    sizes_ = sizes;
    first_ = {0};
    for (const int size : sizes) first_.push_back(first_.back() + size * p);
    rows_.assign(sizes.size(), {});
}

void TreeBlocks::clear()
{
    for (auto& row : rows_)
        for (auto& [v, block] : row) std::ranges::fill(block, 0.0);
}

Numbers& TreeBlocks::of(int u, int v)
{
    auto& row = rows_[static_cast<std::size_t>(u)];
    const auto found = std::ranges::find(row, v, &std::pair<int, Numbers>::first);
    if (found != row.end()) return found->second;
    return row.emplace_back(v, Numbers(static_cast<std::size_t>(size(u) * p_ * size(v) * p_), 0.0)).second;
}

TreeTangent::TreeTangent(const ModelTables& tables, const ElementRule& rule,
                         const lanes::Functions* functions)
    : tables_(tables), rule_(rule), functions_(functions)
{}

void TreeTangent::use(const std::shared_ptr<const RowPattern>& pattern)
{
    if (pattern == pattern_) return;
    pattern_ = pattern;
    plan_.emplace(tables_, *pattern);
    std::vector<int> sizes;
    for (const BodyTable& body : tables_.bodies) sizes.push_back(body.dofs);
    for (const JointRows& joint : plan_->closing) sizes.push_back(joint.n());
    blocks_.resize(sizes, rule_.degree);
    right_.assign(static_cast<std::size_t>(blocks_.first(blocks_.n_unknowns())), 0.0);
    left_ = right_;
    motions_.assign(sizes.size(), {});
    gone_.assign(sizes.size(), {});
    for (int u = first_loop(); u < blocks_.n_unknowns(); ++u) {   // all its multipliers are free
        JointMotion& motion = motions_[static_cast<std::size_t>(u)];
        const int m = motion.f = blocks_.size(u), p = rule_.degree;
        motion.z_rows.assign(static_cast<std::size_t>(m * m * p), 0.0);
        for (int r = 0; r < m; ++r) std::fill_n(motion.z_rows.begin() + (r * m + r) * p, p, 1.0);
        motion.z_columns = motion.z_rows;
    }
}

/// k_AB / h: scaled twists have the mass 1.
void TreeTangent::add_mass(double h)
{
    const int p = rule_.degree;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const int d = blocks_.size(b);
        Numbers& J = blocks_.of(b, b);
        for (int i = 0; i < d; ++i)
            for (int A = 0; A < p; ++A)
                for (int l = 0; l < p; ++l)
                    J[(i * p + A) * d * p + i * p + l] +=
                        rule_.k[row_in_lane(rule_, A) * rule_.size() + (l == 0 ? p : l)] / h;
    }
}

void TreeTangent::add_loads(const WindowLayout& layout, const lanes::Values& nodes, LoadSlopes& slopes)
{
    const int p = rule_.degree;
    const auto add_by = [&](const SlopesOfPair& pair, const double* of_pair, const Numbers& in_time,
                            double factor) {
        Numbers& J = blocks_.of(pair.i, pair.j);
        const int n = blocks_.size(pair.j);
        for (int a = 0; a < blocks_.size(pair.i); ++a)
            for (int b = 0; b < n; ++b) {
                const double slope = factor * of_pair[6 * a + b];
                if (slope == 0) continue;
                for (int A = 0; A < p; ++A)
                    for (int l = 0; l < p; ++l)
                        J[((a * p + A) * n + b) * p + l] += slope * in_time[A * p + l];
            }
    };
    const auto add = [&](const SlopesOfPair& pair) {
        add_by(pair, pair.by_X, slopes.in_time_by_X(), layout.h(0));
        add_by(pair, pair.by_V, slopes.in_time_by_V(), 1);
    };
    slopes.find(layout, nodes);
    for (const SlopesOfPair& pair : slopes.pairs()) add(pair);
    for (const SlopesOfProduct& product : slopes.products())
        for (std::size_t r = 0; r < 2; ++r)
            for (std::size_t s = 0; product.to[r] != world && s < product.from.size(); ++s)
                add(product.of(r, s));
}

/// Node by node: multipliers are those of the last balance.
void TreeTangent::add_forces_of_joints(const WindowLayout& layout, const lanes::Values& nodes,
                                       TangentSlopes& slopes)
{
    const int p = rule_.degree;
    for (int node = 1; node <= last_with_joints(rule_, slopes); ++node)
        for (const SlopesOfPair& pair : slopes.joints.find(node, layout, *pattern_, nodes)) {
            Numbers& J = blocks_.of(pair.i, pair.j);
            const int n = blocks_.size(pair.j), lane = node % p;
            for (int a = 0; a < blocks_.size(pair.i); ++a)
                for (int b = 0; b < n; ++b) J[((a * p + lane) * n + b) * p + lane] += pair.by_X[6 * a + b];
        }
}

/// The rows of what closes loops, at row nodes by multipliers and at columns by twists.
void TreeTangent::add_loops(const NodeGradients& gradients)
{
    const int p = rule_.degree;
    for (std::size_t k = 0; k < plan_->closing.size(); ++k) {
        const JointRows& joint = plan_->closing[k];
        const int u = first_loop() + static_cast<int>(k), m = joint.n();
        for (const int b : joint.bodies) {
            if (b == world) continue;
            const int d = blocks_.size(b);
            Numbers &J = blocks_.of(b, u), &G = blocks_.of(u, b);
            for (int node = 0; node <= p; ++node) {
                Numbers of(static_cast<std::size_t>(m * d));
                gradients.of(joint, b, node, of.data());
                for (int r = 0; r < m; ++r)
                    for (int i = 0; i < d; ++i) {
                        const int lane = node % p;
                        if (gradients.is_row(node)) J[(i * p + lane) * m * p + r * p + lane] = of[r * d + i];
                        if (node > 0) G[(r * p + lane) * d * p + i * p + lane] = of[r * d + i];
                    }
            }
        }
    }
}

/// What moves a parent moves its child: rows of the child go to it, and columns.
void TreeTangent::pass_to_parent(int b)
{
    const JointMotion& motion = motions_[static_cast<std::size_t>(b)];
    const int above = plan_->parent[static_cast<std::size_t>(b)], p = rule_.degree;
    const lanes::BlockSize of_T{blocks_.size(b), blocks_.size(above), p};
    const auto add_from_b = [&](int v) {   // J_pv + T^T J_bv
        of_blocks().add_from_left(motion.T_rows.data(), of_T, blocks_.of(b, v).data(), blocks_.size(v) * p,
                                  blocks_.of(above, v).data(), blocks_.size(v) * p);
    };
    const auto add_to_b = [&](int u) {   // J_up + J_ub T
        of_blocks().add_from_right(blocks_.of(u, b).data(), blocks_.size(u) * p, motion.T_columns.data(),
                                   of_T, false, blocks_.of(u, above).data());
    };
    for (const int v : plan_->coupled[static_cast<std::size_t>(b)]) {
        if (v == above) continue;
        add_from_b(v);
        add_to_b(v);
    }
    add_to_b(above);
    add_to_b(b);   // before what is coupled with b goes on: J_bp + J_bb T
    add_from_b(above);
    add_from_b(b);
}

bool TreeTangent::eliminate(int b)
{
    const JointMotion& motion = motions_[static_cast<std::size_t>(b)];
    const std::vector<int>& coupled = plan_->coupled[static_cast<std::size_t>(b)];
    Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const int p = rule_.degree, d = blocks_.size(b), f = motion.f;
    if (plan_->parent[static_cast<std::size_t>(b)] != world) pass_to_parent(b);
    for (auto* blocks : {&gone.E, &gone.Et, &gone.W}) blocks->resize(coupled.size());
    if (f == 0) return true;
    const lanes::BlockSize of_z{d, f, p};
    const auto times_z = [&](int u, Numbers& out) {
        out.assign(static_cast<std::size_t>(blocks_.size(u) * p * f * p), 0.0);
        of_blocks().add_from_right(blocks_.of(u, b).data(), blocks_.size(u) * p, motion.z_columns.data(),
                                   of_z, false, out.data());
    };
    Numbers Jz;
    times_z(b, Jz);
    gone.D.A.assign(static_cast<std::size_t>(f * p * f * p), 0.0);
    of_blocks().add_from_left(motion.z_rows.data(), of_z, Jz.data(), f * p, gone.D.A.data(), f * p);
    if (!gone.D.factorise(of_blocks(), f * p)) return false;
    for (std::size_t k = 0; k < coupled.size(); ++k) {
        const int columns = blocks_.size(coupled[k]) * p;
        times_z(coupled[k], gone.E[k]);
        gone.Et[k].resize(gone.E[k].size());
        for (int r = 0; r < columns; ++r)
            for (int i = 0; i < f * p; ++i) gone.Et[k][i * columns + r] = gone.E[k][r * f * p + i];
        gone.W[k].assign(static_cast<std::size_t>(f * p * columns), 0.0);
        of_blocks().add_from_left(motion.z_rows.data(), of_z, blocks_.of(b, coupled[k]).data(), columns,
                                  gone.W[k].data(), columns);
        gone.D.solve(of_blocks(), gone.W[k].data(), columns);
    }
    const bool is_apart = is_point_of_rotors(tables_, b);
    for (std::size_t k = 0; k < coupled.size(); ++k)
        for (std::size_t l = 0; l < coupled.size(); ++l)
            if (k == l || !is_apart)
                of_blocks().subtract_product(blocks_.of(coupled[k], coupled[l]).data(), gone.E[k].data(),
                                             gone.W[l].data(), blocks_.size(coupled[k]) * p, f * p,
                                             blocks_.size(coupled[l]) * p);
    return true;
}

bool TreeTangent::factorise(const WindowLayout& layout, const lanes::Values& start,
                            const lanes::Values& nodes, TangentSlopes& slopes)
{
    const bool has_first_row = rule_.points == Points::lobatto;
    const NodeGradients gradients{tables_,           *pattern_,    start,        nodes,
                                  functions_->width, rule_.degree, has_first_row};
    blocks_.clear();
    add_mass(layout.h(0));
    add_loads(layout, nodes, slopes.loads);
    add_forces_of_joints(layout, nodes, slopes);
    add_loops(gradients);
    for (const int u : plan_->order) {
        const bool is_body = u < first_loop();
        if (is_body && !gradients.find(u, *plan_, motions_[static_cast<std::size_t>(u)])) return false;
        if (!eliminate(u)) return false;
    }
    return true;
}

/// The body's freedoms as its own rows ask for, which its parent and others will change.
void TreeTangent::go_inwards(int b)
{
    const JointMotion& motion = motions_[static_cast<std::size_t>(b)];
    const Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const std::vector<int>& coupled = plan_->coupled[static_cast<std::size_t>(b)];
    const int p = rule_.degree, d = blocks_.size(b), above = plan_->parent[static_cast<std::size_t>(b)];
    const double* own = right_.data() + blocks_.first(b);
    if (above != world)
        of_blocks().add_from_right(own, 1, motion.T_rows.data(), {d, blocks_.size(above), p}, false,
                                   right_.data() + blocks_.first(above));
    if (motion.f == 0) return;
    theta_.assign(static_cast<std::size_t>(motion.f * p), 0.0);
    of_blocks().add_from_right(own, 1, motion.z_rows.data(), {d, motion.f, p}, false, theta_.data());
    gone.D.solve(of_blocks(), theta_.data(), 1);
    for (std::size_t k = 0; k < coupled.size(); ++k)
        of_blocks().subtract_product(right_.data() + blocks_.first(coupled[k]), theta_.data(),
                                     gone.Et[k].data(), 1, motion.f * p, blocks_.size(coupled[k]) * p);
    std::ranges::copy(theta_, left_.begin() + blocks_.first(b));
}

void TreeTangent::go_outwards(int b, const lanes::Values& nodes)
{
    const JointMotion& motion = motions_[static_cast<std::size_t>(b)];
    const Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const std::vector<int>& coupled = plan_->coupled[static_cast<std::size_t>(b)];
    const int p = rule_.degree, d = blocks_.size(b), above = plan_->parent[static_cast<std::size_t>(b)];
    double* own = left_.data() + blocks_.first(b);
    theta_.assign(own, own + motion.f * p);
    for (std::size_t k = 0; motion.f > 0 && k < coupled.size(); ++k)
        of_blocks().subtract_times(theta_.data(), gone.W[k].data(), motion.f * p,
                                   blocks_.size(coupled[k]) * p, left_.data() + blocks_.first(coupled[k]));
    std::fill_n(own, d * p, 0.0);
    of_blocks().add_from_right(theta_.data(), 1, motion.z_columns.data(), {motion.f, d, p}, true, own);
    if (above != world)
        of_blocks().add_from_right(left_.data() + blocks_.first(above), 1, motion.T_columns.data(),
                                   {blocks_.size(above), d, p}, true, own);
    for (int i = 0; b < first_loop() && i < d; ++i)
        std::copy_n(own + i * p, p, nodes.step + (tables_.bodies[b].first + i) * functions_->width);
}

void TreeTangent::propose(const lanes::Values& nodes)
{
    const int p = rule_.degree;
    std::ranges::fill(right_, 0.0);
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int i = 0; i < blocks_.size(b); ++i)
            for (int A = 0; A < p; ++A)
                right_[blocks_.first(b) + i * p + A] =
                    -nodes.rows[(tables_.bodies[b].first + i) * functions_->width + A];
    for (const int u : plan_->order) go_inwards(u);
    for (std::size_t i = plan_->order.size(); i-- > 0;) go_outwards(plan_->order[i], nodes);
}

}   // namespace livens
