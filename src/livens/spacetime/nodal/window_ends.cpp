// SPDX-License-Identifier: BSD-3-Clause
// The ends of elements: momentum from the balance of the rows, and the state that follows from it.
#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/window.h"

namespace livens {

namespace {

/// Re-orthonormalises directors that have drifted beyond rounding: one Newton step of the polar factor.
void polish(double* X)
{
    Matrix3 d{};
    std::copy_n(X + 3, 9, d.a);
    const Matrix3 error = transpose(d) * d - identity<3>();
    if (norm(error) < 2e-15) return;
    d -= 0.5 * d * error;
    std::copy_n(d.a, 9, X + 3);
}

}   // namespace

/// The momentum at the end of an element from the balance of all its rows, which with lobatto is its last row
/// once the others are solved:
///
///     p = p_0 + sum_A f_A,      s = s_0 + sum_A tau_A
///
/// with wrenches (f_A, tau_A) of loads and multipliers about the centres of mass (docs/theory.md, "The
/// element"). The last row itself would carry the rounding of k_AB / h, and what Newton's iteration left.
void LobattoWindow::sum_momentum(int e)
{
    if (kernel_.is_solved()) return kernel_.momentum(stretch_, front_.here(), work_.momentum.data());
    const Nodes& nodes = system_.nodes();
    const Rows& rows = system_.balances();
    const int p = system_.rule().degree;
    const bool has_loads = !tables_.model->loads().empty();
    std::vector<double>&sum = work_.momentum, &wrench = work_.wrench;
    const int without = is_radau() ? 0 : p;   // the node that has no multiplier of its own
    sum = front_.here().p;
    for (const auto& body : tables_.bodies)   // the weight has no moment about the centre
        for (int i = 0; i < 3; ++i) sum[body.first + i] += stretch_.h(e) * body.weight[i];
    for (int a = 0; a <= p; ++a) {
        const int A = e * p + a;
        if (a == without && !has_loads) continue;
        if (has_loads)
            std::copy_n(rows.forces(e, a), work_.raw.size(), work_.raw.begin());
        else
            std::fill(work_.raw.begin(), work_.raw.end(), 0.0);
        if (a != without)
            rows.subtract(nodes.basis(A), a == 0 ? work_.impulse.data() : rows.impulses(A), work_.raw.data());
        tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), work_.raw.data(), wrench.data());
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += wrench[i];
    }
}

/// The spin about the centres of mass at the end of an element of radau is that of the polynomial's own
/// velocity, as its rows do not balance moments.
void LobattoWindow::take_spin_of_polynomial(int e)
{
    const ElementRule& rule = system_.rule();
    const Nodes& nodes = system_.nodes();
    const int p = rule.degree, A = (e + 1) * p;
    std::vector<double> V(work_.raw.size(), 0.0);
    for (int B = 1; B <= p; ++B)
        for (std::size_t i = 0; i < V.size(); ++i)
            V[i] += rule.D[p * rule.size() + B] / stretch_.h(e) * nodes.dX(e, B)[i];
    tables_.bodies.times_mass(V.data(), 1.0, work_.raw.data());
    tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), work_.raw.data(), work_.wrench.data());
    for (const auto& body : tables_.bodies)
        for (int i = 3; i < body.dofs; ++i) work_.momentum[body.first + i] = work_.wrench[body.first + i];
}

/// The end state of a solved element.
bool LobattoWindow::end_element(int e, SolveReport& report)
{
    const ElementRule& rule = system_.rule();
    const Nodes& nodes = system_.nodes();
    const int p = rule.degree, A = (e + 1) * p;
    const bool is_last = e + 1 == stretch_.n_elements();
    InstantState &here = front_.here(), &next = front_.next();
    next.t = stretch_.times[e + 1];
    sum_momentum(e);
    if (is_radau()) take_spin_of_polynomial(e);
    next.angles = here.angles;
    for (int a = 1; a <= p; ++a) tables_.loads.turns.follow(Configurations(nodes.X(e * p + a)), next.angles);
    std::copy_n(nodes.X(A), next.X.size(), next.X.begin());
    std::copy_n(nodes.low(A), next.X.size(), next.X_low.begin());
    if (!kernel_.is_solved()) std::copy_n(nodes.maps(A), next.X.size(), next.maps.begin());
    for (int b = 0; mesh_end(e) % 16 == 15 && b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6) polish(next.X.data() + 12 * b);
    // the node's own basis, where nothing asks for it any more
    const bool is_free = is_last && !is_radau() && stretch_.is_unknown(A) && !kernel_.is_solved();
    ConstraintBasis* known = is_free && system_.bases_fit() ? &system_.nodes().own_basis(A) : nullptr;
    if (!instant_.prepare(next, here.held.rows, known, kernel_.factor_at_end()))
        return fail(report, "the free motions carry no inertia at t = " + to_text(next.t, 6) + " s");
    const double weight = stretch_.h(e) * rule.weights[p];
    instant_.from_momentum(next, work_.momentum.data(), weight, work_.end_lambda.data());
    accelerate(next);
    return true;
}

/// A row that was left out as redundant and does not hold; empty: they all do. They may be redundant no more,
/// or others may have become so on the way: rows are chosen at element ends.
std::string LobattoWindow::contradiction(const InstantState& state) const
{
    if (tables_.rank == tables_.n_rows()) return {};
    for (int r = 0; r < tables_.n_rows(); ++r) {
        const ConstraintRow& row = *tables_.rows[r].row;
        if (std::abs(tables_.rows.value(r, {state.t}, state.X.data())) / row.scale < 1e-8) continue;
        return tables_.model->row_name(r) +
               ": was redundant at the start and contradicts the other joints by t = " + to_text(state.t, 6) +
               " s";
    }
    return {};
}

}   // namespace livens
