#include "livens/multibody/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Dense>

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double rank_threshold = 1e-9;
constexpr double inertia_threshold = 1e-12;

int n_twists(const Body& body) { return body.is_point ? 3 : 6; }

struct Gradient {
    Matrix34 i{}, j{};
};

const Matrix34& of(std::span<const Matrix34> X, int body)
{
    return body == world ? world_configuration : X[body];
}

Gradient gradient(const ConstraintRow& row, std::span<const Matrix34> X)
{
    Gradient g;
    constraint_gradient(row, of(X, row.body_i), of(X, row.body_j), g.i, g.j);
    return g;
}

/// N^T F = [F_0 ; sum_i d_i x F_i].
Matrix<6, 1> twist_force(const Matrix34& X, const Matrix34& F)
{
    Vector3 moment{};
    for (int i = 1; i < 4; ++i) moment += cross(X.column(i), F.column(i));
    return {F(0, 0), F(1, 0), F(2, 0), moment[0], moment[1], moment[2]};
}

MatrixXd twist_jacobian(const Model& model, const TwistLayout& layout, std::span<const Matrix34> X,
                        std::span<const int> rows)
{
    MatrixXd G = MatrixXd::Zero(static_cast<Index>(rows.size()), layout.size);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const ConstraintRow& row = model.row(rows[k]);
        const Gradient g = gradient(row, X);
        for (const auto& [body, part] : {std::pair{row.body_i, &g.i}, std::pair{row.body_j, &g.j}}) {
            if (body == world) continue;
            const Matrix<6, 1> f = twist_force(X[body], *part);
            for (int c = 0; c < n_twists(model.bodies()[body]); ++c) {
                G(static_cast<Index>(k), layout.first[body] + c) += f[c];
            }
        }
    }
    return G;
}

/// Mr = N^T (m (x) I3) N of one body, from its six motions dX.
Matrix<6, 6> twist_mass(const Matrix4& m, const Matrix34& X)
{
    Matrix<6, 6> mass{};
    for (int c = 0; c < 6; ++c) {
        Matrix34 dX{};
        if (c < 3) {
            dX(c, 0) = 1;
        } else {
            Vector3 w{};
            w[c - 3] = 1;
            for (int i = 1; i < 4; ++i) dX.set_column(i, cross(w, X.column(i)));
        }
        mass.set_column(c, twist_force(X, dX * m));
    }
    return mass;
}

/// Scales S of the twists, dx = S dy: the mass matrix in y has a diagonal of about one.
VectorXd twist_scales(const Model& model, const TwistLayout& layout)
{
    const double length = model.length();
    VectorXd s(layout.size);
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Body& body = model.bodies()[b];
        const double mass = body.mass(0, 0);
        const double radius = std::sqrt((body.mass(1, 1) + body.mass(2, 2) + body.mass(3, 3)) / mass);
        for (int c = 0; c < n_twists(body); ++c) {
            s[layout.first[b] + c] = 1 / (std::sqrt(mass) * (c < 3 ? 1 : std::max(radius, 1e-4 * length)));
        }
    }
    return s;
}

MatrixXd scaled_mass(const Model& model, const TwistLayout& layout, std::span<const Matrix34> X,
                     const VectorXd& s)
{
    MatrixXd M = MatrixXd::Zero(layout.size, layout.size);
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix<6, 6> m = twist_mass(model.bodies()[b].mass, X[b]);
        const int n = n_twists(model.bodies()[b]), at = layout.first[b];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) M(at + i, at + j) = s[at + i] * m(i, j) * s[at + j];
    }
    return M;
}

/// Ghat with both scales, and the rows' norms before (rows without any effect keep norm 1).
struct ScaledJacobian {
    MatrixXd G;
    VectorXd norms;
};

ScaledJacobian scaled_jacobian(const Model& model, const TwistLayout& layout, std::span<const Matrix34> X,
                               std::span<const int> rows, const VectorXd& s)
{
    ScaledJacobian j;
    j.G = twist_jacobian(model, layout, X, rows) * s.asDiagonal();
    j.norms = j.G.rowwise().norm();
    for (Index k = 0; k < j.norms.size(); ++k) {
        if (j.norms[k] == 0) j.norms[k] = 1;
        j.G.row(k) /= j.norms[k];
    }
    return j;
}

/// The saddle system of a projection in the mass metric. Plain elimination on purpose: orthogonal
/// transformations would mix the in-plane and out-of-plane parts of a planar model and leave rounding where
/// zeros belong.
Eigen::PartialPivLU<MatrixXd> saddle(const MatrixXd& M, const MatrixXd& G, double delta)
{
    const Index n = M.rows(), k = G.rows();
    MatrixXd A = MatrixXd::Zero(n + k, n + k);
    A.topLeftCorner(n, n) = M;
    A.topLeftCorner(n, n).diagonal().array() +=
        1e-14;   // a spin without inertia and without joint stays where it is
    A.topRightCorner(n, k) = G.transpose();
    A.bottomLeftCorner(k, n) = G;
    A.bottomRightCorner(k, k).diagonal().array() -= delta;
    return Eigen::PartialPivLU<MatrixXd>(A);
}

Vector3 turned(const Vector3& d, const Vector3& w)
{
    const double angle = norm(w);
    if (angle == 0) return d;
    const double half = std::sin(0.5 * angle) / angle;
    const Vector3 wd = cross(w, d);
    return d + (std::sin(angle) / angle) * wd + (2 * half * half) * cross(w, wd);
}

Vector3 part(const VectorXd& x, int at) { return {x[at], x[at + 1], x[at + 2]}; }

/// X moved by the twists dx, shortened so that no body turns by more than half a radian.
void move(const Model& model, const TwistLayout& layout, VectorXd dx, std::vector<Matrix34>& X)
{
    double largest = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (!model.bodies()[b].is_point) largest = std::max(largest, norm(part(dx, layout.first[b] + 3)));
    }
    if (largest > 0.5) dx *= 0.5 / largest;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const int at = layout.first[b];
        X[b].set_column(0, X[b].column(0) + part(dx, at));
        if (model.bodies()[b].is_point) continue;
        for (int i = 1; i < 4; ++i) X[b].set_column(i, turned(X[b].column(i), part(dx, at + 3)));
    }
}

/// g = N^T F, stacked.
VectorXd twist_forces(const Model& model, const TwistLayout& layout, std::span<const Matrix34> X,
                      std::span<const Matrix34> F)
{
    VectorXd g(layout.size);
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix<6, 1> f = twist_force(X[b], F[b]);
        for (int c = 0; c < n_twists(model.bodies()[b]); ++c) g[layout.first[b] + c] = f[c];
    }
    return g;
}

VectorXd pick(const std::vector<double>& values, std::span<const int> rows)
{
    VectorXd v(static_cast<Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) v[static_cast<Index>(k)] = values[rows[k]];
    return v;
}

/// One closing of the given rows with one delta.
class Closer {
public:
    Closer(const Model& model, std::span<const Matrix34> X_given, std::span<const int> rows)
        : model_(model), layout_(model), scales_(twist_scales(model, layout_)), given_(X_given), rows_(rows)
    {}

    Closing run(bool nearest, double delta) const
    {
        Closing best{false, {given_.begin(), given_.end()}};
        std::vector<Matrix34> X = best.X;
        double best_level = level(X);
        int since_best = 0;
        for (int iteration = 0; iteration < 100 && since_best < 6 && (best_level > 1 || nearest);
             ++iteration) {
            const double step = iterate(X, nearest, delta);
            if (!std::isfinite(step)) break;
            if (nearest && (step < 1e-9 || iteration >= 30)) nearest = false;
            const double l = level(X);
            since_best = nearest || l < best_level ? 0 : since_best + 1;
            if (nearest || l < best_level) {
                best_level = l;
                best.X = X;
            }
        }
        best.closed = best_level <= 1 || violation(best.X) < 1e-12;
        return best;
    }

private:
    /// Largest |Phi| in units of its rounding level.
    double level(std::span<const Matrix34> X) const
    {
        const VectorXd phi = pick(joint_values(model_, X), rows_),
                       rounding = pick(joint_rounding(model_, X), rows_);
        return phi.size() ? (phi.array().abs() / rounding.array()).maxCoeff() : 0;
    }

    double violation(std::span<const Matrix34> X) const
    {
        const std::vector<double> phi = joint_values(model_, X);
        double worst = 0;
        for (int r : rows_) worst = std::max(worst, std::abs(phi[r]) / model_.row(r).scale);
        return worst;
    }

    /// One step; returns its size in scaled twists relative to the model (1: a length, a radian).
    double iterate(std::vector<Matrix34>& X, bool nearest, double delta) const
    {
        const ScaledJacobian j = scaled_jacobian(model_, layout_, X, rows_, scales_);
        VectorXd rhs = VectorXd::Zero(layout_.size + j.G.rows());
        if (nearest) {
            std::vector<Matrix34> pull(X.size());
            for (std::size_t b = 0; b < X.size(); ++b) pull[b] = (given_[b] - X[b]) * model_.bodies()[b].mass;
            rhs.head(layout_.size) = scales_.cwiseProduct(twist_forces(model_, layout_, X, pull));
        }
        rhs.tail(j.G.rows()) = -pick(joint_values(model_, X), rows_).cwiseQuotient(j.norms);
        const VectorXd y = saddle(scaled_mass(model_, layout_, X, scales_), j.G, delta).solve(rhs);
        const VectorXd dx = scales_.cwiseProduct(y.head(layout_.size));
        if (!dx.allFinite()) return std::numeric_limits<double>::infinity();
        move(model_, layout_, dx, X);
        double size = 0;
        const double length = model_.length();
        for (int b = 0; b < model_.n_bodies(); ++b) {
            size = std::max(size, norm(part(dx, layout_.first[b])) / length);
            if (!model_.bodies()[b].is_point) size = std::max(size, norm(part(dx, layout_.first[b] + 3)));
        }
        return size;
    }

    const Model& model_;
    TwistLayout layout_;
    VectorXd scales_;
    std::span<const Matrix34> given_;
    std::span<const int> rows_;
};

/// Smallest eigenvalue of the scaled mass, body by body: a bound from below for any null space, and cheap.
double least_inertia(const Model& model, const TwistLayout& layout, const MatrixXd& M)
{
    double least = 1;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const int n = n_twists(model.bodies()[b]), at = layout.first[b];
        const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(M.block(at, at, n, n), Eigen::EigenvaluesOnly);
        least = std::min(least, eigen.eigenvalues()[0]);
    }
    return least;
}

/// Z^T Mr Z has its smallest eigenvalue below 1e-12: the motion that belongs to it.
std::vector<double> weightless_motion(const MatrixXd& M, const MatrixXd& Z, const VectorXd& s)
{
    if (Z.cols() == 0) return {};
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(Z.transpose() * M * Z);
    if (eigen.eigenvalues()[0] > inertia_threshold) return {};
    const VectorXd motion = s.cwiseProduct(Z * eigen.eigenvectors().col(0));
    return {motion.data(), motion.data() + motion.size()};
}

}   // namespace

TwistLayout::TwistLayout(const Model& model)
{
    for (const Body& body : model.bodies()) {
        first.push_back(size);
        size += n_twists(body);
    }
}

RowRank row_rank(const Model& model, std::span<const Matrix34> X)
{
    const TwistLayout layout(model);
    const VectorXd s = twist_scales(model, layout);
    std::vector<int> all(model.n_rows());
    std::iota(all.begin(), all.end(), 0);
    MatrixXd G = scaled_jacobian(model, layout, X, all, s).G;
    // Among equal rows the one that comes first in the model is kept.
    for (Index r = 0; r < G.rows(); ++r) {
        G.row(r) *= 1 - 1e-3 * static_cast<double>(r) / static_cast<double>(G.rows());
    }
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    Index k = 0;
    RowRank rank;
    if (G.size() > 0) {
        qr.compute(G.transpose());
        const VectorXd pivots = qr.matrixQR().diagonal().cwiseAbs();
        while (k < pivots.size() && pivots[k] > rank_threshold * pivots[0]) ++k;
        if (k > 0) rank.smallest_pivot = pivots[k - 1] / pivots[0];
        for (Index i = 0; i < G.rows(); ++i) {
            const int row = static_cast<int>(qr.colsPermutation().indices()[i]);
            (i < k ? rank.independent : rank.dependent).push_back(row);
        }
        std::sort(rank.independent.begin(), rank.independent.end());
        std::sort(rank.dependent.begin(), rank.dependent.end());
    }
    const MatrixXd M = scaled_mass(model, layout, X, s);
    if (least_inertia(model, layout, M) > inertia_threshold) return rank;
    MatrixXd Z = MatrixXd::Identity(layout.size, layout.size).rightCols(layout.size - k);
    if (k > 0) Z.applyOnTheLeft(qr.householderQ());
    rank.weightless_motion = weightless_motion(M, Z, s);
    return rank;
}

std::vector<double> joint_values(const Model& model, std::span<const Matrix34> X)
{
    std::vector<double> phi(model.n_rows());
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        phi[r] = constraint_value(row, of(X, row.body_i), of(X, row.body_j));
    }
    return phi;
}

std::vector<double> joint_rates(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    std::vector<double> rates(model.n_rows(), 0.0);
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        const Gradient g = gradient(row, X);
        if (row.body_i != world) rates[r] += dot(g.i, V[row.body_i]);
        if (row.body_j != world) rates[r] += dot(g.j, V[row.body_j]);
    }
    return rates;
}

namespace {

template <int R, int C>
Matrix<R, C> absolute(Matrix<R, C> m)
{
    for (double& x : m.a) x = std::abs(x);
    return m;
}

}   // namespace

std::vector<double> joint_rounding(const Model& model, std::span<const Matrix34> X)
{
    std::vector<double> level(model.n_rows());
    for (int r = 0; r < model.n_rows(); ++r) {
        ConstraintRow row = model.row(r);
        for (Matrix4* c : {&row.c_ii, &row.c_ij, &row.c_jj}) *c = absolute(*c);
        for (Matrix34* b : {&row.b_i, &row.b_j}) *b = absolute(*b);
        row.c = std::abs(row.c);
        const double terms = constraint_value(row, absolute(of(X, row.body_i)), absolute(of(X, row.body_j)));
        level[r] = 4 * eps * std::max(terms, row.scale);
    }
    return level;
}

std::vector<double> joint_rate_bounds(const Model& model, std::span<const Matrix34> X, double speed)
{
    const double rate = speed / model.length();
    std::vector<double> bounds(model.n_rows(), 0.0);
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        const Gradient g = gradient(row, X);
        for (const auto& [body, part_of_row] : {std::pair{row.body_i, &g.i}, std::pair{row.body_j, &g.j}}) {
            if (body == world) continue;
            bounds[r] += norm(part_of_row->column(0)) * speed;
            for (int i = 1; i < 4; ++i) bounds[r] += norm(part_of_row->column(i)) * rate;
        }
    }
    return bounds;
}

Closing close_rows(const Model& model, std::span<const Matrix34> X_given, std::span<const int> rows,
                   bool nearest)
{
    const Closer closer(model, X_given, rows);
    Closing closing;
    // A start far away may spoil the pull towards the nearest configuration, and rows that are all but
    // redundant need the smaller delta; each attempt starts afresh.
    for (const double delta : {1e-8, 1e-14}) {
        if (nearest) {
            closing = closer.run(true, delta);
            if (closing.closed) return closing;
        }
        closing = closer.run(false, delta);
        if (closing.closed) return closing;
    }
    return closer.run(false, 1e-8);
}

std::vector<Matrix34> nearest_rates(const Model& model, std::span<const Matrix34> X,
                                    std::span<const Matrix34> V, std::span<const int> rows)
{
    const TwistLayout layout(model);
    const VectorXd s = twist_scales(model, layout);
    const ScaledJacobian j = scaled_jacobian(model, layout, X, rows, s);
    const auto lu = saddle(scaled_mass(model, layout, X, s), j.G, 0);

    // The first pass projects, the others take rounding out of dPhi/dt and of the part that does not move any
    // more.
    std::vector<Matrix34> rates(X.size(), Matrix34{}), missing(X.size());
    VectorXd y = VectorXd::Zero(layout.size), lambda = VectorXd::Zero(j.G.rows());
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t b = 0; b < X.size(); ++b) missing[b] = (V[b] - rates[b]) * model.bodies()[b].mass;
        VectorXd rhs(layout.size + j.G.rows());
        rhs.head(layout.size) =
            s.cwiseProduct(twist_forces(model, layout, X, missing)) - j.G.transpose() * lambda;
        rhs.tail(j.G.rows()) = -j.G * y;
        const VectorXd correction = lu.solve(rhs);
        y += correction.head(layout.size);
        lambda += correction.tail(j.G.rows());
        for (int b = 0; b < model.n_bodies(); ++b) {
            const int at = layout.first[b];
            const VectorXd xi = s.segment(at, n_twists(model.bodies()[b]))
                                    .cwiseProduct(y.segment(at, n_twists(model.bodies()[b])));
            rates[b].set_column(0, part(xi, 0));
            if (model.bodies()[b].is_point) continue;
            for (int i = 1; i < 4; ++i) rates[b].set_column(i, cross(part(xi, 3), X[b].column(i)));
        }
    }
    return rates;
}

}   // namespace livens
