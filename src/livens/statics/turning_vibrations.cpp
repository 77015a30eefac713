// SPDX-License-Identifier: BSD-3-Clause
#include "livens/statics/turning_vibrations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "livens/statics/small_motions.h"

namespace livens {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_freedoms = 600;
constexpr double small_turn = 1e-3;   // lengths of the model or rad, over which a difference is taken
/// Of its stiffness: forms below are softer than a form, others as stiff.
constexpr double much_softer = 0.5;

/// The springs of a model at a state, on what its joints leave free there.
class Springs {
public:
    explicit Springs(const PreparedState& at)
        : tables_(at.tables), state_(at.state), forms_(at.tables, at.state, Side::right),
          free_(at.tables, at.state)
    {
        TwistTerms dampers, mass;
        forms_.add_loads(terms_, dampers);
        forms_.add_mass(mass);
        z_ = Eigen::Map<const MatrixXd>(free_.Z.data(), free_.n_twists, free_.n);
        if (terms_.empty() || free_.n == 0) return;
        mass_ = symmetric(mass);
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(symmetric(terms_), mass_);
        if (solver.info() != Eigen::Success) return;
        squares_ = solver.eigenvalues();
        forms_of_all_ = solver.eigenvectors();
    }

    bool is_empty() const { return squares_.size() == 0; }
    /// Of the rates of all forms, ascending; negative where loads drive apart.
    const VectorXd& squares() const { return squares_; }
    VectorXd form(Eigen::Index i) const { return forms_of_all_.col(i); }
    /// What the first `n` forms have of a motion.
    VectorXd slow_part(const VectorXd& q, Eigen::Index n) const
    {
        return forms_of_all_.leftCols(n) * (forms_of_all_.leftCols(n).transpose() * (mass_ * q));
    }
    double size(const VectorXd& q) const { return std::sqrt(q.dot(mass_ * q)); }

    /// Of the state, as a form.
    VectorXd velocity() const
    {
        VectorXd V(12 * tables_.n_bodies());
        tables_.rates_of(state_.X.data(), state_.velocity.data(), V.data());
        return form_of(V);
    }

    /// What a form moves, 12 numbers a body.
    VectorXd moved(const VectorXd& form) const
    {
        const VectorXd y = z_ * form;
        VectorXd dX = VectorXd::Zero(12 * tables_.n_bodies());
        for (int b = 0; b < tables_.n_bodies(); ++b) dX.segment<12>(12 * b) = columns(b) * part(y, b);
        return dX;
    }

    /// The form that moves bodies so, as near as rigid bodies and joints can here: its turn is the least.
    VectorXd form_of(const VectorXd& dX) const
    {
        VectorXd y(free_.n_twists), mdX(dX.size());
        tables_.times_mass(dX.data(), 1.0, mdX.data());
        for (int b = 0; b < tables_.n_bodies(); ++b)
            y.segment(tables_.bodies[b].first, tables_.bodies[b].dofs) =
                columns(b).transpose() * mdX.segment<12>(12 * b);
        return z_.transpose() * y;
    }

    /// The body that moves most, and the load that does most of the work.
    Frequency name(double rate, const VectorXd& form) const
    {
        const VectorXd y = z_ * form;
        Frequency found{rate};
        double most = 0;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (part(y, b).squaredNorm() <= most) continue;
            most = part(y, b).squaredNorm();
            found.body = b;
        }
        std::vector<double> work(tables_.model->loads().size(), 0.0);
        for (const TwistTerm& t : terms_) {
            const Eigen::Map<const Eigen::Matrix<double, 6, 6>> K(t.K.data());
            const int m = tables_.bodies[t.i].dofs, n = tables_.bodies[t.j].dofs;
            work[t.source] += part(y, t.i).dot(K.topLeftCorner(m, n) * part(y, t.j));
        }
        const auto hardest = std::max_element(work.begin(), work.end());
        found.name = "load '" + tables_.model->loads()[hardest - work.begin()].name + "'";
        return found;
    }

private:
    MatrixXd symmetric(const TwistTerms& terms) const
    {
        const std::vector<double> K = free_.reduced(tables_, terms);
        const Eigen::Map<const MatrixXd> reduced(K.data(), free_.n, free_.n);
        return 0.5 * (reduced + reduced.transpose());
    }

    Eigen::Map<const Eigen::Matrix<double, 12, Eigen::Dynamic>> columns(int b) const
    {
        return {forms_.columns()[b].data(), 12, tables_.bodies[b].dofs};
    }

    VectorXd part(const VectorXd& y, int b) const
    {
        return y.segment(tables_.bodies[b].first, tables_.bodies[b].dofs);
    }

    const Tables& tables_;
    const InstantState& state_;
    SmallMotions forms_;
    FreeMotions free_;
    TwistTerms terms_;
    MatrixXd z_, mass_, forms_of_all_;
    VectorXd squares_;
};

/// A little further on with these velocities, and by which time; 0: nothing moves.
std::pair<State, double> moved(const Model& model, State state, const VectorXd& V)
{
    double rate = 0;
    for (int b = 0; b < model.n_bodies(); ++b)
        rate =
            std::max({rate, V.segment<3>(12 * b).norm() / model.length(), V.segment<9>(12 * b + 3).norm()});
    if (rate == 0) return {std::move(state), 0};
    const double time = small_turn / rate;
    for (int b = 0; b < model.n_bodies(); ++b)
        for (int i = 0; i < 12; ++i) state.X[b].a[i] += time * V(12 * b + i);
    return {std::move(state), time};
}

}   // namespace

std::vector<TurningVibration> turning_vibrations(const Model& model, const State& state, double slowest)
{
    if (6 * model.n_bodies() - model.n_rows() > most_freedoms) return {};
    const PreparedState now(model, state, Side::right, true);
    if (!now.is_fit) return {};
    const Springs springs(now);
    if (springs.is_empty()) return {};
    const VectorXd& squares = springs.squares();
    const auto n_slow = std::lower_bound(squares.begin(), squares.end(), slowest * slowest) - squares.begin();
    const VectorXd V = springs.moved(springs.slow_part(springs.velocity(), n_slow));
    const auto [then, time] = moved(model, state, V);
    const PreparedState soon(model, then, Side::right, true);
    if (n_slow == squares.size() || !(time > 0) || !soon.is_fit) return {};
    const Springs later(soon);
    std::vector<TurningVibration> found;
    for (auto i = n_slow; i < squares.size(); ++i) {
        const VectorXd form = springs.form(i), q = later.form_of(springs.moved(form));
        const auto softer =
            std::lower_bound(later.squares().begin(), later.squares().end(), much_softer * squares(i)) -
            later.squares().begin();
        const VectorXd left = later.slow_part(q, softer);
        const double turn = std::atan2(later.size(left), later.size(q - left));
        found.push_back({springs.name(std::sqrt(squares(i)), form), turn / time});
    }
    return found;
}

}   // namespace livens
