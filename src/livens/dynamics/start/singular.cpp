// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/start/singular.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Dense>

#include "livens/dynamics/rows/sparse_rows.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double nothing = 1e-6;     // of the terms of a sum
constexpr int most_directions = 8;   // in which branches are looked for

/// The rows and their second derivatives at one configuration, for scaled twists y.
class Curvatures {
public:
    Curvatures(const Model& model, const ClosedStart& closed)
        : tables_(model, closed.independent), at_{closed.start.t}, maps_(12 * closed.start.X.size())
    {
        for (const Matrix34& X : closed.start.X) X_.insert(X_.end(), std::begin(X.a), std::end(X.a));
        tables_.map_twists(X_.data(), maps_.data());
        const int n = tables_.n_rows();
        gradients_.assign(static_cast<std::size_t>(Tables::gradient_size * n), 0.0);
        scale_.resize(n);
        std::vector<double> row(static_cast<std::size_t>(tables_.n_twists));
        for (int r = 0; r < n; ++r) {
            tables_.gradient(r, at_, X_.data(), gradient(r));
            tables_.scaled_gradient(r, X_.data(), maps_.data(), gradient(r), row.data());
            const Eigen::Map<const VectorXd> g(row.data(), tables_.n_twists);
            scale_[r] = g.norm();
            for (Index i = 0; i < g.size(); ++i)
                if (g[i] != 0) entries_.push_back({r, static_cast<int>(i), g[i] / scale_[r]});
        }
    }

    const Tables& tables() const { return tables_; }
    /// Of the rows' gradients, scaled to norm 1.
    const std::vector<SparseRows::Entry>& entries() const { return entries_; }

    /// d2 Phi/dt2 less G X'' of all rows, over the norms of their gradients.
    VectorXd of(const VectorXd& y) const
    {
        const std::vector<double> V = rates(y);
        std::vector<double> centripetal(V.size(), 0.0);
        VectorXd xi(tables_.n_twists);
        tables_.to_twist(maps_.data(), y.data(), xi.data());
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            if (body.dofs == 3) continue;
            double spin[6] = {0, 0, 0, xi[body.first + 3], xi[body.first + 4], xi[body.first + 5]};
            twist::columns(V.data() + 12 * b, spin, centripetal.data() + 12 * b);
        }
        VectorXd bend(tables_.n_rows());
        for (int r = 0; r < tables_.n_rows(); ++r) {
            const auto& table = tables_.rows[r];
            double gamma = tables_.curvature(r, at_, X_.data(), V.data());
            for (int side = 0; side < table.n_sides; ++side)
                for (const int column : table.columns[side])
                    for (int i = 0; i < 3; ++i)
                        gamma += gradient(r)[12 * side + column + i] *
                                 centripetal[12 * table.bodies[side] + column + i];
            bend[r] = scale_[r] > 0 ? gamma / scale_[r] : 0;
        }
        return bend;
    }

    /// What bends of a motion are compared with: they are rounding where nothing turns.
    double least_size(const VectorXd& y) const
    {
        const std::vector<double> V = rates(y);
        double rate = 0;
        for (std::size_t i = 0; i < V.size(); ++i)
            rate = std::max(rate, std::abs(V[i]) / (i % 12 < 3 ? tables_.length : 1));
        return nothing * rate * y.norm();
    }

    /// X' of all bodies, 12 numbers each.
    std::vector<double> rates(const VectorXd& y) const
    {
        VectorXd xi(tables_.n_twists);
        tables_.to_twist(maps_.data(), y.data(), xi.data());
        std::vector<double> V(X_.size());
        tables_.rates_of(X_.data(), xi.data(), V.data());
        return V;
    }

    /// Scaled twists of given rates: the inverse of the map, body by body.
    VectorXd twists_of(const State& state) const
    {
        VectorXd y = VectorXd::Zero(tables_.n_twists);
        MatrixXd D(tables_.n_twists, tables_.n_twists);
        for (Index j = 0; j < D.cols(); ++j) {
            const VectorXd unit = VectorXd::Unit(D.cols(), j);
            tables_.to_twist(maps_.data(), unit.data(), D.col(j).data());
        }
        VectorXd xi = VectorXd::Zero(tables_.n_twists);
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            const Vector3 v = state.V[b].column(0);
            const Vector3 w = body.dofs == 6 ? angular_velocity(state.X[b], state.V[b]) : Vector3{};
            for (int i = 0; i < body.dofs; ++i) xi[body.first + i] = i < 3 ? v[i] : w[i - 3];
        }
        return D.partialPivLu().solve(xi);
    }

private:
    double* gradient(int r) { return gradients_.data() + Tables::gradient_size * r; }
    const double* gradient(int r) const { return gradients_.data() + Tables::gradient_size * r; }

    Tables tables_;
    Instant at_;
    std::vector<double> X_, maps_, gradients_;
    std::vector<SparseRows::Entry> entries_;
    VectorXd scale_;
};

/// Numbers between -1 and 1, the same in each run.
class Noise {
public:
    double next()
    {
        state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
        return 2 * static_cast<double>(state_ >> 11) / 9007199254740992.0 - 1;
    }
    VectorXd vector(Index n)
    {
        VectorXd x(n);
        for (double& entry : x) entry = next();
        return x;
    }

private:
    std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// Whether redundant combinations ask nothing of any motion, judged by some motions at random: a quadratic
/// form that is zero there is zero. Cost and room grow with the bodies. False also where that cannot be told
/// so.
bool asks_nothing(const Curvatures& curvatures, const ClosedStart& closed)
{
    const int n_columns = curvatures.tables().n_twists;
    const std::vector<int>&independent = closed.independent, &redundant = closed.redundant;
    std::vector<SparseRows::Entry> held;
    MatrixXd rest = MatrixXd::Zero(n_columns, static_cast<Index>(redundant.size()));
    for (const auto& entry : curvatures.entries()) {
        const auto at = std::ranges::lower_bound(independent, entry.row);
        if (at != independent.end() && *at == entry.row)
            held.push_back({static_cast<int>(at - independent.begin()), entry.column, entry.value});
        else
            rest(entry.column, std::ranges::lower_bound(redundant, entry.row) - redundant.begin()) =
                entry.value;
    }
    const SparseRows rows(static_cast<int>(independent.size()), n_columns, held);
    if (!(rows.smallest_pivot() > SparseRows::well_held)) return false;
    const std::vector<double> zero(independent.size(), 0.0);
    const auto project = [&](VectorXd& y) {
        return rows.project({y.data(), static_cast<std::size_t>(y.size())}, zero);
    };
    std::vector<std::pair<VectorXd, double>> bends;   // of motions, and their size
    Noise noise;
    for (int motion = 0; motion < 3; ++motion) {
        VectorXd y = noise.vector(n_columns);
        project(y);
        const VectorXd bend = curvatures.of(y);
        bends.emplace_back(bend, std::max(bend.cwiseAbs().maxCoeff(), 1e3 * curvatures.least_size(y)));
    }
    for (std::size_t k = 0; k < redundant.size(); ++k) {
        VectorXd g = rest.col(static_cast<Index>(k));
        const std::vector<double> of_others = project(g);
        for (const auto& [bend, size] : bends) {
            double sum = bend[redundant[k]];
            for (std::size_t i = 0; i < independent.size(); ++i) sum -= of_others[i] * bend[independent[i]];
            if (!(std::abs(sum) <= 1e-3 * nothing * size)) return false;
        }
    }
    return true;
}

/// What redundant combinations ask of the free motions.
class SecondOrder {
public:
    explicit SecondOrder(const Curvatures& curvatures) : curvatures_(curvatures)
    {
        const Tables& tables = curvatures.tables();
        MatrixXd G = MatrixXd::Zero(tables.n_twists, tables.n_rows());
        for (const auto& entry : curvatures.entries()) G(entry.column, entry.row) = entry.value;
        free_ = complement(G, tables.rank);
        redundant_ = complement(G.transpose(), tables.rank);
    }

    const MatrixXd& free() const { return free_; }
    Index n_redundant() const { return redundant_.cols(); }
    int strongest_row(Index combination) const
    {
        Index row = 0;
        redundant_.col(combination).cwiseAbs().maxCoeff(&row);
        return static_cast<int>(row);
    }
    /// mu . d2 Phi/dt2 less G X'' of the redundant combinations; `size` is raised to the terms of the sums.
    VectorXd of(const VectorXd& y, double& size) const
    {
        const VectorXd bend = curvatures_.of(y);
        size = std::max({size, bend.cwiseAbs().maxCoeff(), curvatures_.least_size(y)});
        return redundant_.transpose() * bend;
    }

private:
    /// What is perpendicular to the columns of a matrix of known rank.
    static MatrixXd complement(const MatrixXd& A, Index rank)
    {
        const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
        MatrixXd Q = MatrixXd::Identity(A.rows(), A.rows()).rightCols(A.rows() - rank);
        Q.applyOnTheLeft(qr.householderQ());
        return Q;
    }

    const Curvatures& curvatures_;
    MatrixXd free_, redundant_;   // motions, and combinations of rows that are zero on all motions
};

/// Rank of a matrix whose entries are known to `level`, and the columns of an orthonormal basis of its rows.
MatrixXd row_space(const MatrixXd& A, double level)
{
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
    const VectorXd pivots = qr.matrixQR().diagonal().cwiseAbs();
    const Index rank = (pivots.array() > level).count();
    MatrixXd Q = MatrixXd::Identity(A.cols(), rank);
    if (rank == 0) return Q;   // which has no memory: Eigen would step into it
    Q.applyOnTheLeft(qr.householderQ());
    return Q;
}

/// Quadratic forms Q_k on the free motions, of which the conditions consist; `row` takes part in the largest.
std::vector<MatrixXd> forms_of(const SecondOrder& second, double& size, int& row)
{
    const MatrixXd& Z = second.free();
    const Index f = Z.cols(), n = second.n_redundant();
    std::vector<VectorXd> squares;
    const VectorXd rest = second.of(VectorXd::Zero(Z.rows()), size);   // of drives
    size = 0;
    for (Index i = 0; i < f; ++i) squares.push_back(second.of(Z.col(i), size));
    MatrixXd packed(n, f * (f + 1) / 2);
    for (Index i = 0, at = 0; i < f; ++i)
        for (Index j = i; j < f; ++j, ++at)
            packed.col(at) = 0.5 * (second.of(Z.col(i) + Z.col(j), size) - squares[i] - squares[j] + rest);
    Index largest = 0;
    packed.rowwise().norm().maxCoeff(&largest);
    row = second.strongest_row(largest);
    // the span of the forms, with the metric of symmetric matrices left aside
    const MatrixXd basis = row_space(packed, nothing * size);
    std::vector<MatrixXd> forms;
    for (Index k = 0; k < basis.cols(); ++k) {
        MatrixXd Q(f, f);
        for (Index i = 0, at = 0; i < f; ++i)
            for (Index j = i; j < f; ++j, ++at) Q(i, j) = Q(j, i) = basis(at, k);
        forms.push_back(Q);
    }
    return forms;
}

/// Whether one of the forms is definite, so that no motion fulfils it.
bool is_locked(const std::vector<MatrixXd>& forms)
{
    return std::ranges::any_of(forms, [](const MatrixXd& Q) {
        const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(Q).eigenvalues();
        return eigenvalues[0] > nothing || eigenvalues[Q.rows() - 1] < -nothing;
    });
}

/// A root of the forms on the unit sphere near a start, by Newton's iteration; empty if it finds none where
/// the conditions are independent.
VectorXd root_near(const std::vector<MatrixXd>& forms, VectorXd x)
{
    const Index m = static_cast<Index>(forms.size()), f = x.size();
    MatrixXd J(m + 1, f);
    VectorXd r(m + 1);
    for (int iteration = 0; iteration < 50; ++iteration) {
        for (Index k = 0; k < m; ++k) {
            J.row(k) = 2 * (forms[k] * x).transpose();
            r[k] = x.dot(forms[k] * x);
        }
        J.row(m) = x.transpose();
        r[m] = 0;
        const Eigen::ColPivHouseholderQR<MatrixXd> qr(J);
        if (std::abs(qr.matrixQR()(f - 1, f - 1)) < nothing) return {};
        const VectorXd dx = qr.solve(-r);
        x = (x + dx).normalized();
        if (dx.norm() < 1e-13) return x;
    }
    return {};
}

/// All of them, up to their signs.
std::vector<VectorXd> roots_of(const std::vector<MatrixXd>& forms, Index f)
{
    std::vector<VectorXd> roots;
    Noise noise;
    const int starts = 64 << f;   // of 2^(f - 1) roots at most
    for (int i = 0; i < starts; ++i) {
        const VectorXd root = root_near(forms, noise.vector(f).normalized());
        if (root.size() == 0) continue;
        const bool is_known = std::ranges::any_of(
            roots, [&](const VectorXd& other) { return 1 - std::abs(root.dot(other)) < 1e-9; });
        if (!is_known) roots.push_back(root);
    }
    return roots;
}

}   // namespace

Mobility mobility(const Model& model, const ClosedStart& closed)
{
    Mobility result;
    result.first_order = closed.degrees_of_freedom;
    if (closed.redundant.empty() || closed.degrees_of_freedom == 0) return result;
    const Curvatures curvatures(model, closed);
    if (asks_nothing(curvatures, closed)) return result;
    const SecondOrder second(curvatures);
    double size = 0;
    const std::vector<MatrixXd> forms = forms_of(second, size, result.row);
    const MatrixXd& Z = second.free();
    result.conditions = static_cast<int>(forms.size());
    if (!result.is_singular()) return result;
    result.is_locked = is_locked(forms);

    const VectorXd y = curvatures.twists_of(closed.start);
    double speed_size = 0;
    const VectorXd rest = second.of(y, speed_size);
    result.are_possible = rest.cwiseAbs().maxCoeff() <= nothing * speed_size || speed_size == 0;
    MatrixXd J(second.n_redundant(), Z.cols());
    double unused = 0;
    for (Index j = 0; j < Z.cols(); ++j)
        J.col(j) = 0.5 * (second.of(y + Z.col(j), unused) - second.of(y - Z.col(j), unused));
    const Index rank = y.norm() > 0 ? row_space(J, nothing * size * y.norm()).cols() : 0;
    result.choose_branch = result.are_possible && rank == result.conditions;

    if (result.conditions != result.first_order - 1 || result.first_order > most_directions) return result;
    for (const VectorXd& root : roots_of(forms, Z.cols())) {
        const std::vector<double> V = curvatures.rates(Z * root);
        const double fastest =
            std::abs(*std::ranges::max_element(V, {}, [](double v) { return std::abs(v); }));
        std::vector<Matrix34>& branch = result.branches.emplace_back(closed.start.X.size());
        for (std::size_t i = 0; i < V.size(); ++i) branch[i / 12].a[i % 12] = V[i] / fastest;
    }
    return result;
}

}   // namespace livens
