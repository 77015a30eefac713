// SPDX-License-Identifier: BSD-3-Clause
// One configuration by the arithmetic of lanes, W = 1: numbers, gradients, and the factor of G G^T
// (docs/theory.md, "Without a tangent", Elimination).
#include "livens/dynamics/lanes/joint_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/lanes/lane_rows.h"
#include "livens/dynamics/rows/tables.h"

namespace livens {

namespace {

using lanes::At;

/// Columns of X to those of the pattern: the centre of mass for the reference point.
void to_centres(const ModelTables& tables, const double* X, double* numbers)
{
    for (int b = 0; b < tables.n_bodies(); ++b, X += 12, numbers += 12) {
        std::copy_n(X, 12, numbers);
        const double* c = tables.bodies[b].center;
        for (int i = 0; tables.bodies[b].offset && i < 3; ++i)
            numbers[i] += X[3 + i] * c[0] + X[6 + i] * c[1] + X[9 + i] * c[2];
    }
}

}   // namespace

/// One block for all arrays, each of which takes whole lines of eight doubles, so that all are aligned.
void LaneStore::resize(const RowPattern& pattern, int width)
{
    const lanes::Pattern& p = pattern.view();
    lanes::Values& v = values_;
    const int X = 12 * p.n_bodies;
    const std::pair<double**, int> arrays[] = {{&v.numbers, pattern.n_numbers()},
                                               {&v.increments, pattern.n_numbers()},
                                               {&v.place, 7 * p.n_bodies},
                                               {&v.last_place, 7 * p.n_bodies},
                                               {&v.gradients, p.n_entries},
                                               {&v.factor, pattern.n_factor()},
                                               {&v.violations, p.n_rows},
                                               {&v.impulses, p.n_rows},
                                               {&v.rows, p.n_twists},
                                               {&v.step, p.n_twists},
                                               {&v.work, p.n_rows},
                                               {&v.pivots, 1},
                                               {&v.forms.values, p.forms.n_forms},
                                               {&v.forms.weights, p.forms.n_forms},
                                               {&v.forms.by_rows, p.forms.n_rows},
                                               {&v.at_loads.F, X},
                                               {&v.at_loads.X, X},
                                               {&v.at_loads.V, X}};
    const auto room = [width](int size) { return static_cast<std::size_t>((size * width + 7) / 8 * 8); };
    std::size_t n = 0;
    for (const auto& [array, size] : arrays) n += room(size);
    numbers_.assign(n, 0.0);
    n = 0;
    for (const auto& [array, size] : arrays) {
        *array = numbers_.data() + n;
        n += room(size);
    }
    for (int b = 0; b < p.n_bodies; ++b)
        for (int l = 0; l < width; ++l)   // no turn
            v.place[(7 * b + 3) * width + l] = v.last_place[(7 * b + 3) * width + l] = 1;
    for (int e = 0; e < p.n_entries; ++e)   // those without terms stay
        for (int l = 0; l < width; ++l) v.gradients[e * width + l] = p.gradients.entries.constants[e];
}

bool JointFactor::serves(const ModelTables& tables) { return tables.bodies.are_regular(); }

void JointFactor::use(std::shared_ptr<const RowPattern> pattern)
{
    if (pattern == pattern_) return;
    pattern_ = std::move(pattern);
    store_.resize(*pattern_, 1);
    // numbers, and two derivatives of forms
    work_.assign(static_cast<std::size_t>(pattern_->n_numbers() + 2 * pattern_->forms().n_forms()), 0.0);
}

double JointFactor::prepare(const ModelTables& tables, Instant at, const double* X, const NearFactor& near)
{
    constexpr double rounding = 1e-16;   // of Phi: nothing to correct
    const lanes::Pattern& p = pattern_->view();
    const lanes::Values& v = values();
    to_centres(tables, X, v.numbers);
    lanes::form_products<1>(p, v, v, false);
    for (int k = 0; k < p.forms.n_forms; ++k)
        lanes::store(v.forms.values + k,
                     p.forms.values.constants[k] + lanes::sum_of<1>(p.forms.values, k, v.numbers));
    pattern_->forms().weigh_at(at, v);
    lanes::form_gradients<1>(p, v);
    lanes::form_violations<1>(p, p.violations.constants, v.numbers, v);
    for (int r = 0; r < p.n_rows; ++r)
        if (std::abs(v.violations[r]) < rounding * tables.rows[pattern_->rows()[r]].row->scale)
            v.violations[r] = 0;
    if (near.pattern == pattern_.get()) {
        for (int i = 0; i < pattern_->n_factor(); ++i) v.factor[i] = near.values->factor[i * near.width];
        v.pivots[0] = near.values->pivots[0];
    } else {
        lanes::factorise<1>(p, v);
    }
    const double pivot = std::sqrt(v.pivots[0]);
    n_passes_ = pivot > 1e-3 ? 2 : 4;
    return pivot;
}

/// y -= G^T (G G^T)^-1 (G y - rates), pass after pass for what rounding of the factor has left.
void JointFactor::project(double* y, const double* rates, double* mu) const
{
    const lanes::Pattern& p = pattern_->view();
    const At<1, false> G{values().gradients, nullptr}, factor{values().factor, nullptr};
    double* more = values().work;
    for (int pass = 0; pass < n_passes_; ++pass) {
        lanes::multiply(p, G, y, nullptr, more);
        for (int r = 0; rates != nullptr && r < p.n_rows; ++r) more[r] -= rates[r];
        lanes::solve(p, factor, more);
        lanes::take_off(p, G, more, y);
        for (int r = 0; r < p.n_rows; ++r) mu[r] = (pass == 0 ? 0.0 : mu[r]) + more[r];
    }
}

/// take_off() makes y = -G^T mu. Out of scaled twists f = sqrt(M) y_1, and tau = R L y_2 about the centre of
/// mass.
void JointFactor::add_wrenches(const double* mu, double factor, double* q)
{
    const lanes::Pattern& p = pattern_->view();
    double* y = values().rows;
    std::fill_n(y, p.n_twists, 0.0);
    lanes::take_off(p, At<1, false>{values().gradients, nullptr}, mu, y);
    for (int b = 0; b < p.n_bodies; ++b) {
        const lanes::Body& body = p.bodies[b];
        const double *f = y + body.first, *L = body.root_spin, *d = values().numbers + 12 * b + 3;
        double* out = q + body.first;
        for (int i = 0; i < 3; ++i) out[i] -= factor * body.root_mass * f[i];
        for (int a = 0; body.dofs == 6 && a < 3; ++a) {   // L y_2 in body axes, turned
            const double torque = factor * (L[a] * f[3] + L[3 + a] * f[4] + L[6 + a] * f[5]);
            for (int i = 0; i < 3; ++i) out[3 + i] -= d[3 * a + i] * torque;
        }
    }
}

bool JointFactor::rates(Instant at, double* out) const
{
    const RowForms& forms = pattern_->forms();
    if (forms.n_rows() == 0) return false;
    std::fill_n(out, pattern_->view().n_rows, 0.0);
    forms.add_rates(at, values(), out);
    return true;
}

/// Inner products have the second derivative x'' . y + 2 x' . y' + x . y''. Sums are linear in columns and
/// products: the tables of values serve for derivatives too, without their constants.
void JointFactor::curvatures(const ModelTables& tables, Instant at, const double* V, const double* A,
                             double* out)
{
    const lanes::Pattern& p = pattern_->view();
    double *second = work_.data(), *first = values().increments;
    const double* x = values().numbers;
    to_centres(tables, V, first);
    to_centres(tables, A, second);
    for (int m = 0; m < p.n_products; ++m) {
        const auto [i, j] = p.products[m];
        double sum = 0, rate = 0;
        for (int k = 0; k < 3; ++k) {
            sum += second[i + k] * x[j + k] + 2 * first[i + k] * first[j + k] + x[i + k] * second[j + k];
            rate += first[i + k] * x[j + k] + x[i + k] * first[j + k];
        }
        first[12 * p.n_bodies + m] = rate;
        second[12 * p.n_bodies + m] = sum;
    }
    for (int r = 0; r < p.n_rows; ++r) lanes::store(out + r, lanes::sum_of<1>(p.violations, r, second));
    double *form_first = second + pattern_->n_numbers(), *form_second = form_first + p.forms.n_forms;
    for (int k = 0; k < p.forms.n_forms; ++k) {
        lanes::store(form_first + k, lanes::sum_of<1>(p.forms.values, k, first));
        lanes::store(form_second + k, lanes::sum_of<1>(p.forms.values, k, second));
    }
    pattern_->forms().add_curvatures(at, values(), form_first, form_second, out);
}

}   // namespace livens
