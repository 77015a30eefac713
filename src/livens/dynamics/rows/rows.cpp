// SPDX-License-Identifier: BSD-3-Clause
// Values, rates and wrenches of all rows, each with the rounding of its own terms: what theory.md, "Rank is
// geometry", calls a force and a moment at the joint point, and its doubt.
#include "livens/dynamics/rows/rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace livens::inline dynamics_internal {

namespace {

constexpr double spacing = std::numeric_limits<double>::epsilon();

template <int R, int C>
Matrix<R, C> absolute(Matrix<R, C> m)
{
    for (double& x : m.a) x = std::abs(x);
    return m;
}

/// act(row) of every form of a row, weighed, as a row without signs.
template <typename Act>
void for_each_positive_form(const ConstraintRow& row, std::span<const Matrix34> X, const Act& act)
{
    for_each_form(row, {}, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        ConstraintRow positive;
        positive.body_i = i;
        positive.body_j = j;
        positive.c_ii = absolute(weight * form.c_ii);
        positive.c_ij = absolute(weight * form.c_ij);
        positive.c_jj = absolute(weight * form.c_jj);
        positive.b_i = absolute(weight * form.b_i);
        positive.b_j = absolute(weight * form.b_j);
        positive.c = std::abs(weight * form.c);
        act(positive);
    });
}

/// The gradients of the forms of a row with absolute terms, at absolute X.
RowGradient gradient_terms(const ConstraintRow& row, std::span<const Matrix34> X,
                           const std::vector<Matrix34>& positive)
{
    RowGradient terms(row);
    for_each_form(row, {}, X, [&](const QuadraticForm& form, int i, int j, double weight) {
        const auto of = [&](int body) {
            return body == world ? absolute(world_configuration) : positive[body];
        };
        const auto add = [&](int body, const Matrix34& g) {
            terms.by[terms.bodies.find(body)] += std::abs(weight) * g;
        };
        add(j, of(j) * absolute(form.c_jj) + absolute(form.b_j));
        if (i == world) return;
        add(j, of(i) * absolute(form.c_ij));
        add(i, of(i) * absolute(form.c_ii) + of(j) * absolute(transpose(form.c_ij)) + absolute(form.b_i));
    });
    return terms;
}

std::vector<Matrix34> absolute(std::span<const Matrix34> X)
{
    std::vector<Matrix34> positive;
    for (const Matrix34& body : X) positive.push_back(absolute(body));
    return positive;
}

/// `terms`: the sum of the absolute terms of every entry of g.
Wrench wrench_of(int body, const Vector3& at, const Matrix34& X, const Matrix34& g, const Matrix34& terms)
{
    Wrench wrench{body, at, g.column(0), {}, 0};
    double level = 0;
    for (int i = 1; i < 4; ++i) {
        // The gradient by the directors, less what the force at the joint point explains, is a pure moment.
        wrench.moment += cross(X.column(i), g.column(i) - at[i - 1] * g.column(0));
        level += norm(terms.column(i)) + std::abs(at[i - 1]) * norm(terms.column(0));
    }
    // Inequality |m| <= 8 eps sum |terms|: far from the joint point the sum of large terms says nothing.
    if (norm(wrench.moment) <= 8 * spacing * level) wrench.moment = {};
    const double force = norm(wrench.force);
    // The doubt is the relative rounding of the force, from the sum of the sizes of its terms.
    if (force > 0) wrench.doubt = 4 * spacing * norm(terms.column(0)) / force;
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
    std::vector<double> phi;
    for (int r = 0; r < model.n_rows(); ++r) phi.push_back(constraint_value(model.row(r), X));
    return phi;
}

std::vector<double> joint_values_from(const Model& model, std::span<const double> phi,
                                      std::span<const Matrix34> X_from, std::span<const Matrix34> X)
{
    std::vector<double> values = joint_values(model, X);
    std::vector<Matrix34> step;
    for (int r = 0; r < model.n_rows(); ++r) {
        const ConstraintRow& row = model.row(r);
        if (row.period == 0) continue;
        for (std::size_t b = step.size(); b < X.size(); ++b) step.push_back(X[b] - X_from[b]);
        const double followed = phi[r] + constraint_change(row, {}, Configurations(X_from), {},
                                                           Configurations(X), Configurations(step));
        values[r] += row.period * std::round((followed - values[r]) / row.period);
    }
    return values;
}

std::vector<double> joint_rates(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    std::vector<double> rates(model.n_rows(), 0.0);
    for (int r = 0; r < model.n_rows(); ++r) {
        const RowGradient g = constraint_gradient(model.row(r), X);
        for (const int body : g.bodies) rates[r] += dot(g.of(body), V[body]);
    }
    return rates;
}

std::vector<double> drive_rates(const Model& model, Instant at, std::span<const Matrix34> X)
{
    std::vector<double> rates(model.n_rows(), 0.0);
    for (int r = 0; model.has_drives() && r < model.n_rows(); ++r)
        rates[r] = constraint_rate(model.row(r), at, X);
    return rates;
}

Gap widest_gap(const Model& model, std::span<const Matrix34> X, std::span<const int> rows)
{
    return widest_gap(model, X, rows, joint_values(model, X));
}

Gap widest_gap(const Model& model, std::span<const Matrix34> X, std::span<const int> rows,
               std::span<const double> phi)
{
    const std::vector<Matrix34> positive = absolute(X);
    Gap gap;
    for (const int r : rows) {
        const ConstraintRow& row = model.row(r);
        double terms = 0;
        for_each_positive_form(row, X,
                               [&](const ConstraintRow& form) { terms += constraint_value(form, positive); });
        // A violation of one level is rounding of the row itself; no iteration could take it off.
        const double level = std::abs(phi[r]) / (4 * spacing * std::max(terms, row.scale));
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
    const std::vector<Matrix34> positive = absolute(X);
    for (int r = 0; r < model.n_rows(); ++r) {
        const Joint& joint = model.joints()[model.row_joint(r)];
        const RowGradient g = constraint_gradient(model.row(r), X);
        const RowGradient terms = gradient_terms(model.row(r), X, positive);
        for (const int body : g.bodies) {
            const Vector3 at = body == joint.second  ? joint.point_second
                               : body == joint.first ? joint.point_first
                                                     : Vector3{};
            wrenches[r].push_back(wrench_of(body, at, X[body], g.of(body), terms.of(body)));
        }
    }
    return wrenches;
}

Vector3 moment_about(const Wrench& wrench, const Matrix34& X, const Vector3& theta)
{
    return wrench.moment + cross(X * direction(wrench.at - theta), wrench.force);
}

}   // namespace livens::inline dynamics_internal
