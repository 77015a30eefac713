// SPDX-License-Identifier: BSD-3-Clause
// r_A = sum_e [ h^-1 sum_B k_AB (X_B - X_0) m + F_A ] - W_A G^T lambda_A against N_A, and the multipliers
// from its part in the directions Y of the constraints: S lambda = R^-1 Y^T D^T q_A / W_A (docs/theory.md,
// "The element", "Windows", "Radau points", "Eliminating the joint multipliers").
#include "livens/spacetime/nodal/rows.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

NodalRows::NodalRows(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), loads_(tables, rule), q_(tables.n_twists),
      work_(12 * tables.bodies.size()), second_(work_)
{
    for (EndMomentum& momentum : momenta_) momentum.scaled = momentum.about_reference = q_;
}

void NodalRows::open(const WindowLayout& layout)
{
    int n_active = 0;
    for (int A = 0; A < layout.n_nodes(); ++A) n_active += layout.is_active(A) ? 1 : 0;
    raw_.resize(layout.n_nodes() * work_.size());
    impulses_.resize(layout.n_nodes() * tables_.rank);
    reduced_.resize(n_active * tables_.freedoms());
}

void NodalRows::start_with(const InstantState& first)
{
    momenta_[0].scaled = first.momentum;
    double largest = 0;
    for (const double p : first.momentum) largest = std::max(largest, std::abs(p));
    start_terms_ = largest;
    if (rule_.points == Points::lobatto) return;
    momenta_[0].columns.resize(work_.size());
    tables_.bodies.rates_of(first.X.data(), first.velocity.data(), work_.data());
    tables_.bodies.times_mass(work_.data(), 1.0, momenta_[0].columns.data());
}

/// raw += h^-1 sum_B k_AB (X_B - X_0) m + F_A of element e at its local node A; the first element at a node
/// sets it. The weight is constant, and its integral against M_A is h w_A to the last digit.
void NodalRows::add_element(const WindowLayout& layout, const Nodes& nodes, int e, int A, double* raw)
{
    const int n_nodes = rule_.size();
    const double* k = rule_.k.data() + A * n_nodes;
    const double* y = nodes.dX(e, 1);
    double factor = k[1] / layout.h(e);
    if (n_nodes > 2) {
        std::ranges::fill(work_, 0.0);
        for (int B = 1; B < n_nodes; ++B) accumulate(work_.data(), k[B], nodes.dX(e, B), work_.size());
        y = work_.data();
        factor = 1 / layout.h(e);
    }
    const bool is_first = e == 0 || A > 0;
    double* sum = is_first ? raw : second_.data();
    tables_.bodies.times_mass(y, factor, sum);
    if (!is_first) accumulate(raw, 1, sum, work_.size());
    tables_.bodies.add_weight(layout.h(e) * rule_.weights[A], raw);
    if (!tables_.model->loads().empty()) accumulate(raw, 1, loads_.forces(e, A), work_.size());
}

void NodalRows::twist_row(const WindowLayout& layout, const Nodes& nodes, int A, double* out)
{
    double* raw = raw_.data() + A * work_.size();
    for (int e = layout.first_element(A); e <= layout.last_element(A); ++e)
        add_element(layout, nodes, e, A - e * rule_.degree, raw);
    if (layout.points == Points::radau) accumulate(raw, rule_.c[A], momenta_[0].columns.data(), work_.size());
    tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), raw, out);
}

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
bool NodalRows::eliminate(const WindowLayout& layout, const Nodes& nodes, int A, double* reduced)
{
    const ConstraintBasis& basis = nodes.basis(A);
    const int k = tables_.rank, f = tables_.freedoms(), n = tables_.n_twists;
    double* y = work_.data();
    tables_.bodies.to_scaled_rows(nodes.maps(A), q_.data(), y);
    const EndMomentum& given = momenta_[A == 0 ? 0 : 1];
    const bool has_momentum = A == 0 || (layout.P_last && A == layout.n_nodes() - 1);
    if (has_momentum && layout.is_unknown(A))
        given.add_to(tables_, nodes.maps(A), A == 0 ? 1 : -1, y);
    else if (has_momentum)
        for (int i = 0; i < n; ++i) y[i] += given.scaled[i];
    double terms = terms_, size = size_, sum = 0;
    for (int i = 0; i < n; ++i) terms = std::max(terms, std::abs(y[i]));
    basis.q.apply_transposed(y);
    for (int i = 0; i < f; ++i) {
        reduced[i] = -y[k + i];
        size = std::max(size, std::abs(reduced[i]));
        sum += std::abs(reduced[i]);   // keeps a nan, which a maximum would lose
    }
    terms_ = terms;
    size_ = size;
    basis.q.solve_R(y);
    double* impulses = own_impulses(A);
    for (int c = 0; c < k; ++c) impulses[c] = y[c] * basis.row_scale[c];
    return std::isfinite(sum);
}

bool NodalRows::evaluate(const WindowLayout& layout, const Nodes& nodes)
{
    terms_ = start_terms_;
    size_ = 0;
    bool are_finite = true;
    loads_.evaluate(layout, nodes);
    double* reduced = reduced_.data();
    for (int A = 0; A < layout.n_nodes(); ++A) {
        if (!layout.is_active(A)) continue;
        Patience::ask();
        twist_row(layout, nodes, A, q_.data());
        are_finite = eliminate(layout, nodes, A, reduced) && are_finite;
        reduced += tables_.freedoms();
    }
    return are_finite && std::isfinite(terms_);
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
