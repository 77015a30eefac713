// SPDX-License-Identifier: BSD-3-Clause
// Rules by which methods take loads and hold joints. Diagnostics integrate with them, since momentum balances
// are exact at their points alone (theory.md, "What is diagnosed").
#include "livens/diagnostics/detail/motion_points.h"

#include <algorithm>
#include <utility>

namespace livens::inline diagnostics_internal {

namespace {

Quadrature nodal_rule(const Field& field)
{
    return field.points == Points::lobatto ? gauss_lobatto(field.degree + 1) : radau(field.degree);
}

/// Where loads are taken that are not taken at nodes: endpoint (order 1) takes forces at the end of the step,
/// midpoint, in old files, in its middle.
Quadrature load_rule(const Motion& motion)
{
    if (motion.gauss_points > 0) return gauss(motion.gauss_points);
    return {{motion.order_at_ends == 1 ? 1.0 : 0.5}, {1.0}};
}

}   // namespace

MotionPoints::MotionPoints(const Motion& motion, Quadrature rule, const PointRoles& roles)
    : motion_(motion), roles_(roles), rule_(std::move(rule)), X_table_(motion.X, rule_.points)
{
    const std::size_t n = rule_.points.size() * static_cast<std::size_t>(motion.X.n_values);
    if (!X_table_.has_nodes_alone()) X_.resize(n);
    if (roles.loads) V_.resize(n);
    if (!roles.joints) return;
    multiplier_table_.emplace(motion.multipliers, rule_.points);
    if (!multiplier_table_->has_nodes_alone())
        multipliers_.resize(rule_.points.size() * static_cast<std::size_t>(motion.n_rows));
}

void MotionPoints::go_to(int element)
{
    element_ = element;
    const double factor = 1 / motion_.mesh.length(element);
    if (!X_.empty() && !V_.empty())
        X_table_.all_of_both(element, factor, X_, V_);
    else if (!V_.empty())
        X_table_.all_derivatives(element, factor, V_);
    else if (!X_.empty())
        X_table_.all_values(element, X_);
    if (!multipliers_.empty()) multiplier_table_->all_values(element, multipliers_);
}

bool takes_loads_at_nodes(const Motion& motion)
{
    // Without Gauss points one multiplier an element marks a stepping rule with one stage.
    const bool has_one_stage = motion.X.degree == 1 && motion.multipliers.degree == 0;
    return motion.gauss_points == 0 && !has_one_stage;
}

std::vector<MotionPoints> points_of(const Motion& motion, const PointRoles& wanted)
{
    std::vector<MotionPoints> sets;
    if (motion.X.empty() || motion.n_elements() == 0) return sets;
    const bool is_nodal = takes_loads_at_nodes(motion);
    const bool has_joints = wanted.joints && !motion.multipliers.empty() && motion.n_rows > 0;
    const bool holds_nodes = is_nodal || motion.constraints_hold == ConstraintsHold::at_nodes;
    const bool is_radau = motion.X.points == Points::radau;
    const PointRoles at_nodes{wanted.loads && is_nodal, has_joints && holds_nodes, wanted.nodes,
                              is_radau ? 1 : 0};
    if (at_nodes.nodes && is_radau)
        sets.emplace_back(motion, Quadrature{{0.0}, {0.0}}, PointRoles{false, false, true});
    if (at_nodes.loads || at_nodes.joints || at_nodes.nodes)
        sets.emplace_back(motion, nodal_rule(motion.X), at_nodes);
    const PointRoles elsewhere{wanted.loads && !is_nodal, has_joints && !holds_nodes, false};
    if (elsewhere.loads || elsewhere.joints) sets.emplace_back(motion, load_rule(motion), elsewhere);
    return sets;
}

}   // namespace livens::inline diagnostics_internal
