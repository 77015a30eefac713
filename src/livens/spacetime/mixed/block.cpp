// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/mixed/block.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::mixed {

Block::Block(Equations equations, SparseBackend backend) : equations_(std::move(equations)), lu_(backend)
{
    fields_[0] = fields_[1] = equations_.zero_fields();
}

bool Block::residual()
{
    bad_load_ = equations_.residual(fields(), residual_);
    return bad_load_.empty() &&
           std::all_of(residual_.begin(), residual_.end(), [](double r) { return std::isfinite(r); });
}

bool Block::factorise()
{
    const bool is_new = equations_.tangent(fields(), scaled_);
    for (int c = 0; c < scaled_.size; ++c)
        for (int k = scaled_.column_starts[c]; k < scaled_.column_starts[c + 1]; ++k)
            scaled_.values[k] *= row_scale_[scaled_.rows[k]] * column_scale_[c];
    if (is_new) lu_.analyse(scaled_);
    return lu_.factorise(scaled_);
}

void Block::solve(std::span<double> dx)
{
    work_.resize(residual_.size());
    increment_.resize(residual_.size());
    for (std::size_t i = 0; i < residual_.size(); ++i) work_[i] = -residual_[i] * row_scale_[i];
    solve_refined(lu_, scaled_, work_, increment_);
    for (std::size_t i = 0; i < increment_.size(); ++i) dx[i] = increment_[i] * column_scale_[i];
}

bool Block::move(std::span<const double> dx, double damping)
{
    current_ = 1 - kept_;
    fields_[current_] = fields_[kept_];
    equations_.add(fields_[current_], dx, damping);
    return true;
}

NewtonProblem::Rows Block::rows() const
{
    Rows rows;
    rows.size = worst().value;
    rows.terms = std::max(reference(), 1e-300);
    return rows;
}

/// Largest scaled momentum or multiplier.
double Block::reference() const
{
    const Numbering& n = equations_.numbering();
    const Coordinates& c = *equations_.setup().coordinates;
    double result = 0;
    for (int A = 0; A < n.n_functions(); ++A)
        for (int i = 0; i < c.size; ++i)
            result = std::max(result, std::abs(fields().P[A * c.size + i]) / c.root_masses[i]);
    for (int A = 0; A < n.n_multiplier_functions(); ++A)
        for (int k = 0; n.lambda(A) >= 0 && k < c.n_rows(); ++k)
            result = std::max(result,
                              std::abs(fields().lambda[A * c.n_rows() + k]) / column_scale_[n.lambda(A) + k]);
    return result;
}

void Block::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    begin();
    if (!factorise()) return;
    const ConditionNumbers condition = condition_numbers(scaled_, lu_, row_scale_, column_scale_, goes_on);
    report.condition_1 = condition.one;
    report.condition_2 = condition.two;
    report.scaled_condition = condition_numbers(scaled_, lu_, {}, {}, goes_on).one;
}

}   // namespace livens::mixed
