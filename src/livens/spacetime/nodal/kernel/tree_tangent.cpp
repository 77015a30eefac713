// SPDX-License-Identifier: BSD-3-Clause
// Outwards from the world a body moves with its parent and by its own freedoms, y_b = T y_p + z theta at each
// node, with T and z from the gradients of its joint there. From the leaves inwards the freedoms of all nodes
// of a body are eliminated together, and what is left of its inertia, mass and loads goes to its parent.
// Joints that close loops are unknowns of their own, which go once what is inside of them is gone: then they
// have pivots, -G J^-1 G^T of it (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/tree_tangent.h"

#include <algorithm>

namespace livens {

TreeTangent::TreeTangent(const ModelTables& tables, const ElementRule& rule,
                         const lanes::Functions* functions)
    : tables_(tables), rule_(rule), functions_(functions), forces_(tables, rule)
{}

void TreeTangent::use(const std::shared_ptr<const RowPattern>& pattern)
{
    if (pattern == pattern_) return;
    pattern_ = pattern;
    joints_.emplace(tables_, *pattern, rule_.degree);
    const std::vector<int> sizes = joints_->sizes();
    blocks_.resize(sizes, tables_.n_bodies(), rule_.degree);
    right_.assign(static_cast<std::size_t>(blocks_.first(blocks_.n_unknowns())), 0.0);
    left_ = right_;
    gone_.assign(sizes.size(), {});
}

/// What moves a parent moves its child: rows of the child go to it, and columns; but those by twists of the
/// child, of which only those by its freedoms will be asked.
void TreeTangent::pass_to_parent(int b)
{
    const JointMotion& motion = joints_->motion(b);
    const int above = parent(b), p = rule_.degree;
    const lanes::BlockSize of_T{blocks_.size(b), blocks_.size(above), p};
    const auto add_from_b = [&](int v) {   // J_pv + T^T J_bv
        of_blocks().add_from_left(motion.T_rows.data(), of_T, blocks_.of(b, v).data(), blocks_.size(v) * p,
                                  blocks_.of(above, v).data(), blocks_.size(v) * p);
    };
    const auto add_to_b = [&](int u) {   // J_up + J_ub T
        of_blocks().add_from_right(blocks_.of(u, b).data(), blocks_.size(u) * p, motion.T_columns.data(),
                                   of_T, false, blocks_.of(u, above).data());
    };
    for (const int v : coupled(b)) {
        if (v == above) continue;
        add_from_b(v);
        add_to_b(v);
    }
    // J_bp has J_bb T before T^T of it goes to J_pp: so the product from both sides is made once
    if (blocks_.find(above, b) != nullptr) add_to_b(above);
    add_to_b(b);
    forces_.add_to_parent(blocks_);
    add_from_b(above);
}

/// A point of rotors takes off each of those that it is coupled with, but not off pairs of them, as its axes
/// know nothing of each other.
bool TreeTangent::eliminate(int b)
{
    const JointMotion& motion = joints_->motion(b);
    Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const int p = rule_.degree, d = blocks_.size(b), f = motion.f;
    const bool is_body = b < tables_.n_bodies();
    if (is_body) forces_.reduce(b, parent(b), motion);
    if (parent(b) != world) pass_to_parent(b);
    const std::vector<int>& coupled = this->coupled(b);
    for (auto* blocks : {&gone.E, &gone.Et, &gone.W}) blocks->resize(coupled.size());
    if (f == 0) return true;
    const lanes::BlockSize of_z{d, f, p};
    Numbers Jz(static_cast<std::size_t>(d * p * f * p), 0.0);
    of_blocks().add_from_right(blocks_.of(b, b).data(), d * p, motion.z_columns.data(), of_z, false,
                               Jz.data());
    gone.D.A.assign(static_cast<std::size_t>(f * p * f * p), 0.0);
    of_blocks().add_from_left(motion.z_rows.data(), of_z, Jz.data(), f * p, gone.D.A.data(), f * p);
    if (is_body) forces_.add_to_own(gone.D.A);
    if (!gone.D.factorise(of_blocks(), f * p)) return false;
    for (std::size_t k = 0; k < coupled.size(); ++k) eliminate_from(b, k, Jz);
    const bool is_apart = is_point_of_rotors(tables_, b);
    for (std::size_t k = 0; k < coupled.size(); ++k)
        for (std::size_t l = 0; l < coupled.size(); ++l)
            if (k == l || !is_apart)
                of_blocks().subtract_product(blocks_.of(coupled[k], coupled[l]).data(), gone.E[k].data(),
                                             gone.W[l].data(), blocks_.size(coupled[k]) * p, f * p,
                                             blocks_.size(coupled[l]) * p);
    return true;
}

/// E = J_ub z and W = D^-1 z^T J_bu of the k-th that it is coupled with.
void TreeTangent::eliminate_from(int b, std::size_t k, const Numbers& Jz)
{
    const JointMotion& motion = joints_->motion(b);
    Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const int p = rule_.degree, d = blocks_.size(b), f = motion.f, u = coupled(b)[k],
              columns = blocks_.size(u) * p;
    const lanes::BlockSize of_z{d, f, p};
    Numbers &E = gone.E[k], &Et = gone.Et[k], &W = gone.W[k];
    E.assign(static_cast<std::size_t>(columns * f * p), 0.0);
    W.assign(E.size(), 0.0);
    Et.resize(E.size());
    if (const Numbers* J = blocks_.find(u, b))
        of_blocks().add_from_right(J->data(), columns, motion.z_columns.data(), of_z, false, E.data());
    of_blocks().add_from_left(motion.z_rows.data(), of_z, blocks_.of(b, u).data(), columns, W.data(),
                              columns);
    if (u == parent(b)) {
        of_blocks().add_from_left(motion.T_rows.data(), {d, blocks_.size(u), p}, Jz.data(), f * p, E.data(),
                                  f * p);
        forces_.add_by_own(E);
        forces_.add_by_parent(W);
    }
    for (int r = 0; r < columns; ++r)
        for (int i = 0; i < f * p; ++i) Et[i * columns + r] = E[r * f * p + i];
    gone.D.solve(of_blocks(), W.data(), columns);
}

bool TreeTangent::factorise(const WindowLayout& layout, const lanes::Values& start,
                            const lanes::Values& nodes, TangentSlopes& slopes)
{
    const bool has_first_row = rule_.points == Points::lobatto;
    const NodeGradients gradients{start, nodes, of_blocks(), functions_->width, rule_.degree, has_first_row};
    blocks_.reset(rule_, layout.h(0));
    forces_.find(layout, *pattern_, nodes, slopes);
    forces_.put(joints_->plan(), blocks_);
    joints_->add_loops(gradients, blocks_);
    for (const int u : joints_->plan().order)
        if (!joints_->find(u, gradients) || !eliminate(u)) return false;
    return true;
}

/// The body's freedoms as its own rows ask for, which its parent and others will change.
void TreeTangent::go_inwards(int b)
{
    const JointMotion& motion = joints_->motion(b);
    const Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const std::vector<int>& coupled = this->coupled(b);
    const int p = rule_.degree, d = blocks_.size(b), above = parent(b);
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

/// All with which b is coupled are known, as they went later. Multipliers of loops stay inside.
void TreeTangent::go_outwards(int b, const lanes::Values& nodes)
{
    const JointMotion& motion = joints_->motion(b);
    const Eliminated& gone = gone_[static_cast<std::size_t>(b)];
    const std::vector<int>& coupled = this->coupled(b);
    const int p = rule_.degree, d = blocks_.size(b), above = parent(b);
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
    for (int i = 0; b < tables_.n_bodies() && i < d; ++i)
        std::copy_n(own + i * p, p, nodes.step + (tables_.bodies[b].first + i) * functions_->width);
}

/// Rows of loops ask for nothing here: what constraints are off is taken by the projection behind.
void TreeTangent::propose(const lanes::Values& nodes)
{
    const int p = rule_.degree;
    std::ranges::fill(right_, 0.0);
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int i = 0; i < blocks_.size(b); ++i)
            for (int A = 0; A < p; ++A)
                right_[blocks_.first(b) + i * p + A] =
                    -nodes.rows[(tables_.bodies[b].first + i) * functions_->width + A];
    const std::vector<int>& order = joints_->plan().order;
    for (const int u : order) go_inwards(u);
    for (std::size_t i = order.size(); i-- > 0;) go_outwards(order[i], nodes);
}

}   // namespace livens
