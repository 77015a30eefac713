// SPDX-License-Identifier: BSD-3-Clause
// Stiffness, damping and mass of small motions in scaled twists, source by source: theory.md, "Small motions"
// and "Highest frequencies". Each term also has the sum of its absolute parts, by which rounding is told from
// a value.
#include "livens/statics/small_motions.h"

#include <algorithm>
#include <cmath>

#include "livens/base/error.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"

namespace livens::inline statics_internal {

namespace {

template <int R, int C>
Matrix<R, C> sizes_of(Matrix<R, C> A)
{
    for (double& entry : A.a) entry = std::abs(entry);
    return A;
}

}   // namespace

Matrix<6, 1> times(const Matrix<6, 6>& K, std::span<const double> y)
{
    Matrix<6, 1> Ky{};
    for (int k = 0; k < static_cast<int>(y.size()); ++k)
        for (int i = 0; i < 6; ++i) Ky[i] += K(i, k) * y[k];
    return Ky;
}

/// maps_: plain twists by scaled ones, 6 x 6 a body; columns_: X by scaled twists, 12 x 6. Column by column.
SmallMotions::SmallMotions(const ModelTables& tables, const InstantState& state, Side side)
    : tables_(tables), state_(state), at_{state.t, side}
{
    std::vector<double> y(static_cast<std::size_t>(tables.n_twists), 0.0), xi(y.size());
    for (int k = 0; k < 6; ++k) {   // of all bodies at once
        std::fill(y.begin(), y.end(), 0.0);
        for (const auto& body : tables.bodies)
            if (k < body.dofs) y[body.first + k] = 1;
        tables.bodies.to_twist(state.maps.data(), y.data(), xi.data());
        columns_.resize(tables.bodies.size(), BodyColumns{});
        maps_.resize(tables.bodies.size(), Matrix<6, 6>{});
        for (int b = 0; b < tables.n_bodies(); ++b) {
            const auto& body = tables.bodies[b];
            if (k >= body.dofs) continue;
            double twist[6] = {};
            std::copy_n(xi.data() + body.first, body.dofs, twist);
            std::copy_n(twist, body.dofs, maps_[b].data() + 6 * k);
            twist::columns(state.X.data() + 12 * b, twist, columns_[b].data() + 12 * k);
        }
    }
}

void SmallMotions::add_loads(TwistTerms& springs, TwistTerms& dampers) const
{
    std::vector<double> V(state_.X.size());
    tables_.bodies.rates_of(state_.X.data(), state_.velocity.data(), V.data());
    for (const int l : tables_.loads.with_tangent) {
        const Load& load = tables_.model->loads()[l];
        LoadTangent tangent(load.bodies.size(), load.n_acted);
        load.tangent(tables_.loads.arguments(l, at_, state_.X.data(), V.data(), state_.angles), tangent);
        for (std::size_t r = 0; r < load.n_acted; ++r)
            for (std::size_t s = 0; s < load.bodies.size(); ++s) {
                const int i = load.bodies[r], j = load.bodies[s];
                // The world does not move: its columns multiply zero.
                if (i == world || j == world) continue;
                springs.push_back(term(l, tangent.X[r][s], -1, i, j));
                dampers.push_back(term(l, tangent.V[r][s], -1, i, j));
            }
    }
}

void SmallMotions::add_constraints(TwistTerms& terms) const
{
    const int s = at_.side == Side::left ? 0 : 1;
    const std::vector<double>& lambda = state_.multipliers[s];
    // r = F - G^T lambda - X'' m is what rigidity bears on each body; its geometric term belongs to the
    // constraints.
    std::vector<double> r = forces_less_inertia(s);
    for (int c = 0; c < tables_.n_rows(); ++c) {
        if (lambda[c] == 0) continue;
        const RowTable& row = tables_.rows[c];
        double gradient[RowTables::gradient_size];
        tables_.rows.gradient(c, at_, state_.X.data(), gradient);
        for (int k = 0; k < row.n_sides; ++k) {
            const int i = row.bodies[k];
            for (const int a : row.columns[k])
                for (int n = a; n < a + 3; ++n) r[12 * i + n] -= lambda[c] * gradient[12 * k + n];
            for (int m = 0; m < row.n_sides; ++m) {
                const int j = row.bodies[m];
                const auto K = constraint_hessian(*row.row, at_, Configurations(state_.X.data()), i, j);
                terms.push_back(term(tables_.model->row_joint(c), K, lambda[c], i, j));
            }
        }
    }
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        if (tables_.bodies[b].dofs == 3) continue;
        // The orientation's own second derivative: a turn moves the point where the directors' forces act.
        Matrix<6, 6> K{};   // symmetric where the moments balance
        twist::add_geometric(state_.X.data() + 12 * b, r.data() + 12 * b, K.data(), 6);
        K = transpose(K);   // written row by row
        terms.push_back({-1, b, b, -congruence(maps_[b], K), congruence(sizes_of(maps_[b]), sizes_of(K))});
    }
}

/// The identity, unless an inertia is singular: coordinates are then those of a larger one, and m is not.
void SmallMotions::add_mass(TwistTerms& terms) const
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        Matrix<6, 6> M = identity<6>();
        if (tables_.bodies[b].dofs == 6) {
            Matrix3 inertia;
            tables_.bodies.spin_mass(b, state_.X.data(), state_.X.data(), inertia.data());
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) M(3 + i, 3 + j) = inertia(i, j);
        }
        terms.push_back({-1, b, b, M});
    }
}

TwistTerm SmallMotions::term(int source, const Matrix<12, 12>& K, double factor, int i, int j) const
{
    const BodyColumns &left = columns_[i], &right = columns_[j];
    return {source, i, j, congruence(factor, left, K, right),
            congruence(std::abs(factor), sizes_of(left), sizes_of(K), sizes_of(right))};
}

/// Weight and loads less X'' m, 12 numbers a body.
std::vector<double> SmallMotions::forces_less_inertia(int side) const
{
    std::vector<double> V(state_.X.size()), A(V.size()), r(V.size());
    tables_.bodies.rates_of(state_.X.data(), state_.velocity.data(), V.data());
    tables_.bodies.rates_of(state_.X.data(), state_.acceleration[side].data(), A.data());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        if (body.dofs == 3) continue;
        double spin[6] = {}, centripetal[12];
        std::copy_n(state_.velocity.data() + body.first + 3, 3, spin + 3);
        twist::columns(V.data() + 12 * b, spin, centripetal);
        // X'' = N alpha + [0, w x (w x d_a)]: the second part is there at any spin, whatever the
        // acceleration.
        for (int i = 0; i < 12; ++i) A[12 * b + i] += centripetal[i];
    }
    tables_.bodies.times_mass(A.data(), -1.0, r.data());
    tables_.bodies.add_weight(1.0, r.data());
    tables_.loads.add(at_, state_.X.data(), V.data(), 1.0, r.data(), state_.angles);
    return r;
}

FreeMotions::FreeMotions(const ModelTables& tables, const InstantState& state)
    : n_twists(tables.n_twists), n(tables.freedoms()), Z(n_twists, n)
{
    if (n == 0) return;
    DenseMatrix by_rows(n, n_twists);
    state.held.basis.q.null_space(by_rows.a.data());
    Z = transpose(by_rows);
}

DenseMatrix FreeMotions::reduced(const ModelTables& tables, const TwistTerms& terms) const
{
    DenseMatrix KZ(n_twists, n);
    for (const TwistTerm& t : terms) {
        const auto &i = tables.bodies[t.i], &j = tables.bodies[t.j];
        for (int k = 0; k < n; ++k) {
            const Matrix<6, 1> Kz = times(t.K, Z.column(k).subspan(j.first, j.dofs));
            for (int r = 0; r < i.dofs; ++r) KZ(i.first + r, k) += Kz[r];
        }
    }
    return transposed_product(Z, KZ);
}

/// The diagonal of |Z|^T |K| |Z|: what terms of Z^T K Z add up to where none of them cancel.
std::vector<double> FreeMotions::sizes(const ModelTables& tables, const TwistTerms& terms) const
{
    DenseMatrix z = Z;
    for (double& entry : z.a) entry = std::abs(entry);
    std::vector<double> sum(static_cast<std::size_t>(n), 0.0);
    for (const TwistTerm& t : terms) {
        const auto &i = tables.bodies[t.i], &j = tables.bodies[t.j];
        const Matrix<6, 6> K = sizes_of(t.K);
        for (int k = 0; k < n; ++k) {
            const Matrix<6, 1> Kz = times(K, z.column(k).subspan(j.first, j.dofs));
            sum[k] += dot(z.column(k).subspan(i.first, i.dofs), std::span(Kz.a).first(i.dofs));
        }
    }
    return sum;
}

std::vector<double> FreeMotions::twists(const ModelTables& tables, const InstantState& state, int k) const
{
    std::vector<double> xi(static_cast<std::size_t>(n_twists));
    tables.bodies.to_twist(state.maps.data(), Z.column(k).data(), xi.data());
    return xi;
}

void refuse_sampling(const Model& model)
{
    if (model.samplings().empty()) return;
    throw InputError({"controller-sampled", "controller[" + model.samplings()[0].name + "]",
                      "a sampled controller changes at instants: it has no rest and no small motions", "", "",
                      "", "state it with rates, without 'every', for this question"});
}

StateDirections::StateDirections(const ModelTables& tables, const FreeMotions& free)
{
    struct Direction {
        int first;   // twist
        Vector3 along;
    };
    std::vector<Direction> of_held, of_idle;
    for (int b = 0; b < tables.n_bodies(); ++b) {
        const Body& body = tables.model->bodies()[static_cast<std::size_t>(b)];
        if (!body.holds_states()) continue;
        const int first = tables.bodies[b].first;
        std::vector<Vector3> taken;
        for (const HeldState& state : body.states) {
            taken.push_back(state.along);
            of_held.push_back({first, state.along});
        }
        for (int k = 0; k < 3 && taken.size() < 3; ++k) {   // what is left, axis by axis
            Vector3 e{};
            e[k] = 1;
            for (int again = 0; again < 2; ++again)
                for (const Vector3& one : taken) e -= dot(one, e) * one;
            // Of any direction some axis has at least 1 / sqrt(3): enough of them pass.
            if (norm(e) < 0.5) continue;
            taken.push_back((1 / norm(e)) * e);
            of_idle.push_back({first, taken.back()});
        }
    }
    for (auto [directions, E] : {std::pair(&of_held, &held), std::pair(&of_idle, &idle)}) {
        *E = DenseMatrix(free.n, static_cast<int>(directions->size()));
        for (int k = 0; k < E->cols; ++k) {
            const Direction& one = (*directions)[static_cast<std::size_t>(k)];
            for (int j = 0; j < free.n; ++j)
                for (int i = 0; i < 3; ++i) (*E)(j, k) += one.along[i] * free.Z(one.first + i, j);
        }
    }
}

namespace {

constexpr int many_freedoms = 60;   // from here on a basis of them costs more than it gives

}   // namespace

PreparedState::PreparedState(const Model& model, const State& given, Side side, bool by_basis)
    : PreparedState(model, consistent_start(model, given, StartPolicy::project), side, by_basis)
{}

PreparedState::PreparedState(const Model& model, const ConsistentStart& closed, Side side, bool by_basis)
    : tables(model, closed.independent)
{
    // Many freedoms have a projection along the joints in place of a basis: theory.md, "Highest frequencies".
    const bool is_sparse = !by_basis && tables.freedoms() > many_freedoms && JointFactor::serves(tables) &&
                           tables.rows.are_quadratic();
    InstantSystem instant(tables, is_sparse);
    state.resize(tables);
    state.t = closed.start.t;
    for (int b = 0; b < tables.n_bodies(); ++b) {
        const Matrix34 &X = closed.start.X[b], &V = closed.start.V[b];
        std::copy_n(X.a, 12, state.X.begin() + 12 * b);
        const auto& body = tables.bodies[b];
        const Vector3 w = body.dofs == 6 ? angular_velocity(X, V) : Vector3{};
        for (int i = 0; i < body.dofs; ++i) state.velocity[body.first + i] = i < 3 ? V(i, 0) : w[i - 3];
    }
    state.angles = tables.loads.turns.begin(closed.start);
    tables.loads.turns.follow(closed.start.X, state.angles);
    is_fit = instant.prepare(state, tables.independent);
    if (is_fit) instant.accelerate(state, side);
}

}   // namespace livens::inline statics_internal
