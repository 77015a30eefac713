// SPDX-License-Identifier: BSD-3-Clause
// P = Z Z^T has the largest pivots at twists that span what is free; as projected at every node they are a
// basis there (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/reduced_tangent.h"

#include <algorithm>
#include <cmath>

namespace livens {

namespace {

/// Of a projected twist, across those before: the mechanism has moved on, and others are better.
constexpr double least_of_twist = 1e-2;

double product(const double* a, const double* b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/// sum_a c_a x_a of n numbers a column, all columns side by side.
template <int n>
void combine(const double* c, const double* __restrict x, int columns, double* __restrict sums)
{
    for (int i = 0; i < columns; ++i) {
        double sum = 0;
        for (int a = 0; a < n; ++a) sum += c[a] * x[a * columns + i];
        sums[i] = sum;
    }
}

void combine(int n, const double* c, const double* x, int columns, double* sums)
{
    if (n == 3) return combine<3>(c, x, columns, sums);
    combine<6>(c, x, columns, sums);
}

void add_products(const double* __restrict x, const double* __restrict y, int n, double* __restrict to)
{
    for (int i = 0; i < n; ++i) to[i] += x[i] * y[i];
}

}   // namespace

ReducedTangent::ReducedTangent(const ModelTables& tables, const ElementRule& rule,
                               const lanes::Functions* functions)
    : tables_(tables), rule_(rule), functions_(functions), n_(tables.n_twists)
{}

void ReducedTangent::use(const std::shared_ptr<const RowPattern>& pattern)
{
    if (pattern == pattern_) return;
    pattern_ = pattern;
    f_ = n_ - pattern->view().n_rows;
    chosen_.clear();
    const auto p = static_cast<std::size_t>(rule_.degree), f = static_cast<std::size_t>(f_);
    bases_.assign((p + 1) * f * static_cast<std::size_t>(n_), 0.0);
    theta_.assign((p + 1) * f, 0.0);
    work_.assign(static_cast<std::size_t>((n_ + 2 * pattern->view().n_rows) * functions_->width), 0.0);
}

/// By Cholesky's factorisation of P with the largest pivots, at the start.
void ReducedTangent::choose(const JointFactor& start)
{
    const auto n = static_cast<std::size_t>(n_);
    std::vector<double> P(n * n, 0.0), mu(n);
    for (std::size_t i = 0; i < n; ++i) {
        P[i * n + i] = 1;
        start.project(P.data() + i * n, nullptr, mu.data());
    }
    chosen_.clear();
    while (std::ssize(chosen_) < f_) {
        std::size_t best = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (P[i * n + i] > P[best * n + best]) best = i;
        const std::vector<double> row(P.begin() + static_cast<std::ptrdiff_t>(best * n),
                                      P.begin() + static_cast<std::ptrdiff_t>((best + 1) * n));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) P[i * n + j] -= row[i] * row[j] / row[best];
        chosen_.push_back(static_cast<int>(best));
    }
}

bool ReducedTangent::orthonormalise(int node)
{
    for (int k = 0; k < f_; ++k) {
        double* v = z(node, k);
        for (int before = 0; before < k; ++before) {
            const double along = product(z(node, before), v, n_);
            for (int i = 0; i < n_; ++i) v[i] -= along * z(node, before)[i];
        }
        const double size = std::sqrt(product(v, v, n_));
        if (!(size > least_of_twist)) return false;
        for (int i = 0; i < n_; ++i) v[i] /= size;
    }
    return true;
}

bool ReducedTangent::find_bases(const JointFactor& start, const lanes::Values& nodes)
{
    const int W = functions_->width, p = rule_.degree, n_rows = pattern_->view().n_rows;
    lanes::Values twist = nodes;   // the same numbers and factor, for another step
    twist.step = work_.data();
    twist.violations = twist.step + static_cast<std::ptrdiff_t>(n_ * W);
    twist.work = twist.violations + static_cast<std::ptrdiff_t>(n_rows * W);
    std::vector<double> mu(static_cast<std::size_t>(n_rows));
    for (int k = 0; k < f_; ++k) {
        const int own = chosen_[static_cast<std::size_t>(k)];
        std::fill_n(z(0, k), n_, 0.0);
        z(0, k)[own] = 1;
        start.project(z(0, k), nullptr, mu.data());
        std::fill_n(twist.step, n_ * W, 0.0);
        std::fill_n(twist.step + static_cast<std::ptrdiff_t>(own * W), W, 1.0);
        functions_->project(pattern_->view(), twist);
        for (int node = 1; node <= p; ++node)
            for (int i = 0; i < n_; ++i) z(node, k)[i] = twist.step[i * W + node % p];
    }
    for (int node = 0; node <= p; ++node)
        if (!orthonormalise(node)) return false;
    return true;
}

/// k_AB / h: scaled twists have the mass 1.
void ReducedTangent::add_mass(double h)
{
    const int p = rule_.degree;
    for (int A = 0; A < p; ++A)
        for (int l = 0; l < p; ++l) {
            const int row = row_in_lane(rule_, A), node = l == 0 ? p : l;
            const double factor = rule_.k[row * rule_.size() + node] / h;
            for (int k = 0; k < f_; ++k)
                for (int m = 0; m < f_; ++m) entry(A, k, l, m) = factor * product(z(row, k), z(node, m), n_);
        }
}

/// Columns, the twists of all nodes, stand side by side.
void ReducedTangent::add_load(const SlopesOfPair& pair, const double* slopes, const Numbers& in_time,
                              double factor)
{
    if (std::all_of(slopes, slopes + 36, [](double slope) { return slope == 0; })) return;
    const int p = rule_.degree, first = tables_.bodies[pair.i].first, n = tables_.bodies[pair.i].dofs,
              from = tables_.bodies[pair.j].first, m_of = tables_.bodies[pair.j].dofs, size = p * f_;
    columns_.resize(static_cast<std::size_t>(14 * size));
    double *y = columns_.data(), *forces = y + 6 * size, *sums = forces + 6 * size, *times = sums + size;
    for (int l = 0; l < p; ++l)
        for (int m = 0; m < f_; ++m)
            for (int a = 0; a < m_of; ++a) y[a * size + l * f_ + m] = z(l == 0 ? p : l, m)[from + a];
    for (int a = 0; a < n; ++a) {
        double* force = forces + a * size;
        combine(m_of, slopes + 6 * a, y, size, force);
        for (int i = 0; i < size; ++i) force[i] *= factor;
    }
    for (int A = 0; A < p; ++A) {
        for (int l = 0; l < p; ++l)
            std::fill_n(times + l * f_, f_, in_time[static_cast<std::size_t>(A * p + l)]);
        for (int k = 0; k < f_; ++k) {
            combine(n, z(row_in_lane(rule_, A), k) + first, forces, size, sums);
            add_products(times, sums, size, &entry(A, k, 0, 0));
        }
    }
}

/// Between any two nodes of rank one, (z_A . u) (h S_AB z_B . v_X + C_AB z_B . v_V) with the direction u and
/// slopes v: inner products are made once a node, for each of its f twists.
void ReducedTangent::add_product(const SlopesOfProduct& of, const LoadSlopes& slopes, double h)
{
    const int p = rule_.degree;
    const auto along = [&](int node, int k, int body, const SlopesOfProduct::Twist& y) {
        const BodyTable& table = tables_.bodies[body];
        return product(y.data(), z(node, k) + table.first, table.dofs);
    };
    const auto size = static_cast<std::size_t>((p + 1) * f_);
    directions_.assign(size, 0.0);
    by_X_.assign(size, 0.0);
    by_V_.assign(size, 0.0);
    for (int node = 0; node <= p; ++node)
        for (int k = 0; k < f_; ++k) {
            const auto at = static_cast<std::size_t>(node * f_ + k);
            for (std::size_t r = 0; r < 2; ++r)
                if (of.to[r] != world) directions_[at] += along(node, k, of.to[r], of.direction[r]);
            for (std::size_t s = 0; s < of.from.size(); ++s) {
                by_X_[at] += along(node, k, of.from[s], of.by_X[s]);
                by_V_[at] += along(node, k, of.from[s], of.by_V[s]);
            }
        }
    for (int A = 0; A < p; ++A)
        for (int l = 0; l < p; ++l) {
            const int row = row_in_lane(rule_, A) * f_, column = (l == 0 ? p : l) * f_;
            const auto at = static_cast<std::size_t>(A * p + l);
            const double S = h * slopes.in_time_by_X()[at], C = slopes.in_time_by_V()[at];
            for (int k = 0; k < f_; ++k)
                for (int m = 0; m < f_; ++m)
                    entry(A, k, l, m) +=
                        directions_[row + k] * (S * by_X_[column + m] + C * by_V_[column + m]);
        }
}

/// Forces of joints are of one node alone, which here is a row and a column, in the same lane.
void ReducedTangent::add_at_node(int node, const SlopesOfPair& pair)
{
    const int lane = node % rule_.degree, n = tables_.bodies[pair.i].dofs;
    for (int m = 0; m < f_; ++m) {
        double force[6] = {};
        const double* y = z(node, m) + tables_.bodies[pair.j].first;
        for (int a = 0; a < n; ++a) force[a] = product(pair.by_X + 6 * a, y, tables_.bodies[pair.j].dofs);
        for (int k = 0; k < f_; ++k)
            entry(lane, k, lane, m) += product(z(node, k) + tables_.bodies[pair.i].first, force, n);
    }
}

/// Twists that an earlier element has chosen are tried first; where they do not span what is free any more,
/// others are chosen at this start.
bool ReducedTangent::factorise(const WindowLayout& layout, const JointFactor& start,
                               const lanes::Values& nodes, TangentSlopes& slopes)
{
    const int size = rule_.degree * f_;
    const bool were_chosen = !chosen_.empty();
    if (!were_chosen) choose(start);
    if (!find_bases(start, nodes)) {
        if (!were_chosen) return false;
        choose(start);
        if (!find_bases(start, nodes)) return false;
    }
    factor_.A.assign(static_cast<std::size_t>(size * size), 0.0);
    add_mass(layout.h(0));
    slopes.loads.find(layout, nodes);
    for (const SlopesOfProduct& one : slopes.loads.products()) add_product(one, slopes.loads, layout.h(0));
    for (const SlopesOfPair& pair : slopes.loads.pairs()) {
        add_load(pair, pair.by_X, slopes.loads.in_time_by_X(), layout.h(0));
        add_load(pair, pair.by_V, slopes.loads.in_time_by_V(), 1);
    }
    for (int node = 1; node <= last_with_joints(rule_, slopes); ++node)
        for (const SlopesOfPair& pair : slopes.joints.find(node, layout, *pattern_, nodes))
            add_at_node(node, pair);
    return factor_.factorise(*functions_->blocks, size);
}

/// step <- - Z (Z^T J Z)^-1 Z^T r, with Z of the nodes of rows on the right and of columns on the left.
void ReducedTangent::propose(const lanes::Values& nodes)
{
    const int p = rule_.degree, W = functions_->width;
    for (int A = 0; A < p; ++A)
        for (int k = 0; k < f_; ++k) {
            const double* y = z(row_in_lane(rule_, A), k);
            double sum = 0;
            for (int i = 0; i < n_; ++i) sum -= y[i] * nodes.rows[i * W + A];
            theta_[static_cast<std::size_t>(A * f_ + k)] = sum;
        }
    factor_.solve(*functions_->blocks, theta_.data(), 1);
    std::fill_n(nodes.step, n_ * W, 0.0);
    for (int l = 0; l < p; ++l)
        for (int m = 0; m < f_; ++m) {
            const double* y = z(l == 0 ? p : l, m);
            const double by = theta_[static_cast<std::size_t>(l * f_ + m)];
            for (int i = 0; i < n_; ++i) nodes.step[i * W + l] += y[i] * by;
        }
}

}   // namespace livens
