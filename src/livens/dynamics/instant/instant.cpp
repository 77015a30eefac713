// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/instant/instant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/model.h"

namespace livens {

namespace {

/// The last one, if it is of these rows.
std::shared_ptr<const RowPattern> pattern_of(const ModelTables& tables, const std::vector<int>& rows)
{
    std::shared_ptr<const RowPattern>& known = tables.known_pattern->last;
    if (known == nullptr || known->chosen() != rows) known = std::make_shared<const RowPattern>(tables, rows);
    return known;
}

}   // namespace

void InstantState::resize(const ModelTables& tables)
{
    const auto n = static_cast<std::size_t>(tables.n_twists);
    X.assign(12 * tables.bodies.size(), 0.0);
    X_low.assign(X.size(), 0.0);
    maps.assign(X.size(), 0.0);
    velocity.assign(n, 0.0);
    p.assign(n, 0.0);
    momentum.assign(n, 0.0);
    for (int side = 0; side < 2; ++side) {
        acceleration[side].assign(n, 0.0);
        multipliers[side].assign(tables.rows.size(), 0.0);
    }
    jerk.assign(n, 0.0);
    snap.assign(n, 0.0);
    held.rows = tables.independent;
    held.has_basis = false;
}

void InstantState::take(const InstantState& other)
{
    t = other.t;
    has_past = other.has_past;
    held.rows = other.held.rows;
    held.are_new = held.has_basis = false;
    for (const auto field : {&InstantState::angles, &InstantState::X, &InstantState::X_low,
                             &InstantState::maps, &InstantState::velocity, &InstantState::p,
                             &InstantState::momentum, &InstantState::jerk, &InstantState::snap})
        this->*field = other.*field;
    for (const int side : {0, 1}) {
        acceleration[side] = other.acceleration[side];
        multipliers[side] = other.multipliers[side];
    }
}

void InstantState::look_back(const InstantState& earlier, bool forwards)
{
    has_past = true;
    const double inverse = 1 / (t - earlier.t);
    const double* __restrict v0 = earlier.velocity.data(), * __restrict v1 = velocity.data();
    const double* __restrict a0 = earlier.acceleration[forwards ? 1 : 0].data(), * __restrict a1 =
                                                                                     acceleration[forwards
                                                                                                      ? 0
                                                                                                      : 1]
                                                                                         .data();
    double* __restrict j = jerk.data(), * __restrict s = snap.data();
    const std::size_t n = velocity.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double mean = 0.5 * (a0[i] + a1[i]) - (v1[i] - v0[i]) * inverse;   // of a, less the slope of v
        s[i] = 12 * inverse * inverse * mean;
        j[i] = inverse * (a1[i] - a0[i] + 6 * mean);
    }
}

void InstantState::forget_past()
{
    has_past = false;
    std::fill(jerk.begin(), jerk.end(), 0.0);
    std::fill(snap.begin(), snap.end(), 0.0);
}

InstantSystem::InstantSystem(const ModelTables& tables, bool sparse)
    : tables_(tables), loads_(tables), is_sparse_(sparse)
{
    const auto n = static_cast<std::size_t>(tables.n_twists);
    if (!tables.bodies.are_regular()) {
        reduced_.resize(tables.freedoms());
        z_.assign(n * static_cast<std::size_t>(tables.freedoms()), 0.0);
    }
    for (auto* v : {&a_, &b_}) v->assign(n, 0.0);
    row_rates_.assign(static_cast<std::size_t>(tables.rank), 0.0);
    for (auto* v : {&V_, &centripetal_, &raw_}) v->assign(12 * tables.bodies.size(), 0.0);
}

bool InstantSystem::prepare(InstantState& state, const std::vector<int>& rows, ConstraintBasis* known,
                            const NearFactor& near)
{
    state.held.are_new = state.held.has_basis = false;
    if (known != nullptr && tables_.rank == tables_.n_rows()) {
        give_room(state.held.basis);
        std::swap(state.held.basis, *known);
        state.held.has_basis = true;
        if (!is_sparse_) {
            state.held.rows = rows;
            return tables_.bodies.are_regular() || prepare_singular(state);
        }
    } else {
        tables_.bodies.map_twists(state.X.data(), state.maps.data());
    }
    hold(state, rows, near);
    if (tables_.rank < tables_.n_rows() && !rows_are_fit(state)) {
        give_room(state.held.basis);
        state.held.basis.choose(tables_, {state.t}, state.X.data(), state.maps.data());
        hold(state, std::vector<int>(state.held.basis.rows));
        state.held.are_new = true;
        pivot_at_choice_ = state.held.smallest_pivot;
    }
    return tables_.bodies.are_regular() || prepare_singular(state);
}

/// A basis takes room that grows with the square of the bodies: where it is needed.
void InstantSystem::give_room(ConstraintBasis& basis) const
{
    if (basis.gradients.empty()) basis.resize(tables_, true);
}

/// What these rows hold.
void InstantSystem::hold(InstantState& state, const std::vector<int>& rows, const NearFactor& near)
{
    if (state.held.rows != rows) state.held.rows = rows;
    if (is_sparse_) {
        if (pattern_ == nullptr || pattern_->chosen() != rows) pattern_ = pattern_of(tables_, rows);
        state.held.joints.use(pattern_);
        state.held.smallest_pivot = state.held.joints.prepare(tables_, {state.t}, state.X.data(), near);
        state.held.by_joints = state.held.smallest_pivot > JointFactor::well_held;
        if (state.held.by_joints) return;
    }
    state.held.has_basis = false;
    add_basis(state);
    state.held.smallest_pivot = state.held.basis.smallest_pivot;
}

void InstantSystem::add_basis(InstantState& state) const
{
    if (state.held.has_basis) return;
    give_room(state.held.basis);
    state.held.basis.build(tables_, {state.t}, state.X.data(), state.maps.data(), state.held.rows, false);
    state.held.has_basis = true;
}

bool InstantSystem::rows_are_fit(const InstantState& state)
{
    pivot_at_choice_ = pivot_at_choice_ > 0 ? pivot_at_choice_ : state.held.smallest_pivot;
    // where the mechanism turns, rows that were independent grow alike: others hold better long before
    if (!(state.held.smallest_pivot > std::max(1e-6, 0.1 * pivot_at_choice_))) return false;
    return tables_.first_violated_beside(state.held.rows, {state.t}, state.X.data(), 1e-9) < 0;
}

/// out <- D^T Mr D y: y itself where every inertia is definite.
void InstantSystem::apply_mass(const InstantState& state, const double* y, double* out)
{
    if (tables_.bodies.are_regular()) {
        std::copy(y, y + tables_.n_twists, out);
        return;
    }
    std::vector<double> xi(static_cast<std::size_t>(tables_.n_twists)), rows(xi.size());
    std::vector<double> dX(state.X.size()), P(state.X.size());
    tables_.bodies.to_twist(state.maps.data(), y, xi.data());
    tables_.bodies.rates_of(state.X.data(), xi.data(), dX.data());
    tables_.bodies.times_mass(dX.data(), 1.0, P.data());
    tables_.bodies.twist_rows(state.X.data(), state.maps.data(), P.data(), rows.data());
    tables_.bodies.to_scaled_rows(state.maps.data(), rows.data(), out);
}

/// The mass on the null space where it is not the identity.
bool InstantSystem::prepare_singular(const InstantState& state)
{
    const int f = tables_.freedoms(), n = tables_.n_twists;
    state.held.basis.q.null_space(z_.data());
    std::vector<double> column(static_cast<std::size_t>(n)), image(column.size());
    for (int j = 0; j < f; ++j) {
        for (int i = 0; i < n; ++i)
            column[static_cast<std::size_t>(i)] = z_[static_cast<std::size_t>(i * f + j)];
        apply_mass(state, column.data(), image.data());
        for (int r = j; r < f; ++r) {
            double sum = 0;
            for (int i = 0; i < n; ++i)
                sum += z_[static_cast<std::size_t>(i * f + r)] * image[static_cast<std::size_t>(i)];
            reduced_.row(r)[j] = sum;
        }
    }
    return reduced_.factorise();
}

/// lambda <- S R^-1 y / weight on the chosen rows; by joints y is what joints.project() says.
void InstantSystem::scatter(const InstantState& state, double* y, double weight, double* lambda) const
{
    if (tables_.rank < tables_.n_rows()) std::fill(lambda, lambda + tables_.n_rows(), 0.0);
    if (state.held.by_joints) {
        const std::vector<int>& rows = state.held.joints.pattern()->rows();
        for (int c = 0; c < tables_.rank; ++c) lambda[rows[c]] = y[c] / weight;
        return;
    }
    const ConstraintBasis& basis = state.held.basis;
    basis.q.solve_R(y);
    for (int c = 0; c < tables_.rank; ++c) lambda[basis.rows[c]] = y[c] * basis.row_scale(c) / weight;
}

/// M y + Ghat^T lambda = forces and Ghat y = (what y holds in its first `rank` places, as Q^T y); all scaled.
/// On return y is the solution and the first `rank` forces are R S^-1 lambda.
void InstantSystem::solve(const InstantState& state, double* forces, double* y)
{
    const OrthogonalBasis& q = state.held.basis.q;
    const int k = tables_.rank, n = tables_.n_twists;
    if (tables_.bodies.are_regular()) {
        q.apply_transposed(forces);
        for (int c = 0; c < k; ++c) forces[c] -= y[c];
        std::copy(forces + k, forces + n, y + k);
        q.apply(y);
        return;
    }
    std::fill(y + k, y + n, 0.0);
    q.apply(y);
    std::vector<double> image(static_cast<std::size_t>(n)), eta(static_cast<std::size_t>(n - k), 0.0);
    apply_mass(state, y, image.data());
    const int f = n - k;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < f; ++j)
            eta[static_cast<std::size_t>(j)] +=
                z_[static_cast<std::size_t>(i * f + j)] * (forces[i] - image[static_cast<std::size_t>(i)]);
    reduced_.solve(eta.data());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < f; ++j)
            y[i] += z_[static_cast<std::size_t>(i * f + j)] * eta[static_cast<std::size_t>(j)];
    apply_mass(state, y, image.data());
    for (int i = 0; i < n; ++i) forces[i] -= image[static_cast<std::size_t>(i)];
    q.apply_transposed(forces);
}

void InstantSystem::from_momentum(InstantState& state, const double* p, double weight, double* lambda)
{
    double* y = a_.data();
    double* rest = b_.data();
    if (state.held.by_joints) {
        tables_.bodies.to_scaled_rows(state.maps.data(), p, y);
        const bool is_driven = state.held.joints.rates({state.t}, row_rates_.data());
        for (double& rate : row_rates_) rate = -rate;
        state.held.joints.project(y, is_driven ? row_rates_.data() : nullptr, rest);
        std::copy(p, p + tables_.n_twists, state.p.begin());
        state.held.joints.add_wrenches(rest, -1, state.p.data());
        scatter(state, rest, weight, lambda);
        tables_.bodies.to_twist(state.maps.data(), y, state.velocity.data());
        std::copy(y, y + tables_.n_twists, state.momentum.begin());
        return;
    }
    tables_.bodies.to_scaled_rows(state.maps.data(), p, rest);
    follow_drives(state, y);
    solve(state, rest, y);
    scatter(state, rest, weight, lambda);
    tables_.bodies.to_twist(state.maps.data(), y, state.velocity.data());
    // what the multipliers take off is taken off p itself: without joints p stays as it is, to the bit
    std::copy(p, p + tables_.n_twists, state.p.begin());
    for (int c = 0; c < tables_.rank; ++c) {
        const int r = state.held.basis.rows[c];
        tables_.add_wrenches(r, state.X.data(), state.maps.data(), state.held.basis.gradient(c),
                             -weight * lambda[r], state.p.data());
    }
    apply_mass(state, y, state.momentum.data());
}

void InstantSystem::from_velocity(InstantState& state)
{
    tables_.bodies.rates_of(state.X.data(), state.velocity.data(), V_.data());
    tables_.bodies.times_mass(V_.data(), 1.0, raw_.data());
    tables_.bodies.twist_rows(state.X.data(), state.maps.data(), raw_.data(), state.p.data());
    tables_.bodies.to_scaled_rows(state.maps.data(), state.p.data(), state.momentum.data());
}

/// First places of Q^T y for a velocity with dPhi/dt = 0.
void InstantSystem::follow_drives(const InstantState& state, double* y) const
{
    const ConstraintBasis& basis = state.held.basis;
    std::fill(y, y + tables_.rank, 0.0);
    if (!tables_.model->has_drives()) return;
    for (int c = 0; c < tables_.rank; ++c)
        y[c] = -tables_.rows.rate(basis.rows[c], {state.t}, state.X.data()) * basis.row_scale(c);
    basis.q.solve_R_transposed(y);
}

/// First places of Q^T y for an acceleration with d2 Phi/dt2 = 0, from the velocities in V_ and centripetal_.
void InstantSystem::particular(const InstantState& state, Side from, double* y) const
{
    const ConstraintBasis& basis = state.held.basis;
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[basis.rows[c]];
        const double* g = basis.gradient(c);
        double gamma = tables_.rows.curvature(basis.rows[c], {state.t, from}, state.X.data(), V_.data());
        for (int side = 0; side < table.n_sides; ++side) {
            const double* a = centripetal_.data() + 12 * table.bodies[side];
            for (const int column : table.columns[side])
                for (int i = 0; i < 3; ++i) gamma += g[12 * side + column + i] * a[column + i];
        }
        y[c] = -gamma * basis.row_scale(c);
    }
    basis.q.solve_R_transposed(y);
}

/// R^-1 1 is large in the rows of the combination that is nearest to zero: theory.md, "Singular positions".
std::vector<int> InstantSystem::weak_rows(InstantState& state) const
{
    add_basis(state);
    std::vector<double> y(static_cast<std::size_t>(tables_.n_twists), 1.0);
    state.held.basis.q.solve_R(y.data());
    double largest = 0;
    for (int c = 0; c < tables_.rank; ++c) largest = std::max(largest, std::abs(y[c]));
    std::vector<int> rows;
    for (int c = 0; c < tables_.rank; ++c)
        if (std::abs(y[c]) > 1e-3 * largest) rows.push_back(state.held.basis.rows[c]);
    return rows;
}

/// Ghat acceleration = 0: what velocities and drives do to the rows has no part in a response.
void InstantSystem::respond(InstantState& state, const double* raw, double* acceleration)
{
    double *y = a_.data(), *forces = b_.data();
    tables_.bodies.twist_rows(state.X.data(), state.maps.data(), raw, y);
    tables_.bodies.to_scaled_rows(state.maps.data(), y, forces);
    if (state.held.by_joints) {
        std::swap(y, forces);
        std::ranges::fill(row_rates_, 0.0);
        state.held.joints.project(y, row_rates_.data(), forces);
    } else {
        std::fill(y, y + tables_.rank, 0.0);
        solve(state, forces, y);
    }
    tables_.bodies.to_twist(state.maps.data(), y, acceleration);
}

void InstantSystem::accelerate(InstantState& state, Side side)
{
    const double* X = state.X.data();
    tables_.bodies.rates_of(X, state.velocity.data(), V_.data());
    // X'' without twist acceleration: [0, w x (w x d_a)]
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        if (body.dofs == 3) continue;
        double spin[6] = {0, 0, 0, 0, 0, 0};
        std::copy_n(state.velocity.data() + body.first + 3, 3, spin + 3);
        twist::columns(V_.data() + 12 * b, spin, centripetal_.data() + 12 * b);
    }
    tables_.bodies.times_mass(centripetal_.data(), -1.0, raw_.data());
    tables_.bodies.add_weight(1.0, raw_.data());
    loads_.add({state.t, side}, X, V_.data(), raw_.data(), state.angles, tapes_are_trusted_);
    double* y = a_.data();
    double* forces = b_.data();
    tables_.bodies.twist_rows(X, state.maps.data(), raw_.data(), y);
    tables_.bodies.to_scaled_rows(state.maps.data(), y, forces);
    const int s = side == Side::right ? 1 : 0;
    if (state.held.by_joints) {
        std::swap(y, forces);
        state.held.joints.curvatures(tables_, {state.t, side}, V_.data(), centripetal_.data(),
                                     row_rates_.data());
        for (double& value : row_rates_) value = -value;
        state.held.joints.project(y, row_rates_.data(), forces);
    } else {
        particular(state, side, y);
        solve(state, forces, y);
    }
    scatter(state, forces, 1.0, state.multipliers[s].data());
    tables_.bodies.to_twist(state.maps.data(), y, state.acceleration[s].data());
}

}   // namespace livens
