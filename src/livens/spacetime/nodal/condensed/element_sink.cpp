// SPDX-License-Identifier: BSD-3-Clause
// A block of two bodies at two nodes stays what it is where both nodes are inside of the element, as joints
// are eliminated there; on the side of an end it is taken times the null space Z, so that ends have the
// free motions of the chain (docs/theory.md, "The whole matrix of lobatto", Along the joints).
#include "livens/spacetime/nodal/condensed/element_sink.h"

#include <algorithm>

#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// to += sum_k a_k z_k of rows z_k of f numbers, those a_k so far apart.
/// Zeros, of which blocks have many, are passed by; other rows are added two at a time.
void add_rows(const RowFunctions& sums, double* to, const double* a, int apart, const NullSpaceRows& z)
{
    int held = -1;   // the last that is not zero and was not added yet
    for (int k = 0; k < z.n; ++k) {
        if (a[k * apart] == 0) continue;
        if (held >= 0)
            sums.subtract_pair(to, -a[held * apart], z.at + held * z.f, -a[k * apart], z.at + k * z.f, z.f);
        held = held >= 0 ? -1 : k;
    }
    if (held >= 0) subtract_scaled(sums, to, -a[held * apart], z.at + held * z.f, z.f);
}

}   // namespace

ElementSink::ElementSink(AlongJoints& all, int degree) : all_(all), q_(degree - 1) {}

void ElementSink::begin(int e)
{
    e_ = e;
    const std::vector<JointForest::Body>& bodies = all_.forest_.bodies;
    const auto q = static_cast<std::size_t>(q_);
    sizes_ = {q_, all_.between_.n_rows(e), all_.between_.n_columns(e)};
    blocks_.bodies.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const auto n = static_cast<std::size_t>(bodies[b].d) * q;
        ElementBlocks::OfBody& of = blocks_.bodies[b];
        of.own.assign(n * n, 0.0);
        of.by_parent.clear();
        of.of_parent.clear();
        of.by_ends.assign(n * static_cast<std::size_t>(sizes_.n_columns), 0.0);
        of.of_ends.assign(n * static_cast<std::size_t>(sizes_.n_rows), 0.0);
    }
    blocks_.ends.assign(count(sizes_.n_rows, sizes_.n_columns), 0.0);
}

ElementSink::Place ElementSink::place_of(int A, bool of_rows) const
{
    const WindowLayout& layout = *all_.layout_;
    const int first = e_ * layout.degree, a = A - first;
    if (a > 0 && a < layout.degree) return {a - 1, -1};
    const bool has_first = of_rows ? layout.is_active(first) : layout.is_unknown(first);
    return {-1, a > 0 && has_first ? all_.z_.f : 0};
}

void ElementSink::open(int e, int A, int B)
{
    if (e != e_) begin(e);
    A_ = A;
    B_ = B;
    row_ = place_of(A, true);
    column_ = place_of(B, false);
}

void ElementSink::mass(int body, double factor, const double* H)
{
    double values[36] = {};
    const int d = all_.forest_.bodies[body].d;
    for (int i = 0; i < 3; ++i) values[7 * i] = factor;
    for (int r = 0; r < 3 && d == 6; ++r)
        for (int c = 0; c < 3; ++c) values[6 * (r + 3) + c + 3] = factor * H[r + 3 * c];
    block(body, body, values);
}

/// Of rows of body i by twists of body j, one of which is the other's parent.
Numbers& ElementSink::inside_block(int i, int j)
{
    const std::vector<JointForest::Body>& bodies = all_.forest_.bodies;
    if (i == j) return blocks_.bodies[i].own;
    const bool is_child = bodies[i].parent == j;
    Numbers& block = is_child ? blocks_.bodies[i].by_parent : blocks_.bodies[j].of_parent;
    if (block.empty()) block.assign(count(bodies[i].d * q_, bodies[j].d * q_), 0.0);
    return block;
}

void ElementSink::block(int i, int j, const double* values)
{
    const RowFunctions& sums = row_functions();
    const int f = all_.z_.f, q = q_, columns = sizes_.n_columns, n_rows = sizes_.n_rows;
    const auto rows_of = [&](int A, int body) {
        return NullSpaceRows{all_.z_.at(A) + all_.tables_.bodies[body].first * f, all_.forest_.bodies[body].d,
                             f};
    };
    const NullSpaceRows of_i = rows_of(A_, i), of_j = rows_of(B_, j);
    if (row_.inside >= 0 && column_.inside >= 0) {
        const int stride = of_j.n * q;
        double* const to = inside_block(i, j).data() + row_.inside * stride + column_.inside;
        for (int r = 0; r < of_i.n; ++r)
            for (int c = 0; c < of_j.n; ++c) to[r * q * stride + c * q] += values[6 * r + c];
    } else if (row_.inside >= 0) {
        double* const to = blocks_.bodies[i].by_ends.data() + row_.inside * columns + column_.end;
        for (int r = 0; r < of_i.n; ++r) add_rows(sums, to + r * q * columns, values + 6 * r, 1, of_j);
    } else if (column_.inside >= 0) {
        double* const to = blocks_.bodies[j].of_ends.data() + column_.inside * n_rows + row_.end;
        for (int c = 0; c < of_j.n; ++c) add_rows(sums, to + c * q * n_rows, values + c, 6, of_i);
    } else {
        double* const to = blocks_.ends.data() + row_.end * columns + column_.end;
        product_.assign(count(of_i.n, f), 0.0);
        for (int r = 0; r < of_i.n; ++r) add_rows(sums, product_.data() + r * f, values + 6 * r, 1, of_j);
        for (int k = 0; k < f; ++k)
            add_rows(sums, to + k * columns, of_i.at + k, f, {product_.data(), of_i.n, f});
    }
}

/// How bodies move at the nodes inside.
/// Gradients of the rows that hold a body, (m, d; A) for it and (m, n; A) for its parent. Each node's basis
/// may have the rows in an order of its own.
bool ElementSink::set_motions()
{
    const ModelTables& tables = all_.tables_;
    const JointForest& forest = all_.forest_;
    const std::size_t n_rows = forest.held.size();
    double q[6];
    places_.resize(n_rows * static_cast<std::size_t>(q_));
    const auto node = [&](int a) { return e_ * all_.layout_->degree + 1 + a; };
    for (int a = 0; a < q_; ++a) {
        const std::vector<int>& rows = all_.nodes_->basis(node(a)).rows;
        for (std::size_t c = 0; c < rows.size(); ++c)
            places_[static_cast<std::size_t>(a) * n_rows + rows[c]] = static_cast<int>(c);
    }
    for (const int b : forest.order) {
        const auto& [parent, rows, d, f] = forest.bodies[b];
        const int n = parent == world ? 0 : forest.bodies[parent].d;
        own_.resize(count(d - f, d * q_));
        above_.resize(count(d - f, n * q_));
        for (int m = 0; m < d - f; ++m)
            for (int a = 0; a < q_; ++a) {
                const int A = node(a), row = rows[m];
                const double *X = all_.nodes_->X(A), *maps = all_.nodes_->maps(A);
                const double* gradient =
                    all_.nodes_->basis(A).gradient(places_[static_cast<std::size_t>(a) * n_rows + row]);
                for (int side = 0; side < tables.rows[row].n_sides; ++side) {
                    const bool is_own = tables.rows[row].bodies[side] == b;
                    const int body = is_own ? b : parent, numbers = is_own ? d : n;
                    tables.wrench(row, side, X, maps, gradient, q);
                    double y[6];
                    scale_row(tables.bodies[body], maps + 12 * body, q, y);
                    Numbers& to = is_own ? own_ : above_;
                    for (int i = 0; i < numbers; ++i) to[(m * numbers + i) * q_ + a] = y[i];
                }
            }
        if (!all_.elements_[e_].factor.set_motion(forest, b, own_.data(), above_.data())) return false;
    }
    return true;
}

void ElementSink::finish(int e)
{
    if (e != e_) begin(e);   // nothing has come
    Patience::ask();
    AlongJoints::OfElement& element = all_.elements_[e];
    element.factor.resize(all_.forest_, sizes_);
    element.is_good = set_motions() && element.factor.factorise(all_.forest_, blocks_);
    std::ranges::copy(blocks_.ends, all_.between_.storage(e).begin());
    e_ = -1;
}

}   // namespace livens
