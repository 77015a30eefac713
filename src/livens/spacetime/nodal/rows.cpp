// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/rows.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "livens/dynamics/instant/instant.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// sum += factor * x, 12 numbers a body, for arrays that do not overlap.
inline void accumulate(double* __restrict sum, double factor, const double* __restrict x, std::size_t n)
{
    for (std::size_t b = 0; b < n; b += 12)
        for (std::size_t i = b; i < b + 12; ++i) sum[i] += factor * x[i];
}

}   // namespace

Rows::Rows(const Tables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), size_of_X_(12 * tables.bodies.size())
{
    for (EndMomentum& momentum : momenta_) {
        momentum.scaled.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
        momentum.about_reference = momentum.scaled;
    }
    q_.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
    for (auto* v : {&work_, &X_, &V_}) v->assign(size_of_X_, 0.0);
}

void Rows::open(const Stretch& stretch)
{
    const auto n = static_cast<std::size_t>(stretch.n_nodes());
    int n_active = 0;
    for (int A = 0; A < stretch.n_nodes(); ++A) n_active += stretch.is_active(A) ? 1 : 0;
    of_loads_.forces.resize(static_cast<std::size_t>(stretch.n_elements() * rule_.size()) * size_of_X_);
    raw_.resize(n * size_of_X_);
    impulses_.resize(n * static_cast<std::size_t>(tables_.rank));
    reduced_.resize(static_cast<std::size_t>(n_active * tables_.freedoms()));
}

void Rows::start_with(const InstantState& first)
{
    momenta_[0].scaled = first.momentum;
    double largest = 0;
    for (const double p : first.momentum) largest = std::max(largest, std::abs(p));
    start_terms_ = largest;
    if (rule_.points == Points::lobatto) return;
    momenta_[0].columns.resize(size_of_X_);
    tables_.bodies.rates_of(first.X.data(), first.velocity.data(), V_.data());
    tables_.bodies.times_mass(V_.data(), 1.0, momenta_[0].columns.data());
}

void Rows::interpolate(const Stretch& stretch, const Nodes& nodes, int e, int c, double* X, double* V) const
{
    const int n_nodes = rule_.size();
    const double inverse = 1 / stretch.h(e);
    std::copy_n(nodes.X(e * rule_.degree), size_of_X_, X);
    std::fill_n(V, size_of_X_, 0.0);
    for (int B = 1; B < n_nodes; ++B) {
        accumulate(X, rule_.M[c * n_nodes + B], nodes.dX(e, B), size_of_X_);
        accumulate(V, rule_.dM[c * n_nodes + B] * inverse, nodes.dX(e, B), size_of_X_);
    }
}

void Rows::count_turns(const Stretch& stretch, const Nodes& nodes)
{
    of_loads_.angles.clear();
    if (tables_.loads.turns.empty()) return;
    std::vector<double> now = stretch.angles;
    for (int A = 0; A < stretch.n_nodes(); ++A) {
        tables_.loads.turns.follow(Configurations(nodes.X(A)), now);
        of_loads_.angles.insert(of_loads_.angles.end(), now.begin(), now.end());
    }
}

std::span<const double> Rows::angles(int e, int c) const
{
    if (of_loads_.angles.empty()) return {};
    int node = 0;
    while (node < rule_.degree && rule_.nodes[node + 1] <= rule_.loads.points[c]) ++node;
    const std::size_t n = tables_.loads.turns.size();
    return std::span(of_loads_.angles).subspan(static_cast<std::size_t>(e * rule_.degree + node) * n, n);
}

/// F_A of the loads at all nodes of an element.
void Rows::add_loads(const Stretch& stretch, const Nodes& nodes, int e)
{
    const int n_nodes = rule_.size();
    const double h = stretch.h(e);
    double* first = of_loads_.forces.data() + place(e * n_nodes);
    std::fill_n(first, static_cast<std::size_t>(n_nodes) * size_of_X_, 0.0);
    for (std::size_t c = 0; c < rule_.loads.points.size(); ++c) {
        interpolate(stretch, nodes, e, static_cast<int>(c), X_.data(), V_.data());
        std::fill(work_.begin(), work_.end(), 0.0);
        const Instant at = stretch.load_point(rule_, e, static_cast<int>(c));
        tables_.loads.add(at, X_.data(), V_.data(), h * rule_.loads.weights[c], work_.data(),
                          angles(e, static_cast<int>(c)));
        for (int A = 0; A < n_nodes; ++A) {
            const double m = rule_.M[c * n_nodes + A];
            accumulate(first + place(A), m, work_.data(), size_of_X_);
        }
    }
}

/// raw += h^-1 sum_B k_AB (X_B - X_0) m + F_A of element e at its local node A; the first element at a node
/// sets it. The weight is constant, and its integral against M_A is h w_A to the last digit.
void Rows::add_element(const Stretch& stretch, const Nodes& nodes, int e, int A, double* raw)
{
    const int n_nodes = rule_.size();
    const double* k = rule_.k.data() + A * n_nodes;
    const double* y = nodes.dX(e, 1);
    double factor = k[1] / stretch.h(e);
    if (n_nodes > 2) {
        std::fill_n(work_.data(), size_of_X_, 0.0);
        for (int B = 1; B < n_nodes; ++B) accumulate(work_.data(), k[B], nodes.dX(e, B), size_of_X_);
        y = work_.data();
        factor = 1 / stretch.h(e);
    }
    const bool is_first = e == 0 || A > 0;
    double* sum = is_first ? raw : X_.data();
    tables_.bodies.times_mass(y, factor, sum);
    if (!is_first) accumulate(raw, 1, sum, size_of_X_);
    tables_.bodies.add_weight(stretch.h(e) * rule_.weights[A], raw);
    if (!tables_.model->loads().empty()) accumulate(raw, 1, forces(e, A), size_of_X_);
}

void Rows::twist_row(const Stretch& stretch, const Nodes& nodes, int A, double* out)
{
    double* raw = raw_.data() + place(A);
    for (int e = stretch.first_element(A); e <= stretch.last_element(A); ++e)
        add_element(stretch, nodes, e, A - e * rule_.degree, raw);
    if (stretch.points == Points::radau) accumulate(raw, rule_.c[A], momenta_[0].columns.data(), size_of_X_);
    tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), raw, out);
}

/// y += the momentum at the start or - that at the end, where it is known.
void Rows::add_end_momentum(const Stretch& stretch, const Nodes& nodes, int A, double* __restrict y) const
{
    const bool is_last = A != 0;
    const EndMomentum& given = momenta_[is_last ? 1 : 0];
    if (!stretch.is_unknown(A)) {
        const double* __restrict p = given.scaled.data();
        for (int i = 0; i < tables_.n_twists; ++i) y[i] += p[i];
        return;
    }
    std::vector<double> about_centre = given.about_reference, scaled(about_centre.size());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        if (body.dofs == 6) BodyTables::to_centre(nodes.maps(A) + 12 * b, about_centre.data() + body.first);
    }
    tables_.bodies.to_scaled_rows(nodes.maps(A), about_centre.data(), scaled.data());
    for (std::size_t i = 0; i < scaled.size(); ++i) y[i] += is_last ? -scaled[i] : scaled[i];
}

/// lambda_A from the rows in the constraint directions; what is left are the reduced rows.
bool Rows::eliminate(const Stretch& stretch, const Nodes& nodes, int A, double* reduced)
{
    const ConstraintBasis& basis = nodes.basis(A);
    const int k = tables_.rank, f = tables_.freedoms(), n = tables_.n_twists;
    double* y = work_.data();
    tables_.bodies.to_scaled_rows(nodes.maps(A), q_.data(), y);
    if (A == 0 || (stretch.P_last && A == stretch.n_nodes() - 1)) add_end_momentum(stretch, nodes, A, y);
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
    double* impulses = impulses_.data() + static_cast<std::size_t>(A * k);
    for (int c = 0; c < k; ++c) impulses[c] = y[c] * basis.row_scale[c];
    return std::isfinite(sum);
}

bool Rows::evaluate(const Stretch& stretch, const Nodes& nodes)
{
    terms_ = start_terms_;
    size_ = 0;
    bool are_finite = true;
    const bool has_loads = !tables_.model->loads().empty();
    count_turns(stretch, nodes);
    for (int e = 0; has_loads && e < stretch.n_elements(); ++e) add_loads(stretch, nodes, e);
    double* reduced = reduced_.data();
    for (int A = 0; A < stretch.n_nodes(); ++A) {
        if (!stretch.is_active(A)) continue;
        Patience::ask();
        twist_row(stretch, nodes, A, q_.data());
        are_finite = eliminate(stretch, nodes, A, reduced) && are_finite;
        reduced += tables_.freedoms();
    }
    return are_finite && std::isfinite(terms_);
}

void Rows::subtract(const ConstraintBasis& basis, const double* impulses, double* out) const
{
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[static_cast<std::size_t>(basis.rows[c])];
        const double s = impulses[c];
        for (int side = 0; side < table.n_sides; ++side) {
            double* r = out + 12 * table.bodies[side];
            const double* g = basis.gradient(c) + 12 * side;
            for (const int a : table.columns[side])
                for (int i = 0; i < 3; ++i) r[a + i] -= s * g[a + i];
        }
    }
}

std::string Rows::bad_load(const Stretch& stretch, const Nodes& nodes) const
{
    std::vector<double> X(size_of_X_), V(size_of_X_);
    for (int e = 0; e < stretch.n_elements(); ++e)
        for (std::size_t c = 0; c < rule_.loads.points.size(); ++c) {
            interpolate(stretch, nodes, e, static_cast<int>(c), X.data(), V.data());
            const Instant at = stretch.load_point(rule_, e, static_cast<int>(c));
            const int load = tables_.loads.bad(at, X.data(), V.data(), angles(e, static_cast<int>(c)));
            if (load >= 0) return not_finite(tables_.model->loads()[load]);
        }
    return "";
}

}   // namespace livens
