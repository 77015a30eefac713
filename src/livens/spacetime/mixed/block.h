// SPDX-License-Identifier: BSD-3-Clause
// A block of the family mixed as Newton's iteration sees it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/solvers/newton.h"
#include "livens/solvers/staircase.h"
#include "livens/spacetime/mixed/border.h"
#include "livens/spacetime/mixed/scaling.h"
#include "livens/spacetime/mixed/tangent.h"

namespace livens::mixed {

/// Factors of a block's matrix: along time, in stretches that share threads; by a general sparse solver where
/// these meet no pivot, or another backend than Eigen is asked for.
class BlockFactors {
public:
    explicit BlockFactors(SparseBackend backend) : backend_(backend), general_(backend) {}

    /// `is_new`: the pattern; `cuts`: see StaircaseLU. False: singular or not finite.
    bool factorise(const SparseMatrix& A, bool is_new, std::span<const int> cuts);
    /// By the general solver.
    bool factorise_generally(const SparseMatrix& A);
    const SparseLU& general() const { return general_; }
    /// x = A^-1 b, refined once.
    void solve(const SparseMatrix& A, std::span<const double> b, std::span<double> x);
    long long entries() const
    {
        return is_general_ ? general_.factor_entries() : along_time_.factor_entries();
    }

private:
    void apply_inverse(std::span<const double> b, std::span<double> x) const;

    SparseBackend backend_;
    StaircaseLU along_time_;
    SparseLU general_;
    bool is_general_ = false, is_analysed_ = false;
    std::vector<double> missed_, correction_;
};

/// The whole matrix of a block, rows and columns scaled (docs/theory.md, "Scaling"), each
/// solution refined once. Increments are not scaled.
class Block : public NewtonProblem {
public:
    /// `border`: of conditions by component, or null; must outlive it.
    Block(Equations equations, SparseBackend backend, Border* border = nullptr);
    Block(const Block&) = delete;   // its parts know each other
    Block& operator=(const Block&) = delete;

    const Equations& equations() const { return equations_; }
    /// The current point; to be set before an iteration begins.
    Fields& fields() { return fields_[current_]; }
    const Fields& fields() const { return fields_[current_]; }
    /// Scales of rows and columns at the fields as they are; once, before an iteration begins.
    void begin() { scaling_.set(fields()); }
    /// The kept point of a block of the same layout, on another model.
    virtual void adopt(const Block& other);
    /// Rows of the last residual(), then those of conditions, all with the opposite sign.
    std::vector<double> rows_behind() const;
    /// Increments of another block of the same layout, at its current point, by the factors of this one.
    virtual void solve_for(const Block& other, std::span<double> dx);
    Border* border() { return border_; }
    const std::string& bad_load() const { return bad_load_; }
    Worst worst() const { return scaling_.worst(residual_); }
    long long factor_entries() const { return factors_.entries(); }
    /// Of the matrix as published, and of the scaled one that is factorised, at the current point.
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override;

    int n_unknowns() const override
    {
        return equations_.space().size() + (border_ != nullptr ? border_->conditions().n_numbers() : 0);
    }
    bool residual() override;
    bool factorise() override;
    void solve(std::span<double> dx) override { solve_for(*this, dx); }
    bool move(std::span<const double> dx, double damping) override;
    void keep() override;
    double size_of(std::span<const double> dx) const override;
    Rows rows() const override;

protected:
    /// The matrix of the equations alone.
    SparseMatrix& inner() { return border_ != nullptr ? scaled_.inner : scaled_.all; }
    bool form();
    bool form_inner();
    void move_fields(std::span<const double> dx, double damping);
    std::vector<int> cuts() const;

    Equations equations_;
    Border* border_;
    Tangent tangent_;
    Scaling scaling_;
    BlockFactors factors_;
    Fields fields_[2];
    int current_ = 0, kept_ = 0;
    ScaledMatrix scaled_;
    std::vector<double> residual_, work_, increment_;
    std::string bad_load_;   ///< of the last residual
};

}   // namespace livens::mixed
