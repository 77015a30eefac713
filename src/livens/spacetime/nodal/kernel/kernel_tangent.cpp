// SPDX-License-Identifier: BSD-3-Clause
// All freedoms of an element at once while they are few, else along the joints, and what either costs
// (docs/theory.md, "Without a tangent", Stiff loads). The unit is a step of free bodies of the same element.
#include "livens/spacetime/nodal/kernel/kernel_tangent.h"

namespace livens {

namespace {

constexpr int most_reduced = 48;   // freedoms of all nodes: beyond, a tree costs less
// Measured: a factor 10 + 0.65 p f and a step 1 + 0.02 p f; along the joints 4 + 2 p and 1.5 for bodies on
// hinges, 7 and 0.25 more for each freedom that bodies have besides, in the mean.
constexpr double least_factor = 10, factor_of_freedom = 0.65, step_of_freedom = 0.02;   // of all nodes
constexpr double least_tree = 4, tree_of_node = 2, tree_step = 1.5, tree_of_freedom = 7,
                 tree_step_of_freedom = 0.25;

}   // namespace

/// Joints' forces are asked from the beginning where no load has slopes: without them the tangent would be
/// that of free bodies.
KernelTangent::KernelTangent(const ModelTables& tables, const ElementRule& rule,
                             const lanes::Functions* functions)
    : degree_(rule.degree), n_twists_(tables.n_twists), slopes_(tables, rule, functions->width),
      reduced_(tables, rule, functions), tree_(tables, rule, functions)
{
    slopes_.has_joints = tables.loads.with_tangent.empty();
}

void KernelTangent::use(const std::shared_ptr<const RowPattern>& pattern)
{
    n_reduced_ = degree_ * (n_twists_ - pattern->view().n_rows);
    is_reduced_ = n_reduced_ <= most_reduced;
    if (!is_reduced_) return tree_.use(pattern);
    reduced_.use(pattern);
    ask_joints();   // of few bodies they cost little
}

KernelTangent::Cost KernelTangent::cost() const
{
    if (!is_reduced_) {
        const double more = 6.0 * n_reduced_ / (degree_ * n_twists_) - 1;   // freedoms of a body than a hinge
        return {least_tree + tree_of_node * degree_ + tree_of_freedom * more,
                tree_step + tree_step_of_freedom * more};
    }
    return {least_factor + factor_of_freedom * n_reduced_, 1 + step_of_freedom * n_reduced_};
}

bool KernelTangent::factorise(const WindowLayout& layout, const JointFactor& start,
                              const lanes::Values& nodes)
{
    slopes_.joints.begin();
    return is_reduced_ ? reduced_.factorise(layout, start, nodes, slopes_)
                       : tree_.factorise(layout, start.values(), nodes, slopes_);
}

void KernelTangent::propose(const lanes::Values& nodes)
{
    if (is_reduced_)
        reduced_.propose(nodes);
    else
        tree_.propose(nodes);
}

}   // namespace livens
