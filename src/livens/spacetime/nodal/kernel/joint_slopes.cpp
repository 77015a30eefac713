// SPDX-License-Identifier: BSD-3-Clause
// - mu N_i^T K_ij N_j of each row, and what turning does to the moment of all forces of joints on a body:
// with G_pq = d_p . g_q of their columns g, t_a = G_cb - G_bc and a turn w in its axes makes d_a the sum of
// w_e eps_eaf d_f (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/joint_slopes.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/rows/twist_blocks.h"

namespace livens {

namespace {

/// sum_f eps_eaf G_fb
double turned(const double (&G)[3][3], int e, int a, int b)
{
    if (e == a) return 0;
    const int f = 3 - e - a;
    return (a == (e + 1) % 3 ? 1 : -1) * G[f][b];
}

}   // namespace

JointSlopes::JointSlopes(const ModelTables& tables, const ElementRule& rule, int width)
    : tables_(tables), rule_(rule), width_(width), X_(12 * tables.bodies.size()), maps_(X_), forces_(X_)
{}

void JointSlopes::place(int lane, const lanes::Values& nodes)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        double* X = X_.data() + 12 * b;
        for (int i = 0; i < 12; ++i) X[i] = nodes.numbers[(12 * b + i) * width_ + lane];
        for (int i = 0; tables_.bodies[b].offset && i < 3; ++i)
            for (int a = 0; a < 3; ++a) X[i] -= tables_.bodies[b].center[a] * X[3 + 3 * a + i];
        tables_.bodies.map_twist(b, X_.data(), maps_.data() + 12 * b);
    }
}

Matrix<12, 12>& JointSlopes::of(int i, int j)
{
    const auto found = std::find_if(pairs_.rbegin(), pairs_.rend(),
                                    [=](const Pair& pair) { return pair.i == i && pair.j == j; });
    return found == pairs_.rend() ? pairs_.emplace_back(Pair{i, j, {}}).K : found->K;
}

void JointSlopes::add_row(int r, double mu, Instant at)
{
    const RowTable& table = tables_.rows[r];
    double g[RowTables::gradient_size];
    tables_.rows.gradient(r, at, X_.data(), g);
    for (int side = 0; side < table.n_sides; ++side) {
        for (const int a : table.columns[side])
            for (int i = 0; i < 3; ++i) forces_[12 * table.bodies[side] + a + i] -= mu * g[12 * side + a + i];
        double y[6];
        tables_.scaled_wrench(r, side, X_.data(), g, y);
        for (const double share : y) terms_ = std::max(terms_, std::abs(mu * share));
    }
    if (!table.is_quadratic) return add_hessian(r, mu, at);
    for (const RowTable::Entry& entry : table.form) {
        Matrix<12, 12>& K = of(table.bodies[entry.to_side], table.bodies[entry.from_side]);
        for (int i = 0; i < 3; ++i) K(entry.to + i, entry.from + i) -= mu * entry.value;
    }
}

void JointSlopes::add_hessian(int r, double mu, Instant at)
{
    const RowTable& table = tables_.rows[r];
    for (int i = 0; i < table.n_sides; ++i)
        for (int j = 0; j < table.n_sides; ++j)
            of(table.bodies[i], table.bodies[j]) +=
                -mu * constraint_hessian(*table.row, at, Configurations(X_.data()), table.bodies[i],
                                         table.bodies[j]);
}

void JointSlopes::add_turning(int b)
{
    const BodyTable& body = tables_.bodies[b];
    const double *d = X_.data() + 12 * b + 3, *g = forces_.data() + 12 * b;
    double G[3][3] = {};   // of columns about the centre of mass
    for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q)
            for (int i = 0; i < 3; ++i) G[p][q] += d[3 * p + i] * (g[3 + 3 * q + i] - body.center[q] * g[i]);
    double H[3][3];
    for (int a = 0; a < 3; ++a)
        for (int e = 0; e < 3; ++e)
            H[a][e] = turned(G, e, (a + 2) % 3, (a + 1) % 3) - turned(G, e, (a + 1) % 3, (a + 2) % 3);
    SlopesOfPair& slopes = slopes_.emplace_back(SlopesOfPair{b, b, {}, {}});
    const double* s = body.spin;
    for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    slopes.by_X[6 * (3 + a) + 3 + c] += s[3 * a + i] * H[i][j] * s[3 * c + j];
}

const std::vector<SlopesOfPair>& JointSlopes::find(int node, const WindowLayout& layout,
                                                   const RowPattern& pattern, const lanes::Values& nodes)
{
    const int lane = node % rule_.degree;
    place(lane, nodes);
    std::ranges::fill(forces_, 0.0);
    pairs_.clear();
    slopes_.clear();
    const Instant at{layout.time(rule_, node)};
    for (std::size_t c = 0; c < pattern.rows().size(); ++c)
        add_row(pattern.rows()[c], nodes.impulses[static_cast<int>(c) * width_ + lane], at);
    for (const auto& [i, j, K] : pairs_) {
        double raw[36] = {};
        SlopesOfPair& slopes = slopes_.emplace_back(SlopesOfPair{i, j, {}, {}});
        add_reduced(K, X_.data() + 12 * i, X_.data() + 12 * j, tables_.bodies[j].dofs, raw);
        scale_block(tables_, maps_.data(), i, maps_.data(), j, raw, slopes.by_X);
    }
    for (int b = 0; b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6) add_turning(b);
    return slopes_;
}

}   // namespace livens
