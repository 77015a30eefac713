// SPDX-License-Identifier: BSD-3-Clause
// Loads at the Gauss points of an element, put into lanes, and the momentum at its end from the balance of
// all rows, p_0 + sum f_A and s_0 + sum tau_A: the last row itself would carry the rounding of k_AB / h
// (docs/theory.md, "The element").
#include "livens/spacetime/nodal/kernel/kernel_wrenches.h"

#include <algorithm>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"

namespace livens {

KernelWrenches::KernelWrenches(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), X_(12 * tables.bodies.size()), V_(X_), raw_(X_),
      of_loads_(6 * tables.bodies.size()), taken_(of_loads_)
{}

void KernelWrenches::evaluate_loads(const WindowLayout& layout, const lanes::Pattern& pattern,
                                    const lanes::Values& nodes, int width)
{
    std::ranges::fill(of_loads_, 0.0);
    for (int c = 0; c < rule_.degree; ++c) {
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (!pattern.bodies[b].loaded) continue;
            const double* center = tables_.bodies[b].center;
            double *X = X_.data() + 12 * b, *V = V_.data() + 12 * b;
            for (int i = 0; i < 12; ++i) {
                X[i] = nodes.load_X[(12 * b + i) * width + c];
                V[i] = nodes.load_V[(12 * b + i) * width + c];
            }
            for (int i = 0; tables_.bodies[b].offset && i < 3; ++i)
                for (int a = 0; a < 3; ++a) {
                    X[i] -= center[a] * X[3 + 3 * a + i];
                    V[i] -= center[a] * V[3 + 3 * a + i];
                }
        }
        if (c == 0) angles_ = layout.angles;
        tables_.loads.turns.follow(Configurations(X_.data()), angles_);
        std::ranges::fill(raw_, 0.0);
        tables_.loads.add(layout.load_point(rule_, 0, c), X_.data(), V_.data(),
                          layout.h(0) * rule_.loads.weights[c], raw_.data(), angles_);
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (!pattern.bodies[b].loaded) continue;
            double *F = raw_.data() + 12 * b, wrench[6];
            for (int a = 0; a < 3; ++a)
                for (int i = 0; i < 3; ++i) F[3 + 3 * a + i] -= tables_.bodies[b].center[a] * F[i];
            for (int i = 0; i < 12; ++i) nodes.loads[(12 * b + i) * width + c] = F[i];
            twist::rows(X_.data() + 12 * b, F, wrench);
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) of_loads_[6 * b + i] += wrench[i];
        }
    }
}

void KernelWrenches::momentum(const WindowLayout& layout, const InstantState& start, double* p) const
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        for (int i = 0; i < body.dofs; ++i) {
            const double weight = i < 3 ? layout.h(0) * body.weight[i] : 0;   // no moment about the centre
            p[body.first + i] = start.p[body.first + i] + weight + of_loads_[6 * b + i] + taken_[6 * b + i];
        }
    }
}

}   // namespace livens
