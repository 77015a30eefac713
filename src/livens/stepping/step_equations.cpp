// SPDX-License-Identifier: BSD-3-Clause
// Equations of one step in the displacement u = X_1 - X_0 and Lambda = a h^2 lambda: m u - h P_0 - a h^2 (F -
// G^T lambda) = 0 and Phi(X_1) = 0, with a = 1/2 for the midpoint and 1 for the endpoint. theory.md, "The
// witnesses", with P_1 eliminated.
#include "livens/stepping/step_equations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace livens {

namespace {

template <int R, int C>
bool finite(const Matrix<R, C>& m)
{
    return std::all_of(std::begin(m.a), std::end(m.a), [](double x) { return std::isfinite(x); });
}

}   // namespace

StepEquations::StepEquations(const Model& model, const ConsistentStart& assembly, SteppingRule rule)
    : model_(model), a_(rule == SteppingRule::midpoint ? 0.5 : 1.0), length_(model.length())
{
    for (int b = 0; b < model.n_bodies(); ++b) {
        first_.push_back(n_displacements_);
        n_displacements_ += n_numbers(b);
    }
    // Dependent rows would make the tangent singular; they hold with the others.
    for (int r : assembly.independent) rows_.push_back({model.row(r), r});
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        for (const ConstraintRow& row : rigidity_rows(b)) rows_.push_back({row, -1});
    }
}

StepEquations::System StepEquations::evaluate(const StepStart& start,
                                              const std::vector<double>& unknowns) const
{
    System system;
    system.residual.assign(size(), 0.0);
    const std::vector<Matrix34> u = displacements(unknowns);
    std::vector<Matrix34> X_a = start.X, X_1 = start.X, V_a = u;
    for (int b = 0; b < model_.n_bodies(); ++b) {
        X_a[b] += a_ * u[b];
        X_1[b] += u[b];
        V_a[b] *= 1 / start.h;
        add_force(b, 1, u[b] * model_.bodies()[b].mass, system);
        add_force(b, -start.h, start.P[b], system);
    }
    add_mass(system);
    add_constraints(start.X, X_a, X_1, unknowns, system);
    add_loads(start, X_a, V_a, system);
    return system;
}

StepEquations::System StepEquations::projection(const std::vector<Matrix34>& X,
                                                const std::vector<Matrix34>& P) const
{
    System system;
    system.residual.assign(size(), 0.0);
    add_mass(system);
    // Lambda = 0: what remains are the columns G^T and the rows G.
    add_constraints(X, X, X, std::vector<double>(size(), 0.0), system);
    std::fill(system.residual.begin(), system.residual.end(), 0.0);
    for (int b = 0; b < model_.n_bodies(); ++b) add_force(b, 1, P[b], system);
    return system;
}

void StepEquations::add_mass(System& system) const
{
    for (int b = 0; b < model_.n_bodies(); ++b) add_columns(b, b, 1, model_.bodies()[b].mass, system);
}

/// G(q_a)^T Lambda and Phi(q1), and their tangents: a K Lambda, G(q_a)^T, G(q1).
void StepEquations::add_constraints(const std::vector<Matrix34>& X_0, const std::vector<Matrix34>& X_a,
                                    const std::vector<Matrix34>& X_1, const std::vector<double>& unknowns,
                                    System& system) const
{
    const std::vector<Matrix34> u = displacements(unknowns);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        const ConstraintRow& row = rows_[k].form;
        const int at = n_displacements_ + static_cast<int>(k), i = row.body_i, j = row.body_j;
        const double multiplier = unknowns[at];
        // what positions tell up to turns, or up to a sign, is followed from the start of the step
        system.residual[at] = row.functions.empty()
                                  ? constraint_value(row, X_1)
                                  : constraint_value(row, X_0) + constraint_change(row, {}, X_0, {}, X_1, u);
        // Forces act at X_a, constraints hold at X_1. At the midpoint G(X_a) u = Phi(X_1) - Phi(X_0) for
        // quadratic rows, hence the rule keeps energy.
        const RowGradient all_a = constraint_gradient(row, X_a), all_1 = constraint_gradient(row, X_1);
        for (const int body : all_a.bodies) {
            const Matrix34 g_a = all_a.of(body), g_1 = all_1.of(body);
            add_force(body, multiplier, g_a, system);
            for (int c = 0; c < n_numbers(body); ++c) {
                if (g_a[c] != 0) system.tangent.push_back({first_[body] + c, at, g_a[c]});
                if (g_1[c] != 0) system.tangent.push_back({at, first_[body] + c, g_1[c]});
            }
        }
        if (multiplier == 0) continue;
        if (!row.functions.empty()) {
            add_hessian(row, X_a, a_ * multiplier, system);
            continue;
        }
        add_columns(i, i, a_ * multiplier, row.c_ii, system);
        add_columns(j, j, a_ * multiplier, row.c_jj, system);
        add_columns(i, j, a_ * multiplier, transpose(row.c_ij), system);
        add_columns(j, i, a_ * multiplier, row.c_ij, system);
    }
}

/// Of a row that is no quadratic form: factor times its second derivatives.
void StepEquations::add_hessian(const ConstraintRow& row, const std::vector<Matrix34>& X, double factor,
                                System& system) const
{
    const RowBodies bodies = row_bodies(row);
    for (const int body : bodies)
        for (const int by : bodies) {
            const Matrix<12, 12> H = constraint_hessian(row, {}, X, body, by);
            for (int r = 0; r < n_numbers(body); ++r)
                for (int c = 0; c < n_numbers(by); ++c)
                    if (H(r, c) != 0)
                        system.tangent.push_back({first_[body] + r, first_[by] + c, factor * H(r, c)});
        }
}

/// -a h^2 F(t_a, q_a, V_a) and its tangent -a h^2 (a dF/dX + dF/dV / h).
void StepEquations::add_loads(const StepStart& start, const std::vector<Matrix34>& X_a,
                              const std::vector<Matrix34>& V_a, System& system) const
{
    const double factor = -a_ * start.h * start.h;
    for (int b = 0; b < model_.n_bodies(); ++b) {
        add_force(b, factor, weight(model_.bodies()[b], model_.gravity()), system);
    }
    // The end of a step is seen from inside the step: a load that jumps there has not jumped yet.
    const Instant at{start.t + a_ * start.h, a_ == 1 ? Side::left : Side::middle};
    for (const Load& load : model_.loads()) {
        const LoadArguments arguments = load_arguments(load, at, X_a, V_a);
        LoadForces F(load.n_acted);
        LoadTangent T(load.bodies.size(), load.n_acted);
        load.forces(arguments, F);
        if (load.depends_on_X || load.depends_on_V) load.tangent(arguments, T);
        for (std::size_t s = 0; s < load.n_acted; ++s) {
            const int body = load.bodies[s];
            if (body == world) continue;
            if (!finite(F[s])) system.not_finite = not_finite(load);
            add_force(body, factor, F[s], system);
            for (std::size_t w = 0; w < load.bodies.size(); ++w) {
                const int by = load.bodies[w];
                if (by == world) continue;
                const Matrix<12, 12> d = a_ * T.X[s][w] + (1 / start.h) * T.V[s][w];
                if (!finite(d)) system.not_finite = not_finite(load);
                for (int r = 0; r < n_numbers(body); ++r)
                    for (int c = 0; c < n_numbers(by); ++c) {
                        if (d(r, c) != 0)
                            system.tangent.push_back({first_[body] + r, first_[by] + c, factor * d(r, c)});
                    }
            }
        }
    }
}

void StepEquations::add_force(int body, double factor, const Matrix34& F, System& system) const
{
    for (int c = 0; c < n_numbers(body); ++c) system.residual[first_[body] + c] += factor * F[c];
}

/// Tangent of factor * X_by C in the rows of `body`: entry (r, c) of X C is sum_k X(r, k) C(k, c).
void StepEquations::add_columns(int body, int by, double factor, const Matrix4& C, System& system) const
{
    if (body == world || by == world) return;
    for (int c = 0; c < n_numbers(body) / 3; ++c)
        for (int k = 0; k < n_numbers(by) / 3; ++k) {
            if (C(k, c) == 0) continue;
            for (int r = 0; r < 3; ++r) {
                system.tangent.push_back(
                    {first_[body] + 3 * c + r, first_[by] + 3 * k + r, factor * C(k, c)});
            }
        }
}

std::vector<Matrix34> StepEquations::displacements(const std::vector<double>& unknowns) const
{
    std::vector<Matrix34> u(model_.n_bodies(), Matrix34{});
    for (int b = 0; b < model_.n_bodies(); ++b)
        for (int c = 0; c < n_numbers(b); ++c) u[b][c] = unknowns[first_[b] + c];
    return u;
}

std::vector<double> StepEquations::multipliers(const std::vector<double>& unknowns, double h) const
{
    std::vector<double> lambda(model_.n_rows(), 0.0);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        if (rows_[k].model_row >= 0)
            lambda[rows_[k].model_row] = unknowns[n_displacements_ + k] / (a_ * h * h);
    }
    return lambda;
}

StepStart StepEquations::next(const StepStart& start, const std::vector<double>& unknowns) const
{
    StepStart end = start;
    end.t = start.t + start.h;
    const std::vector<Matrix34> u = displacements(unknowns);
    for (int b = 0; b < model_.n_bodies(); ++b) {
        end.X[b] += u[b];
        const Matrix34 p_a = (1 / start.h) * (u[b] * model_.bodies()[b].mass);
        // p_a is the mean momentum of the step; for the midpoint the end lies as far beyond it as the start
        // before.
        end.P[b] = a_ == 1 ? p_a : start.P[b] + (1 / a_) * (p_a - start.P[b]);
    }
    return end;
}

double StepEquations::increment_size(const std::vector<double>& increment) const
{
    double size = 0;
    for (int b = 0; b < model_.n_bodies(); ++b)
        for (int c = 0; c < n_numbers(b); ++c) {
            // Displacements by the model's length, directors by one: the measure of the tolerance.
            size = std::max(size, std::abs(increment[first_[b] + c]) / (c < 3 ? length_ : 1));
        }
    return size;
}

std::string StepEquations::row_name(const Row& row) const
{
    if (row.model_row < 0) return "the rigidity of body '" + model_.body_name(row.form.body_j) + "'";
    const std::string& joint = model_.joints()[model_.row_joint(row.model_row)].name;
    return "joint '" + joint + "' (row '" + row.form.label + "')";
}

StepEquations::Worst StepEquations::worst_residual(const std::vector<double>& residual) const
{
    Worst worst;
    const auto look = [&](double value, auto name) {
        if (value > worst.value || !std::isfinite(value)) worst = {value, name()};
    };
    for (int b = 0; b < model_.n_bodies(); ++b) {
        const Matrix4& m = model_.bodies()[b].mass;
        const double moment = m(1, 1) + m(2, 2) + m(3, 3);
        for (int c = 0; c < n_numbers(b); ++c) {
            look(std::abs(residual[first_[b] + c]) / (c < 3 ? m(0, 0) * length_ : moment),
                 [&] { return "the momentum of body '" + model_.body_name(b) + "'"; });
        }
    }
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        look(std::abs(residual[n_displacements_ + k]) / rows_[k].form.scale,
             [&] { return row_name(rows_[k]); });
    }
    return worst;
}

}   // namespace livens
