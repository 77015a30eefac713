// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration on the whole matrix of (P23): what it asks of a block, each in scaled rows and unknowns
// but given back unscaled (docs/theory.md, "The elements of the paper": Scaling, Newton's iteration).
#include "livens/spacetime/mixed/block.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::mixed {

Block::Block(Equations equations, SparseBackend backend)
    : equations_(std::move(equations)), tangent_(equations_), scaling_(equations_.space()), lu_(backend)
{
    fields_[0] = fields_[1] = equations_.space().zero();
}

bool Block::residual()
{
    bad_load_ = equations_.residual(fields(), residual_);
    return bad_load_.empty() &&
           std::all_of(residual_.begin(), residual_.end(), [](double r) { return std::isfinite(r); });
}

bool Block::factorise()
{
    const bool is_new = tangent_.evaluate(fields(), scaled_);
    const std::span<const double> of_rows = scaling_.rows(), of_columns = scaling_.columns();
    for (int c = 0; c < scaled_.size; ++c)
        for (int k = scaled_.column_starts[c]; k < scaled_.column_starts[c + 1]; ++k)
            scaled_.values[k] *= of_rows[scaled_.rows[k]] * of_columns[c];
    if (is_new) lu_.analyse(scaled_);
    return lu_.factorise(scaled_);
}

void Block::solve(std::span<double> dx)
{
    work_.resize(residual_.size());
    increment_.resize(residual_.size());
    for (std::size_t i = 0; i < residual_.size(); ++i) work_[i] = -residual_[i] * scaling_.rows()[i];
    solve_refined(lu_, scaled_, work_, increment_);
    for (std::size_t i = 0; i < increment_.size(); ++i) dx[i] = increment_[i] * scaling_.columns()[i];
}

bool Block::move(std::span<const double> dx, double damping)
{
    current_ = 1 - kept_;
    fields_[current_] = fields_[kept_];
    equations_.space().add(fields_[current_], dx, damping);
    return true;
}

NewtonProblem::Rows Block::rows() const
{
    Rows rows;
    rows.size = worst().value;
    rows.terms = std::max(scaling_.largest(fields()), 1e-300);
    return rows;
}

void Block::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    begin();
    if (!factorise()) return;
    const ConditionNumbers condition =
        condition_numbers(scaled_, lu_, scaling_.rows(), scaling_.columns(), goes_on);
    report.condition_1 = condition.one;
    report.condition_2 = condition.two;
    report.scaled_condition = condition_numbers(scaled_, lu_, {}, {}, goes_on).one;
}

}   // namespace livens::mixed
