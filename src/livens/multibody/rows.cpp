#include "livens/multibody/rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace livens {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

const Matrix34& of(std::span<const Matrix34> X, int body)
{
    return body == world ? world_configuration : X[body];
}

/// By X_i and X_j.
std::array<Matrix34, 2> gradient(const ConstraintRow& row, const Matrix34& X_i, const Matrix34& X_j)
{
    std::array<Matrix34, 2> g{};
    constraint_gradient(row, X_i, X_j, g[0], g[1]);
    return g;
}

template <int R, int C>
Matrix<R, C> absolute(Matrix<R, C> m)
{
    for (double& x : m.a) x = std::abs(x);
    return m;
}

ConstraintRow absolute(ConstraintRow row)
{
    for (Matrix4* c : {&row.c_ii, &row.c_ij, &row.c_jj}) *c = absolute(*c);
    for (Matrix34* b : {&row.b_i, &row.b_j}) *b = absolute(*b);
    row.c = std::abs(row.c);
    return row;
}

/// `terms`: the sum of the absolute terms of every entry of g.
Wrench wrench_of(int body, const Vector3& at, const Matrix34& X, const Matrix34& g, const Matrix34& terms)
{
    Wrench wrench{body, at, g.column(0), {}, 0};
    double level = 0;
    for (int i = 1; i < 4; ++i) {
        wrench.moment += cross(X.column(i), g.column(i) - at[i - 1] * g.column(0));
        level += norm(terms.column(i)) + std::abs(at[i - 1]) * norm(terms.column(0));
    }
    if (norm(wrench.moment) <= 8 * eps * level) wrench.moment = {};
    const double force = norm(wrench.force);
    if (force > 0) wrench.doubt = 4 * eps * norm(terms.column(0)) / force;
    return wrench;
}

}   // namespace

std::vector<int> all_rows(const Model& model)
{
    std::vector<int> rows(model.n_rows());
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
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
        const auto g = gradient(row, of(X, row.body_i), of(X, row.body_j));
        if (row.body_i != world) rates[r] += dot(g[0], V[row.body_i]);
        if (row.body_j != world) rates[r] += dot(g[1], V[row.body_j]);
    }
    return rates;
}

std::vector<double> drive_rates(const Model& model, Instant at, std::span<const Matrix34> X)
{
    std::vector<double> rates(model.n_rows(), 0.0);
    for (int r = 0; model.has_drives() && r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        rates[r] = constraint_rate(row, at, of(X, row.body_i), of(X, row.body_j));
    }
    return rates;
}

Gap widest_gap(const Model& model, std::span<const Matrix34> X, std::span<const int> rows)
{
    const std::vector<double> phi = joint_values(model, X);
    Gap gap;
    for (const int r : rows) {
        const ConstraintRow row = absolute(model.row(r));
        const double terms = constraint_value(row, absolute(of(X, row.body_i)), absolute(of(X, row.body_j)));
        const double level = std::abs(phi[r]) / (4 * eps * std::max(terms, row.scale));
        const double violation = std::abs(phi[r]) / row.scale;
        if (gap.row < 0 || violation > gap.violation) gap.row = r, gap.violation = violation;
        gap.level = std::max(gap.level, level);
        gap.near = gap.near && (level <= 1 || violation <= 1e-9);
    }
    return gap;
}

RowWrenches row_wrenches(const Model& model, std::span<const Matrix34> X)
{
    RowWrenches wrenches(model.n_rows());
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        const Joint& joint = model.joints()[model.row_joint(r)];
        const Matrix34 &X_i = of(X, row.body_i), &X_j = of(X, row.body_j);
        const auto g = gradient(row, X_i, X_j);
        const auto terms = gradient(absolute(row), absolute(X_i), absolute(X_j));
        const auto on = [&](int body, int side) {
            const Vector3& at = body == joint.second ? joint.point_second : joint.point_first;
            return body == world ? Wrench{} : wrench_of(body, at, X[body], g[side], terms[side]);
        };
        wrenches[r] = {on(row.body_i, 0), on(row.body_j, 1)};
    }
    return wrenches;
}

Vector3 moment_about(const Wrench& wrench, const Matrix34& X, const Vector3& theta)
{
    return wrench.moment + cross(X * direction(wrench.at - theta), wrench.force);
}

}   // namespace livens
