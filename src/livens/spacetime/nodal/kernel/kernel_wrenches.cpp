// SPDX-License-Identifier: BSD-3-Clause
// Loads at the Gauss points of an element, in lanes, and the momentum at its end from the balance of all
// rows, p_0 + sum f_A and s_0 + sum tau_A: the last row itself would carry the rounding of k_AB / h
// (docs/theory.md, "The element").
#include "livens/spacetime/nodal/kernel/kernel_wrenches.h"

#include <algorithm>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"

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

/// Of recorded loads only the arms that their tapes look at are interpolated. X and X' of all bodies are made
/// only for loads that record nothing, whose F are added to what the others have shared out.
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
    const double* X_0 = start.X.data() + 12 * b;
    double left[12];   // at the end that is no row
    std::copy_n(totals_.data() + 12 * b, 12, left);
    // f_0 and sum d_a x f_a of numbers that far apart
    const auto add = [&](const double* d, int to_next_d, const double* f, int to_next_f) {
        double moment[3] = {};
        for (int a = 3; a < 12; a += 3) {
            const double x = d[a * to_next_d], y = d[(a + 1) * to_next_d], z = d[(a + 2) * to_next_d];
            const double u = f[a * to_next_f], v = f[(a + 1) * to_next_f], w = f[(a + 2) * to_next_f];
            moment[0] += y * w - z * v;
            moment[1] += z * u - x * w;
            moment[2] += x * v - y * u;
        }
        for (int i = 0; i < 3; ++i) wrench[i] += f[i * to_next_f], wrench[3 + i] += moment[i];
    };
    const double *numbers = nodes.numbers + 12 * b * W, *F = nodes.at_loads.F + 12 * b * W;
    for (int l = 0; l < p; ++l) {
        for (int i = 0; i < 12; ++i) left[i] -= F[i * W + l];
        if (l == 0 && !is_radau)
            add(X_0, 1, F, W);
        else
            add(numbers + l, W, F + l, W);
    }
    if (is_radau)
        add(X_0, 1, left, 1);
    else
        add(numbers, W, left, 1);
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
