#include "livens/spacetime/mixed/mechanism.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "livens/base/error.h"
#include "livens/multibody/mass_properties.h"
#include "livens/solvers/sparse.h"

namespace livens::mixed {

namespace {

const std::string none;

const Matrix34& place(const std::vector<Matrix34>& X, int body)
{
    return body == world ? world_configuration : X[body];
}

bool finite(const Matrix34& m)
{
    return std::all_of(std::begin(m.a), std::end(m.a), [](double x) { return std::isfinite(x); });
}

void refuse_singular(const Body& body)
{
    if (!is_singular(body.mass, body.is_point)) return;
    throw InputError(
        {"mass-singular", "body[" + body.name + "].inertia",
         "the mass matrix of body '" + body.name + "' is singular, and the elements 'mixed' divide by it", "",
         "J1 + J2 > J3 for every principal moment",
         "a lamina or a needle has no extent along some axis, so one of its directors has no inertia",
         "use the method lobatto, or give the body a little thickness"});
}

/// Adds up entries of a small sparse matrix by columns. Entries of value zero belong to the pattern.
class MatrixBuilder {
public:
    explicit MatrixBuilder(int size) : columns_(static_cast<std::size_t>(size)) {}

    void add(int row, int column, double value)
    {
        auto& entries = columns_[column];
        const auto at = std::lower_bound(entries.begin(), entries.end(), row,
                                         [](const auto& entry, int r) { return entry.first < r; });
        if (at != entries.end() && at->first == row)
            at->second += value;
        else
            entries.insert(at, {row, value});
    }
    SparseMatrix build() const { return sparse_from_columns(columns_); }

private:
    std::vector<std::vector<std::pair<int, double>>> columns_;
};

}   // namespace

Mechanism::Mechanism(const Model& m, const std::vector<int>& independent_rows) : model(m)
{
    for (int b = 0; b < m.n_bodies(); ++b) {
        const Body& body = m.bodies()[b];
        refuse_singular(body);
        first.push_back(n_coordinates);
        n_coordinates += n_numbers(b);
        weights.push_back(weight(body, m.gravity()));
        inverse_masses.push_back(inverse_mass(body.mass, body.is_point));
        for (int c = 0; c < n_numbers(b); ++c) root_masses.push_back(std::sqrt(body.mass(c / 3, c / 3)));
    }
    for (int r : independent_rows) rows.push_back({m.row(r), r});
    for (int b = 0; b < m.n_bodies(); ++b) {
        if (m.bodies()[b].is_point) continue;
        for (const ConstraintRow& row : rigidity_rows(b)) rows.push_back({row, -1});
    }
    for (int k = 0; k < n_rows(); ++k) {
        list_gradient(k);
        list_hessian(k);
    }
}

void Mechanism::list_gradient(int row)
{
    const ConstraintRow& form = rows[row].form;
    for (int side = 0; side < 2; ++side) {
        const int body = side == 0 ? form.body_i : form.body_j;
        if (body == world) continue;
        const Matrix4& own = side == 0 ? form.c_ii : form.c_jj;
        const Matrix4 other = side == 0 ? transpose(form.c_ij) : form.c_ij;
        const Matrix34& b = side == 0 ? form.b_i : form.b_j;
        for (int c = 0; c < n_numbers(body); ++c) {
            const bool is_quadratic = norm(own.column(c / 3)) > 0 || norm(other.column(c / 3)) > 0;
            if (is_quadratic || b.a[c] != 0) gradient_entries.push_back({row, body, c});
        }
    }
}

void Mechanism::list_hessian(int row)
{
    const ConstraintRow& form = rows[row].form;
    const auto add = [&](int body_i, int body_j, const Matrix4& C) {   // of X_i C in the rows of body j
        if (body_i == world || body_j == world) return;
        for (int k = 0; k < n_numbers(body_i) / 3; ++k)
            for (int c = 0; c < n_numbers(body_j) / 3; ++c) {
                if (C(k, c) == 0) continue;
                for (int d = 0; d < 3; ++d)
                    hessian_entries.push_back(
                        {row, first[body_j] + 3 * c + d, first[body_i] + 3 * k + d, C(k, c)});
            }
    };
    add(form.body_i, form.body_i, form.c_ii);
    add(form.body_j, form.body_j, form.c_jj);
    add(form.body_i, form.body_j, form.c_ij);
    add(form.body_j, form.body_i, transpose(form.c_ij));
}

std::string Mechanism::row_name(int row) const
{
    const Row& r = rows[row];
    if (r.model_row < 0) return "the rigidity of body '" + model.body_name(r.form.body_j) + "'";
    return "joint '" + model.joints()[model.row_joint(r.model_row)].name + "' (row '" + r.form.label + "')";
}

void Mechanism::unstack(const double* coordinates, std::vector<Matrix34>& X) const
{
    X.resize(first.size());
    for (int b = 0; b < n_bodies(); ++b) {
        X[b] = {};
        std::copy_n(coordinates + first[b], n_numbers(b), X[b].a);
    }
}

void Mechanism::stack(const std::vector<Matrix34>& X, double* coordinates) const
{
    for (int b = 0; b < n_bodies(); ++b) std::copy_n(X[b].a, n_numbers(b), coordinates + first[b]);
}

LoadArguments Mechanism::arguments(const Load& load, double t, const std::vector<Matrix34>& X,
                                   const std::vector<Matrix34>& V) const
{
    LoadArguments arguments;
    arguments.at = {t, Side::middle};
    for (int s = 0; s < 2; ++s) {
        if (load.bodies[s] == world) continue;
        arguments.X[s] = X[load.bodies[s]];
        arguments.V[s] = V[load.bodies[s]];
    }
    return arguments;
}

void Mechanism::gradient(int row, const std::vector<Matrix34>& X, Matrix34& g_i, Matrix34& g_j) const
{
    const ConstraintRow& form = rows[row].form;
    constraint_gradient(form, place(X, form.body_i), place(X, form.body_j), g_i, g_j);
}

double Mechanism::value(int row, const std::vector<Matrix34>& X) const
{
    const ConstraintRow& form = rows[row].form;
    return constraint_value(form, place(X, form.body_i), place(X, form.body_j));
}

const std::string& Mechanism::forces(double t, const std::vector<Matrix34>& X, const std::vector<Matrix34>& V,
                                     const std::vector<double>& lambda, std::vector<Matrix34>& F) const
{
    const std::string* bad = &none;
    F = weights;
    for (const Load& load : model.loads()) {
        LoadForces f{};
        load.forces(arguments(load, t, X, V), f);
        for (int s = 0; s < 2; ++s) {
            if (load.bodies[s] == world) continue;
            if (!finite(f[s])) bad = &load.name;
            F[load.bodies[s]] += f[s];
        }
    }
    for (int k = 0; k < n_rows(); ++k) {
        if (lambda[k] == 0) continue;
        const ConstraintRow& form = rows[k].form;
        Matrix34 g_i{}, g_j{};
        gradient(k, X, g_i, g_j);
        if (form.body_i != world) F[form.body_i] -= lambda[k] * g_i;
        if (form.body_j != world) F[form.body_j] -= lambda[k] * g_j;
    }
    return *bad;
}

std::vector<std::vector<double>> Mechanism::multipliers(const std::vector<State>& states) const
{
    const int size = n_coordinates + n_rows();
    SparseLU lu(SparseBackend::eigen);
    std::vector<std::vector<double>> result;
    std::vector<double> x(static_cast<std::size_t>(size));
    const std::vector<double> zero(static_cast<std::size_t>(n_rows()), 0.0);
    std::vector<Matrix34> F;
    for (const State& state : states) {
        MatrixBuilder builder(size);
        for (int b = 0; b < n_bodies(); ++b)
            for (int i = 0; i < n_numbers(b); ++i)
                for (int c = i % 3; c < n_numbers(b); c += 3)
                    builder.add(first[b] + i, first[b] + c, model.bodies()[b].mass(i / 3, c / 3));
        for (const GradientEntry& g : gradient_entries) {
            Matrix34 g_i{}, g_j{};
            gradient(g.row, state.X, g_i, g_j);
            const double entry = (rows[g.row].form.body_i == g.body ? g_i : g_j).a[g.component];
            builder.add(first[g.body] + g.component, n_coordinates + g.row, entry);
            builder.add(n_coordinates + g.row, first[g.body] + g.component, entry);
        }
        forces(state.t, state.X, state.V, zero, F);
        stack(F, x.data());
        for (int k = 0; k < n_rows(); ++k) {
            const ConstraintRow& form = rows[k].form;
            const Matrix34 at_rest{};
            x[n_coordinates + k] =
                -constraint_curvature(form, form.body_i == world ? at_rest : state.V[form.body_i],
                                      form.body_j == world ? at_rest : state.V[form.body_j]);
        }
        const SparseMatrix A = builder.build();
        if (result.empty()) lu.analyse(A);
        if (lu.factorise(A))
            lu.solve(x, x);
        else
            std::fill(x.begin(), x.end(), std::numeric_limits<double>::quiet_NaN());
        result.emplace_back(x.begin() + n_coordinates, x.end());
    }
    return result;
}

}   // namespace livens::mixed
