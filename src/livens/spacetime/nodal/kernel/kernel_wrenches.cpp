// SPDX-License-Identifier: BSD-3-Clause
// Loads at the Gauss points of an element, in lanes, and the momentum at its end from the balance of all
// rows, p_0 + sum f_A and s_0 + sum tau_A: the last row itself would carry the rounding of k_AB / h
// (docs/theory.md, "The element").
#include "livens/spacetime/nodal/kernel/kernel_wrenches.h"

#include <algorithm>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"

namespace livens {

KernelWrenches::KernelWrenches(const ModelTables& tables, const ElementRule& rule,
                               const lanes::Functions* functions)
    : tables_(tables), rule_(rule), taken_(6 * tables.bodies.size())
{
    if (functions != nullptr && !tables.model->loads().empty())
        loads_.emplace(tables, functions->loads, functions->width, rule.degree);
}

void KernelWrenches::begin(const WindowLayout& layout)
{
    if (loads_) loads_->begin(layout.load_points(rule_, 0));
}

void KernelWrenches::evaluate_loads(const WindowLayout& layout, const lanes::Values& nodes,
                                    const lanes::Rule& rule)
{
    loads_->evaluate(nodes.at_loads.X, nodes.at_loads.V, rule.load_weights, layout.angles, nodes.at_loads.F);
}

void KernelWrenches::momentum(const WindowLayout& layout, const InstantState& start,
                              const lanes::Values& nodes, double* p) const
{
    const int W = loads_ ? loads_->width() : 0;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        double of_loads[6] = {};
        for (int c = 0; loads_ && c < rule_.degree; ++c) {
            double X[12], F[12], wrench[6];
            for (int i = 0; i < 12; ++i) {
                X[i] = nodes.at_loads.X[(12 * b + i) * W + c];
                F[i] = nodes.at_loads.F[(12 * b + i) * W + c];
            }
            twist::rows(X, F, wrench);
            for (int i = 0; i < 6; ++i) of_loads[i] += wrench[i];
        }
        for (int i = 0; i < body.dofs; ++i) {
            const double weight = i < 3 ? layout.h(0) * body.weight[i] : 0;   // no moment about the centre
            p[body.first + i] = start.p[body.first + i] + weight + of_loads[i] + taken_[6 * b + i];
        }
    }
}

}   // namespace livens
