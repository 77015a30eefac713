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
    : tables_(tables), rule_(rule), functions_(functions), totals_(12 * tables.bodies.size()),
      taken_(6 * tables.bodies.size())
{
    if (functions == nullptr || tables.model->loads().empty()) return;
    loads_.emplace(tables, functions->loads->run, functions->width, rule.degree);
    if (loads_->has_others())
        others_.assign(totals_.size() * static_cast<std::size_t>(functions->width), 0.0);
}

void KernelWrenches::begin(const WindowLayout& layout)
{
    if (loads_) loads_->begin(layout.load_points(rule_, 0));
}

void KernelWrenches::evaluate_loads(const WindowLayout& layout, const lanes::Pattern& pattern,
                                    const lanes::Values& start, const lanes::Values& nodes,
                                    const lanes::Rule& rule)
{
    const lanes::LoadProgram program = loads_->view();
    functions_->loads->interpolate_arms(program, start.numbers, nodes.increments, rule.M, rule.dM);
    loads_->run_steps(layout.angles);
    functions_->loads->share_out(program, rule.load_weights, rule.M_rows, nodes.at_loads.F);
    if (!loads_->has_others()) return;
    functions_->interpolate(pattern, start, nodes, rule);
    loads_->evaluate_others(nodes.at_loads.X, nodes.at_loads.V, rule.load_weights, layout.angles,
                            others_.data());
    functions_->loads->share_columns(program, others_.data(), rule.M_rows, nodes.at_loads.F);
}

/// About the centre of mass, sum_A X_A x F_A over all nodes: rows have all shares F_A but one, which is what
/// they leave of the sum over load points, as the shares of a load point add up to it.
void KernelWrenches::add_loads(int b, const InstantState& start, const lanes::Values& nodes,
                               double* wrench) const
{
    const int W = functions_->width, p = rule_.degree;
    const bool is_radau = rule_.points == Points::radau;
    double left[12], X[12], F[12], one[6];
    std::copy_n(totals_.data() + 12 * b, 12, left);
    const auto add = [&](const double* forces) {
        twist::rows(X, forces, one);
        for (int i = 0; i < 6; ++i) wrench[i] += one[i];
    };
    const auto place = [&](int lane) {   // of a column
        for (int i = 3; i < 12; ++i) X[i] = nodes.numbers[(12 * b + i) * W + lane];
    };
    for (int l = 0; l < p; ++l) {
        for (int i = 0; i < 12; ++i) {
            F[i] = nodes.at_loads.F[(12 * b + i) * W + l];
            left[i] -= F[i];
        }
        if (l == 0 && !is_radau)
            std::copy_n(start.X.data() + 12 * b, 12, X);
        else
            place(l);
        add(F);
    }
    if (is_radau)
        std::copy_n(start.X.data() + 12 * b, 12, X);
    else
        place(0);
    add(left);
}

void KernelWrenches::momentum(const WindowLayout& layout, const InstantState& start,
                              const lanes::Values& nodes, const lanes::Rule& rule, double* p)
{
    if (loads_) loads_->add_up(rule.load_weights, others_.empty() ? nullptr : others_.data(), totals_.data());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        double of_loads[6] = {};
        if (loads_) add_loads(b, start, nodes, of_loads);
        for (int i = 0; i < body.dofs; ++i) {
            const double weight = i < 3 ? layout.h(0) * body.weight[i] : 0;   // no moment about the centre
            p[body.first + i] = start.p[body.first + i] + weight + of_loads[i] + taken_[6 * b + i];
        }
    }
}

}   // namespace livens
