// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/detail/sparse_form.h"

#include "livens/base/elementary.h"

namespace livens::inline diagnostics_internal {

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
{
    for (const PairForm& form : coordinate.forms) {
        forms_.emplace_back(form);
        stated_.push_back(forms_.back().value(stated));
    }
}

double SparseCoordinate::change(const double* X) const
{
    if (!is_angle()) return forms_[0].value(X) - stated_[0];
    const double c0 = stated_[0], s0 = stated_[1], c = forms_[0].value(X), s = forms_[1].value(X);
    return arc_tangent(c0 * s - s0 * c, c0 * c + s0 * s);
}

double SparseCoordinate::rate(const double* X, const double* V) const
{
    if (!is_angle()) return forms_[0].rate(X, V);
    const double c = forms_[0].value(X), s = forms_[1].value(X);
    return (c * forms_[1].rate(X, V) - s * forms_[0].rate(X, V)) / (c * c + s * s);
}

/// theta' = (c s' - s c') / r, r = c^2 + s^2: the slope of that.
double SparseCoordinate::acceleration(const double* X, const double* V, const double* A) const
{
    if (!is_angle()) return forms_[0].acceleration(X, V, A);
    const double c = forms_[0].value(X), s = forms_[1].value(X), dc = forms_[0].rate(X, V),
                 ds = forms_[1].rate(X, V), r = c * c + s * s;
    const double turned = c * forms_[1].acceleration(X, V, A) - s * forms_[0].acceleration(X, V, A);
    return (turned - 2 * (c * dc + s * ds) * (c * ds - s * dc) / r) / r;
}

}   // namespace livens::inline diagnostics_internal
