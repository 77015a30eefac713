// SPDX-License-Identifier: BSD-3-Clause
// - mu N_i^T K_ij N_j of each row, and what turning does to the moment of all forces of joints on a body:
// with G_pq = d_p . g_q of their columns g, t_a = G_cb - G_bc and a turn w in its axes makes d_a the sum of
// w_e eps_eaf d_f (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/joint_slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/rows/twist_blocks.h"
#include "livens/multibody/model.h"

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

/// From the last one back: rows of one joint follow each other, so that their pair is among the last.
Matrix4& JointSlopes::of(int i, int j)
{
    const auto found = std::find_if(pairs_.rbegin(), pairs_.rend(),
                                    [=](const Pair& pair) { return pair.i == i && pair.j == j; });
    return found == pairs_.rend() ? pairs_.emplace_back(Pair{i, j, {}}).K : found->K;
}

/// `largest` multiplier of the row at those nodes that this one stands for.
void JointSlopes::add_row(int r, double mu, double largest, Instant at)
{
    const RowTable& table = tables_.rows[r];
    double g[RowTables::gradient_size];
    tables_.rows.gradient(r, at, X_.data(), g);
    for (int side = 0; side < table.n_sides; ++side) {
        for (const int a : table.columns[side])
            for (int i = 0; i < 3; ++i) forces_[12 * table.bodies[side] + a + i] -= mu * g[12 * side + a + i];
        double y[6];
        tables_.scaled_wrench(r, side, X_.data(), g, y);
        for (const double share : y) terms_ = std::max(terms_, std::abs(largest * share));
    }
    if (!table.is_quadratic) return add_hessian(r, mu, at);
    for (const RowTable::Entry& entry : table.form)
        of(table.bodies[entry.to_side], table.bodies[entry.from_side])(entry.to / 3, entry.from / 3) -=
            mu * entry.value;
}

/// Of a form d2/dX dX, by rows and columns of its bodies: gradients are X K, so that C_ij^T stands where X_j
/// makes the gradient by X_i.
void JointSlopes::add_form(const QuadraticForm& form, int i, int j, double factor)
{
    const auto add = [&](int body, int other, const Matrix4& C, bool is_transposed) {
        Matrix4& K = of(body, other);
        for (int to = 0; to < 4; ++to)
            for (int from = 0; from < 4; ++from)
                K(to, from) += factor * (is_transposed ? C(to, from) : C(from, to));
    };
    add(j, j, form.c_jj, false);
    if (i == world) return;
    add(i, i, form.c_ii, false);
    add(i, j, form.c_ij, true);
    add(j, i, form.c_ij, false);
}

/// Its forms by their weights, and of its functions sum_kl F_kl dq_k/dX (dq_l/dX)^T, at once by scaled
/// twists.
void JointSlopes::add_hessian(int r, double mu, Instant at)
{
    const RowTable& table = tables_.rows[r];
    const ConstraintRow& row = *table.row;
    const Configurations X(X_.data());
    for_each_form(row, at, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        add_form(form, i, j, -mu * weight);
    });
    for_each_function(row,
                      [&](const SmoothFunction& F, std::size_t first) { add_function(row, F, first, mu); });
}

/// - mu sum_kl F_kl (dq_k/dX) (dq_l/dX)^T for all pairs of the function's bodies, two a form at most; a body
/// that several forms share has one place.
void JointSlopes::add_function(const ConstraintRow& row, const SmoothFunction& function, std::size_t first,
                               double mu)
{
    constexpr std::size_t most = 2 * SmoothFunction::most;
    int bodies[most];
    std::size_t n = 0;
    double y[SmoothFunction::most][most][6] = {};   // of each q by each body
    const Configurations X(X_.data());
    const SmoothFunction::Value F = function.at(function_point(row, function, first, X));
    for (std::size_t k = 0; k < function.n; ++k) {
        const PairForm& q = row.coordinates[first + k];
        const FormGradient g = form_gradient(q, q.body_i, q.body_j, X);
        for (const auto& [b, by] : {std::pair(q.body_i, &g.i), std::pair(q.body_j, &g.j)}) {
            if (b == world) continue;
            const auto side = static_cast<std::size_t>(std::find(bodies, bodies + n, b) - bodies);
            if (side == n) bodies[n++] = b;
            tables_.bodies.scaled_row(b, X_.data() + 12 * b, maps_.data() + 12 * b, by->a, y[k][side]);
        }
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            SlopesOfPair& slopes = slopes_.emplace_back(SlopesOfPair{bodies[i], bodies[j], {}, {}});
            for (std::size_t k = 0; k < function.n; ++k)
                for (std::size_t l = 0; l < function.n; ++l)
                    for (std::size_t a = 0; F.hessian[k][l] != 0 && a < 36; ++a)
                        slopes.by_X[a] -= mu * F.hessian[k][l] * y[k][i][a / 6] * y[l][j][a % 6];
        }
}

/// Of the moment of forces that stay as they are in space; what they change by stands in the pairs. Forces
/// of all rows are summed before, so that this is one 3 x 3 matrix a body.
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

SlopesOfPair JointSlopes::by_twists(const Pair& pair) const
{
    double raw[36] = {};
    twist::add_block(pair.K.a, X_.data() + 12 * pair.i, X_.data() + 12 * pair.j, 1, raw, 6);
    SlopesOfPair slopes{pair.i, pair.j, {}, {}};
    scale_block(tables_, maps_.data(), pair.i, maps_.data(), pair.j, raw, slopes.by_X);
    return slopes;
}

void JointSlopes::collect(int node, const WindowLayout& layout, const RowPattern& pattern,
                          const lanes::Values& nodes, const auto& largest)
{
    const int lane = node % rule_.degree;
    place(lane, nodes);
    std::ranges::fill(forces_, 0.0);
    pairs_.clear();
    slopes_.clear();
    const Instant at{layout.time(rule_, node)};
    for (std::size_t c = 0; c < pattern.rows().size(); ++c) {
        const double* impulses = nodes.impulses + static_cast<int>(c) * width_;
        add_row(pattern.rows()[c], impulses[lane], largest(impulses), at);
    }
    for (const Pair& pair : pairs_) slopes_.push_back(by_twists(pair));
    for (int b = 0; b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6) add_turning(b);
}

const std::vector<SlopesOfPair>& JointSlopes::find(int node, const WindowLayout& layout,
                                                   const RowPattern& pattern, const lanes::Values& nodes)
{
    collect(node, layout, pattern, nodes,
            [&](const double* impulses) { return impulses[node % rule_.degree]; });
    return slopes_;
}

const std::vector<SlopesOfPair>& JointSlopes::find_middle(int last, const WindowLayout& layout,
                                                          const RowPattern& pattern,
                                                          const lanes::Values& nodes)
{
    collect(middle_of(last), layout, pattern, nodes, [&](const double* impulses) {
        double most = 0;
        for (int node = 1; node <= last; ++node)
            most = std::max(most, std::abs(impulses[node % rule_.degree]));
        return most;
    });
    return slopes_;
}

}   // namespace livens
