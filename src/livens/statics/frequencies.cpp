// SPDX-License-Identifier: BSD-3-Clause
#include "livens/statics/frequencies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "livens/statics/small_motions.h"

namespace livens {

namespace {

/// An eigenvalue, and the body and the source that have the largest part in it.
struct Mode {
    double value = 0;
    int body = -1, source = -1;
};

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const Eigen::Matrix<double, 6, 6>> block(const Matrix<6, 6>& K)
{
    return Eigen::Map<const Eigen::Matrix<double, 6, 6>>(K.data());
}
Eigen::Map<const Eigen::Matrix<double, 6, 6>> block(const TwistTerm& term) { return block(term.K); }

/// Terms on the free motions: by a basis of these, or by what projects onto them.
class Spectrum {
public:
    Spectrum(const Tables& tables, InstantState& state, const TwistTerms& mass)
        : tables_(tables), state_(state)
    {
        if (state.by_joints) return;
        free_.emplace(tables, state);
        z_ = Eigen::Map<const MatrixXd>(free_->Z.data(), free_->n_twists, free_->n);
        mass_ = on_free_motions(mass);
    }

    /// Of the positive eigenvalues, ascending. `columns`: X of each body by its scaled twist.
    std::vector<Vibration> vibrations(const TwistTerms& terms, const TwistTerms& dampers,
                                      const std::vector<BodyColumns>& columns) const
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
                const VectorXd moved = Eigen::Map<const Eigen::Matrix<double, 12, 6>>(columns[b].data())
                                           .leftCols(tables_.bodies[b].dofs) *
                                       part(y, b);
                one.shift = std::max(one.shift, moved.head(3).norm());
                one.turn = std::max(one.turn, moved.tail(9).norm() / std::sqrt(2.0));
            }
            found.push_back(one);
        }
        return found;
    }

    /// The largest eigenvalue, if it is positive and no rounding.
    Mode highest(const TwistTerms& terms) const
    {
        Mode mode;
        if (terms.empty() || tables_.freedoms() == 0) return mode;
        const auto [value, y] = state_.by_joints ? by_lanczos(terms) : by_basis(terms);
        if (!(value > 0) || is_rounding(value, y, terms)) return mode;
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

    Pair by_basis(const TwistTerms& terms) const
    {
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(on_free_motions(terms), mass_);
        if (solver.info() != Eigen::Success) return {};
        for (int i = static_cast<int>(z_.cols()) - 1; i >= 0; --i) {
            const Pair found{solver.eigenvalues()(i), z_ * solver.eigenvectors().col(i)};
            if (!(found.value > 0) || !is_rounding(found.value, found.y, terms)) return found;
        }
        return {};
    }

    /// Whether y^T K y, y^T M y = 1, is no more than the rounding of what is summed to it.
    bool is_rounding(double value, const VectorXd& y, const TwistTerms& terms) const
    {
        constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();   // of sums of 144 products
        double size = 0;
        for (const TwistTerm& t : terms) {
            const VectorXd left = part(y, t.i).cwiseAbs(), right = part(y, t.j).cwiseAbs();
            size += left.dot(block(t.size).topLeftCorner(left.size(), right.size()) * right);
        }
        return value <= rounding * size;
    }

    /// Lanczos' iteration on P K P, each vector orthogonal to all before it; the mass is the identity there.
    Pair by_lanczos(const TwistTerms& terms) const
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
    VectorXd times(const TwistTerms& terms, const VectorXd& y) const
    {
        VectorXd out = VectorXd::Zero(y.size());
        for (const TwistTerm& t : terms) {
            const auto &i = tables_.bodies[t.i], &j = tables_.bodies[t.j];
            const auto K = block(t).topLeftCorner(i.dofs, j.dofs);
            out.segment(i.first, i.dofs) += 0.5 * (K * y.segment(j.first, j.dofs));
            out.segment(j.first, j.dofs) += 0.5 * (K.transpose() * y.segment(i.first, i.dofs));
        }
        return out;
    }

    VectorXd part(const VectorXd& y, int body) const
    {
        return y.segment(tables_.bodies[body].first, tables_.bodies[body].dofs);
    }

    MatrixXd on_free_motions(const TwistTerms& terms) const
    {
        const std::vector<double> K = free_->reduced(tables_, terms);
        const Eigen::Map<const MatrixXd> reduced(K.data(), free_->n, free_->n);
        return 0.5 * (reduced + reduced.transpose());
    }

    int most_active(const TwistTerms& terms, const VectorXd& y) const
    {
        int most = -1;
        double largest = 0, work = 0;
        for (std::size_t k = 0; k < terms.size(); ++k) {   // terms of a source follow each other
            const TwistTerm& t = terms[k];
            if (k == 0 || t.source != terms[k - 1].source) work = 0;
            const int m = tables_.bodies[t.i].dofs, n = tables_.bodies[t.j].dofs;
            work += part(y, t.i).dot(block(t).topLeftCorner(m, n) * part(y, t.j));
            const bool is_last = k + 1 == terms.size() || terms[k + 1].source != t.source;
            if (!is_last || work <= largest) continue;
            largest = work;
            most = t.source;
        }
        return most;
    }

    const Tables& tables_;
    InstantState& state_;
    std::optional<FreeMotions> free_;   // where the state has a basis
    MatrixXd z_, mass_;
};

}   // namespace

std::string Frequency::where(const Model& model) const
{
    if (body < 0) return "";
    return "body '" + model.body_name(body) + "'" + (name.empty() ? ", which bears a preload" : ", " + name);
}

HighestFrequencies highest_frequencies(const Model& model, const State& state, Side side)
{
    const PreparedState at(model, state, side, false);
    if (!at.is_fit) return {};
    const SmallMotions forms(at.tables, at.state, side);
    TwistTerms springs, dampers, constraints, mass;
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
    const PreparedState at(model, state, side, true);
    if (!at.is_fit) return {};
    const SmallMotions forms(at.tables, at.state, side);
    TwistTerms restoring, dampers, mass;
    forms.add_loads(restoring, dampers);
    forms.add_constraints(restoring);
    forms.add_mass(mass);
    return Spectrum(at.tables, at.state, mass).vibrations(restoring, dampers, forms.columns());
}

}   // namespace livens
