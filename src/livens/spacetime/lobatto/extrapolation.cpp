// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/lobatto/extrapolation.h"

#include <cmath>

namespace livens {

namespace {

/// Weights outside of an element grow with 6^degree, and rounding with them: above this degree a polynomial
/// through every second node says more.
constexpr int highest_degree = 10;

constexpr int most_lanes = 24;

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

Extrapolation::Extrapolation(const ElementRule& rule, int width)
    : degree_(rule.degree), width_(width), nodes_(rule.nodes), used_(nodes_used(rule.degree)),
      basis_(some_of(nodes_, used_))
{}

void Extrapolation::remember(const double* place, int n_bodies, double start, double end)
{
    places_.assign(place, place + 7 * n_bodies * width_);
    end_ = end;
    h_ = end - start;
}

/// Of all nodes for an element that is `ratio` times as long.
void Extrapolation::weigh(double ratio)
{
    if (std::abs(ratio - ratio_) <= 1e-12 * std::abs(ratio)) return;
    ratio_ = ratio;
    const int n = degree_ + 1;   // lanes of what is remembered, and its start
    weights_.assign(static_cast<std::size_t>(n * width_), 0.0);
    std::vector<double> values(used_.size());
    for (int l = 0; l < degree_; ++l) {
        basis_.values(1 + ratio * nodes_[l == 0 ? degree_ : l], values);
        for (std::size_t k = 0; k < used_.size(); ++k) {
            const int A = used_[k], from = A == 0 ? degree_ : A == degree_ ? 0 : A;
            weights_[static_cast<std::size_t>(from * width_ + l)] = values[k];
        }
    }
}

void Extrapolation::place(double h, int n_lanes, double* place)
{
    weigh(h / h_);
    const int W = width_;
    const std::size_t n_bodies = places_.size() / static_cast<std::size_t>(7 * W);
    for (std::size_t b = 0; b < n_bodies; ++b) {
        const double* from = places_.data() + 7 * b * W;
        double sums[7][most_lanes];
        for (int c = 0; c < 7; ++c) {
            double* sum = sums[c];
            const double* of_start = weights_.data() + degree_ * W;   // where nothing is turned
            for (int l = 0; l < n_lanes; ++l) sum[l] = c == 3 ? of_start[l] : 0;
            for (int k = 0; k < degree_; ++k)
                for (int l = 0; l < n_lanes; ++l) sum[l] += weights_[k * W + l] * from[c * W + k];
        }
        const double s = from[3 * W], x = from[4 * W], y = from[5 * W], z = from[6 * W];   // of the end
        double* to = place + 7 * b * W;
        for (int l = 0; l < n_lanes; ++l) {
            for (int c = 0; c < 3; ++c) to[c * W + l] = sums[c][l] - from[c * W];
            const double qs = sums[3][l], qx = sums[4][l], qy = sums[5][l], qz = sums[6][l];
            const double size = 1 / std::sqrt(qs * qs + qx * qx + qy * qy + qz * qz);
            to[3 * W + l] = size * (s * qs + x * qx + y * qy + z * qz);
            to[4 * W + l] = size * (s * qx - x * qs - (y * qz - z * qy));
            to[5 * W + l] = size * (s * qy - y * qs - (z * qx - x * qz));
            to[6 * W + l] = size * (s * qz - z * qs - (x * qy - y * qx));
        }
    }
}

}   // namespace livens
