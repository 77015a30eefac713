// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/lanes/row_forms.h"

#include <algorithm>

namespace livens::inline dynamics_internal {

void RowForms::add(const ConstraintRow& row)
{
    Row made{n_forms_, {}, static_cast<int>(row.coordinates.size()), row.function};
    for (const Drive& drive : row.drives) made.factors.push_back(drive.factor);
    n_forms_ = made.first_coordinate() + made.n_coordinates;
    rows_.push_back(std::move(made));
}

SmoothFunction::Value RowForms::function_at(const Row& row, const double* forms) const
{
    SmoothFunction::Point q{};
    for (int k = 0; k < row.n_coordinates; ++k)
        q[static_cast<std::size_t>(k)] = forms[row.first_coordinate() + k];
    return row.function->at(q);
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
        if (row.function) {
            const SmoothFunction::Value F = function_at(row, one.forms.values);
            *sum += F.value;
            for (int k = 0; k < row.n_coordinates; ++k)
                one.forms.weights[form + k] = F.gradient[static_cast<std::size_t>(k)];
        }
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

/// F of the coordinates of all lanes: change += its own, and its gradient are their weights.
void RowForms::add_function(const Row& row, const lanes::Values& start, const lanes::Values& nodes, int width,
                            double* change)
{
    constexpr int most = 8;   // lanes at a time
    SmoothFunction::Point from{}, steps[most]{};
    SmoothFunction::Value after[most];
    const int first = row.first_coordinate(), n = row.n_coordinates;
    for (int k = 0; k < n; ++k) from[static_cast<std::size_t>(k)] = start.forms.values[first + k];
    for (int l = 0; l < width; l += most) {
        const int count = std::min(most, width - l);
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < count; ++i)
                steps[i][static_cast<std::size_t>(k)] = nodes.forms.values[(first + k) * width + l + i];
        const auto n_steps = static_cast<std::size_t>(count);
        row.function->moved(from, {steps, n_steps}, {after, n_steps});
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
        if (row.function) add_function(row, start, nodes, width, change);
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
        if (!row.function) continue;
        const SmoothFunction::Value F = function_at(row, one.forms.values);
        for (int k = 0; k < row.n_coordinates; ++k) {
            const auto a = static_cast<std::size_t>(k);
            sum += F.gradient[a] * second[form + k];
            for (int l = 0; l < row.n_coordinates; ++l)
                sum += first[form + k] * F.hessian[a][static_cast<std::size_t>(l)] * first[form + l];
        }
    }
}

}   // namespace livens::inline dynamics_internal
