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

/// The part of v across q_0 .. q_n-1, rows of d numbers; R, if it is there, takes what is taken off.
double orthogonalise(const double* q, int n, int d, double* v, double* R, int stride)
{
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

void NodeGradients::of(const JointRows& joint, int b, int node, double* G) const
{
    const BodyTable& body = tables.bodies[b];
    const lanes::Pattern& all = pattern.view();
    std::fill_n(G, joint.n() * body.dofs, 0.0);
    for (int i = 0; i < joint.n(); ++i) {
        const int row = joint.rows[static_cast<std::size_t>(i)];
        const auto put = [&](int twist, double value) {
            const int k = twist - body.first;
            if (k >= 0 && k < body.dofs) G[i * body.dofs + k] += value;
        };
        for (int u = all.gradients.unit_begin[row]; u < all.gradients.unit_begin[row + 1]; ++u)
            put(all.gradients.units[u].twist, all.gradients.units[u].value);
        const lanes::Group* group = all.groups;
        while (row >= group->first + group->n) ++group;
        for (int c = group->columns; c < group[1].columns; ++c) {
            const int entry = all.gradients.columns[c].entry + row - group->first;
            const int lane = node == p ? 0 : node;
            put(all.gradients.columns[c].twist,
                node == 0 ? start.gradients[entry] : nodes.gradients[entry * width + lane]);
        }
    }
}

bool NodeGradients::find(int b, const TreePlan& plan, JointMotion& motion) const
{
    const JointRows& joint = plan.held[static_cast<std::size_t>(b)];
    const int above = plan.parent[static_cast<std::size_t>(b)], m = joint.n(), d = tables.bodies[b].dofs;
    const int n = above == world ? 0 : tables.bodies[above].dofs;
    if (m > d) return false;
    motion.f = d - m;
    for (Numbers* z : {&motion.z_rows, &motion.z_columns})
        z->resize(static_cast<std::size_t>(d * motion.f * p));
    for (Numbers* T : {&motion.T_rows, &motion.T_columns}) T->resize(static_cast<std::size_t>(d * n * p));
    for (int node = 0; node <= p; ++node) {
        double own[36], over[36], z[36], T[36];
        if (m > 0) of(joint, b, node, own);
        if (m > 0 && above != world) of(joint, above, node, over);
        if (!motion_of(own, m, d, over, n, z, T)) return false;
        const auto put = [&](Numbers& to, const double* from, int size, int lane) {
            for (int i = 0; i < size; ++i) to[i * p + lane] = from[i];
        };
        if (is_row(node)) put(motion.z_rows, z, d * motion.f, node % p);
        if (is_row(node)) put(motion.T_rows, T, d * n, node % p);
        if (node > 0) put(motion.z_columns, z, d * motion.f, node % p);
        if (node > 0) put(motion.T_columns, T, d * n, node % p);
    }
    return true;
}

}   // namespace livens
