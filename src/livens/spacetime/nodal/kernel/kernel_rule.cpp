// SPDX-License-Identifier: BSD-3-Clause
// k_AB / h, - h K^-1, weights and values at load points as rows of lanes, one lane a node, with the last node
// in lane 0 where nodes are unknown (docs/theory.md, "Without a tangent", All nodes at once). Turns are
// solved for in still axes if there are gyroscopic terms ("Still axes").
#include "livens/spacetime/nodal/kernel/kernel_rule.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"

namespace livens {

namespace {

/// An element of so few steps has nothing to gain from still axes.
constexpr int few_steps = 3;

/// Whether some body's axis of turning turns itself. Where none does, as in a plane, nothing is gyroscopic.
bool turns_in_space(const ModelTables& tables, const InstantState& start, double h)
{
    const std::vector<double>& accelerations = start.acceleration[h > 0 ? 1 : 0];
    // the bound below is the square of an angle of 1e-8 between spin and spin acceleration
    return std::ranges::any_of(tables.bodies, [&](const BodyTable& body) {
        const double *w = start.velocity.data() + body.first + 3, *a = accelerations.data() + body.first + 3;
        if (body.dofs == 3) return false;
        const Vector3 turn{w[0], w[1], w[2]}, change{a[0], a[1], a[2]}, across = cross(turn, change);
        return dot(across, across) > 1e-16 * dot(turn, turn) * dot(change, change);
    });
}

}   // namespace

/// Tables of W x W numbers, one after the other: for length 1 k, -K^-1, M, M' and M at rows, for length h
/// k / h, -h K^-1 and M' / h. Behind them W numbers each: h w_A, h times weights of load points, shares c_A
/// (radau).
KernelRule::KernelRule(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions)
    : tables_(tables), rule_(rule), width_(functions != nullptr ? functions->width : 0)
{
    if (functions == nullptr) return;
    const int p = rule.degree, W = width_, n = rule.size(), block = W * W;
    numbers_.assign(8 * block + 3 * W, 0.0);
    double *k = numbers_.data(), *inverse = k + block, *M = inverse + block, *dM = M + block,
           *M_rows = dM + block, *scaled_k = M_rows + block, *scaled_inverse = scaled_k + block,
           *scaled_dM = scaled_inverse + block, *weights = scaled_dM + block;
    const std::vector<double> K = inverse_of_k(rule);
    for (int l = 0; l < p; ++l) {
        for (int A = 0; A < p; ++A) {
            k[l * W + A] = rule.k[row_of(A) * n + node_of(l)];
            // rows are in the order of their nodes
            const int row = row_of(A) - node_of_row(rule, 0);
            inverse[A * W + l] = -K[static_cast<std::size_t>((node_of(l) - 1) * p + row)];
            M_rows[A * W + l] = rule.M[A * n + row_of(l)];   // here A is a load point
        }
        for (int c = 0; c < W; ++c) {   // lanes behind the last load point are as this one
            M[l * W + c] = rule.M[std::min(c, p - 1) * n + node_of(l)];
            dM[l * W + c] = rule.dM[std::min(c, p - 1) * n + node_of(l)];
        }
    }
    lanes_ = {scaled_k,    scaled_inverse, weights, M,       scaled_dM,    M_rows,
              weights + W, nullptr,        nullptr, nullptr, tables.length};
    if (rule.points != Points::radau) return;
    double* share = weights + 2 * W;
    for (int A = 0; A < p; ++A) share[A] = rule.c[row_of(A)];
    start_rates_.assign(12 * tables.bodies.size(), 0.0);
    no_momentum_.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
    lanes_.share = share;
    lanes_.start_rates = start_rates_.data();
}

void KernelRule::scale(double h)
{
    h_ = h;
    const int W = width_, block = W * W;
    const double* k = numbers_.data();
    double *scaled = numbers_.data() + 5 * block, *weights = scaled + 3 * block;
    const auto fill = [block](const double* __restrict of, double* __restrict to, auto&& by) {
        for (int i = 0; i < block; ++i) to[i] = by(of[i]);
    };
    fill(k, scaled, [h](double x) { return x / h; });
    fill(k + block, scaled + block, [h](double x) { return x * h; });
    fill(k + 3 * block, scaled + 2 * block, [h](double x) { return x / h; });
    for (int A = 0; A < rule_.degree; ++A) weights[A] = h * rule_.weights[row_of(A)];
    for (int c = 0; c < rule_.degree; ++c) weights[W + c] = h * rule_.loads.weights[c];
}

/// X' of centres of mass and directors.
void KernelRule::find_start_rates(const InstantState& start)
{
    tables_.bodies.rates_of(start.X.data(), start.velocity.data(), start_rates_.data());
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int a = 0; tables_.bodies[b].offset && a < 3; ++a)
            for (int i = 0; i < 3; ++i)
                start_rates_[12 * b + i] +=
                    tables_.bodies[b].center[a] * start_rates_[12 * b + 3 + 3 * a + i];
}

/// Root of mass times shifts and root of inertia times changes of directors, times the largest |k_AB| / h:
/// in the units of scaled rows.
double KernelRule::largest_of_sums(const double* increments) const
{
    const int W = width_, p = rule_.degree;
    const auto largest = [W, p](const double* of, int n) {
        double most = 0;
        for (int i = 0; i < n; ++i)
            for (int l = 0; l < p; ++l) most = std::max(most, std::abs(of[i * W + l]));
        return most;
    };
    double impulse = 0;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        const double *d = increments + 12 * b * W, turned = largest(d + 3 * W, 9);
        impulse = std::max(impulse, largest(d, 3) / body.inverse_root_mass + body.root_inertia * turned);
    }
    return impulse * largest(lanes_.k, p);
}

void KernelRule::use(const WindowLayout& layout, const InstantState& start, int last_steps)
{
    times_.clear();
    for (int l = 0; l < rule_.degree; ++l) times_.push_back(layout.time(rule_, node_of(l)));
    const bool is_shared = lanes_.share != nullptr;
    lanes_.momentum = is_shared ? no_momentum_.data() : start.momentum.data();
    if (is_shared) find_start_rates(start);
    const int few = lanes_.in_still_axes ? few_steps - 1 : few_steps;   // which they made so few
    lanes_.in_still_axes = !is_shared && last_steps > few && turns_in_space(tables_, start, layout.h(0));
    if (layout.h(0) != h_) scale(layout.h(0));
}

}   // namespace livens
