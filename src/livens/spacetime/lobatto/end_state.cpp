#include "livens/spacetime/lobatto/end_state.h"

#include <algorithm>
#include <utility>

#include "livens/spacetime/lobatto/twist.h"

namespace livens {

void EndState::resize(const Mechanism& mechanism)
{
    const auto n = static_cast<std::size_t>(mechanism.n_twists);
    X.assign(12 * mechanism.bodies.size(), 0.0);
    X_low.assign(X.size(), 0.0);
    frames.assign(X.size(), 0.0);
    velocity.assign(n, 0.0);
    p.assign(n, 0.0);
    momentum.assign(n, 0.0);
    for (int side = 0; side < 2; ++side) {
        acceleration[side].assign(n, 0.0);
        multipliers[side].assign(mechanism.rows.size(), 0.0);
    }
    jerk.assign(n, 0.0);
    snap.assign(n, 0.0);
    basis.resize(mechanism, true);
}

void EndState::look_back(const EndState& earlier)
{
    has_past = true;
    const double inverse = 1 / (t - earlier.t);
    const std::size_t n = velocity.size();
    const double *v0 = earlier.velocity.data(), *v1 = velocity.data();
    const double *a0 = earlier.acceleration[1].data(), *a1 = acceleration[0].data();
    double* __restrict j = jerk.data();
    double* __restrict s = snap.data();
    for (std::size_t i = 0; i < n; ++i) {
        const double slope = (v1[i] - v0[i]) * inverse;
        j[i] = (2 * a0[i] + 4 * a1[i] - 6 * slope) * inverse;
        s[i] = (6 * a0[i] + 6 * a1[i] - 12 * slope) * (inverse * inverse);
    }
}

void EndState::forget_past()
{
    has_past = false;
    std::fill(jerk.begin(), jerk.end(), 0.0);
    std::fill(snap.begin(), snap.end(), 0.0);
}

EndSolver::EndSolver(const Mechanism& mechanism) : mechanism_(mechanism)
{
    const auto n = static_cast<std::size_t>(mechanism.n_twists);
    if (!mechanism.regular) {
        reduced_.resize(mechanism.freedoms());
        z_.assign(n * static_cast<std::size_t>(mechanism.freedoms()), 0.0);
    }
    for (auto* v : {&a_, &b_, &c_}) v->assign(n, 0.0);
    for (auto* v : {&V_, &centripetal_, &raw_}) v->assign(12 * mechanism.bodies.size(), 0.0);
}

bool EndSolver::prepare(EndState& state, ConstraintBasis* known)
{
    mechanism_.frames_of(state.X.data(), state.frames.data());
    if (known != nullptr && mechanism_.rank == mechanism_.n_rows())
        state.basis.exchange(*known);
    else
        state.smallest_pivot = state.basis.choose(mechanism_, state.X.data(), state.frames.data());
    return mechanism_.regular || prepare_singular(state);
}

/// out <- D^T Mr D y: y itself where every inertia is definite.
void EndSolver::apply_mass(const EndState& state, const double* y, double* out)
{
    if (mechanism_.regular) {
        std::copy(y, y + mechanism_.n_twists, out);
        return;
    }
    std::vector<double> xi(static_cast<std::size_t>(mechanism_.n_twists)), rows(xi.size());
    std::vector<double> dX(state.X.size()), P(state.X.size());
    mechanism_.unscale(state.frames.data(), y, xi.data());
    mechanism_.columns_of(state.X.data(), xi.data(), dX.data());
    mechanism_.times_mass(dX.data(), 1.0, P.data());
    mechanism_.rows_of(state.X.data(), state.frames.data(), P.data(), rows.data());
    mechanism_.scale_rows(state.frames.data(), rows.data(), out);
}

/// The mass on the null space where it is not the identity.
bool EndSolver::prepare_singular(const EndState& state)
{
    const int f = mechanism_.freedoms(), n = mechanism_.n_twists;
    state.basis.q.null_space(z_.data());
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

/// lambda <- S R^-1 y / weight on the chosen rows.
void EndSolver::scatter(const EndState& state, const double* y, double weight, double* lambda) const
{
    const ConstraintBasis& basis = state.basis;
    std::fill(lambda, lambda + mechanism_.n_rows(), 0.0);
    for (int c = 0; c < mechanism_.rank; ++c) lambda[basis.rows[c]] = y[c] * basis.row_scale[c] / weight;
}

/// M y + Ghat^T lambda = forces and Ghat y = (what y holds in its first `rank` places, as Q^T y); all scaled.
/// On return y is the solution and `multipliers` holds R S^-1 lambda, `rank` numbers.
void EndSolver::solve(const EndState& state, const double* forces, double* y, double* multipliers)
{
    const OrthogonalBasis& q = state.basis.q;
    const int k = mechanism_.rank, n = mechanism_.n_twists;
    double* g = c_.data();
    if (mechanism_.regular) {
        std::copy(forces, forces + n, g);
        q.apply_transposed(g);
        for (int c = 0; c < k; ++c) multipliers[c] = g[c] - y[c];
        std::copy(g + k, g + n, y + k);
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
    for (int i = 0; i < n; ++i) g[i] = forces[i] - image[static_cast<std::size_t>(i)];
    q.apply_transposed(g);
    std::copy(g, g + k, multipliers);
}

void EndSolver::from_momentum(EndState& state, const double* p, double weight, double* lambda)
{
    double* y = a_.data();
    double* rest = b_.data();
    mechanism_.scale_rows(state.frames.data(), p, rest);
    std::fill(y, y + mechanism_.rank, 0.0);
    solve(state, rest, y, rest);
    state.basis.q.solve_R(rest);
    scatter(state, rest, weight, lambda);
    mechanism_.unscale(state.frames.data(), y, state.velocity.data());
    // what the multipliers take off is taken off p itself: without joints p stays as it is, to the bit
    std::copy(p, p + mechanism_.n_twists, state.p.begin());
    for (int c = 0; c < mechanism_.rank; ++c) {
        const int r = state.basis.rows[c];
        add_reaction(state, c, -weight * lambda[r], state.p.data());
    }
    mechanism_.scale_rows(state.frames.data(), state.p.data(), state.momentum.data());
}

/// rows += factor Ghat_c for column c of the basis, about the centres of mass.
void EndSolver::add_reaction(const EndState& state, int c, double factor, double* rows) const
{
    const int r = state.basis.rows[c];
    const auto& table = mechanism_.rows[r];
    for (int side = table.first_side(); side < 2; ++side) {
        const auto& body = mechanism_.bodies[table.body(side)];
        double q[6];
        mechanism_.wrench(r, side, state.X.data(), state.frames.data(), state.basis.gradients.data() + 24 * c,
                          q);
        for (int i = 0; i < body.dofs; ++i) rows[body.first + i] += factor * q[i];
    }
}

void EndSolver::from_velocity(EndState& state)
{
    mechanism_.columns_of(state.X.data(), state.velocity.data(), V_.data());
    mechanism_.times_mass(V_.data(), 1.0, raw_.data());
    mechanism_.rows_of(state.X.data(), state.frames.data(), raw_.data(), state.p.data());
    mechanism_.scale_rows(state.frames.data(), state.p.data(), state.momentum.data());
}

/// First places of Q^T y for an acceleration with d2 Phi/dt2 = 0, from the velocities in V_ and centripetal_.
void EndSolver::particular(const EndState& state, double* y) const
{
    const ConstraintBasis& basis = state.basis;
    for (int c = 0; c < mechanism_.rank; ++c) {
        const auto& table = mechanism_.rows[basis.rows[c]];
        const double* g = basis.gradients.data() + 24 * c;
        double gamma = mechanism_.curvature(basis.rows[c], V_.data());
        for (int side = table.first_side(); side < 2; ++side) {
            const double* a = centripetal_.data() + 12 * table.body(side);
            for (const int column : table.columns[side])
                for (int i = column; i < column + 3; ++i) gamma += g[12 * side + i] * a[i];
        }
        y[c] = -gamma * basis.row_scale[c];
    }
    basis.q.solve_R_transposed(y);
}

void EndSolver::accelerate(EndState& state, Side side)
{
    const double* X = state.X.data();
    mechanism_.columns_of(X, state.velocity.data(), V_.data());
    // X'' without twist acceleration: [0, w x (w x d_a)]
    for (int b = 0; b < mechanism_.n_bodies(); ++b) {
        const auto& body = mechanism_.bodies[b];
        if (body.dofs == 3) continue;
        double spin[6] = {0, 0, 0, 0, 0, 0};
        std::copy_n(state.velocity.data() + body.first + 3, 3, spin + 3);
        twist::columns(V_.data() + 12 * b, spin, centripetal_.data() + 12 * b);
    }
    mechanism_.times_mass(centripetal_.data(), -1.0, raw_.data());
    mechanism_.add_weight(1.0, raw_.data());
    mechanism_.add_loads({state.t, side}, X, V_.data(), 1.0, raw_.data());
    double* y = a_.data();
    double* forces = b_.data();
    mechanism_.rows_of(X, state.frames.data(), raw_.data(), y);
    mechanism_.scale_rows(state.frames.data(), y, forces);
    particular(state, y);
    solve(state, forces, y, forces);
    const int s = side == Side::right ? 1 : 0;
    state.basis.q.solve_R(forces);
    scatter(state, forces, 1.0, state.multipliers[s].data());
    mechanism_.unscale(state.frames.data(), y, state.acceleration[s].data());
}

}   // namespace livens
