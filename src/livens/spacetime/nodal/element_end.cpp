// SPDX-License-Identifier: BSD-3-Clause
// The state at the end of a solved element: its momentum from the balance of all rows, of which the joints
// take h w_p G^T lambda, the velocity that is left, and acceleration and reactions from the equations of
// motion there (docs/theory.md, "Element ends"; of radau: "Radau points"; shared nodes: "Windows").
#include "livens/spacetime/nodal/element_end.h"

#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/nodal/kernel/march_kernel.h"
#include "livens/spacetime/nodal/system.h"

namespace livens {

namespace {

/// Re-orthonormalises directors that have drifted beyond rounding: one Newton step of the polar factor.
void orthonormalise(double* X)
{
    Matrix3 d{};
    std::copy_n(X + 3, 9, d.a);
    const Matrix3 error = transpose(d) * d - identity<3>();
    if (norm(error) < 2e-15) return;
    d -= 0.5 * d * error;
    std::copy_n(d.a, 9, X + 3);
}

/// The node of an element that has no multiplier of its own.
int node_without(const ElementRule& rule) { return rule.points == Points::radau ? 0 : rule.degree; }

}   // namespace

ElementEnd::ElementEnd(const ModelTables& tables, bool sparse)
    : tables_(tables), instant_(tables, sparse), jumps_(tables.model->load_breaks()),
      lambda_(tables.rows.size()), end_lambda_(lambda_), impulse_(tables.rank), momentum_(tables.n_twists),
      wrench_(momentum_), raw_(12 * tables.bodies.size())
{
    for (InstantState& state : states_) state.resize(tables);
}

bool ElementEnd::is_jump(double t) const { return std::ranges::binary_search(jumps_, t); }

bool ElementEnd::set(InstantState& state, const State& given)
{
    state.t = given.t;
    if (state.X.empty()) state.resize(tables_);
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        std::copy_n(given.X[b].a, 12, state.X.begin() + 12 * b);
        const auto& body = tables_.bodies[b];
        const Vector3 v = given.V[b].column(0);
        const Vector3 w = body.dofs == 6 ? angular_velocity(given.X[b], given.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i) state.velocity[body.first + i] = i < 3 ? v[i] : w[i - 3];
    }
    state.angles = tables_.loads.turns.begin(given);
    tables_.loads.turns.follow(Configurations(state.X.data()), state.angles);
    if (!instant_.prepare(state, tables_.independent)) return false;
    instant_.from_velocity(state);
    return true;
}

/// On both sides, which differ only where a load jumps in time.
void ElementEnd::accelerate(InstantState& state)
{
    instant_.accelerate(state, Side::right);
    if (is_jump(state.t)) {
        instant_.accelerate(state, Side::left);
    } else {
        state.acceleration[0] = state.acceleration[1];
        state.multipliers[0] = state.multipliers[1];
    }
}

/// With the multipliers that are left there when its momentum is tangent to the constraints.
bool ElementEnd::find_first(NodalSystem& system)
{
    const WindowLayout& layout = system.layout();
    InstantState& here = states_[now_];
    const double weight = layout.weight(system.rule(), 0);
    here.t = layout.times[0];
    if (!layout.X_first) {
        here.angles = layout.angles;
        tables_.loads.turns.follow(Configurations(system.nodes().X(0)), here.angles);
        std::copy_n(system.nodes().X(0), here.X.size(), here.X.begin());
        std::copy_n(system.nodes().low(0), here.X.size(), here.X_low.begin());
        if (!instant_.prepare(here, tables_.independent)) return false;
    }
    std::vector<double>& p = momentum_;
    if (layout.P_first) {
        p = system.balances().end_momentum(false).about_reference;
        for (int b = 0; b < tables_.n_bodies(); ++b)
            if (tables_.bodies[b].dofs == 6)
                BodyTables::to_centre(here.maps.data() + 12 * b, p.data() + tables_.bodies[b].first);
    } else {
        system.balances().twist_row(layout, system.nodes(), 0, p.data());
        for (double& value : p) value = -value;
    }
    instant_.from_momentum(here, p.data(), weight, lambda_.data());
    for (int c = 0; c < tables_.rank; ++c) {
        const double taken = weight * lambda_[here.held.rows[c]];
        impulse_[c] = (layout.P_first ? system.balances().impulses(0)[c] : 0.0) - taken;
    }
    accelerate(here);
    return true;
}

void ElementEnd::begin(const double* impulses) { std::copy_n(impulses, tables_.rank, impulse_.data()); }

/// What the rows of an element add to the momentum at its start:
///
///     p = p_0 + sum_A f_A,      s = s_0 + sum_A tau_A
///
/// with wrenches (f_A, tau_A) of loads and multipliers about the centres of mass (docs/theory.md, "The
/// element"). With lobatto that is its last row once the others are solved. The last row itself would carry
/// the rounding of k_AB / h and the residual of Newton's iteration.
void ElementEnd::add_wrenches(const NodalSystem& system, int e, std::span<double> raw,
                              std::span<double> wrench, double* sum) const
{
    const Nodes& nodes = system.nodes();
    const NodalRows& rows = system.balances();
    const int p = system.rule().degree, without = node_without(system.rule());
    const double h = system.layout().h(e);
    const bool has_loads = !tables_.model->loads().empty();
    for (const auto& body : tables_.bodies)   // the weight has no moment about the centre
        for (int i = 0; i < 3; ++i) sum[body.first + i] += h * body.weight[i];
    for (int a = 0; a <= p; ++a) {
        const int A = e * p + a;
        if (a == without && !has_loads) continue;
        if (has_loads)
            std::copy_n(rows.loads().forces(e, a), raw.size(), raw.begin());
        else
            std::ranges::fill(raw, 0.0);
        if (a != without)
            rows.subtract(nodes.basis(A), A == 0 ? impulse_.data() : rows.impulses(A), raw.data());
        tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), raw.data(), wrench.data());
        for (std::size_t i = 0; i < wrench.size(); ++i) sum[i] += wrench[i];
    }
}

/// The impulse at a shared node counts whole in the element behind it: what the projection at the end of the
/// one before has taken off, it takes less (pass_on()). So ends need not wait for each other's projections.
std::vector<double> ElementEnd::momenta(const NodalSystem& system) const
{
    const int n = system.layout().n_elements();
    const std::size_t size = momentum_.size();
    std::vector<double> sums(static_cast<std::size_t>(n) * size, 0.0);
    in_shares(n, least_shared, [&](int, int begin, int end) {
        std::vector<double> raw(raw_.size()), wrench(size);
        for (int e = begin; e < end; ++e) add_wrenches(system, e, raw, wrench, sums.data() + e * size);
    });
    const double* before = states_[now_].p.data();
    for (double* own = sums.data(); own != sums.data() + sums.size(); before = own, own += size) {
        const double* __restrict p = before;
        double* __restrict sum = own;
        for (std::size_t i = 0; i < size; ++i) sum[i] += p[i];
    }
    return sums;
}

void ElementEnd::begin_as(const ElementEnd& other, const NodalSystem& system, int e)
{
    here().take(other.here());
    impulse_ = other.impulse_;
    instant_.choose_as(other.instant_);
    std::vector<double>& angles = here().angles;
    for (int A = 1; A <= e * system.rule().degree && !tables_.loads.turns.empty(); ++A)
        tables_.loads.turns.follow(Configurations(system.nodes().X(A)), angles);
}

/// The spin about the centres of mass at the end of an element of radau is that of the polynomial's own
/// velocity, as its rows do not balance moments.
void ElementEnd::take_spin_of_polynomial(const NodalSystem& system, int e)
{
    const ElementRule& rule = system.rule();
    const Nodes& nodes = system.nodes();
    const int p = rule.degree, A = (e + 1) * p;
    std::vector<double> V(raw_.size(), 0.0);
    for (int B = 1; B <= p; ++B)
        for (std::size_t i = 0; i < V.size(); ++i)
            V[i] += rule.D[p * rule.size() + B] / system.layout().h(e) * nodes.dX(e, B)[i];
    tables_.bodies.times_mass(V.data(), 1.0, raw_.data());
    tables_.bodies.twist_rows(nodes.X(A), states_[1 - now_].maps.data(), raw_.data(), wrench_.data());
    for (const auto& body : tables_.bodies)
        for (int i = 3; i < body.dofs; ++i) momentum_[body.first + i] = wrench_[body.first + i];
}

bool ElementEnd::reach(NodalSystem& system, MarchKernel& kernel, int e, const double* momentum, bool polish)
{
    const ElementRule& rule = system.rule();
    const WindowLayout& layout = system.layout();
    const Nodes& nodes = system.nodes();
    const int p = rule.degree, A = (e + 1) * p;
    const bool is_radau = rule.points == Points::radau;
    InstantState &here = states_[now_], &next = states_[1 - now_];
    next.t = layout.times[e + 1];
    if (kernel.is_solved())
        kernel.momentum(layout, here, momentum_.data());
    else
        std::copy_n(momentum, momentum_.size(), momentum_.begin());
    if (!tables_.loads.turns.empty()) {
        next.angles = here.angles;
        for (int a = 1; a <= p; ++a)
            tables_.loads.turns.follow(Configurations(nodes.X(e * p + a)), next.angles);
    }
    std::copy_n(nodes.X(A), next.X.size(), next.X.begin());
    std::copy_n(nodes.low(A), next.X.size(), next.X_low.begin());
    if (kernel.is_solved() && is_radau)   // the kernel has no maps of nodes
        tables_.bodies.map_twists(nodes.X(A), next.maps.data());
    else if (!kernel.is_solved())
        std::copy_n(nodes.maps(A), next.X.size(), next.maps.begin());
    if (is_radau) take_spin_of_polynomial(system, e);
    for (int b = 0; polish && b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6) orthonormalise(next.X.data() + 12 * b);
    // the node's own basis, where nothing asks for it any more
    const bool is_free = layout.n_elements() == 1 && !is_radau && layout.is_unknown(A) && !kernel.is_solved();
    ConstraintBasis* known = is_free && system.bases_fit() ? &system.nodes().own_basis(A) : nullptr;
    if (!instant_.prepare(next, here.held.rows, known, kernel.factor_at_end())) return false;
    const double weight = layout.h(e) * rule.weights[p];
    instant_.from_momentum(next, momentum_.data(), weight, end_lambda_.data());
    accelerate(next);
    return true;
}

/// A row that was left out and is off by more than 1e-8 of its scale (docs/theory.md, "Least reactions").
std::string ElementEnd::contradiction() const
{
    const InstantState& state = states_[1 - now_];
    if (tables_.rank == tables_.n_rows()) return {};
    const int r = tables_.first_violated_beside(state.held.rows, {state.t}, state.X.data(), 1e-8);
    if (r < 0) return {};
    return tables_.model->row_name(r) +
           ": was redundant at the start and contradicts the other joints by t = " + to_text(state.t, 6) +
           " s";
}

const double* ElementEnd::multipliers(const NodalSystem& system, int e, int a)
{
    const ElementRule& rule = system.rule();
    const int p = rule.degree;
    if (a == node_without(rule))   // at the start of radau that of the acceleration there
        return (a == p ? end_lambda_ : here().multipliers[1]).data();
    const double* impulses = a == 0 ? impulse_.data() : system.balances().impulses(e * p + a);
    if (a == p)
        lambda_ = end_lambda_;   // the part that the projection took, to which the node's own is added
    else if (tables_.rank < tables_.n_rows())
        std::ranges::fill(lambda_, 0.0);
    const double weight = system.layout().h(e) * rule.weights[a];
    const int* row = system.nodes().rows().data();
    for (int c = 0, n = tables_.rank; c < n; ++c) {
        const double own = impulses[c] / weight;
        lambda_[row[c]] = a == p ? lambda_[row[c]] + own : own;
    }
    return lambda_.data();
}

void ElementEnd::pass_on(const NodalSystem& system, int e)
{
    const WindowLayout& layout = system.layout();
    const int p = layout.degree;
    const double weight = layout.h(e) * system.rule().weights[p];
    if (e + 1 < layout.n_elements())   // the shared node's other side
        for (int c = 0; c < tables_.rank; ++c)
            impulse_[c] =
                system.balances().impulses((e + 1) * p)[c] - weight * end_lambda_[system.nodes().rows()[c]];
    if (is_jump(next().t))
        next().forget_past();
    else
        next().look_back(here(), layout.h(e) > 0);
    now_ = 1 - now_;
}

}   // namespace livens
