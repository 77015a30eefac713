// SPDX-License-Identifier: BSD-3-Clause
// The polynomial of the element before at shares 1 + s_A h / h_before: weights of its nodes in lanes, made
// anew where the ratio of lengths changes; the kernel turns the quaternions back by its end (docs/theory.md,
// "Without a tangent", Guesses).
#include "livens/spacetime/nodal/kernel/extrapolation.h"

#include <algorithm>
#include <cmath>

namespace livens {

namespace {

/// Weights outside of an element grow with 6^degree, and rounding with them: above this degree a polynomial
/// through every second node says more.
constexpr int highest_degree = 10;

/// The end, from which the next element goes on, each step-th node before it, and the start.
std::vector<int> nodes_used(int degree)
{
    const int step = degree > highest_degree ? 2 : 1;
    std::vector<int> used;
    for (int A = degree; A > 0; A -= step) used.insert(used.begin(), A);
    used.insert(used.begin(), 0);
    return used;
}

std::vector<double> some_of(const std::vector<double>& all, const std::vector<int>& places)
{
    std::vector<double> some;
    for (const int place : places) some.push_back(all[place]);
    return some;
}

}   // namespace

Extrapolation::Extrapolation(const ElementRule& rule, const lanes::Functions& functions)
    : degree_(rule.degree), functions_(&functions), nodes_(rule.nodes), used_(nodes_used(rule.degree)),
      basis_(some_of(nodes_, used_))
{
    weights_.resize(static_cast<std::size_t>(functions.width * (functions.width + 1)));
}

void Extrapolation::remember(const double* place, int n_bodies, double start, double end)
{
    places_ = place;
    n_bodies_ = n_bodies;
    end_ = end;
    h_ = end - start;
}

/// Of all nodes for an element that is `ratio` times as long.
void Extrapolation::weigh(double ratio)
{
    if (std::abs(ratio - ratio_) <= 1e-12 * std::abs(ratio)) return;
    ratio_ = ratio;
    std::ranges::fill(weights_, 0.0);
    double* weights = weights_.data();
    const int W = functions_->width;
    std::vector<double> values(used_.size());
    for (int l = 0; l < W; ++l) {
        if (l >= degree_) {   // stands for no node
            weights[W * W + l] = 1;
            continue;
        }
        basis_.values(1 + ratio * nodes_[l == 0 ? degree_ : l], values);
        for (std::size_t k = 0; k < used_.size(); ++k) {
            const int A = used_[k], from = A == 0 ? W : A == degree_ ? 0 : A;
            weights[from * W + l] = values[k];
        }
    }
}

/// Elements of one length have weights that were made once: ratios are compared to rounding.
void Extrapolation::place(double h, double* place)
{
    weigh(h / h_);
    functions_->extrapolate(n_bodies_, degree_, places_, weights_.data(), place);
}

}   // namespace livens
