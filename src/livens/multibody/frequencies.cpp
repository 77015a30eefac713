// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/frequencies.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "livens/multibody/body.h"
#include "livens/multibody/closing.h"
#include "livens/multibody/instant.h"
#include "livens/multibody/twist.h"

namespace livens {

namespace {

using Block = Eigen::Matrix<double, 6, 6>;
using Columns = Eigen::Matrix<double, 12, 6>;   // N D of a body: its X by its scaled twist

/// Part of a form on scaled twists: what a source does to body i when body j moves.
struct Term {
    int source, i, j;
    Block K;
};
using Terms = std::vector<Term>;

class Forms {
public:
    Forms(const Tables& tables, const InstantState& state, Side side)
        : tables_(tables), state_(state), at_{state.t, side}
    {
        std::vector<double> y(static_cast<std::size_t>(tables.n_twists), 0.0), xi(y.size());
        std::vector<double> dX(state.X.size());
        for (int b = 0; b < tables.n_bodies(); ++b) {
            Columns c = Columns::Zero();
            Block D = Block::Zero();
            for (int k = 0; k < tables.bodies[b].dofs; ++k) {
                double& unit = y[tables.bodies[b].first + k];
                unit = 1;
                tables.to_twist(state.maps.data(), y.data(), xi.data());
                unit = 0;
                const double* own = xi.data() + tables.bodies[b].first;
                for (int r = 0; r < tables.bodies[b].dofs; ++r) D(r, k) = own[r];
                double twist[6] = {};
                std::copy_n(own, tables.bodies[b].dofs, twist);
                twist::columns(state.X.data() + 12 * b, twist, c.col(k).data());
            }
            columns_.push_back(c);
            maps_.push_back(D);
        }
    }

    const std::vector<Columns>& columns() const { return columns_; }

    /// - dF/dX and - dF/dX' of the loads.
    void add_loads(Terms& springs, Terms& dampers) const
    {
        std::vector<double> V(state_.X.size());
        tables_.rates_of(state_.X.data(), state_.velocity.data(), V.data());
        for (const int l : tables_.loads_with_tangent) {
            const Load& load = tables_.model->loads()[l];
            LoadTangent tangent(load.bodies.size());
            load.tangent(tables_.arguments(l, at_, state_.X.data(), V.data(), state_.angles), tangent);
            for (std::size_t r = 0; r < 2; ++r)
                for (std::size_t s = 0; s < load.bodies.size(); ++s) {
                    const int i = load.bodies[r], j = load.bodies[s];
                    if (i == world || j == world) continue;
                    springs.push_back({l, i, j, reduced(tangent.X[r][s], -1, i, j)});
                    dampers.push_back({l, i, j, reduced(tangent.V[r][s], -1, i, j)});
                }
        }
    }

    /// sum lambda K of the joints' rows, joint by joint, and the same of rigidity: its multipliers are what
    /// is left of F - G^T lambda - X'' m, whose turning with the body is the geometric term.
    void add_constraints(Terms& terms) const
    {
        const int s = at_.side == Side::left ? 0 : 1;
        const std::vector<double>& lambda = state_.multipliers[s];
        std::vector<double> r = forces_less_inertia(s);
        for (int c = 0; c < tables_.n_rows(); ++c) {
            if (lambda[c] == 0) continue;
            const Tables::RowTable& row = tables_.rows[c];
            double gradient[Tables::gradient_size] = {};
            tables_.gradient(c, at_, state_.X.data(), gradient);
            for (int k = 0; k < row.n_sides; ++k) {
                const int i = row.bodies[k];
                for (const int a : row.columns[k])
                    for (int n = a; n < a + 3; ++n) r[12 * i + n] -= lambda[c] * gradient[12 * k + n];
                for (int m = 0; m < row.n_sides; ++m) {
                    const int j = row.bodies[m];
                    const auto K = constraint_hessian(*row.row, at_, Configurations(state_.X.data()), i, j);
                    terms.push_back({tables_.model->row_joint(c), i, j, reduced(K, lambda[c], i, j)});
                }
            }
        }
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (tables_.bodies[b].dofs == 3) continue;
            Block K = Block::Zero();   // symmetric where the moments balance
            twist::add_geometric(state_.X.data() + 12 * b, r.data() + 12 * b, K.data(), 6);
            terms.push_back({-1, b, b, -maps_[b].transpose() * K * maps_[b]});
        }
    }

    /// The mass itself: the identity unless an inertia is singular.
    void add_mass(Terms& terms) const
    {
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            Block M = Block::Identity();
            if (tables_.bodies[b].dofs == 6) {
                Eigen::Matrix3d inertia;
                tables_.spin_mass(b, state_.X.data(), state_.X.data(), inertia.data());
                M.bottomRightCorner<3, 3>() = inertia;
            }
            terms.push_back({-1, b, b, M});
        }
    }

private:
    Block reduced(const Matrix<12, 12>& K, double factor, int i, int j) const
    {
        const Eigen::Map<const Eigen::Matrix<double, 12, 12>> full(K.data());
        return factor * columns_[i].transpose() * full * columns_[j];
    }

    std::vector<double> forces_less_inertia(int side) const
    {
        std::vector<double> V(state_.X.size()), A(V.size()), r(V.size());
        tables_.rates_of(state_.X.data(), state_.velocity.data(), V.data());
        tables_.rates_of(state_.X.data(), state_.acceleration[side].data(), A.data());
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            if (body.dofs == 3) continue;
            double spin[6] = {}, centripetal[12];
            std::copy_n(state_.velocity.data() + body.first + 3, 3, spin + 3);
            twist::columns(V.data() + 12 * b, spin, centripetal);
            for (int i = 0; i < 12; ++i) A[12 * b + i] += centripetal[i];
        }
        tables_.times_mass(A.data(), -1.0, r.data());
        tables_.add_weight(1.0, r.data());
        tables_.add_loads(at_, state_.X.data(), V.data(), 1.0, r.data(), state_.angles);
        return r;
    }

    const Tables& tables_;
    const InstantState& state_;
    Instant at_;
    std::vector<Columns> columns_;
    std::vector<Block> maps_;
};

/// An eigenvalue, and the body and the source that have the largest part in it.
struct Mode {
    double value = 0;
    int body = -1, source = -1;
};

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Terms on the free motions: by a basis of these, or by what projects onto them.
class Spectrum {
public:
    Spectrum(const Tables& tables, InstantState& state, const Terms& mass) : tables_(tables), state_(state)
    {
        if (state.by_joints) return;
        z_.resize(tables.n_twists, tables.freedoms());
        std::vector<double> z(static_cast<std::size_t>(z_.size()));
        state.basis.q.null_space(z.data());
        for (int i = 0; i < z_.rows(); ++i)
            for (int j = 0; j < z_.cols(); ++j) z_(i, j) = z[static_cast<std::size_t>(i * z_.cols() + j)];
        mass_ = on_free_motions(mass);
    }

    /// Of the positive eigenvalues, ascending. `columns`: X of each body by its scaled twist.
    std::vector<Vibration> vibrations(const Terms& terms, const Terms& dampers,
                                      const std::vector<Columns>& columns) const
    {
        std::vector<Vibration> found;
        if (terms.empty() || z_.cols() == 0) return found;
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(on_free_motions(terms), mass_);
        if (solver.info() != Eigen::Success) return found;
        for (int i = 0; i < solver.eigenvalues().size(); ++i) {
            if (!(solver.eigenvalues()(i) > 0)) continue;
            Vibration one{std::sqrt(solver.eigenvalues()(i))};
            const VectorXd y = z_ * solver.eigenvectors().col(i);
            one.decay = y.dot(times(dampers, y));
            for (int b = 0; b < tables_.n_bodies(); ++b) {
                const VectorXd moved = columns[b].leftCols(tables_.bodies[b].dofs) * part(y, b);
                one.shift = std::max(one.shift, moved.head(3).norm());
                one.turn = std::max(one.turn, moved.tail(9).norm() / std::sqrt(2.0));
            }
            found.push_back(one);
        }
        return found;
    }

    /// The largest eigenvalue, if it is positive.
    Mode highest(const Terms& terms) const
    {
        Mode mode;
        if (terms.empty() || tables_.freedoms() == 0) return mode;
        const auto [value, y] = state_.by_joints ? by_lanczos(terms) : by_basis(terms);
        if (!(value > 0)) return mode;
        mode.value = value;
        double most = 0;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (part(y, b).squaredNorm() <= most) continue;
            most = part(y, b).squaredNorm();
            mode.body = b;
        }
        mode.source = most_active(terms, y);
        return mode;
    }

private:
    struct Pair {
        double value = 0;
        VectorXd y{};
    };

    Pair by_basis(const Terms& terms) const
    {
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(on_free_motions(terms), mass_);
        if (solver.info() != Eigen::Success) return {};
        return {solver.eigenvalues().tail(1)(0), z_ * solver.eigenvectors().rightCols(1)};
    }

    /// Lanczos' iteration on P K P, each vector orthogonal to all before it; the mass is the identity there.
    Pair by_lanczos(const Terms& terms) const
    {
        constexpr int most_vectors = 120;    // what is found then is a lower bound, and good to a few digits
        constexpr double tolerance = 1e-6;   // of the residual; the eigenvalue has its square
        const int most = std::min(most_vectors, tables_.freedoms());
        MatrixXd V(tables_.n_twists, most);
        VectorXd alpha(most), beta(most);
        VectorXd w(tables_.n_twists);
        std::minstd_rand random(1);
        for (double& x : w) x = static_cast<double>(random()) / static_cast<double>(random.max()) - 0.5;
        project(w);
        for (int k = 0;; ++k) {
            V.col(k) = w / w.norm();
            w = times(terms, V.col(k));
            project(w);
            alpha(k) = w.dot(V.col(k));
            for (int pass = 0; pass < 2; ++pass)
                w -= (V.leftCols(k + 1) * (V.leftCols(k + 1).transpose() * w)).eval();
            beta(k) = w.norm();
            const double size = alpha.head(k + 1).cwiseAbs().maxCoeff();
            const bool is_last = k + 1 == most || !(beta(k) > 1e-13 * size);
            if (!is_last && k % 10 != 9) continue;
            Eigen::SelfAdjointEigenSolver<MatrixXd> small;
            small.computeFromTridiagonal(alpha.head(k + 1), beta.head(k));
            if (small.info() != Eigen::Success) return {};
            const double left = beta(k) * std::abs(small.eigenvectors()(k, k)),
                         value = small.eigenvalues()(k);
            if (is_last || left <= tolerance * std::abs(value))
                return {value, V.leftCols(k + 1) * small.eigenvectors().col(k)};
        }
    }

    void project(VectorXd& y) const
    {
        std::vector<double> mu(state_.rows.size());
        state_.joints.project(y.data(), nullptr, mu.data());
    }

    /// The symmetric part of K y.
    VectorXd times(const Terms& terms, const VectorXd& y) const
    {
        VectorXd out = VectorXd::Zero(y.size());
        for (const Term& t : terms) {
            const auto &i = tables_.bodies[t.i], &j = tables_.bodies[t.j];
            const auto K = t.K.topLeftCorner(i.dofs, j.dofs);
            out.segment(i.first, i.dofs) += 0.5 * (K * y.segment(j.first, j.dofs));
            out.segment(j.first, j.dofs) += 0.5 * (K.transpose() * y.segment(i.first, i.dofs));
        }
        return out;
    }

    VectorXd part(const VectorXd& y, int body) const
    {
        return y.segment(tables_.bodies[body].first, tables_.bodies[body].dofs);
    }

    MatrixXd on_free_motions(const Terms& terms) const
    {
        MatrixXd K = MatrixXd::Zero(z_.rows(), z_.rows());
        for (const Term& t : terms) {
            const int m = tables_.bodies[t.i].dofs, n = tables_.bodies[t.j].dofs;
            K.block(tables_.bodies[t.i].first, tables_.bodies[t.j].first, m, n) += t.K.topLeftCorner(m, n);
        }
        const MatrixXd reduced = z_.transpose() * K * z_;
        return 0.5 * (reduced + reduced.transpose());
    }

    int most_active(const Terms& terms, const VectorXd& y) const
    {
        int most = -1;
        double largest = 0, work = 0;
        for (std::size_t k = 0; k < terms.size(); ++k) {   // terms of a source follow each other
            const Term& t = terms[k];
            if (k == 0 || t.source != terms[k - 1].source) work = 0;
            const int m = tables_.bodies[t.i].dofs, n = tables_.bodies[t.j].dofs;
            work += part(y, t.i).dot(t.K.topLeftCorner(m, n) * part(y, t.j));
            const bool is_last = k + 1 == terms.size() || terms[k + 1].source != t.source;
            if (!is_last || work <= largest) continue;
            largest = work;
            most = t.source;
        }
        return most;
    }

    const Tables& tables_;
    InstantState& state_;
    MatrixXd z_, mass_;
};

constexpr int many_freedoms = 60;   // from here on a basis of them costs more than it gives

/// A state, closed, with accelerations and multipliers on one side.
struct Prepared {
    Tables tables;
    mutable InstantState state;   // which projects in room of its own
    bool is_fit;                  // else close_start() has refused it

    /// `by_basis`: with a basis of what is free, however much that is.
    Prepared(const Model& model, const State& given, Side side, bool by_basis)
        : Prepared(model, close_start(model, given, StartPolicy::project), side, by_basis)
    {}

private:
    Prepared(const Model& model, const ClosedStart& closed, Side side, bool by_basis)
        : tables(model, closed.independent)
    {
        const bool is_sparse = !by_basis && tables.freedoms() > many_freedoms && JointFactor::serves(tables);
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
        is_fit = instant.prepare(state, tables.independent);
        if (is_fit) instant.accelerate(state, side);
    }
};

}   // namespace

std::string Frequency::where(const Model& model) const
{
    if (body < 0) return "";
    return "body '" + model.body_name(body) + "'" + (name.empty() ? ", which bears a preload" : ", " + name);
}

HighestFrequencies highest_frequencies(const Model& model, const State& state, Side side)
{
    const Prepared at(model, state, side, false);
    if (!at.is_fit) return {};
    const Forms forms(at.tables, at.state, side);
    Terms springs, dampers, constraints, mass;
    forms.add_loads(springs, dampers);
    forms.add_constraints(constraints);
    forms.add_mass(mass);
    const Spectrum spectrum(at.tables, at.state, mass);
    const auto load = [&](const Mode& mode, double rate) {
        return Frequency{rate, mode.body,
                         mode.source < 0 ? "" : "load '" + model.loads()[mode.source].name + "'"};
    };
    const Mode spring = spectrum.highest(springs), damper = spectrum.highest(dampers),
               bearing = spectrum.highest(constraints);
    const Frequency of_constraints{
        std::sqrt(bearing.value), bearing.body,
        bearing.source < 0 ? "" : "joint '" + model.joints()[bearing.source].name + "'"};
    return {load(spring, std::sqrt(spring.value)), load(damper, damper.value), of_constraints};
}

std::vector<Vibration> vibrations(const Model& model, const State& state, Side side)
{
    const Prepared at(model, state, side, true);
    if (!at.is_fit) return {};
    const Forms forms(at.tables, at.state, side);
    Terms restoring, dampers, mass;
    forms.add_loads(restoring, dampers);
    forms.add_constraints(restoring);
    forms.add_mass(mass);
    return Spectrum(at.tables, at.state, mass).vibrations(restoring, dampers, forms.columns());
}

}   // namespace livens
