// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/coordinate_load.h"

#include <cmath>
#include <utility>

#include "livens/base/elementary.h"

namespace livens {

namespace {

double value_of(const PairForm& form, const Configurations& X)
{
    return form_value(form, form.body_i, form.body_j, X);
}

/// The same angle, zero in X: sine and cosine are turned.
std::vector<PairForm> from(const std::vector<PairForm>& forms, const Configurations& X)
{
    if (forms.size() == 1) return forms;
    const double c = value_of(forms[0], X), s = value_of(forms[1], X), size = hypotenuse(c, s, 0);
    const auto mixed = [&](double a, double b) {
        PairForm sum = forms[0];
        const PairForm& other = forms[1];
        const auto mix = [&](auto& to, const auto& more) { to = a / size * to + b / size * more; };
        mix(sum.c_ii, other.c_ii);
        mix(sum.c_ij, other.c_ij);
        mix(sum.c_jj, other.c_jj);
        mix(sum.b_i, other.b_i);
        mix(sum.b_j, other.b_j);
        sum.c = a / size * forms[0].c + b / size * other.c;
        return sum;
    };
    return {mixed(c, s), mixed(-s, c)};
}

/// Whether the gradient of a form by X of its body j, or i, has more than a first column.
bool turns(const PairForm& form, bool by_j)
{
    double sum = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = 1; b < 4; ++b)
            sum += std::abs(by_j ? form.c_ij(a, b) : form.c_ij(b, a)) +
                   std::abs(by_j ? form.c_jj(a, b) : form.c_ii(a, b));
    for (int k = 1; k < 4; ++k) sum += norm((by_j ? form.b_j : form.b_i).column(k));
    return sum > 0;
}

}   // namespace

CoordinateLoad::CoordinateLoad(const Joint& joint, const NamedCoordinate& coordinate, const Configurations& X)
    : at_start_(coordinate.at_stated)
{
    std::vector<PairForm> forms = from(coordinate.coordinate.forms, X);
    coordinate_ = {forms};
    bodies_ = {forms[0].body_j, forms[0].body_i};
    n_ = forms[0].body_i == world ? 1 : 2;
    for (PairForm& form : forms) {
        needs_directors_[0] = needs_directors_[0] || turns(form, true);
        needs_directors_[1] = needs_directors_[1] || (n_ == 2 && turns(form, false));
        form.body_j = 0;
        form.body_i = n_ == 2 ? 1 : world;
    }
    if (forms.size() == 1) {
        static_cast<PairForm&>(row_) = forms[0];
        at_start_ -= value_of(coordinate.coordinate.forms[0], X);
    } else {
        row_ = coupling_row({{1, {forms}}}, 0, 1, joint.name);
    }
}

LawArguments CoordinateLoad::look(const LoadArguments& arguments) const
{
    const Configurations X(arguments.X);
    const RowGradient gradient = constraint_gradient(row_, X);
    LawArguments seen{arguments.at, at_start_ + constraint_value(row_, X), 0};
    for (std::size_t b = 0; b < n_; ++b) seen.rate += dot(gradient.of(static_cast<int>(b)), arguments.V[b]);
    return seen;
}

void CoordinateLoad::forces(const LoadArguments& arguments, double Q, LoadForces& F) const
{
    const RowGradient gradient = constraint_gradient(row_, Configurations(arguments.X));
    for (std::size_t b = 0; b < n_; ++b) F[b] = Q * gradient.of(static_cast<int>(b));
}

/// dF_b/dX_c = (Q_q g_c + Q_q' dq'/dX_c) g_b + Q H_bc, with dq'/dX_c = sum_d H_cd V_d, and
/// dF_b/dV_c = Q_q' g_c g_b.
void CoordinateLoad::tangent(const LoadArguments& arguments, const LawValue& Q, LoadTangent& tangent) const
{
    const Configurations X(arguments.X);
    const RowGradient gradient = constraint_gradient(row_, X);
    std::array<std::array<Matrix<12, 12>, 2>, 2> H{};
    std::array<Matrix34, 2> g{}, rate_by_X{};
    for (std::size_t b = 0; b < n_; ++b) {
        g[b] = gradient.of(static_cast<int>(b));
        for (std::size_t c = 0; c < n_; ++c) {
            H[b][c] = constraint_hessian(row_, arguments.at, X, static_cast<int>(b), static_cast<int>(c));
            for (int i = 0; i < 12; ++i)
                for (int j = 0; j < 12; ++j) rate_by_X[b].a[i] += H[b][c](i, j) * arguments.V[c].a[j];
        }
    }
    for (std::size_t b = 0; b < n_; ++b)
        for (std::size_t c = 0; c < n_; ++c)
            for (int i = 0; i < 12; ++i)
                for (int j = 0; j < 12; ++j) {
                    const double slope = Q.by_value * g[c].a[j] + Q.by_rate * rate_by_X[c].a[j];
                    tangent.X[b][c](i, j) += g[b].a[i] * slope + Q.force * H[b][c](i, j);
                    tangent.V[b][c](i, j) += Q.by_rate * g[b].a[i] * g[c].a[j];
                }
}

}   // namespace livens
