// SPDX-License-Identifier: BSD-3-Clause
// r_A = sum_e [ h^-1 sum_B k_AB (X_B - X_0) m + F_A ] - W_A G^T lambda_A against N_A, and the multipliers
// from its part in the directions Y of the constraints: S lambda = R^-1 Y^T D^T q_A / W_A (docs/theory.md,
// "The element", "Windows", "Radau points", "Eliminating the joint multipliers").
#include "livens/spacetime/nodal/rows.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/row_functions.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

NodalRows::NodalRows(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), loads_(tables, rule), size_of_node_(12 * tables.n_bodies()),
      workspaces_(1, workspace())
{
    for (EndMomentum& momentum : momenta_)
        momentum.scaled = momentum.about_reference =
            std::vector<double>(static_cast<std::size_t>(tables.n_twists), 0.0);
}

RowWorkspace NodalRows::workspace() const
{
    RowWorkspace made;
    made.work.assign(static_cast<std::size_t>(size_of_node_), 0.0);
    made.second = made.work;
    made.q.assign(static_cast<std::size_t>(tables_.n_twists), 0.0);
    return made;
}

void NodalRows::open(const WindowLayout& layout)
{
    int n_active = 0;
    for (int A = 0; A < layout.n_nodes(); ++A) n_active += layout.is_active(A) ? 1 : 0;
    if (const std::size_t n = layout.n_nodes() * size_of_node_; raw_.size() != n) {
        raw_.resize(n);
        for_each_item(layout.n_nodes(), least_shared,
                      [&](int A) { std::fill_n(raw_.begin() + A * size_of_node_, size_of_node_, 0.0); });
    }
    are_finite_.resize(static_cast<std::size_t>(layout.n_nodes()));
    impulses_.resize(layout.n_nodes() * tables_.rank);
    reduced_.resize(n_active * tables_.freedoms());
}

/// With radau each row A has the share c_A of the momentum at the start, as columns P of 12 numbers a body.
void NodalRows::start_with(const InstantState& first)
{
    momenta_[0].scaled = first.momentum;
    if (rule_.points == Points::lobatto) return;
    double* const rates = workspaces_[0].work.data();
    momenta_[0].columns.resize(static_cast<std::size_t>(size_of_node_));
    tables_.bodies.rates_of(first.X.data(), first.velocity.data(), rates);
    tables_.bodies.times_mass(rates, 1.0, momenta_[0].columns.data());
}

/// raw += h^-1 sum_B k_AB (X_B - X_0) m + F_A of element e at its local node A; the first element at a node
/// sets it. The weight is constant, and its integral against M_A is h w_A to the last digit.
void NodalRows::add_element(const WindowLayout& layout, const Nodes& nodes, int e, int A, double* raw,
                            RowWorkspace& at) const
{
    const int n_nodes = rule_.size();
    const double* k = rule_.k.data() + A * n_nodes;
    const double* y = nodes.dX(e, 1);
    double factor = k[1] / layout.h(e);
    if (n_nodes > 2) {
        row_functions().product(at.work.data(), {k + 1, 1, y, size_of_node_, n_nodes - 1},
                                static_cast<int>(size_of_node_));
        y = at.work.data();
        factor = 1 / layout.h(e);
    }
    const bool is_first = e == 0 || A > 0;
    double* sum = is_first ? raw : at.second.data();
    tables_.bodies.times_mass(y, factor, sum);
    if (!is_first) accumulate(raw, 1, sum, at.work.size());
    tables_.bodies.add_weight(layout.h(e) * rule_.weights[A], raw);
    if (!tables_.model->loads().empty()) accumulate(raw, 1, loads_.forces(e, A), at.work.size());
}

void NodalRows::twist_row(const WindowLayout& layout, const Nodes& nodes, int A, double* out)
{
    take_row(layout, nodes, A, workspaces_[0]);
    std::ranges::copy(workspaces_[0].q, out);
}

/// N^T raw into q.
void NodalRows::take_row(const WindowLayout& layout, const Nodes& nodes, int A, RowWorkspace& at)
{
    double* raw = raw_.data() + A * size_of_node_;
    for (int e = layout.first_element(A); e <= layout.last_element(A); ++e)
        add_element(layout, nodes, e, A - e * rule_.degree, raw, at);
    if (layout.points == Points::radau)
        accumulate(raw, rule_.c[A], momenta_[0].columns.data(), at.work.size());
    tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), raw, at.q.data());
}

/// Momenta of an end that may move are kept about reference points, in world axes; rows want them about the
/// centres of mass, in the scaled twists of where the body is now.
void EndMomentum::add_to(const ModelTables& tables, const double* maps, double sign, double* y) const
{
    std::vector<double> about_centre = about_reference, rows(about_centre.size());
    for (int b = 0; b < tables.n_bodies(); ++b)
        if (tables.bodies[b].dofs == 6)
            BodyTables::to_centre(maps + 12 * b, about_centre.data() + tables.bodies[b].first);
    tables.bodies.to_scaled_rows(maps, about_centre.data(), rows.data());
    for (std::size_t i = 0; i < rows.size(); ++i) y[i] += sign * rows[i];
}

/// lambda_A from the rows in the constraint directions; what is left are the reduced rows.
/// They have the opposite sign, as the right-hand side of a step.
bool NodalRows::eliminate(const WindowLayout& layout, const Nodes& nodes, int A, double* reduced,
                          RowWorkspace& at)
{
    const ConstraintBasis& basis = nodes.basis(A);
    const int k = tables_.rank, f = tables_.freedoms(), n = tables_.n_twists;
    double* y = at.work.data();
    tables_.bodies.to_scaled_rows(nodes.maps(A), at.q.data(), y);
    const EndMomentum& given = momenta_[A == 0 ? 0 : 1];
    const bool has_momentum = A == 0 || (layout.P_last && A == layout.n_nodes() - 1);
    if (has_momentum && layout.is_unknown(A))
        given.add_to(tables_, nodes.maps(A), A == 0 ? 1 : -1, y);
    else if (has_momentum)
        for (int i = 0; i < n; ++i) y[i] += given.scaled[i];
    double terms = at.terms, size = at.size, sum = 0;
    for (int i = 0; i < n; ++i) terms = std::max(terms, std::abs(y[i]));
    basis.q.apply_transposed(y);
    for (int i = 0; i < f; ++i) {
        reduced[i] = -y[k + i];
        size = std::max(size, std::abs(reduced[i]));
        sum += std::abs(reduced[i]);   // keeps a nan, which a maximum would lose
    }
    at.terms = terms;
    at.size = size;
    basis.q.solve_R(y);
    double* impulses = own_impulses(A);
    for (int c = 0; c < k; ++c) impulses[c] = y[c] * basis.row_scale(c);
    return std::isfinite(sum);
}

bool NodalRows::evaluate(const WindowLayout& layout, const Nodes& nodes)
{
    const auto n_threads = static_cast<std::size_t>(Crew::size());
    if (workspaces_.size() < n_threads) workspaces_.resize(n_threads, workspace());
    for (RowWorkspace& one : workspaces_) one.size = one.terms = 0;
    loads_.evaluate(layout, nodes);
    const int first = layout.is_active(0) ? 0 : 1;   // all but the ends are active
    in_shares(layout.n_nodes(), least_shared, [&](int slot, int begin, int end) {
        RowWorkspace& at = workspaces_[slot];
        for (int A = begin; A < end; ++A) {
            are_finite_[A] = 1;
            if (!layout.is_active(A)) continue;
            Patience::ask();
            take_row(layout, nodes, A, at);
            double* const reduced = reduced_.data() + (A - first) * tables_.freedoms();
            are_finite_[A] = eliminate(layout, nodes, A, reduced, at);
        }
    });
    size_ = 0;
    terms_ = 0;
    for (const double p : momenta_[0].scaled) terms_ = std::max(terms_, std::abs(p));
    for (const RowWorkspace& one : workspaces_) {
        size_ = std::max(size_, one.size);
        terms_ = std::max(terms_, one.terms);
    }
    return std::ranges::all_of(are_finite_, [](char is) { return is != 0; }) && std::isfinite(terms_);
}

void NodalRows::subtract(const ConstraintBasis& basis, const double* impulses, double* out) const
{
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[basis.rows[c]];
        const double s = impulses[c];
        for (int side = 0; side < table.n_sides; ++side) {
            double* r = out + 12 * table.bodies[side];
            const double* g = basis.gradient(c) + 12 * side;
            for (const int a : table.columns[side])
                for (int i = 0; i < 3; ++i) r[a + i] -= s * g[a + i];
        }
    }
}

}   // namespace livens
