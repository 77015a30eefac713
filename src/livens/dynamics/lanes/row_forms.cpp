// SPDX-License-Identifier: BSD-3-Clause
// The weight of a drive's form is f_k(t), that of a coordinate the slope F_k: docs/theory.md, "Drives" and
// "Coordinates of joints".
#include "livens/dynamics/lanes/row_forms.h"

#include <algorithm>
#include <cmath>

namespace livens::inline dynamics_internal {

namespace {

SmoothFunction::Value value_at(const SmoothFunction& F, const double* forms)
{
    SmoothFunction::Point q{};
    std::copy_n(forms, F.n, q.begin());
    return F.at(q);
}

}   // namespace

void RowForms::add(const ConstraintRow& row)
{
    Row made{n_forms_, {}, row.functions, row.period, row.c};
    for (const Drive& drive : row.drives) made.factors.push_back(drive.factor);
    n_forms_ = made.first_coordinate() + static_cast<int>(row.coordinates.size());
    rows_.push_back(std::move(made));
}

void RowForms::weigh_at(Instant at, const lanes::Values& one) const
{
    double* sum = one.forms.by_rows;
    for (const Row& row : rows_) {
        *sum = 0;
        int form = row.first;
        for (const TimeFunction& factor : row.factors) {
            one.forms.weights[form] = factor(at).value;
            *sum += one.forms.weights[form] * one.forms.values[form];
            ++form;
        }
        for (const SmoothFunction& function : row.functions) {
            const SmoothFunction::Value F = value_at(function, one.forms.values + form);
            *sum += F.value;
            std::copy_n(F.gradient.begin(), function.n, one.forms.weights + form);
            form += static_cast<int>(function.n);
        }
        // X tells such a row up to its period: the value nearest to zero,
        // of the whole row, whose constant is not among the forms
        if (row.period > 0) *sum = std::remainder(*sum + row.constant, row.period) - row.constant;
        ++sum;
    }
}

void RowForms::weigh_nodes(std::span<const double> times, const lanes::Values& start,
                           const lanes::Values& nodes, int width) const
{
    for (const Row& row : rows_) {
        int form = row.first;
        for (const TimeFunction& factor : row.factors) {
            double* w = nodes.forms.weights + form * width;
            for (int l = 0; l < width; ++l)
                w[l] = l < std::ssize(times) ? factor({times[static_cast<std::size_t>(l)]}).value
                                             : start.forms.weights[form];
            ++form;
        }
    }
}

/// F of its coordinates, from form `first` on, in all lanes: change += its own, and its gradient are their
/// weights.
void RowForms::add_function(const SmoothFunction& F, int first, const lanes::Values& start,
                            const lanes::Values& nodes, int width, double* change)
{
    constexpr int most = 8;   // lanes at a time
    SmoothFunction::Point from{}, steps[most]{};
    SmoothFunction::Value after[most];
    const int n = static_cast<int>(F.n);
    std::copy_n(start.forms.values + first, n, from.begin());
    for (int l = 0; l < width; l += most) {
        const int count = std::min(most, width - l);
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < count; ++i)
                steps[i][static_cast<std::size_t>(k)] = nodes.forms.values[(first + k) * width + l + i];
        const auto n_steps = static_cast<std::size_t>(count);
        // By how forms have changed, not from two values of F: small elements lose no digits.
        F.moved(from, {steps, n_steps}, {after, n_steps});
        for (int i = 0; i < count; ++i) {
            change[l + i] += after[i].value;
            for (int k = 0; k < n; ++k)
                nodes.forms.weights[(first + k) * width + l + i] =
                    after[i].gradient[static_cast<std::size_t>(k)];
        }
    }
}

/// f_k changes with the form as it was at the start, the form with f_k as it is at the node: both are
/// differences, so that small elements lose no digits (docs/theory.md, "Drives").
void RowForms::weigh(const void* forms, const lanes::Values& start, const lanes::Values& nodes, int width)
{
    const auto& all = *static_cast<const RowForms*>(forms);
    double* change = nodes.forms.by_rows;
    for (const Row& row : all.rows_) {
        const int n_factors = static_cast<int>(row.factors.size());
        for (int l = 0; l < width; ++l) {
            change[l] = 0;
            for (int form = row.first; form < row.first + n_factors; ++form) {
                const double w = nodes.forms.weights[form * width + l];
                change[l] += w * nodes.forms.values[form * width + l] +
                             (w - start.forms.weights[form]) * start.forms.values[form];
            }
        }
        int first = row.first_coordinate();
        for (const SmoothFunction& F : row.functions) {
            add_function(F, first, start, nodes, width, change);
            first += static_cast<int>(F.n);
        }
        change += width;
    }
}

void RowForms::add_rates(Instant at, const lanes::Values& one, double* out) const
{
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        int form = rows_[i].first;
        for (const TimeFunction& factor : rows_[i].factors)
            out[places_[i]] += factor(at).first * one.forms.values[form++];
    }
}

void RowForms::add_curvatures(Instant at, const lanes::Values& one, const double* first, const double* second,
                              double* out) const
{
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        double& sum = out[places_[i]];
        int form = row.first;
        for (const TimeFunction& factor : row.factors) {
            const TimeValue f = factor(at);
            sum += f.value * second[form] + 2 * f.first * first[form] + f.second * one.forms.values[form];
            ++form;
        }
        for (const SmoothFunction& function : row.functions) {
            const SmoothFunction::Value F = value_at(function, one.forms.values + form);
            for (std::size_t k = 0; k < function.n; ++k) {
                sum += F.gradient[k] * second[form + static_cast<int>(k)];
                for (std::size_t l = 0; l < function.n; ++l)
                    sum += first[form + static_cast<int>(k)] * F.hessian[k][l] *
                           first[form + static_cast<int>(l)];
            }
            form += static_cast<int>(function.n);
        }
    }
}

}   // namespace livens::inline dynamics_internal
