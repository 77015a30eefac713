// SPDX-License-Identifier: BSD-3-Clause
// The largest eigenvalue of a symmetric part is at most the largest sum of what a row of blocks has in
// Frobenius' norm, half of it from the transpose. In mass-orthonormal twists the motions that joints leave
// are a part of all, and a largest eigenvalue on a part is no larger (docs/theory.md, "Highest frequencies").
#include "livens/statics/rate_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "livens/dynamics/rows/twist_blocks.h"
#include "livens/multibody/model.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::inline statics_internal {

double RateBounds::springs(const State& state) { return std::sqrt(largest(state, Slopes::by_X)); }

double RateBounds::dampers(const State& state) { return largest(state, Slopes::by_V); }

/// Infinite where an inertia is singular: in scaled twists M is then not the identity, and this is no bound.
double RateBounds::largest(const State& state, Slopes slopes)
{
    if (!tables_.bodies.are_regular()) return std::numeric_limits<double>::infinity();
    maps_.resize(12 * tables_.bodies.size());
    tables_.bodies.map_twists(state.X.data()->a, maps_.data());
    angles_ = tables_.loads.turns.begin(state);
    tables_.loads.turns.follow(state.X, angles_);
    sums_.assign(tables_.bodies.size(), 0.0);
    for (const int l : tables_.loads.with_tangent) {
        const Load& load = tables_.model->loads()[l];
        if (slopes == Slopes::by_X ? load.depends_on_X : load.depends_on_V) add(l, state, slopes);
    }
    return *std::max_element(sums_.begin(), sums_.end());
}

void RateBounds::add(int l, const State& state, Slopes slopes)
{
    const Load& load = tables_.model->loads()[l];
    const double *X = state.X.data()->a, *V = state.V.data()->a;
    const LoadArguments arguments = tables_.loads.arguments(l, {state.t, Side::right}, X, V, angles_);
    if (slopes == Slopes::by_V && load.products) {   // which have all of it, for a tenth
        for (const ProductSlopes& one : load.products(arguments)) add_damper(load, one, X);
        return;
    }
    LoadTangent tangent(load.bodies.size(), load.n_acted);
    load.tangent(arguments, tangent);
    for (std::size_t r = 0; r < load.n_acted; ++r)
        for (std::size_t s = 0; s < load.bodies.size(); ++s) {
            const int i = load.bodies[r], j = load.bodies[s];
            if (i == world || j == world) continue;
            double raw[36] = {}, scaled[36];
            const Matrix<12, 12>& K = slopes == Slopes::by_X ? tangent.X[r][s] : tangent.V[r][s];
            add_reduced(K, X + 12 * i, X + 12 * j, tables_.bodies[j].dofs, raw);
            scale_block(tables_, maps_.data(), i, maps_.data(), j, raw, scaled);
            const double size = std::sqrt(squared_norm(std::span(scaled)));
            add_size(i, j, size);
        }
}

/// A block g s^T with the slope s is of rank one: its Frobenius norm is that of g times that of s.
void RateBounds::add_damper(const Load& load, const ProductSlopes& slopes, const double* X)
{
    const auto size = [&](int b, const Matrix34& g) {
        double y[6] = {};
        tables_.bodies.scaled_row(b, X + 12 * b, maps_.data() + 12 * b, g.a, y);
        return std::sqrt(squared_norm(std::span(y)));
    };
    for (std::size_t r = 0; r < load.n_acted; ++r)
        for (std::size_t s = 0; s < load.bodies.size(); ++s) {
            const int i = load.bodies[r], j = load.bodies[s];
            if (i != world && j != world)
                add_size(i, j, size(i, slopes.direction[r]) * size(j, slopes.by_V[s]));
        }
}

/// Half in the row of either body: the block and its transpose are halves of the symmetric part.
void RateBounds::add_size(int i, int j, double size)
{
    sums_[i] += 0.5 * size;
    sums_[j] += 0.5 * size;
}

}   // namespace livens::inline statics_internal
