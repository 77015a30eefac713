// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration on the whole matrix of (P23): what it asks of a block, each in scaled rows and unknowns
// but given back unscaled (docs/theory.md, "The elements of the paper": Scaling, Newton's iteration).
#include "livens/spacetime/mixed/block.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/solvers/crew.h"

namespace livens::mixed {

namespace {

constexpr int least_shared_columns = 1000;   // of a matrix, that a thread takes

}   // namespace

/// Along time first ("The chain", Stretches); what that refuses has the general LU.
bool BlockFactors::factorise(const SparseMatrix& A, bool is_new, std::span<const int> cuts)
{
    is_general_ = false;
    if (is_new) is_analysed_ = false;
    if (backend_ != SparseBackend::eigen) return factorise_generally(A);
    if (is_new) along_time_.analyse(A, cuts);
    return along_time_.factorise(A) || factorise_generally(A);
}

bool BlockFactors::factorise_generally(const SparseMatrix& A)
{
    is_general_ = true;
    if (!is_analysed_) general_.analyse(A);
    is_analysed_ = true;
    return general_.factorise(A);
}

void BlockFactors::apply_inverse(std::span<const double> b, std::span<double> x) const
{
    is_general_ ? general_.solve(b, x) : along_time_.solve(b, x);
}

/// With one step of refinement.
void BlockFactors::solve(const SparseMatrix& A, std::span<const double> b, std::span<double> x)
{
    missed_.resize(b.size());
    correction_.resize(b.size());
    apply_inverse(b, x);
    if (is_general_) {
        A.multiply(x, missed_);
        for (std::size_t i = 0; i < b.size(); ++i) missed_[i] = b[i] - missed_[i];
    } else {
        std::ranges::copy(b, missed_.begin());
        along_time_.subtract_product(x, missed_);
    }
    apply_inverse(missed_, correction_);
    for_each_item(static_cast<int>(b.size()), least_shared_columns, [&](int i) { x[i] += correction_[i]; });
}

Block::Block(Equations equations, SparseBackend backend, Border* border)
    : equations_(std::move(equations)), border_(border), tangent_(equations_), scaling_(equations_.space()),
      factors_(backend)
{
    fields_[0] = fields_[1] = equations_.space().zero();
}

bool Block::residual()
{
    if (border_ != nullptr && !border_->evaluate(equations_, fields())) return false;
    bad_load_ = equations_.residual(fields(), residual_);
    return bad_load_.empty() &&
           std::all_of(residual_.begin(), residual_.end(), [](double r) { return std::isfinite(r); });
}

/// First rows of stretches: one for few functions, as it is one more for each two nodes that are left to the
/// end; and the end. Of two the first costs a little more, forwards; of four those in the middle carry both
/// of their ends along, and have fewer functions for it.
std::vector<int> Block::cuts() const
{
    const Numbering& numbering = equations_.space().numbering;
    const int n = numbering.n_functions();
    const int n_stretches = n < 32 ? 1 : n < 4096 ? 2 : 4;
    const auto shares = n_stretches == 4 ? std::vector{0.31, 0.5, 0.69} : std::vector{0.485};
    std::vector<int> rows{0};
    for (int s = 1; s < n_stretches; ++s)
        rows.push_back(numbering.row_dP(static_cast<int>(shares[s - 1] * n)));
    rows.push_back(numbering.size());
    return rows;
}

/// The scaled matrix of the equations alone. Returns whether its pattern is another one.
bool Block::form_inner()
{
    const bool is_new = tangent_.evaluate(fields(), inner());
    SparseMatrix& A = inner();
    scaled_.rows.assign(scaling_.rows().begin(), scaling_.rows().end());
    scaled_.columns.assign(scaling_.columns().begin(), scaling_.columns().end());
    for_each_item(A.size, least_shared_columns, [&](int c) {
        for (int k = A.column_starts[c]; k < A.column_starts[c + 1]; ++k)
            A.values[k] *= scaled_.rows[A.rows[k]] * scaled_.columns[c];
    });
    return is_new;
}

bool Block::form()
{
    const bool is_new = form_inner();
    if (border_ == nullptr) return is_new;
    border_->add_to(scaled_, equations_, fields());
    return true;
}

bool Block::factorise()
{
    const bool is_new = form();
    return factors_.factorise(scaled_.all, is_new, cuts());
}

std::vector<double> Block::rows_behind() const
{
    std::vector<double> rows = residual_;
    for (double& row : rows) row = -row;
    if (border_ != nullptr) {
        const std::vector<double>& missed = border_->conditions().missed();
        rows.insert(rows.end(), missed.begin(), missed.end());
    }
    return rows;
}

/// With a border, increments end with those of momenta in world axes, and of unknown numbers.
void Block::solve_for(const Block& other, std::span<double> dx)
{
    work_ = other.rows_behind();
    increment_.resize(work_.size());
    const int n_rows = static_cast<int>(work_.size());
    for_each_item(n_rows, least_shared_columns, [&](int i) { work_[i] *= scaled_.rows[i]; });
    factors_.solve(scaled_.all, work_, increment_);
    for_each_item(n_rows, least_shared_columns, [&](int i) { increment_[i] *= scaled_.columns[i]; });
    const std::size_t n = residual_.size();
    std::copy_n(increment_.begin(), n, dx.begin());
    if (border_ != nullptr) border_->conditions().to_momenta(increment_.data() + n, dx.data() + n);
}

void Block::adopt(const Block& other)
{
    fields_[0] = fields_[1] = other.fields_[other.kept_];
    if (border_ != nullptr) border_->conditions().adopt(other.border_->conditions());
    begin();
}

void Block::move_fields(std::span<const double> dx, double damping)
{
    current_ = 1 - kept_;
    fields_[current_] = fields_[kept_];
    equations_.space().add(fields_[current_], dx, damping);
}

bool Block::move(std::span<const double> dx, double damping)
{
    const auto n = static_cast<std::size_t>(equations_.space().size());
    move_fields(dx.first(n), damping);
    if (border_ != nullptr) border_->conditions().move(dx.subspan(n), damping);
    return true;
}

void Block::keep()
{
    kept_ = current_;
    if (border_ != nullptr) border_->conditions().keep();
}

double Block::size_of(std::span<const double> dx) const
{
    const double size = scaling_.size_of(dx);
    if (border_ == nullptr) return size;
    const double of_momenta =
        border_->conditions().size_of(dx.subspan(static_cast<std::size_t>(equations_.space().size())));
    return of_momenta <= size || std::isnan(size) ? size : of_momenta;
}

NewtonProblem::Rows Block::rows() const
{
    Rows rows;
    rows.terms = std::max(scaling_.largest(fields()), 1e-300);
    // What conditions miss counts by its share of their scales.
    const double missing = border_ != nullptr ? rows.terms * border_->conditions().largest() : 0;
    rows.size = std::max(worst().value, missing);
    return rows;
}

void Block::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    begin();
    form();
    if (!factors_.factorise_generally(scaled_.all)) return;   // which has transposed solutions, too
    const ConditionNumbers condition =
        condition_numbers(scaled_.all, factors_.general(), scaled_.rows, scaled_.columns, goes_on);
    report.condition_1 = condition.one;
    report.condition_2 = condition.two;
    report.scaled_condition = condition_numbers(scaled_.all, factors_.general(), {}, {}, goes_on).one;
}

}   // namespace livens::mixed
