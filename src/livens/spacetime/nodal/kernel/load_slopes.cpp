// SPDX-License-Identifier: BSD-3-Clause
// Slopes of loads at the middle load point of an element by scaled twists, and what they are multiplied by in
// time (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/load_slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/twist_blocks.h"
#include "livens/multibody/model.h"

namespace livens {

/// S_AB = sum_c w_c M_A(s_c) M_B(s_c), C_AB = sum_c w_c M_A(s_c) M_B'(s_c).
LoadSlopes::LoadSlopes(const ModelTables& tables, const ElementRule& rule, int width)
    : tables_(tables), rule_(rule), width_(width), middle_(rule.degree / 2),
      S_(static_cast<std::size_t>(rule.degree * rule.degree), 0.0), C_(S_), X_(12 * tables.bodies.size()),
      V_(X_), maps_(X_)
{
    const int p = rule.degree, n = rule.size();
    for (int A = 0; A < p; ++A)
        for (int l = 0; l < p; ++l)
            for (int c = 0; c < p; ++c) {
                const int B = l == 0 ? p : l;
                const double w = rule.loads.weights[c] * rule.M[c * n + row_in_lane(rule, A)];
                S_[A * p + l] += w * rule.M[c * n + B];
                C_[A * p + l] += w * rule.dM[c * n + B];
            }
}

/// About the reference points, as loads want them.
void LoadSlopes::place(const lanes::Values& nodes)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const BodyTable& body = tables_.bodies[b];
        double *X = X_.data() + 12 * b, *V = V_.data() + 12 * b;
        for (int i = 0; i < 12; ++i) {
            X[i] = nodes.at_loads.X[(12 * b + i) * width_ + middle_];
            V[i] = nodes.at_loads.V[(12 * b + i) * width_ + middle_];
        }
        for (int i = 0; body.offset && i < 3; ++i)
            for (int a = 0; a < 3; ++a) {
                X[i] -= body.center[a] * X[3 + 3 * a + i];
                V[i] -= body.center[a] * V[3 + 3 * a + i];
            }
        tables_.bodies.map_twist(b, X_.data(), maps_.data() + 12 * b);
    }
}

/// N_i^T dF_i/dX_j N_j and the same by X', scaled; of forces along coordinates products in their place, a
/// vector a body instead of 6 x 6 a pair. The world has no twists.
void LoadSlopes::add(int l, const WindowLayout& layout)
{
    const Load& load = tables_.model->loads()[l];
    const Instant at = layout.load_point(rule_, 0, middle_);
    const LoadArguments arguments = tables_.loads.arguments(l, at, X_.data(), V_.data(), angles_);
    if (load.products) {
        for (const ProductSlopes& one : load.products(arguments)) add_product(load, one, layout.h(0));
        return;
    }
    LoadTangent slopes(load.bodies.size(), load.n_acted);
    load.tangent(arguments, slopes);
    terms_ = std::max(terms_, std::abs(layout.h(0)) * load_terms(tables_, load, arguments, slopes));
    for (std::size_t r = 0; r < load.n_acted; ++r)
        for (std::size_t s = 0; s < load.bodies.size(); ++s) {
            const int i = load.bodies[r], j = load.bodies[s];
            if (i == world || j == world) continue;
            SlopesOfPair& pair = pairs_.emplace_back(SlopesOfPair{i, j, {}, {}});
            const auto reduce = [&](const Matrix<12, 12>& K, double* scaled) {
                double raw[36] = {};
                add_reduced(K, X_.data() + 12 * i, X_.data() + 12 * j, tables_.bodies[j].dofs, raw);
                scale_block(tables_, maps_.data(), i, maps_.data(), j, raw, scaled);
            };
            if (load.depends_on_X) reduce(slopes.X[r][s], pair.by_X);
            if (load.depends_on_V) reduce(slopes.V[r][s], pair.by_V);
        }
}

/// Rounding of X and X' changes f by rounding of |df/dX| |X| + |df/dX'| |X'|, and rows by h times that times
/// the largest share of g = dq/dX: what terms() is for.
void LoadSlopes::add_product(const Load& load, const ProductSlopes& slopes, double h)
{
    SlopesOfProduct found{{load.bodies[0], load.bodies[1]}};
    const auto scaled = [&](int b, const Matrix34& g) {
        SlopesOfProduct::Twist y{};
        tables_.bodies.scaled_row(b, X_.data() + 12 * b, maps_.data() + 12 * b, g.a, y.data());
        return y;
    };
    double largest = 0, force = 0;   // what the slopes make of the terms of X and X'
    for (std::size_t side = 0; side < 2; ++side) {
        if (found.to[side] == world) continue;
        found.direction[side] = scaled(found.to[side], slopes.direction[side]);
        for (const double share : found.direction[side]) largest = std::max(largest, std::abs(share));
    }
    for (std::size_t k = 0; k < load.bodies.size(); ++k) {
        const int b = load.bodies[k];
        if (b == world) continue;
        found.from.push_back(b);
        found.by_X.push_back(scaled(b, slopes.by_X[k]));
        found.by_V.push_back(scaled(b, slopes.by_V[k]));
        for (int i = 0; i < 12; ++i)
            force += std::abs(slopes.by_X[k].a[i] * X_[12 * b + i]) +
                     std::abs(slopes.by_V[k].a[i] * V_[12 * b + i]);
    }
    terms_ = std::max(terms_, std::abs(h) * largest * force);
    products_.push_back(std::move(found));
}

/// Turns are followed from the start of the element to its middle in one step.
void LoadSlopes::find(const WindowLayout& layout, const lanes::Values& nodes)
{
    pairs_.clear();
    products_.clear();
    terms_ = 0;
    place(nodes);
    angles_ = layout.angles;
    tables_.loads.turns.follow(Configurations(X_.data()), angles_);
    for (const int l : tables_.loads.with_tangent) add(l, layout);
}

}   // namespace livens
