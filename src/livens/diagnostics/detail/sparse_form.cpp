// SPDX-License-Identifier: BSD-3-Clause
// Forms by the few numbers of X that they see: 12 a body, column by column, so that a column is named by its
// first number, 12 body + 3 column. theory.md, "Joints are quadratic forms" and "Coordinates of joints".
#include "livens/diagnostics/detail/sparse_form.h"

#include <algorithm>

#include "livens/base/elementary.h"

namespace livens::inline diagnostics_internal {

/// 1/2 tr(X K X^T) has each block of a body by 1/2, and c_ij, which stands in K twice, by 1.
SparseForm::SparseForm(const PairForm& form) : constant_(form.c)
{
    add_products(form.body_j, form.body_j, form.c_jj, 0.5);
    add_terms(form.body_j, form.b_j);
    if (form.body_i == world) return;   // whose terms are folded into b_j and c
    add_products(form.body_i, form.body_i, form.c_ii, 0.5);
    add_products(form.body_i, form.body_j, form.c_ij, 1);
    add_terms(form.body_i, form.b_i);
}

void SparseForm::add_products(int body, int other, const Matrix4& c, double factor)
{
    for (int k = 0; k < 4; ++k)
        for (int l = 0; l < 4; ++l)
            if (c(k, l) != 0) products_.push_back({12 * body + 3 * k, 12 * other + 3 * l, factor * c(k, l)});
}

void SparseForm::add_terms(int body, const Matrix34& b)
{
    for (int i = 0; i < 12; ++i)
        if (b.a[i] != 0) terms_.push_back({12 * body + i, b.a[i]});
}

double SparseForm::value(const double* X) const
{
    double sum = 0;
    for (const Term& term : terms_) sum += term.value * X[term.number];
    for (const Product& p : products_) {
        const double *x = X + p.x, *y = X + p.y;
        sum += p.value * (x[0] * y[0] + x[1] * y[1] + x[2] * y[2]);
    }
    return sum + constant_;
}

double SparseForm::rate(const double* X, const double* V) const
{
    double sum = 0;
    for (const Term& term : terms_) sum += term.value * V[term.number];
    for (const Product& p : products_) {
        const double *x = X + p.x, *y = X + p.y, *u = V + p.x, *v = V + p.y;
        sum += p.value * (u[0] * y[0] + u[1] * y[1] + u[2] * y[2] + x[0] * v[0] + x[1] * v[1] + x[2] * v[2]);
    }
    return sum;
}

/// (x . y)'' = x'' . y + x . y'' + 2 x' . y', of which rate() with A in place of V has the first two.
double SparseForm::acceleration(const double* X, const double* V, const double* A) const
{
    double sum = 0;
    for (const Product& p : products_) {
        const double *u = V + p.x, *v = V + p.y;
        sum += 2 * p.value * (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
    }
    return sum + rate(X, A);
}

SparseCoordinate::SparseCoordinate(const JointCoordinate& coordinate, const double* stated)
    : kind_(coordinate.kind)
{
    for (const PairForm& form : coordinate.forms) {
        forms_.emplace_back(form);
        stated_.push_back(forms_.back().value(stated));
    }
}

SmoothFunction::Point SparseCoordinate::forms_at(const double* X) const
{
    SmoothFunction::Point q{};
    for (std::size_t k = 0; k < forms_.size(); ++k) q[k] = forms_[k].value(X);
    return q;
}

/// Of an angle by sine and cosine of what it has turned since: the shorter way, in (-pi, pi].
double SparseCoordinate::change(const double* X) const
{
    const SmoothFunction::Point q = forms_at(X);
    if (counts_turns())
        return arc_tangent(stated_[0] * q[1] - stated_[1] * q[0], stated_[0] * q[0] + stated_[1] * q[1]);
    SmoothFunction::Point stated{};
    std::ranges::copy(stated_, stated.begin());
    return coordinate_at(kind_, q).value - coordinate_at(kind_, stated).value;
}

double SparseCoordinate::rate(const double* X, const double* V) const
{
    if (kind_ == CoordinateKind::displacement) return forms_[0].rate(X, V);
    const SmoothFunction::Value at = coordinate_at(kind_, forms_at(X));
    double rate = 0;
    for (std::size_t k = 0; k < forms_.size(); ++k) rate += at.gradient[k] * forms_[k].rate(X, V);
    return rate;
}

/// Of q(f): the sum of dq/df f'' and f'^T d2q/df2 f'.
double SparseCoordinate::acceleration(const double* X, const double* V, const double* A) const
{
    if (kind_ == CoordinateKind::displacement) return forms_[0].acceleration(X, V, A);
    const SmoothFunction::Value at = coordinate_at(kind_, forms_at(X));
    SmoothFunction::Point rates{};
    double acceleration = 0;
    for (std::size_t k = 0; k < forms_.size(); ++k) {
        rates[k] = forms_[k].rate(X, V);
        acceleration += at.gradient[k] * forms_[k].acceleration(X, V, A);
    }
    for (std::size_t k = 0; k < forms_.size(); ++k)
        for (std::size_t l = 0; l < forms_.size(); ++l)
            acceleration += at.hessian[k][l] * rates[k] * rates[l];
    return acceleration;
}

}   // namespace livens::inline diagnostics_internal
