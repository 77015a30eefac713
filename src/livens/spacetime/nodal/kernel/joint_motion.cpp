// SPDX-License-Identifier: BSD-3-Clause
// y = T y_parent + z theta at each node: with G_c y_c + G_p y_p = 0 and G_c^T = Q R, T = - Q R^-T G_p, and z
// spans what is across Q (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/joint_motion.h"

#include <algorithm>
#include <cmath>

namespace livens {

namespace {

/// Of a joint's rows on its outer body, by their own size: nearly dependent ones do not tell how it moves.
constexpr double least_of_rows = 1e-6;
constexpr int most_nodes = 18;   // degrees that have lanes

/// The part of v across q_0 .. q_n-1, rows of d numbers; R, if it is there, takes what is taken off.
double orthogonalise(const double* q, int n, int d, double* v, double* R, int stride)
{
    // the second time takes off what rounding of a large part along q has left of a small rest
    for (int twice = 0; twice < 2; ++twice)
        for (int k = 0; k < n; ++k) {
            double along = 0;
            for (int i = 0; i < d; ++i) along += q[k * d + i] * v[i];
            for (int i = 0; i < d; ++i) v[i] -= along * q[k * d + i];
            if (R != nullptr) R[k * stride] += along;
        }
    double size = 0;
    for (int i = 0; i < d; ++i) size += v[i] * v[i];
    return std::sqrt(size);
}

/// What a body with the m rows `own` moves by at one node: z, d x f, and T, d x n, for the rows `above` of a
/// parent of n freedoms. False: the rows hang together.
bool motion_of(const double* own, int m, int d, const double* above, int n, double* z, double* T)
{
    double q[36] = {}, R[36] = {};
    for (int r = 0; r < m; ++r) {
        double* v = q + r * d;
        std::copy_n(own + r * d, d, v);
        double before = 0;
        for (int i = 0; i < d; ++i) before += v[i] * v[i];
        R[6 * r + r] = orthogonalise(q, r, d, v, R + r, 6);
        if (!(R[6 * r + r] > least_of_rows * std::sqrt(before))) return false;
        for (int i = 0; i < d; ++i) v[i] /= R[6 * r + r];
    }
    std::fill_n(T, d * n, 0.0);
    for (int j = 0; j < n; ++j) {   // T = - Q R^-T above
        double x[6];
        for (int r = 0; r < m; ++r) {
            x[r] = above[r * n + j];
            for (int k = 0; k < r; ++k) x[r] -= R[6 * k + r] * x[k];
            x[r] /= R[6 * r + r];
            for (int i = 0; i < d; ++i) T[i * n + j] -= q[r * d + i] * x[r];
        }
    }
    double left[6];   // of unit vectors, squared: what those so far have of them is taken off
    std::fill_n(left, d, 1.0);
    for (int k = 0; k < m; ++k)
        for (int e = 0; e < d; ++e) left[e] -= q[k * d + e] * q[k * d + e];
    for (int f = m; f < d; ++f) {   // the one with most left
        const auto e = std::max_element(left, left + d) - left;
        double* v = q + f * d;
        std::fill_n(v, d, 0.0);
        v[e] = 1;
        const double size = orthogonalise(q, f, d, v, nullptr, 0);
        for (int i = 0; i < d; ++i) {
            v[i] /= size;
            z[i * (d - m) + f - m] = v[i];
            left[i] -= v[i] * v[i];
        }
    }
    return true;
}

}   // namespace

/// First with one order of twists at all nodes side by side; where that leaves too little of a row or twist
/// at one of them, node by node.
bool spacetime_internal::find_motion(const lanes::BlockFunctions& functions, const lanes::JointSize& size,
                                     const HoldingRows& rows, double* z, double* T)
{
    const auto& [m, d, n, p] = size;
    if (functions.move_joint(rows.own, rows.above, size, least_of_rows, z, T)) return true;
    for (int A = 0; A < p; ++A) {
        double own[36], above[36], z_here[36], T_here[36];
        for (int i = 0; i < m * d; ++i) own[i] = rows.own[i * p + A];
        for (int i = 0; i < m * n; ++i) above[i] = rows.above[i * p + A];
        if (!motion_of(own, m, d, above, n, z_here, T_here)) return false;
        for (int i = 0; i < d * (d - m); ++i) z[i * p + A] = z_here[i];
        for (int i = 0; i < d * n; ++i) T[i * p + A] = T_here[i];
    }
    return true;
}

/// Constants of a row are units of the pattern; other entries stand in dense columns of the row's group, row
/// after row. Twists of other bodies are left out.
GradientPlaces::GradientPlaces(const ModelTables& tables, const RowPattern& pattern, const JointRows& joint,
                               int b)
{
    if (b == world) return;
    const BodyTable& body = tables.bodies[b];
    const lanes::Pattern& all = pattern.view();
    size = joint.n() * body.dofs;
    const auto put = [&](int i, int twist, int from, double value) {
        const int k = twist - body.first;
        if (k >= 0 && k < body.dofs) parts.push_back({i * body.dofs + k, from, value});
    };
    for (int i = 0; i < joint.n(); ++i) {
        const int row = joint.rows[static_cast<std::size_t>(i)];
        for (int u = all.gradients.unit_begin[row]; u < all.gradients.unit_begin[row + 1]; ++u)
            put(i, all.gradients.units[u].twist, -1, all.gradients.units[u].value);
        const lanes::Group* group = all.groups;
        while (row >= group->first + group->n) ++group;
        for (int c = group->columns; c < group[1].columns; ++c) {
            const lanes::Column& column = all.gradients.columns[c];
            put(i, column.twist, column.entry + row - group->first, 0);
        }
    }
}

void NodeGradients::of(const GradientPlaces& places, int node, double* G) const
{
    std::fill_n(G, places.size, 0.0);
    for (const GradientPlaces::Part& part : places.parts)
        G[part.to] += part.from < 0 ? part.value
                      : node == 0   ? start.gradients[part.from]
                                    : nodes.gradients[part.from * width + node % p];
}

HeldBody::HeldBody(const ModelTables& tables, const RowPattern& pattern, const TreePlan& plan, int b)
    : size_{plan.held[static_cast<std::size_t>(b)].n(), tables.bodies[b].dofs, 0, 0},
      own_(tables, pattern, plan.held[static_cast<std::size_t>(b)], b),
      above_(tables, pattern, plan.held[static_cast<std::size_t>(b)],
             plan.parent[static_cast<std::size_t>(b)])
{
    const int above = plan.parent[static_cast<std::size_t>(b)];
    if (above != world) size_.n = tables.bodies[above].dofs;
}

bool HeldBody::find_at(const NodeGradients& gradients, int node, Numbers& z_of_all, Numbers& T_of_all) const
{
    const int p = gradients.p, lane = node % p, f = size_.d - size_.m;
    double own[36], above[36], z[36], T[36];
    gradients.of(own_, node, own);
    gradients.of(above_, node, above);
    if (!motion_of(own, size_.m, size_.d, above, size_.n, z, T)) return false;
    for (int i = 0; i < size_.d * f; ++i) z_of_all[i * p + lane] = z[i];
    for (int i = 0; i < size_.d * size_.n; ++i) T_of_all[i * p + lane] = T[i];
    return true;
}

/// All nodes side by side. False: at one of them the same choice does not serve.
bool HeldBody::find_columns(const NodeGradients& gradients, JointMotion& motion) const
{
    const int p = gradients.p;
    double own[36 * most_nodes], above[36 * most_nodes];
    const auto gather = [&](const GradientPlaces& places, double* G) {
        std::fill_n(G, places.size * p, 0.0);
        for (const GradientPlaces::Part& part : places.parts)
            for (int l = 0; l < p; ++l)
                G[part.to * p + l] +=
                    part.from < 0 ? part.value : gradients.nodes.gradients[part.from * gradients.width + l];
    };
    gather(own_, own);
    gather(above_, above);
    return gradients.functions.move_joint(own, above, {size_.m, size_.d, size_.n, p}, least_of_rows,
                                          motion.z_columns.data(), motion.T_columns.data());
}

/// Rows and columns are the same nodes in all lanes but lane 0, which with lobatto is node 0 for rows and
/// node p for columns: only that one is found anew.
bool HeldBody::find(const NodeGradients& gradients, JointMotion& motion) const
{
    const auto p = static_cast<std::size_t>(gradients.p), d = static_cast<std::size_t>(size_.d);
    if (size_.m > size_.d) return false;
    motion.f = size_.d - size_.m;
    motion.z_columns.resize(d * static_cast<std::size_t>(motion.f) * p);
    motion.T_columns.resize(d * static_cast<std::size_t>(size_.n) * p);
    if (!find_columns(gradients, motion))
        for (int node = 1; node <= gradients.p; ++node)
            if (!find_at(gradients, node, motion.z_columns, motion.T_columns)) return false;
    motion.z_rows = motion.z_columns;
    motion.T_rows = motion.T_columns;
    return !gradients.has_first_row || find_at(gradients, 0, motion.z_rows, motion.T_rows);
}

}   // namespace livens
